//! Decoding of common image formats into the textures of a scene, with limits checked before decoding.

use std::collections::{HashMap, HashSet};
use std::io::Cursor;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};

use crate::scene::LoadOptions;
use crate::scene::error::one_line;
use crate::scene::files::Files;
use crate::scene::texture::normal_map::{is_height_field, normals_from_heights};
use crate::scene::texture::{Encoding, Texture, Wrap, srgb8_from_linear};

/// The image channel used as a cut-out mask (MTL `-imfchan`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Channel {
    /// Alpha if the image has one, otherwise the mean of red, green and blue.
    #[default]
    Automatic,
    /// Red, green, blue or alpha: 0..3.
    Number(u8),
}

/// Identifies a texture: equal keys give the same texture.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct TextureKey {
    pub kind: TextureKind,
    /// What is outside of the picture along u and v.
    pub wrap: [Wrap; 2],
}

/// What a texture is made of.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum TextureKind {
    /// Colours; alpha is set to 1.
    Colour(PathBuf),
    /// Colours with the alpha of the image.
    ColourAndAlpha(PathBuf),
    /// Colours with the alpha of the image if that is a cut-out, otherwise 1.
    ColourAndCutOut(PathBuf),
    /// Colours of the first image (white if none), alpha from a channel of the second.
    Masked(Option<PathBuf>, PathBuf, Channel),
    /// A normal map, or a height map to convert into one. The `u32` holds the bits of an `f32`, a factor on its slopes.
    Normals(PathBuf, u32),
    /// Numbers: roughness and metalness.
    Numbers(PathBuf),
}

/// Creates each texture once, and limits memory and decoding work.
#[derive(Debug)]
pub struct TextureStore {
    max_edge: u32,
    bytes_left: u64,
    /// Bytes that may still be decoded, including images that fail or do not become textures.
    effort_left: u64,
    known: HashMap<TextureKey, Option<usize>>,
    /// Images embedded in models, by the names given by the importer.
    embedded: HashMap<PathBuf, EmbeddedImage>,
    means: HashMap<PathBuf, Option<[f32; 4]>>,
    /// Textures whose alpha was found to be a cut-out.
    cut_outs: HashSet<usize>,
}

/// An image embedded in a model.
#[derive(Debug)]
pub struct EmbeddedImage {
    /// The buffer that contains the image; images may share it.
    pub bytes: Rc<Vec<u8>>,
    /// Byte range of the image in the buffer.
    pub range: Range<usize>,
}

/// Decoding budget as a multiple of the texture limit. Bounds the work for thousands of images that fail.
const EFFORT: u64 = 4;

/// End of the warning about an unusable image.
const WITHOUT: &str = "; drawn without it";

impl TextureStore {
    pub fn new(options: &LoadOptions) -> Self {
        Self {
            max_edge: options.max_texture_edge,
            bytes_left: options.max_texture_bytes,
            effort_left: options.max_texture_bytes.saturating_mul(EFFORT),
            means: HashMap::new(),
            cut_outs: HashSet::new(),
            known: HashMap::new(),
            embedded: HashMap::new(),
        }
    }

    /// Registers an image embedded in a model under a name.
    pub fn insert(&mut self, name: PathBuf, picture: EmbeddedImage) {
        self.embedded.insert(name, picture);
    }

    /// Index of the texture in `textures`; `None` if it failed before. Only the first failure is returned as an error.
    pub fn get(
        &mut self,
        files: &Files,
        key: TextureKey,
        textures: &mut Vec<Texture>,
    ) -> Result<Option<usize>, String> {
        if let Some(known) = self.known.get(&key) {
            return Ok(*known);
        }
        let made = self.make(files, &key.kind);
        let index = made.as_ref().ok().map(|_| textures.len());
        let wrap = key.wrap;
        let may_cut = matches!(key.kind, TextureKind::ColourAndCutOut(_));
        self.known.insert(key, index);
        let texture = Texture { wrap, ..made? };
        if may_cut && texture.rgba8.chunks_exact(4).any(|t| t[3] != 255) {
            self.cut_outs.insert(textures.len());
        }
        textures.push(texture);
        Ok(index)
    }

    /// Whether a texture made as [`TextureKind::ColourAndCutOut`] is a cut-out.
    pub fn is_cut_out(&self, texture: usize) -> bool {
        self.cut_outs.contains(&texture)
    }

    fn make(&mut self, files: &Files, kind: &TextureKind) -> Result<Texture, String> {
        match kind {
            TextureKind::Colour(path) => {
                let mut texture = self.colours(files, path)?;
                texture.rgba8.chunks_exact_mut(4).for_each(|t| t[3] = 255);
                Ok(texture)
            }
            TextureKind::ColourAndAlpha(path) => self.colours(files, path),
            TextureKind::ColourAndCutOut(path) => {
                let mut texture = self.colours(files, path)?;
                if !is_cut_out(&texture.rgba8) {
                    texture.rgba8.chunks_exact_mut(4).for_each(|t| t[3] = 255);
                }
                Ok(texture)
            }
            TextureKind::Masked(colour, mask, channel) => {
                let mask = self.colours(files, mask)?;
                // Without the colours, the mask still cuts out the right holes.
                let colour = colour.as_ref().and_then(|p| self.colours(files, p).ok());
                Ok(masked(colour, mask, *channel))
            }
            TextureKind::Normals(path, strength) => {
                let image = self.decode(files, path)?;
                Ok(normals(name_of(path), image, f32::from_bits(*strength)))
            }
            TextureKind::Numbers(path) => {
                let mut texture = self.colours(files, path)?;
                texture.encoding = Encoding::Linear;
                Ok(texture)
            }
        }
    }

    /// Mean red, green, blue and alpha of an image, 0..1 as encoded; `None` if it failed before.
    pub fn mean(&mut self, files: &Files, path: &Path) -> Result<Option<[f32; 4]>, String> {
        if let Some(mean) = self.means.get(path) {
            return Ok(*mean);
        }
        let mean = self.compute_mean(files, path);
        self.means
            .insert(path.to_owned(), mean.as_ref().ok().copied());
        mean.map(Some)
    }

    fn compute_mean(&mut self, files: &Files, path: &Path) -> Result<[f32; 4], String> {
        let before = self.bytes_left;
        let texels = self.decode(files, path)?.into_rgba8();
        self.bytes_left = before;
        let count = 255.0 * (texels.width() as f64 * texels.height() as f64);
        let mut sums = [0u64; 4];
        for texel in texels.pixels() {
            sums.iter_mut()
                .zip(texel.0)
                .for_each(|(sum, v)| *sum += u64::from(v));
        }
        Ok(sums.map(|sum| (sum as f64 / count) as f32))
    }

    fn colours(&mut self, files: &Files, path: &Path) -> Result<Texture, String> {
        let image = self.decode(files, path)?;
        let (width, height) = (image.width(), image.height());
        Ok(Texture {
            name: name_of(path),
            width,
            height,
            rgba8: to_srgb8(image),
            encoding: Encoding::Srgb,
            wrap: [Wrap::Repeat; 2],
        })
    }

    fn decode(&mut self, files: &Files, path: &Path) -> Result<DynamicImage, String> {
        let read;
        let bytes = match self.embedded.get(path) {
            Some(EmbeddedImage { bytes, range }) => &bytes[range.clone()],
            None if !files.has(path) => {
                return Err(format!("texture {} is missing{WITHOUT}", path.display()));
            }
            None => {
                read = files
                    .read(path)
                    .map_err(|error| format!("texture {error}{WITHOUT}"))?;
                &read
            }
        };
        let fails = |what: String| format!("texture {} {what}{WITHOUT}", name_of(path));
        let (decoder, size) =
            open_bounded(path, bytes, self.max_edge, self.bytes_left).map_err(fails)?;
        let left = self.effort_left.checked_sub(size);
        self.effort_left = left.ok_or_else(|| {
            fails("exceeds the limit on decoding pictures; raise --max-texture-mib".to_owned())
        })?;
        let image = DynamicImage::from_decoder(decoder).map_err(|e| fails(undecodable(&e)))?;
        self.bytes_left -= size;
        Ok(image)
    }
}

fn name_of(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

fn undecodable(error: &image::ImageError) -> String {
    format!("cannot be decoded ({})", one_line(&error.to_string()))
}

/// Reads the header of an image and checks its size. Returns the decoder and the size of the resulting texture, bytes.
fn open_bounded<'b>(
    path: &Path,
    bytes: &'b [u8],
    max_edge: u32,
    bytes_left: u64,
) -> Result<(impl ImageDecoder + 'b, u64), String> {
    let unreadable = |error: image::ImageError| undecodable(&error);
    let mut reader = ImageReader::new(Cursor::new(bytes));
    // The format is detected from the content, except for TGA, which has no signature and is recognised by its name.
    match image::guess_format(bytes)
        .ok()
        .or_else(|| ImageFormat::from_path(path).ok())
    {
        Some(format) => reader.set_format(format),
        None => return Err("has an unknown format; convert it to PNG or JPEG".to_owned()),
    }
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(max_edge);
    limits.max_image_height = Some(max_edge);
    // Decoders with 16 or 32 bits per channel need more memory than the result.
    limits.max_alloc = Some(bytes_left.saturating_mul(4));
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(unreadable)?;
    let (width, height) = decoder.dimensions();
    let size = 4 * u64::from(width) * u64::from(height);
    if width == 0 || height == 0 {
        return Err("is empty".to_owned());
    }
    if width.max(height) > max_edge {
        return Err(format!(
            "has {width}x{height} texels, the limit is {max_edge}x{max_edge}; shrink it or raise --max-texture-edge"
        ));
    }
    if size > bytes_left {
        return Err(format!(
            "needs {size} bytes, {bytes_left} are left for textures; raise --max-texture-mib"
        ));
    }
    Ok((decoder, size))
}

/// Converts to 8 bits per channel, sRGB. Floating-point images (HDR) are linear and get encoded; all others are sRGB already.
fn to_srgb8(image: DynamicImage) -> Vec<u8> {
    match image {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            let texels = image.into_rgba32f();
            let byte = |v: &[f32; 4]| {
                [
                    srgb8_from_linear(v[0]),
                    srgb8_from_linear(v[1]),
                    srgb8_from_linear(v[2]),
                    (v[3].clamp(0.0, 1.0) * 255.0).round() as u8,
                ]
            };
            texels.pixels().flat_map(|p| byte(&p.0)).collect()
        }
        other => other.into_rgba8().into_raw(),
    }
}

fn normals(name: String, image: DynamicImage, strength: f32) -> Texture {
    let texels = image.into_rgba8();
    let (width, height) = texels.dimensions();
    let texels = texels.into_raw();
    let rgba8 = if is_height_field(&texels) {
        normals_from_heights(&texels, width, height, strength)
    } else {
        texels
    };
    Texture {
        name,
        width,
        height,
        rgba8,
        encoding: Encoding::Linear,
        wrap: [Wrap::Repeat; 2],
    }
}

/// Share of the texels of a cut-out that are clear or solid, not in between.
const DECIDED: f64 = 0.9;

/// Whether the alpha of a picture (RGBA) cuts out shapes: part of it is clear, part solid, and little in between. Other alphas
/// are glosses, heights, or nothing.
fn is_cut_out(rgba8: &[u8]) -> bool {
    let (mut clear, mut solid) = (0usize, 0usize);
    for texel in rgba8.chunks_exact(4) {
        clear += usize::from(texel[3] < 32);
        solid += usize::from(texel[3] > 223);
    }
    let all = (rgba8.len() / 4) as f64;
    clear > 0 && solid > 0 && (clear + solid) as f64 >= DECIDED * all
}

/// The colours with the mask as alpha, at the size of the colours, or of the mask if there are none.
fn masked(colour: Option<Texture>, mask: Texture, channel: Channel) -> Texture {
    let mut colour = colour.unwrap_or_else(|| Texture {
        rgba8: vec![255; mask.rgba8.len()],
        ..mask.clone()
    });
    let has_alpha = mask.rgba8.chunks_exact(4).any(|t| t[3] != 255);
    let pick = |t: &[u8]| match channel {
        Channel::Number(i) => t[usize::from(i.min(3))],
        Channel::Automatic if has_alpha => t[3],
        // Masks are grey, so the mean is as good as the luminance.
        Channel::Automatic => ((u16::from(t[0]) + u16::from(t[1]) + u16::from(t[2])) / 3) as u8,
    };
    let nearest =
        |i: u32, of: u32, to: u32| (u64::from(i) * u64::from(to) / u64::from(of)) as usize;
    let (width, height) = (colour.width, colour.height);
    for (y, row) in (0..height).zip(colour.rgba8.chunks_exact_mut(4 * width as usize)) {
        let start = nearest(y, height, mask.height) * mask.width as usize;
        for (x, texel) in (0..width).zip(row.chunks_exact_mut(4)) {
            let at = 4 * (start + nearest(x, width, mask.width));
            texel[3] = pick(&mask.rgba8[at..at + 4]);
        }
    }
    colour
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(width: u32, texels: &[[u8; 4]]) -> Texture {
        Texture {
            name: "test".into(),
            width,
            height: texels.len() as u32 / width,
            rgba8: texels.concat(),
            encoding: Encoding::Srgb,
            wrap: [Wrap::Repeat; 2],
        }
    }

    #[test]
    fn masks_become_alpha_in_the_size_of_the_colour() {
        let mask = texture(2, &[[0, 0, 0, 255], [255, 255, 255, 255]]);
        let red = texture(4, &[[200, 0, 0, 255]; 8]);
        let both = masked(Some(red), mask.clone(), Channel::Automatic);
        let alphas: Vec<u8> = both.rgba8.chunks_exact(4).map(|t| t[3]).collect();
        assert_eq!(alphas, [0, 0, 255, 255, 0, 0, 255, 255]);
        assert_eq!(both.rgba8[0], 200);
        let white = masked(None, mask, Channel::Number(0));
        assert_eq!(white.rgba8, [255, 255, 255, 0, 255, 255, 255, 255]);
    }

    #[test]
    fn an_alpha_is_a_cut_out_if_it_is_clear_and_solid() {
        let alphas =
            |list: &[u8]| is_cut_out(&list.iter().flat_map(|a| [9, 9, 9, *a]).collect::<Vec<_>>());
        assert!(alphas(&[0, 255]) && alphas(&[0, 0, 0, 0, 0, 0, 0, 0, 250, 128]));
        assert!(!alphas(&[255; 9]) && !alphas(&[0; 9]), "one of both");
        assert!(!alphas(&[0, 60, 128, 190, 255]), "a gloss");
    }

    #[test]
    fn the_alpha_of_a_mask_counts_if_it_has_any() {
        let mask = texture(2, &[[9, 9, 9, 0], [9, 9, 9, 255]]);
        let both = masked(None, mask.clone(), Channel::Automatic);
        assert_eq!((both.rgba8[3], both.rgba8[7]), (0, 255));
        let red = masked(None, mask, Channel::Number(0));
        assert_eq!((red.rgba8[3], red.rgba8[7]), (9, 9));
    }
}
