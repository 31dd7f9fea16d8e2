//! The clear sky of Hošek & Wilkie 2012, *An Analytic Model for Full Spectral Sky-Dome Radiance*: its RGB fit (1.4a).
//!
//! The tables are from the crate `hw-skymodel`, in f32. Native radiances times 683 lm/W are cd/m².

use glam::DVec3;
use hw_skymodel::rgb::{SkyParams, SkyState};

use super::preetham::angle_between;
use super::spectrum::LUMINOUS_EFFICACY;

/// Turbidities for which the model was fitted.
pub const TURBIDITY_RANGE: (f64, f64) = (1.0, 10.0);

/// The sky for one turbidity, ground albedo and sun position, in the form that a shader evaluates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hosek {
    /// Unit vector toward the sun.
    pub sun_direction: DVec3,
    /// The nine coefficients of R, G and B, in the authors' storage order: A B C D E F G I H of the paper (the eighth
    /// multiplies √cos θ, the ninth is the anisotropy of the glow around the sun).
    pub coefficients: [[f64; 9]; 3],
    /// Mean radiance of R, G and B, cd/m²: radiance = `mean_radiance` · [`distribution`].
    pub mean_radiance: DVec3,
}

impl Hosek {
    /// `turbidity` in 1..=10, `ground_albedo` in 0..=1 and the elevation of `sun_direction` (unit vector) in 0..=π/2; clamped.
    pub fn new(turbidity: f64, ground_albedo: f64, sun_direction: DVec3) -> Self {
        let elevation = sun_direction.y.clamp(0.0, 1.0).asin();
        let params = SkyParams {
            elevation: (elevation as f32).clamp(0.0, std::f32::consts::FRAC_PI_2),
            turbidity: (turbidity as f32).clamp(1.0, 10.0),
            albedo: [(ground_albedo as f32).clamp(0.0, 1.0); 3],
        };
        // All three are clamped to the ranges that `new` checks; NaN gives a black sky.
        let (coefficients, mean) =
            SkyState::new(&params).map_or(([0.0; 27], [0.0; 3]), |s| s.raw());
        let channel = |i: usize| std::array::from_fn(|k| f64::from(coefficients[9 * i + k]));
        Self {
            sun_direction,
            coefficients: [channel(0), channel(1), channel(2)],
            mean_radiance: DVec3::from_array(mean.map(f64::from)) * LUMINOUS_EFFICACY,
        }
    }

    /// Radiance in the unit direction `dir`, not below the horizon, as linear BT.709 RGB, cd/m²; not clamped.
    pub fn radiance(&self, dir: DVec3) -> DVec3 {
        self.ring(dir.y)(dir)
    }

    /// [`Self::radiance`] in the directions whose elevation has this sine.
    pub fn ring(&self, sine: f64) -> impl Fn(DVec3) -> DVec3 {
        let cos_theta = sine.max(0.0);
        let Self {
            sun_direction,
            coefficients,
            mean_radiance,
        } = *self;
        let parts = coefficients.map(|of| of_zenith_angle(&of, cos_theta));
        move |dir| {
            let gamma = angle_between(dir, sun_direction);
            let cos_gamma = gamma.cos();
            let channel = |i: usize| {
                let [factor, added] = parts[i];
                factor * (added + around_sun(&coefficients[i], gamma, cos_gamma))
            };
            mean_radiance * DVec3::new(channel(0), channel(1), channel(2))
        }
    }
}

/// Hošek & Wilkie 2012, eq. 8: F(θ, γ) with the coefficients in stored order.
///
/// `cos_theta` in 0..=1 (treated as at least 0), `gamma` in radians, 0..=π.
pub fn distribution(coefficients: &[f64; 9], cos_theta: f64, gamma: f64) -> f64 {
    let [factor, added] = of_zenith_angle(coefficients, cos_theta.max(0.0));
    factor * (added + around_sun(coefficients, gamma, gamma.cos()))
}

/// What in F depends on θ: a factor, and a term beside [`around_sun`].
fn of_zenith_angle(&[a, b, _, _, _, _, _, i, _]: &[f64; 9], cos_theta: f64) -> [f64; 2] {
    [
        1.0 + a * (b / (cos_theta + 0.01)).exp(),
        i * cos_theta.sqrt(),
    ]
}

/// What in F depends on γ.
fn around_sun(&[_, _, c, d, e, f, g, _, h]: &[f64; 9], gamma: f64, cos_gamma: f64) -> f64 {
    let square = 1.0 + h * h - 2.0 * h * cos_gamma;
    let chi = (1.0 + cos_gamma * cos_gamma) / (square * square.sqrt());
    c + d * (e * gamma).exp() + f * cos_gamma * cos_gamma + g * chi
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::sun_position::direction;

    #[test]
    fn our_distribution_is_the_crates() {
        let sun = direction(40.0, 25.0);
        let ours = Hosek::new(3.5, 0.3, sun);
        let params = SkyParams {
            elevation: 25f32.to_radians(),
            turbidity: 3.5,
            albedo: [0.3; 3],
        };
        let crates = SkyState::new(&params).unwrap();
        for dir in [
            direction(0.0, 3.0),
            direction(50.0, 30.0),
            direction(250.0, 70.0),
        ] {
            let (theta, gamma) = (dir.y.acos() as f32, angle_between(dir, sun) as f32);
            let red = crates.radiance(theta, gamma, hw_skymodel::rgb::Channel::R);
            let expected = f64::from(red) * LUMINOUS_EFFICACY;
            assert!((ours.radiance(dir).x / expected - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn a_sun_at_the_zenith_makes_a_symmetric_sky() {
        let sky = Hosek::new(3.0, 0.2, DVec3::Y);
        let (a, b) = (
            sky.radiance(direction(0.0, 30.0)),
            sky.radiance(direction(211.0, 30.0)),
        );
        assert!((a - b).abs().max_element() < 1e-9 * a.max_element());
    }

    #[test]
    fn bright_ground_brightens_the_sky() {
        let (black, white) = (
            Hosek::new(3.0, 0.0, DVec3::Y),
            Hosek::new(3.0, 1.0, DVec3::Y),
        );
        let dir = direction(10.0, 20.0);
        assert!(white.radiance(dir).min_element() > black.radiance(dir).min_element());
    }
}
