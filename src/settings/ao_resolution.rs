//! How finely ambient occlusion is computed.

use clap::ValueEnum;

/// How finely ambient occlusion is computed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum AoResolution {
    /// Half from 720 rows on, full below.
    #[default]
    Auto,
    /// From every pixel, at every second of every second row.
    Full,
    /// From every second pixel of every second row, at every fourth of every fourth.
    Half,
}

impl AoResolution {
    /// Pixels of a picture of so many rows to an occluder, each way.
    pub fn downscale(self, rows: u32) -> u32 {
        match self {
            Self::Full => 1,
            Self::Half => 2,
            Self::Auto => 1 + u32::from(rows >= 720),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pictures_have_an_occluder_at_every_pixel() {
        let of = |rows| AoResolution::Auto.downscale(rows);
        assert_eq!([of(360), of(719), of(720), of(2160)], [1, 1, 2, 2]);
    }
}
