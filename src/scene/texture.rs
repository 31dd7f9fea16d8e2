//! Textures: pictures of any common format as sRGB bytes, and their mip levels filtered in linear light.

use std::collections::HashMap;
use std::io::Cursor;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader};

use super::LoadOptions;
use super::files::Files;

/// A picture, or one mip level of it: sRGB-encoded RGBA, rows from the top, no padding.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Texture {
    /// File name, for messages and debug labels.
    pub name: String,
    /// Texels in a row, at least 1.
    pub width: u32,
    /// Rows, at least 1.
    pub height: u32,
    /// `4 * width * height` bytes; red, green and blue are sRGB-encoded, alpha is linear.
    pub rgba8: Vec<u8>,
}

impl Texture {
    /// All mip levels below this one, down to 1 x 1: each texel is the average, in linear light, of the texels that it
    /// covers in the level above.
    pub fn mip_levels(&self) -> Vec<Texture> {
        let mut levels: Vec<Texture> = Vec::new();
        loop {
            let above = levels.last().unwrap_or(self);
            if above.width == 1 && above.height == 1 {
                return levels;
            }
            let level = halve(above);
            levels.push(level);
        }
    }

    fn linear(&self, x: u32, y: u32) -> [f32; 4] {
        let at = 4 * (y as usize * self.width as usize + x as usize);
        let [r, g, b, a] = [0, 1, 2, 3].map(|i| self.rgba8[at + i]);
        let light = |v: u8| CODEC.linear[usize::from(v)];
        [light(r), light(g), light(b), f32::from(a) / 255.0]
    }
}

/// The next mip level: half the size, rounded down. An odd edge is shared between its two neighbours by area.
fn halve(above: &Texture) -> Texture {
    let (width, height) = ((above.width / 2).max(1), (above.height / 2).max(1));
    let mut rgba8 = Vec::with_capacity(4 * width as usize * height as usize);
    let columns: Vec<_> = (0..width)
        .map(|x| footprint(x, above.width, width))
        .collect();
    for y in 0..height {
        let rows = footprint(y, above.height, height);
        for columns in &columns {
            let mut sum = [0.0f32; 4];
            for (y, wy) in rows.iter().filter(|(_, w)| *w > 0.0) {
                for (x, wx) in columns.iter().filter(|(_, w)| *w > 0.0) {
                    let texel = above.linear(*x, *y);
                    sum.iter_mut()
                        .zip(texel)
                        .for_each(|(s, v)| *s += wx * wy * v);
                }
            }
            let [r, g, b, a] = sum;
            rgba8.extend([encode(r), encode(g), encode(b), (a * 255.0).round() as u8]);
        }
    }
    Texture {
        name: above.name.clone(),
        width,
        height,
        rgba8,
    }
}

/// The up to three texels above that texel `i` of `small` covers, with weights that sum to 1.
fn footprint(i: u32, large: u32, small: u32) -> [(u32, f32); 3] {
    let ratio = f64::from(large) / f64::from(small);
    let (start, end) = (f64::from(i) * ratio, f64::from(i + 1) * ratio);
    let first = start.floor() as u32;
    [0, 1, 2].map(|k| {
        let texel = (first + k).min(large - 1);
        let low = start.max(f64::from(first + k));
        let high = end.min(f64::from(first + k + 1));
        let covered = if first + k < large {
            (high - low).max(0.0)
        } else {
            0.0
        };
        (texel, (covered / ratio) as f32)
    })
}

/// IEC 61966-2-1 as tables: `linear` decodes, `threshold[v]` is the light above which byte `v` becomes `v + 1`.
struct Codec {
    linear: [f32; 256],
    threshold: [f32; 255],
}

static CODEC: LazyLock<Codec> = LazyLock::new(|| Codec {
    linear: std::array::from_fn(|v| decode(v as f64 / 255.0) as f32),
    threshold: std::array::from_fn(|v| decode((v as f64 + 0.5) / 255.0) as f32),
});

/// IEC 61966-2-1, section 5.2: sRGB signal to linear light, both 0..1.
fn decode(signal: f64) -> f64 {
    if signal <= 0.04045 {
        signal / 12.92
    } else {
        ((signal + 0.055) / 1.055).powf(2.4)
    }
}

/// The byte whose light is nearest in the signal, for light 0..1.
fn encode(light: f32) -> u8 {
    CODEC
        .threshold
        .partition_point(|threshold| *threshold < light) as u8
}

/// Decodes each picture once and bounds what all of them may take.
#[derive(Debug)]
pub(super) struct TextureStore {
    max_edge: u32,
    bytes_left: u64,
    known: HashMap<PathBuf, Option<usize>>,
}

impl TextureStore {
    pub fn new(options: &LoadOptions) -> Self {
        Self {
            max_edge: options.max_texture_edge,
            bytes_left: options.max_texture_bytes,
            known: HashMap::new(),
        }
    }

    /// The number of the picture in `textures`. None if it failed before; an error says why the first time.
    pub fn get(
        &mut self,
        files: &Files,
        path: &Path,
        textures: &mut Vec<Texture>,
    ) -> Result<Option<usize>, String> {
        if let Some(known) = self.known.get(path) {
            return Ok(*known);
        }
        let decoded = self.decode(files, path);
        let number = decoded.as_ref().ok().map(|_| textures.len());
        self.known.insert(path.to_owned(), number);
        textures.push(decoded?);
        Ok(number)
    }

    fn decode(&mut self, files: &Files, path: &Path) -> Result<Texture, String> {
        let plain = "; drawn in its plain colour";
        if !files.has(path) {
            return Err(format!("texture {} is missing{plain}", path.display()));
        }
        let bytes = files
            .read(path)
            .map_err(|error| format!("texture {error}{plain}"))?;
        let name = path
            .file_name()
            .unwrap_or_default()
            .to_string_lossy()
            .into_owned();
        let image = self
            .decode_bytes(path, &bytes)
            .map_err(|what| format!("texture {name} {what}{plain}"))?;
        let (width, height) = (image.width(), image.height());
        Ok(Texture {
            name,
            width,
            height,
            rgba8: to_srgb8(image),
        })
    }

    /// Refuses by the header alone what is too large.
    fn decode_bytes(&mut self, path: &Path, bytes: &[u8]) -> Result<DynamicImage, String> {
        let unreadable = |error: image::ImageError| {
            format!("cannot be decoded ({})", one_line(&error.to_string()))
        };
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
        limits.max_image_width = Some(self.max_edge);
        limits.max_image_height = Some(self.max_edge);
        // Decoders of 16 and 32 bit a channel need more than the result does.
        limits.max_alloc = Some(self.bytes_left.saturating_mul(4));
        reader.limits(limits);
        let decoder = reader.into_decoder().map_err(unreadable)?;
        let (width, height) = decoder.dimensions();
        let size = 4 * u64::from(width) * u64::from(height);
        if width == 0 || height == 0 {
            return Err("has no texels".to_owned());
        }
        if width.max(height) > self.max_edge {
            return Err(format!(
                "has {width}x{height} texels, the limit is {0}x{0}",
                self.max_edge
            ));
        }
        if size > self.bytes_left {
            return Err(format!(
                "needs {size} bytes, {} are left for textures",
                self.bytes_left
            ));
        }
        let image = DynamicImage::from_decoder(decoder).map_err(unreadable)?;
        self.bytes_left -= size;
        Ok(image)
    }
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

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texture(width: u32, height: u32, texel: impl Fn(u32, u32) -> [u8; 4]) -> Texture {
        let rgba8 = (0..height)
            .flat_map(|y| (0..width).map(move |x| (x, y)))
            .flat_map(|(x, y)| texel(x, y))
            .collect();
        Texture {
            name: "test".into(),
            width,
            height,
            rgba8,
        }
    }

    #[test]
    fn encoding_undoes_decoding() {
        for v in 0..=255u8 {
            assert_eq!(encode(CODEC.linear[usize::from(v)]), v);
        }
        assert_eq!((encode(-1.0), encode(2.0), encode(f32::NAN)), (0, 255, 0));
    }

    #[test]
    fn black_and_white_average_to_half_the_light() {
        let board = texture(2, 2, |x, y| [if (x + y) % 2 == 0 { 255 } else { 0 }; 4]);
        let levels = board.mip_levels();
        assert_eq!(levels.len(), 1);
        assert_eq!(
            levels[0].rgba8,
            [188, 188, 188, 128],
            "188 is half the light of 255; alpha is linear"
        );
    }

    #[test]
    fn levels_halve_down_to_one_texel() {
        let sizes = |w, h| -> Vec<(u32, u32)> {
            texture(w, h, |_, _| [7; 4])
                .mip_levels()
                .iter()
                .map(|l| (l.width, l.height))
                .collect()
        };
        assert_eq!(sizes(8, 2), [(4, 1), (2, 1), (1, 1)]);
        assert_eq!(sizes(5, 3), [(2, 1), (1, 1)]);
        assert!(sizes(1, 1).is_empty());
    }

    #[test]
    fn a_constant_stays_and_odd_edges_lose_no_light() {
        let grey = texture(7, 5, |_, _| [90, 120, 3, 255]);
        assert!(
            grey.mip_levels()
                .iter()
                .all(|l| l.rgba8.chunks_exact(4).all(|t| t == [90, 120, 3, 255]))
        );
        let weights: f32 = (0..3)
            .flat_map(|i| footprint(i, 7, 3))
            .map(|(_, w)| w)
            .sum();
        assert!((weights - 3.0).abs() < 1e-5);
        let last = footprint(2, 7, 3);
        assert!(
            last.iter().any(|(x, w)| *x == 6 && *w > 0.3),
            "the last column counts: {last:?}"
        );
    }
}
