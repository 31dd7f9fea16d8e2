//! The clear sky of Preetham, Shirley & Smits 1999, *A Practical Analytic Model for Daylight*.
//!
//! Each of Y, x and y is Q(θ, γ) = Q_z F(θ, γ) / F(0, θ_s) with Perez' function F and its own five coefficients.
//! θ: angle from the zenith; γ: angle from the sun; θ_s: the sun's angle from the zenith.
//!
//! Known limits of the published fit (reproduced, not corrected): its horizontal illuminance is 1.5 to 2 times that of
//! [`super::hosek`] and of the IES clear sky ([`super::cie`]), and far more with a low sun in clear air: 15.6 klux at turbidity 2
//! with the sun at 1°, where those two give 3.3 and 2.8.

use std::f64::consts::PI;

use glam::DVec3;

use super::colour;

/// Turbidities for which the model was fitted.
pub const TURBIDITY_RANGE: (f64, f64) = (2.0, 10.0);

/// Perez et al. 1993 coefficients A to E of one quantity, linear in turbidity: `[slope, constant]` per coefficient.
type PerezTable = [[f64; 2]; 5];

// Preetham et al. 1999, A.2, digits as published.
const PEREZ_LUMINANCE: PerezTable = [
    [0.1787, -1.4630],
    [-0.3554, 0.4275],
    [-0.0227, 5.3251],
    [0.1206, -2.5771],
    [-0.0670, 0.3703],
];
const PEREZ_X: PerezTable = [
    [-0.0193, -0.2592],
    [-0.0665, 0.0008],
    [-0.0004, 0.2125],
    [-0.0641, -0.8989],
    [-0.0033, 0.0452],
];
const PEREZ_Y: PerezTable = [
    [-0.0167, -0.2608],
    [-0.0950, 0.0092],
    [-0.0079, 0.2102],
    [-0.0441, -1.6537],
    [-0.0109, 0.0529],
];

/// Zenith chromaticity: rows T², T, 1; columns θ_s³, θ_s², θ_s, 1 (Preetham et al. 1999, A.2).
type ZenithTable = [[f64; 4]; 3];

const ZENITH_X: ZenithTable = [
    [0.00166, -0.00375, 0.00209, 0.0],
    [-0.02903, 0.06377, -0.03202, 0.00394],
    [0.11693, -0.21196, 0.06052, 0.25886],
];
const ZENITH_Y: ZenithTable = [
    [0.00275, -0.00610, 0.00317, 0.0],
    [-0.04214, 0.08970, -0.04153, 0.00516],
    [0.15346, -0.26756, 0.06670, 0.26688],
];

/// Preetham et al. 1999, A.2: luminance of the zenith, cd/m² (the paper's kcd/m² times 1000).
///
/// `sun_zenith_angle` θ_s in radians, 0..=π/2.
pub fn zenith_luminance(turbidity: f64, sun_zenith_angle: f64) -> f64 {
    let chi = (4.0 / 9.0 - turbidity / 120.0) * (PI - 2.0 * sun_zenith_angle);
    1000.0 * ((4.0453 * turbidity - 4.9710) * chi.tan() - 0.2155 * turbidity + 2.4192)
}

/// Preetham et al. 1999, A.2: chromaticity (x, y) of the zenith. `sun_zenith_angle` in radians, 0..=π/2.
pub fn zenith_chromaticity(turbidity: f64, sun_zenith_angle: f64) -> [f64; 2] {
    let t = sun_zenith_angle;
    let cubic = |c: [f64; 4]| ((c[0] * t + c[1]) * t + c[2]) * t + c[3];
    let at = |z: ZenithTable| (cubic(z[0]) * turbidity + cubic(z[1])) * turbidity + cubic(z[2]);
    [at(ZENITH_X), at(ZENITH_Y)]
}

/// Perez et al. 1993 (Preetham et al. 1999, eq. 3): F = (1 + A e^(B / cos θ)) (1 + C e^(D γ) + E cos² γ).
///
/// `coefficients` are A to E; `cos_theta` is in 0..=1 and treated as at least 1e-6; `gamma` in radians, 0..=π.
pub fn perez(coefficients: &[f64; 5], cos_theta: f64, gamma: f64) -> f64 {
    gradation(coefficients, cos_theta) * indicatrix(coefficients, gamma, gamma.cos())
}

/// The factor of F that depends on θ.
fn gradation(&[a, b, ..]: &[f64; 5], cos_theta: f64) -> f64 {
    1.0 + a * (b / cos_theta.max(1e-6)).exp()
}

/// The factor of F that depends on γ.
fn indicatrix(&[_, _, c, d, e]: &[f64; 5], gamma: f64, cos_gamma: f64) -> f64 {
    1.0 + c * (d * gamma).exp() + e * cos_gamma * cos_gamma
}

/// The numbers a shader needs to evaluate a sky of Perez' form: Q = `zenith_over_f` · F(θ, γ) for Q = Y, x, y in this order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PerezSky {
    /// Coefficients A to E of Y, x and y.
    pub coefficients: [[f64; 5]; 3],
    /// Zenith values of Y (cd/m²), x and y, each divided by its own F(0, θ_s).
    pub zenith_over_f: [f64; 3],
}

impl PerezSky {
    /// (Y in cd/m², x, y) from the cosine of the zenith angle and the angle from the sun (radians).
    pub fn luminance_chromaticity(&self, cos_theta: f64, gamma: f64) -> (f64, f64, f64) {
        let q = |i: usize| self.zenith_over_f[i] * perez(&self.coefficients[i], cos_theta, gamma);
        (q(0), q(1), q(2))
    }
}

/// The sky for one turbidity and one sun position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preetham {
    sun_direction: DVec3,
    perez: PerezSky,
}

impl Preetham {
    /// `turbidity` in 2..=10; `sun_direction` a unit vector, not below the horizon. Neither is checked here:
    /// [`super::sky::Daylight`] guards them.
    pub fn new(turbidity: f64, sun_direction: DVec3) -> Self {
        let theta_s = sun_direction.y.clamp(-1.0, 1.0).acos();
        let coefficients = [PEREZ_LUMINANCE, PEREZ_X, PEREZ_Y]
            .map(|table| table.map(|[slope, constant]| slope * turbidity + constant));
        let [x, y] = zenith_chromaticity(turbidity, theta_s);
        let zenith = [zenith_luminance(turbidity, theta_s), x, y];
        let over_f = |i: usize| zenith[i] / perez(&coefficients[i], 1.0, theta_s);
        let perez = PerezSky {
            coefficients,
            zenith_over_f: [over_f(0), over_f(1), over_f(2)],
        };
        Self {
            sun_direction,
            perez,
        }
    }

    /// The numbers for a shader.
    pub fn perez(&self) -> PerezSky {
        self.perez
    }

    /// Unit vector toward the sun.
    pub fn sun_direction(&self) -> DVec3 {
        self.sun_direction
    }

    /// (Y in cd/m², x, y) in the unit direction `dir`, which is not below the horizon.
    pub fn luminance_chromaticity(&self, dir: DVec3) -> (f64, f64, f64) {
        let gamma = angle_between(dir, self.sun_direction);
        self.perez.luminance_chromaticity(dir.y, gamma)
    }

    /// Radiance in the unit direction `dir` as linear BT.709 RGB, cd/m²; not clamped.
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        self.ring(dir.y)(dir)
    }

    /// [`Self::radiance`] in the directions whose elevation has this sine.
    pub fn ring(&self, sine: f64) -> impl Fn(DVec3) -> DVec3 {
        let PerezSky {
            coefficients,
            zenith_over_f,
        } = self.perez;
        let gradations = coefficients.map(|of| gradation(&of, sine));
        let sun = self.sun_direction;
        move |dir| {
            let gamma = angle_between(dir, sun);
            let cos_gamma = gamma.cos();
            let [luminance, x, y] = std::array::from_fn(|i| {
                let around_sun = indicatrix(&coefficients[i], gamma, cos_gamma);
                zenith_over_f[i] * (gradations[i] * around_sun)
            });
            colour::rgb_from_xyz(colour::xyz_from_xyy(x, y, luminance))
        }
    }
}

/// Angle between two unit vectors, radians. Kahan's formula: the arc cosine loses half the digits near 0 and π.
pub fn angle_between(a: DVec3, b: DVec3) -> f64 {
    2.0 * (a - b).length().atan2((a + b).length())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::sun_position::direction;

    #[test]
    fn the_zenith_has_the_zenith_values() {
        for (turbidity, elevation) in [(2.0, 10.0), (3.0, 45.0), (6.0, 80.0)] {
            let sky = Preetham::new(turbidity, direction(30.0, elevation));
            let (luminance, x, y) = sky.luminance_chromaticity(DVec3::Y);
            let theta_s = (90.0 - elevation).to_radians();
            assert!((luminance / zenith_luminance(turbidity, theta_s) - 1.0).abs() < 1e-12);
            let expected = zenith_chromaticity(turbidity, theta_s);
            assert!((x - expected[0]).abs() < 1e-12 && (y - expected[1]).abs() < 1e-12);
        }
    }

    #[test]
    fn a_sun_at_the_zenith_makes_a_symmetric_sky() {
        let sky = Preetham::new(3.0, DVec3::Y);
        for elevation in [0.0, 5.0, 30.0, 60.0, 89.0] {
            let north = sky.radiance(direction(0.0, elevation));
            for azimuth in [45.0, 90.0, 200.0, 333.0] {
                let there = sky.radiance(direction(azimuth, elevation));
                assert!((there - north).abs().max_element() < 1e-9 * north.max_element());
            }
        }
    }

    #[test]
    fn the_sky_mirrors_in_the_plane_of_the_sun() {
        let sky = Preetham::new(2.5, direction(100.0, 20.0));
        let (left, right) = (
            sky.radiance(direction(60.0, 40.0)),
            sky.radiance(direction(140.0, 40.0)),
        );
        assert!((left - right).abs().max_element() < 1e-9 * left.max_element());
    }

    #[test]
    fn small_angles_keep_their_digits() {
        let tilt = 1e-9;
        let tilted = DVec3::new(tilt, 1.0, 0.0).normalize();
        assert!((angle_between(DVec3::Y, tilted) - tilt).abs() < 1e-15);
        assert!((angle_between(DVec3::Y, DVec3::NEG_Y) - PI).abs() < 1e-15);
    }
}
