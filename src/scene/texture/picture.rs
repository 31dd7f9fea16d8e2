//! Pictures of any common format, bounded before they are decoded, as the textures of a scene.

use std::collections::HashMap;
use std::io::Cursor;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};

use crate::scene::LoadOptions;
use crate::scene::files::Files;
use crate::scene::texture::normal_map::{is_height_field, normals_from_heights};
use crate::scene::texture::{Encoding, Texture, encode};

/// Which channel of a picture is the mask of a cut-out (MTL `-imfchan`).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub(in crate::scene) enum Channel {
    /// Alpha if the picture has any, else luminance.
    #[default]
    Automatic,
    /// Red, green, blue or alpha: 0..3.
    Number(u8),
}

/// What a texture is made of: the same wish gives the same texture.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub(in crate::scene) enum Wanted {
    /// A colour; its alpha is 1.
    Colour(PathBuf),
    /// A colour with the alpha of the picture.
    ColourAndAlpha(PathBuf),
    /// The alpha from the second picture; without a first one the colour is white.
    Masked(Option<PathBuf>, PathBuf, Channel),
    /// Numbers as they stand: a normal map, or a height map (its slopes multiplied by the `f32` of these bits) turned into one.
    Normals(PathBuf, u32),
}

/// Makes each texture once and bounds what all of them may take.
#[derive(Debug)]
pub(in crate::scene) struct TextureStore {
    max_edge: u32,
    bytes_left: u64,
    /// Texels that may still be decoded, in bytes: also for pictures that fail in the end, and for those that are no textures.
    effort_left: u64,
    known: HashMap<Wanted, Option<usize>>,
    /// Pictures inside of models, by the names that the reader of the model made up for them.
    inner: HashMap<PathBuf, Inner>,
    means: HashMap<PathBuf, Result<[f32; 3], String>>,
}

/// A picture inside of a model.
#[derive(Debug)]
pub(in crate::scene) struct Inner {
    /// What it is a part of; many may be parts of the same.
    pub bytes: Rc<Vec<u8>>,
    /// Which part.
    pub range: Range<usize>,
}

/// Times the bytes of all textures that decoding may take: nobody waits for thousands of pictures that fail.
const EFFORT: u64 = 4;

const PLAIN: &str = "; drawn in its plain colour";

impl TextureStore {
    pub fn new(options: &LoadOptions) -> Self {
        Self {
            max_edge: options.max_texture_edge,
            bytes_left: options.max_texture_bytes,
            effort_left: options.max_texture_bytes.saturating_mul(EFFORT),
            means: HashMap::new(),
            known: HashMap::new(),
            inner: HashMap::new(),
        }
    }

    /// Makes a picture inside of a model known as `name`.
    pub fn insert(&mut self, name: PathBuf, picture: Inner) {
        self.inner.insert(name, picture);
    }

    /// The number of the texture in `textures`. None if it failed before; an error says why the first time.
    pub fn get(
        &mut self,
        files: &Files,
        wanted: Wanted,
        textures: &mut Vec<Texture>,
    ) -> Result<Option<usize>, String> {
        if let Some(known) = self.known.get(&wanted) {
            return Ok(*known);
        }
        let made = self.make(files, &wanted);
        let number = made.as_ref().ok().map(|_| textures.len());
        self.known.insert(wanted, number);
        textures.push(made?);
        Ok(number)
    }

    fn make(&mut self, files: &Files, wanted: &Wanted) -> Result<Texture, String> {
        match wanted {
            Wanted::Colour(path) => {
                let mut texture = self.colours(files, path)?;
                texture.rgba8.chunks_exact_mut(4).for_each(|t| t[3] = 255);
                Ok(texture)
            }
            Wanted::ColourAndAlpha(path) => self.colours(files, path),
            Wanted::Masked(colour, mask, channel) => {
                let mask = self.colours(files, mask)?;
                // A colour that fails leaves white: the holes are still right.
                let colour = colour.as_ref().and_then(|p| self.colours(files, p).ok());
                Ok(masked(colour, mask, *channel))
            }
            Wanted::Normals(path, strength) => {
                let image = self.decode(files, path)?;
                Ok(normals(name_of(path), image, f32::from_bits(*strength)))
            }
        }
    }

    /// The mean red, green and blue of a picture that is no texture by itself, 0..1 as they stand.
    pub fn mean(&mut self, files: &Files, path: &Path) -> Result<[f32; 3], String> {
        if let Some(mean) = self.means.get(path) {
            return mean.clone();
        }
        let mean = self.compute_mean(files, path);
        self.means.insert(path.to_owned(), mean.clone());
        mean
    }

    fn compute_mean(&mut self, files: &Files, path: &Path) -> Result<[f32; 3], String> {
        let before = self.bytes_left;
        let texels = self.decode(files, path)?.into_rgba8();
        self.bytes_left = before;
        let count = 255.0 * (texels.width() as f64 * texels.height() as f64);
        let mut sums = [0u64; 3];
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
        })
    }

    fn decode(&mut self, files: &Files, path: &Path) -> Result<DynamicImage, String> {
        let read;
        let bytes = match self.inner.get(path) {
            Some(Inner { bytes, range }) => &bytes[range.clone()],
            None if !files.has(path) => {
                return Err(format!("texture {} is missing{PLAIN}", path.display()));
            }
            None => {
                read = files
                    .read(path)
                    .map_err(|error| format!("texture {error}{PLAIN}"))?;
                &read
            }
        };
        let fails = |what: String| format!("texture {} {what}{PLAIN}", name_of(path));
        let (decoder, size) =
            open_bounded(path, bytes, self.max_edge, self.bytes_left).map_err(fails)?;
        let left = self.effort_left.checked_sub(size);
        self.effort_left = left.ok_or_else(|| {
            fails("is one picture too many to decode; raise --max-texture-mib".to_owned())
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

/// A picture whose header is read, and the bytes that it takes as a texture. Refuses by the header alone what is too large.
fn open_bounded<'b>(
    path: &Path,
    bytes: &'b [u8],
    max_edge: u32,
    bytes_left: u64,
) -> Result<(impl ImageDecoder + 'b, u64), String> {
    let unreadable = |error: image::ImageError| undecodable(&error);
    let mut reader = ImageReader::new(Cursor::new(bytes));
    // The content decides; TGA alone has no signature, so there the name does.
    match image::guess_format(bytes)
        .ok()
        .or_else(|| ImageFormat::from_path(path).ok())
    {
        Some(format) => reader.set_format(format),
        None => return Err("is in no known format (use PNG or JPEG)".to_owned()),
    }
    let mut limits = image::Limits::default();
    limits.max_image_width = Some(max_edge);
    limits.max_image_height = Some(max_edge);
    // Decoders of 16 and 32 bit a channel need more than the result does.
    limits.max_alloc = Some(bytes_left.saturating_mul(4));
    reader.limits(limits);
    let decoder = reader.into_decoder().map_err(unreadable)?;
    let (width, height) = decoder.dimensions();
    let size = 4 * u64::from(width) * u64::from(height);
    if width == 0 || height == 0 {
        return Err("has no texels".to_owned());
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

/// Eight bits a channel, sRGB. Float pictures (HDR) hold linear light and are encoded; all others are sRGB already.
fn to_srgb8(image: DynamicImage) -> Vec<u8> {
    match image {
        DynamicImage::ImageRgb32F(_) | DynamicImage::ImageRgba32F(_) => {
            let texels = image.into_rgba32f();
            let byte = |v: &[f32; 4]| {
                [
                    encode(v[0]),
                    encode(v[1]),
                    encode(v[2]),
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
    }
}

/// The colour with the mask as its alpha, each taken at the size of the colour, or of the mask if there is no colour.
fn masked(colour: Option<Texture>, mask: Texture, channel: Channel) -> Texture {
    let mut colour = colour.unwrap_or_else(|| Texture {
        rgba8: vec![255; mask.rgba8.len()],
        ..mask.clone()
    });
    let has_alpha = mask.rgba8.chunks_exact(4).any(|t| t[3] != 255);
    let pick = |t: &[u8]| match channel {
        Channel::Number(i) => t[usize::from(i.min(3))],
        Channel::Automatic if has_alpha => t[3],
        // Masks are drawn in black and white: the mean serves as well as a luminance.
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

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
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
        }
    }

    #[test]
    fn masks_become_alpha_at_the_size_of_the_colour() {
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
    fn a_mask_with_alpha_means_its_alpha() {
        let mask = texture(2, &[[9, 9, 9, 0], [9, 9, 9, 255]]);
        let both = masked(None, mask.clone(), Channel::Automatic);
        assert_eq!((both.rgba8[3], both.rgba8[7]), (0, 255));
        let red = masked(None, mask, Channel::Number(0));
        assert_eq!((red.rgba8[3], red.rgba8[7]), (9, 9));
    }
}
