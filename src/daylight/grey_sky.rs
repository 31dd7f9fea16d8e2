//! Grey skies of one formula: the standard skies of the CIE and the measured sky of Perez.
//!
//! L = level · φ(Z) f(χ): the gradation φ from the zenith to the horizon times the indicatrix f around the sun, where Z is the
//! angle from the zenith and χ the angle from the sun. Both models define luminances only, so these skies are white (D65,
//! R = G = B). [`super::cie`] and [`super::perez`] have the numbers.

use std::f64::consts::PI;
use std::sync::LazyLock;

use glam::DVec3;

use super::preetham::angle_between;
use super::quadrature::gauss_legendre;

/// Rings and columns of half a hemisphere for [`Distribution::illuminance`].
const NODES: usize = 128;
static RINGS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| gauss_legendre(NODES));
/// Azimuth between two columns.
const COLUMN: f64 = PI / NODES as f64;
/// Cosines of the columns' azimuths from the sun.
static COLUMNS: LazyLock<[f64; NODES]> =
    LazyLock::new(|| std::array::from_fn(|i| (COLUMN * (i as f64 + 0.5)).cos()));

/// A relative distribution of luminance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Distribution {
    /// a, b and g of φ(Z) = 1 + a exp(b / cos Z) + g cos Z.
    pub gradation: [f64; 3],
    /// k, c, d and e of f(χ) = k + c exp(d χ) + e cos² χ.
    pub indicatrix: [f64; 4],
    /// In b / cos Z, cos Z is treated as at least this, above 0.
    pub least_cosine: f64,
}

impl Distribution {
    /// The same luminance in all directions.
    pub const UNIFORM: Self = Self {
        gradation: [0.0, -1.0, 0.0],
        indicatrix: [1.0, 0.0, -1.0, 0.0],
        least_cosine: 1e-4,
    };

    /// φ(Z), from the cosine of the angle from the zenith, 0..=1.
    pub fn gradation(&self, cos_zenith_angle: f64) -> f64 {
        let [a, b, g] = self.gradation;
        let fall = a * (b / cos_zenith_angle.max(self.least_cosine)).exp();
        1.0 + fall + g * cos_zenith_angle
    }

    /// f(χ), from the angle from the sun, radians in 0..=π.
    pub fn indicatrix(&self, chi: f64) -> f64 {
        self.around_sun(chi, chi.cos())
    }

    /// The same, from the cosine of the angle too.
    fn around_sun(&self, chi: f64, cos_chi: f64) -> f64 {
        let [k, c, d, e] = self.indicatrix;
        k + c * (d * chi).exp() + e * cos_chi * cos_chi
    }

    /// φ(Z) f(χ); 0 where the formula is negative, as that of Perez is beside the horizon of some skies.
    fn product(&self, cos_zenith_angle: f64, chi: f64) -> f64 {
        (self.gradation(cos_zenith_angle) * self.indicatrix(chi)).max(0.0)
    }

    /// Illuminance of a horizontal plane where φ f is the luminance, for the cosine of the sun's angle from the zenith, 0..=1.
    ///
    /// Within 1e-6 of 1024 x 2048 nodes for the skies of the CIE, 4e-6 for those of Perez.
    pub fn illuminance(&self, cos_sun_angle: f64) -> f64 {
        let sin_sun_angle = (1.0 - cos_sun_angle * cos_sun_angle).max(0.0).sqrt();
        // The sky mirrors in the plane of the sun: half of it is enough.
        let ring = |&(cosine, weight): &(f64, f64)| {
            let across = sin_sun_angle * (1.0 - cosine * cosine).sqrt();
            let gradation = self.gradation(cosine);
            let luminance = |azimuth: &f64| {
                let cos_chi = (cos_sun_angle * cosine + across * azimuth).clamp(-1.0, 1.0);
                (gradation * self.around_sun(cos_chi.acos(), cos_chi)).max(0.0)
            };
            let sum: f64 = COLUMNS.iter().map(luminance).sum();
            2.0 * COLUMN * weight * cosine * sum
        };
        RINGS.iter().map(ring).sum()
    }
}

/// A sky of this formula with its level.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GreySky {
    /// Unit vector toward the sun, not below the horizon.
    pub sun_direction: DVec3,
    /// The relative distribution.
    pub distribution: Distribution,
    /// Luminance where φ f = 1, cd/m².
    pub level: f64,
    /// Illuminance of a horizontal plane, lux.
    pub horizontal_illuminance: f64,
}

impl GreySky {
    /// The sky that gives a horizontal plane `lux`, with the sun at `sun_direction` (unit vector, not below the horizon).
    ///
    /// A formula that is nowhere positive, as that of Perez for irradiances that no sky has, is replaced by a uniform sky.
    pub fn new(distribution: Distribution, sun_direction: DVec3, lux: f64) -> Self {
        let of = |d: Distribution| (d, d.illuminance(sun_direction.y.clamp(0.0, 1.0)));
        let (distribution, unit) = match of(distribution) {
            (_, unit) if unit <= 0.0 => of(Distribution::UNIFORM),
            good => good,
        };
        Self {
            sun_direction,
            distribution,
            level: lux / unit,
            horizontal_illuminance: lux,
        }
    }

    /// Radiance in the unit direction `dir`, not below the horizon: linear BT.709 RGB, cd/m².
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        let chi = angle_between(dir, self.sun_direction);
        DVec3::splat(self.level * self.distribution.product(dir.y, chi))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::quadrature::SphereQuadrature;
    use crate::daylight::sun_position::direction;

    #[test]
    fn uniform_and_linear_skies_have_their_closed_forms() {
        let uniform = Distribution::UNIFORM.illuminance(0.3);
        assert!((uniform / PI - 1.0).abs() < 1e-12, "{uniform}");
        // 1 + 2 cos Z: π (1 + 4/3).
        let overcast = Distribution {
            gradation: [0.0, -1.0, 2.0],
            ..Distribution::UNIFORM
        };
        let overcast = overcast.illuminance(0.3);
        assert!((overcast / (PI * 7.0 / 3.0) - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_sky_gives_the_illuminance_it_was_asked_for() {
        let distribution = Distribution {
            gradation: [-1.0, -0.15, 0.0],
            indicatrix: [0.7, 24.0, -2.8, 0.15],
            least_cosine: 1e-4,
        };
        let sky = GreySky::new(distribution, direction(77.0, 33.0), 12_345.0);
        let fine = SphereQuadrature::upper(256, 512);
        let found = fine.irradiance(DVec3::Y, |dir| sky.radiance(dir)).x;
        assert!((found / 12_345.0 - 1.0).abs() < 3e-6, "{found}");
    }

    #[test]
    fn no_formula_gives_negative_light() {
        let of = |a| Distribution {
            gradation: [a, 0.2, 0.0],
            indicatrix: [1.0, 5.0, -3.0, 0.3],
            least_cosine: 0.01,
        };
        let dark_below = GreySky::new(of(-0.7), direction(0.0, 40.0), 5000.0);
        assert_eq!(dark_below.radiance(DVec3::X), DVec3::ZERO);
        assert!(dark_below.radiance(DVec3::Y).x > 0.0);
        let nowhere = GreySky::new(of(-2.0), direction(0.0, 40.0), 5000.0);
        assert!((nowhere.radiance(DVec3::X).x / (5000.0 / PI) - 1.0).abs() < 1e-12);
    }
}
