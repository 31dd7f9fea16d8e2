//! Names of physical methods that options choose between.

use clap::ValueEnum;

/// Which model gives the sky its luminance and colour.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum SkyModel {
    /// Clear sky of Preetham, Shirley & Smits 1999 (the lecture's).
    #[default]
    Preetham,
    /// Clear sky of Hošek & Wilkie 2012.
    Hosek,
    /// CIE standard overcast sky; no sun.
    Overcast,
    /// CIE standard clear sky, white.
    CieClear,
}

/// Which formulas turn place and moment into a sun position.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum SunPositionMethod {
    /// NREL's Solar Position Algorithm (Reda & Andreas 2004).
    #[default]
    Spa,
    /// The lecture's formulas (Preetham et al. 1999, A.6).
    Lecture,
}

/// How luminance becomes a signal between 0 and 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum ToneCurve {
    /// Scale and gamma (the lecture's).
    Linear,
    /// Ferschin's exponential.
    Exponential,
    /// Reinhard's sigmoid.
    #[default]
    Reinhard,
    /// AgX.
    Agx,
    /// Khronos PBR neutral.
    Neutral,
    /// Academy's filmic curve.
    Aces,
}

/// How the irradiance cube is integrated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum IrradianceMethod {
    /// The lecture's random numbers.
    MonteCarlo,
    /// A low-discrepancy sequence.
    #[default]
    Quasi,
    /// Every texel of the sky, no samples.
    Exact,
    /// Spherical harmonics of degree 2.
    Sh,
}
