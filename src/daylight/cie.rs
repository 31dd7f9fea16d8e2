//! Standard skies of the CIE: the fifteen general skies and the traditional overcast one (ISO 15469:2004 = CIE S 011/E:2003).
//!
//! They define relative luminances only; a horizontal diffuse illuminance in lux scales them. If none is measured,
//! [`daylight_availability`] estimates one from the sun's elevation and the cover that the standard's name of the sky tells.

use std::f64::consts::PI;

use super::grey_sky::Distribution;

/// Sky types of the IES, "Recommended practice for the calculation of daylight availability" (1984).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SkyCover {
    /// 800 + 15 500 √(sin el) lux; the sun shines.
    Clear,
    /// 300 + 45 000 sin el lux; the sun shines through gaps and thin clouds, see [`partly_cloudy_sun`].
    PartlyCloudy,
    /// 300 + 21 000 sin el lux; no sun.
    Overcast,
}

/// Horizontal diffuse illuminance, lux, with the sun at `elevation_deg` (clamped to 0..=90). See [`SkyCover`].
pub fn daylight_availability(cover: SkyCover, elevation_deg: f64) -> f64 {
    let sine = elevation_deg.clamp(0.0, 90.0).to_radians().sin();
    match cover {
        SkyCover::Clear => 800.0 + 15_500.0 * sine.sqrt(),
        SkyCover::PartlyCloudy => 300.0 + 45_000.0 * sine,
        SkyCover::Overcast => 300.0 + 21_000.0 * sine,
    }
}

/// IES 1984: illuminance of the sun at normal incidence in a partly cloudy sky, lux: 127 500 exp(-0.80 m), m the air mass.
pub fn partly_cloudy_sun(air_mass: f64) -> f64 {
    127_500.0 * (-0.80 * air_mass).exp()
}

/// A standard sky.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandardSky {
    /// Relative luminances.
    pub distribution: Distribution,
    /// Level of the sky and of the sun.
    pub cover: SkyCover,
    /// Whether the sun gives light: not in overcast skies, and not in type 9, "with the obscured sun".
    pub has_sun: bool,
}

/// ISO 15469:2004, table 1: a, b, c, d, e of the types 1..=15.
const GENERAL: [[f64; 5]; 15] = [
    [4.0, -0.70, 0.0, -1.0, 0.0],
    [4.0, -0.70, 2.0, -1.5, 0.15],
    [1.1, -0.8, 0.0, -1.0, 0.0],
    [1.1, -0.8, 2.0, -1.5, 0.15],
    [0.0, -1.0, 0.0, -1.0, 0.0],
    [0.0, -1.0, 2.0, -1.5, 0.15],
    [0.0, -1.0, 5.0, -2.5, 0.30],
    [0.0, -1.0, 10.0, -3.0, 0.45],
    [-1.0, -0.55, 2.0, -1.5, 0.15],
    [-1.0, -0.55, 5.0, -2.5, 0.30],
    [-1.0, -0.55, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 10.0, -3.0, 0.45],
    [-1.0, -0.32, 16.0, -3.0, 0.30],
    [-1.0, -0.15, 16.0, -3.0, 0.30],
    [-1.0, -0.15, 24.0, -2.8, 0.15],
];

/// The sky type whose name the standard gives as "CIE standard clear sky, low illuminance turbidity" (Kittler 1967).
pub const CLEAR: u8 = 12;

/// The traditional overcast sky (Moon & Spencer 1942), the standard's type 16: L = L_z (1 + 2 sin el)/3.
pub const OVERCAST: u8 = 16;

/// The sky of a type, 1..=16; numbers beyond are clamped.
///
/// φ(Z) = 1 + a exp(b / cos Z), f(χ) = 1 + c (exp(d χ) - exp(d π/2)) + e cos² χ.
pub fn standard_sky(number: u8) -> StandardSky {
    let number = number.clamp(1, OVERCAST);
    let (gradation, indicatrix) = match GENERAL.get(usize::from(number) - 1) {
        Some(&[a, b, c, d, e]) => {
            let constant = 1.0 - c * (d * PI / 2.0).exp();
            ([a, b, 0.0], [constant, c, d, e])
        }
        None => ([0.0, -1.0, 2.0], Distribution::UNIFORM.indicatrix),
    };
    let cover = match number {
        1..=5 | OVERCAST => SkyCover::Overcast,
        6..=10 => SkyCover::PartlyCloudy,
        _ => SkyCover::Clear,
    };
    StandardSky {
        distribution: Distribution {
            gradation,
            indicatrix,
            // At lower cosines exp(b / cos Z) is 0 for every type.
            least_cosine: 1e-4,
        },
        cover,
        has_sun: cover != SkyCover::Overcast && number != 9,
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::daylight::grey_sky::GreySky;
    use crate::daylight::preetham::angle_between;
    use crate::daylight::sun_position::direction;

    #[test]
    fn overcast_zenith_is_three_times_the_horizon() {
        let sky = GreySky::new(standard_sky(OVERCAST).distribution, DVec3::Y, 10_000.0);
        let (up, level) = (sky.radiance(DVec3::Y).x, sky.radiance(DVec3::X).x);
        assert!((up / level - 3.0).abs() < 1e-12, "{up} {level}");
        assert!((up / (10_000.0 * 9.0 / (7.0 * PI)) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn clear_sky_is_kittlers() {
        let sun = direction(0.0, 40.0);
        let sky = GreySky::new(standard_sky(CLEAR).distribution, sun, 10_000.0);
        let kittler = |dir: DVec3| {
            let f = |g: f64| {
                1.0 - 10.0 * (-1.5 * PI).exp() + 10.0 * (-3.0 * g).exp() + 0.45 * g.cos().powi(2)
            };
            let phi = |cosine: f64| 1.0 - (-0.32 / cosine).exp();
            f(angle_between(dir, sun)) * phi(dir.y) / (f(50f64.to_radians()) * phi(1.0))
        };
        for dir in [direction(10.0, 5.0), direction(120.0, 60.0), sun] {
            let ratio = sky.radiance(dir).x / sky.radiance(DVec3::Y).x;
            assert!((ratio / kittler(dir) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_cover_tells_level_and_sun() {
        let suns = (1..=16).filter(|n| standard_sky(*n).has_sun);
        assert_eq!(suns.collect::<Vec<_>>(), [6, 7, 8, 10, 11, 12, 13, 14, 15]);
        let lux = |cover| daylight_availability(cover, 30.0);
        let [clear, partly, overcast] =
            [SkyCover::Clear, SkyCover::PartlyCloudy, SkyCover::Overcast].map(lux);
        assert!(
            partly > clear && clear > overcast,
            "{partly} {clear} {overcast}"
        );
        assert!((partly_cloudy_sun(1.0) - 57_289.0).abs() < 1.0);
    }
}
