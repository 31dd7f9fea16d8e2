//! How precisely radiance is kept.

use crate::gpu::Format;

/// Precision of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Precision {
    /// Half floats: for the screen. The sun's disc is cut at 65 504 kcd/m².
    Half,
    /// 32-bit floats: for files and sums.
    Float,
}

impl Precision {
    pub(in crate::passes) fn format(self) -> Format {
        match self {
            Self::Half => Format::R16G16B16A16_SFLOAT,
            Self::Float => Format::R32G32B32A32_SFLOAT,
        }
    }

    /// Largest radiance that the format holds, kcd/m².
    pub(in crate::passes) fn max_radiance(self) -> f32 {
        match self {
            Self::Half => 65_504.0,
            Self::Float => f32::MAX,
        }
    }
}
