//! Standard skies of the CIE: overcast (Moon & Spencer 1942) and clear (Kittler 1967).
//!
//! They define relative luminances only; a horizontal diffuse illuminance in lux scales them. If none is measured,
//! [`daylight_availability`] estimates one from the sun's elevation. Both skies are white (D65, R = G = B).

use std::f64::consts::PI;

use glam::DVec3;

use super::colour::D65_WHITE;
use super::preetham::{PerezSky, angle_between, perez};
use super::quadrature::horizontal_irradiance;

/// Sky types of the IES Lighting Handbook, "Daylight availability" (Gillette, Pierpoint & Treado 1984): horizontal diffuse
/// illuminance by the sun's elevation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SkyCover {
    /// 800 + 15 500 √(sin el) lux.
    Clear,
    /// 300 + 21 000 sin el lux.
    Overcast,
}

/// Horizontal diffuse illuminance, lux, with the sun at `elevation_deg` (clamped to 0..=90). See [`SkyCover`].
pub fn daylight_availability(cover: SkyCover, elevation_deg: f64) -> f64 {
    let sine = elevation_deg.clamp(0.0, 90.0).to_radians().sin();
    match cover {
        SkyCover::Clear => 800.0 + 15_500.0 * sine.sqrt(),
        SkyCover::Overcast => 300.0 + 21_000.0 * sine,
    }
}

/// CIE standard overcast sky (Moon & Spencer 1942): L = L_z (1 + 2 sin el)/3, independent of the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Overcast {
    /// Luminance of the zenith L_z, cd/m²; three times that of the horizon.
    pub zenith_luminance: f64,
}

impl Overcast {
    /// The sky whose horizontal illuminance is `lux`: E = 7π/9 L_z.
    pub fn new(lux: f64) -> Self {
        Self {
            zenith_luminance: 9.0 * lux / (7.0 * PI),
        }
    }

    /// Radiance in the unit direction `dir`, not below the horizon: linear BT.709 RGB, cd/m².
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        DVec3::splat(self.zenith_luminance * (1.0 + 2.0 * dir.y.max(0.0)) / 3.0)
    }
}

/// CIE standard clear sky (Kittler 1967; CIE S 011/E:2003 type 12 is the same function).
///
/// L/L_z = f(γ) φ(θ) / (f(θ_s) φ(0)), φ = 1 - exp(-0.32 / cos θ), f = 0.91 + 10 exp(-3γ) + 0.45 cos² γ.
/// Divided by 0.91 (exactly: 1 - 10 exp(-3π/2)), this is Perez' form, so the shader of [`super::preetham`] evaluates it as well.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CieClear {
    sun_direction: DVec3,
    perez: PerezSky,
}

impl CieClear {
    /// The sky with the sun at `sun_direction` (unit vector, not below the horizon) whose horizontal illuminance is `lux`.
    pub fn new(lux: f64, sun_direction: DVec3) -> Self {
        let constant = 1.0 - 10.0 * (-1.5 * PI).exp();
        let luminance = [-1.0, -0.32, 10.0 / constant, -3.0, 0.45 / constant];
        let relative = |dir: DVec3| perez(&luminance, dir.y, angle_between(dir, sun_direction));
        let scale = lux / horizontal_irradiance(|dir| DVec3::splat(relative(dir))).x;
        let flat = [0.0; 5];
        let [x, y] = D65_WHITE;
        Self {
            sun_direction,
            perez: PerezSky {
                coefficients: [luminance, flat, flat],
                zenith_over_f: [scale, x, y],
            },
        }
    }

    /// The coefficients for a shader; the chromaticity is constant (F = 1).
    pub fn perez(&self) -> PerezSky {
        self.perez
    }

    /// Radiance in the unit direction `dir`, not below the horizon: linear BT.709 RGB, cd/m².
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        let gamma = angle_between(dir, self.sun_direction);
        DVec3::splat(self.perez.luminance_chromaticity(dir.y, gamma).0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::sun_position::direction;

    #[test]
    fn overcast_zenith_is_three_times_the_horizon() {
        let sky = Overcast::new(10_000.0);
        let ratio = sky.radiance(DVec3::Y).x / sky.radiance(DVec3::X).x;
        assert!((ratio - 3.0).abs() < 1e-14);
    }

    #[test]
    fn both_skies_give_the_illuminance_they_were_asked_for() {
        let overcast = Overcast::new(12_345.0);
        let e = horizontal_irradiance(|dir| overcast.radiance(dir)).x;
        assert!((e / 12_345.0 - 1.0).abs() < 1e-12, "{e}");
        let clear = CieClear::new(12_345.0, direction(77.0, 33.0));
        let e = horizontal_irradiance(|dir| clear.radiance(dir)).x;
        assert!((e / 12_345.0 - 1.0).abs() < 1e-12, "{e}");
    }

    #[test]
    fn clear_sky_is_kittlers() {
        let sun = direction(0.0, 40.0);
        let sky = CieClear::new(10_000.0, sun);
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
}
