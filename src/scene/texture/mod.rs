//! Textures: sRGB colours or linear values with 8 bits per channel, and mip levels filtered in linear light.

pub mod normal_map;
pub mod picture;

use std::sync::LazyLock;

use serde::{Deserialize, Serialize};

/// Encoding of the red, green and blue channels of a [`Texture`]; alpha is always linear.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Encoding {
    /// sRGB.
    Srgb,
    /// Linear: the vectors of a normal map, 0..255 for −1..1.
    Linear,
}

/// What a texture shows outside of its picture, along one side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default, Serialize, Deserialize)]
pub enum Wrap {
    /// The picture again.
    #[default]
    Repeat,
    /// The picture mirrored, then again.
    Mirror,
    /// The edge.
    Clamp,
}

impl Wrap {
    /// The texel, 0..`count`, that stands for texel `i` of the plane.
    pub fn texel(self, i: i64, count: u32) -> u32 {
        let n = i64::from(count);
        let inside = match self {
            Self::Repeat => i.rem_euclid(n),
            Self::Clamp => i.clamp(0, n - 1),
            Self::Mirror => {
                let pair = i.rem_euclid(2 * n);
                pair.min(2 * n - 1 - pair)
            }
        };
        inside as u32
    }
}

/// An image or one of its mip levels: RGBA, top row first, no padding.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Texture {
    /// File name, for messages and debug names.
    pub name: String,
    /// Width, texels, at least 1.
    pub width: u32,
    /// Height, texels, at least 1.
    pub height: u32,
    /// `4 * width * height` bytes.
    pub rgba8: Vec<u8>,
    /// Encoding of red, green and blue.
    pub encoding: Encoding,
    /// What is outside of the picture along u and v.
    pub wrap: [Wrap; 2],
}

impl Texture {
    /// All mip levels below this one, down to 1 x 1. Each texel is the average, in linear light, of the texels it covers in the
    /// level above.
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

    /// A texel in linear light, RGBA.
    pub fn linear(&self, x: u32, y: u32) -> [f32; 4] {
        let at = 4 * (y as usize * self.width as usize + x as usize);
        let [r, g, b, a] = [0, 1, 2, 3].map(|i| self.rgba8[at + i]);
        let plain = |v: u8| f32::from(v) / 255.0;
        let light = |v: u8| match self.encoding {
            Encoding::Srgb => CODEC.linear[usize::from(v)],
            Encoding::Linear => plain(v),
        };
        [light(r), light(g), light(b), plain(a)]
    }
}

/// The next mip level: half the size, rounded down. With odd sizes, a texel that straddles two is shared by area.
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
            let plain = |v: f32| (v * 255.0).round() as u8;
            let byte = |v: f32| match above.encoding {
                Encoding::Srgb => srgb8_from_linear(v),
                Encoding::Linear => plain(v),
            };
            rgba8.extend([byte(r), byte(g), byte(b), plain(a)]);
        }
    }
    Texture {
        name: above.name.clone(),
        width,
        height,
        rgba8,
        encoding: above.encoding,
        wrap: above.wrap,
    }
}

/// The up to three of `large` texels covered by texel `i` of `small`, with weights that sum to 1.
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

/// IEC 61966-2-1 as lookup tables: `linear` decodes; `threshold[v]` is the linear value above which byte `v` becomes `v + 1`.
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

/// IEC 61966-2-1, section 5.2: sRGB signal to linear light, both 0..1.
pub fn linear_from_srgb(signal: f32) -> f32 {
    decode(f64::from(signal)) as f32
}

/// The sRGB byte nearest to a linear value, 0..1.
pub fn srgb8_from_linear(light: f32) -> u8 {
    CODEC
        .threshold
        .partition_point(|threshold| *threshold < light) as u8
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
            encoding: Encoding::Srgb,
            wrap: [Wrap::Repeat; 2],
        }
    }

    #[test]
    fn texels_outside_of_the_picture() {
        let row = |wrap: Wrap| (-3..6).map(|i| wrap.texel(i, 3)).collect::<Vec<_>>();
        assert_eq!(row(Wrap::Repeat), [0, 1, 2, 0, 1, 2, 0, 1, 2]);
        assert_eq!(row(Wrap::Mirror), [2, 1, 0, 0, 1, 2, 2, 1, 0]);
        assert_eq!(row(Wrap::Clamp), [0, 0, 0, 0, 1, 2, 2, 2, 2]);
    }

    #[test]
    fn encoding_undoes_decoding() {
        for v in 0..=255u8 {
            assert_eq!(srgb8_from_linear(CODEC.linear[usize::from(v)]), v);
        }
        assert_eq!(
            (
                srgb8_from_linear(-1.0),
                srgb8_from_linear(2.0),
                srgb8_from_linear(f32::NAN)
            ),
            (0, 255, 0)
        );
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
    fn a_constant_stays_and_odd_sizes_lose_no_light() {
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
