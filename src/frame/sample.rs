//! Where each frame of an average samples: the pixel, the sun's disc, the noise.

use glam::{DVec2, Vec2, Vec3};

use crate::daylight::sampling;
use crate::daylight::sky::Daylight;
use crate::daylight::sunlight::SUN_ANGULAR_RADIUS;

/// Where a frame samples the pixel and the sun's disc.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// Offset in the pixel, in pixels, −0.5..0.5.
    pub(super) jitter: Vec2,
    /// Unit vector toward a point of the sun's disc.
    pub(super) sun_direction: Vec3,
    /// Turns the noise of occlusion, 0..1.
    pub(super) phase: f32,
}

impl Sample {
    /// That of frame number `index` of an average of `samples`; a single one is at the centres.
    pub(super) fn new(samples: u32, daylight: &Daylight, index: u32) -> Self {
        let centre = daylight.sun_direction.as_vec3();
        if samples <= 1 {
            return Self {
                jitter: Vec2::ZERO,
                sun_direction: centre,
                phase: 0.0,
            };
        }
        // Two stretches of one sequence, far apart, so that pixel and disc are not sampled in step.
        let pixel = sampling::r2(index) - 0.5;
        let disc = sampling::r2(index.wrapping_add(1 << 20));
        Self {
            jitter: pixel.as_vec2(),
            sun_direction: on_disc(centre, disc),
            phase: sampling::radical_inverse(index) as f32,
        }
    }
}

/// A uniform point of the sun's disc for `xi` in the unit square.
fn on_disc(centre: Vec3, xi: DVec2) -> Vec3 {
    let radius = (xi.x.sqrt() * SUN_ANGULAR_RADIUS) as f32;
    let angle = (xi.y * std::f64::consts::TAU) as f32;
    let (tangent, bitangent) = centre.any_orthonormal_pair();
    (centre + radius * (angle.cos() * tangent + angle.sin() * bitangent)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_disc_is_covered_and_not_left() {
        let centre = Vec3::new(0.3, 0.5, -0.8).normalize();
        let angles: Vec<f64> = (0..1000)
            .map(|i| f64::from(on_disc(centre, sampling::r2(i)).cross(centre).length()).asin())
            .collect();
        let largest = angles.iter().copied().fold(0.0, f64::max);
        assert!(largest <= SUN_ANGULAR_RADIUS * 1.001 && largest > SUN_ANGULAR_RADIUS * 0.97);
        // Uniform over the disc: half of the points lie within 1/sqrt(2) of the radius.
        let inner = angles
            .iter()
            .filter(|a| **a < SUN_ANGULAR_RADIUS / 2f64.sqrt())
            .count();
        assert!((450..550).contains(&inner), "{inner}");
    }
}
