//! Sample positions of the frames of an average in the pixel and on the sun's disc, and the choice of sky visibility.

use glam::{DVec2, UVec2, Vec2, Vec3};

use crate::daylight::sampling;
use crate::daylight::sky::Daylight;
use crate::daylight::sunlight::on_disc;
use crate::passes::dome::gather::DomeSettings;
use crate::passes::view::{View, Window};
use crate::scene::Camera;

use super::FrameSettings;

/// How the sky's visibility from a surface is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Visibility {
    /// That of a single frame, see [`Ambient`](crate::passes::light::lighting::Ambient).
    #[default]
    Ssao,
    /// Shadow maps or rays in sampled sky directions: their mean over the samples converges to the true visibility.
    Dome,
    /// `Dome`, cross-faded from a preview, for a view that comes to rest.
    Progressive,
}

/// The pixel filter.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Filter {
    /// One pixel wide, uniform.
    #[default]
    Box,
    /// A Blackman-Harris window 3 pixels wide: smooth, with little aliasing of fine patterns.
    BlackmanHarris,
}

/// How the frames of an average differ.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Sampling {
    /// How the sky's visibility is computed.
    pub visibility: Visibility,
    /// Directions of [`Visibility::Dome`], and their maps or rays.
    pub dome: DomeSettings,
    /// The pixel filter.
    pub filter: Filter,
}

/// Seed of the points on the sun's disc, distinct from those of the sky.
const DISC: u32 = 0x0d15_c000;

/// Sample position of a frame in the pixel and on the sun's disc.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sample {
    /// Offset from the pixel's centre, pixels.
    pub jitter: Vec2,
    /// Unit vector toward a point of the sun's disc.
    pub sun_direction: Vec3,
    /// Sub-texel shift of the shadow map, 0..1.
    pub texel: Vec2,
    /// Phase of the ambient occlusion noise, 0..1.
    pub phase: f32,
    /// Mip bias toward finer levels, relative to one sample per pixel.
    sharpen: f32,
}

/// Mip bias toward finer levels for converging frames: each sample filters over an eighth of the pixel's width.
const SHARPEN: f32 = 3.0;

/// The same for moving views, whose picture holds some ten samples: each filters over half of the pixel's width.
const MOVING_SHARPEN: f32 = 1.0;

impl Sample {
    /// The sample of frame number `index` of an average. Without a number, or if nothing is averaged: the centres of pixel and sun.
    pub fn of(settings: &FrameSettings, daylight: &Daylight, index: Option<u32>) -> Self {
        let sun = daylight.direct_light().direction.as_vec3();
        let Some(index) = index.filter(|_| settings.averages()) else {
            return Self::central(sun);
        };
        let sample = Self::new(sun, index, &settings.sampling);
        if settings.converges() {
            return Self {
                sharpen: SHARPEN,
                ..sample
            };
        }
        if settings.lighting.shadows.penumbrae {
            // The shadow lookup already integrates over the disc.
            return Self {
                sun_direction: sun,
                ..sample
            };
        }
        sample
    }

    /// The same under another sun, if there is one, at the centres of the pixels: so its visibility is that of points.
    pub fn under(self, sun: Option<Vec3>) -> Self {
        sun.map_or(self, |sun_direction| Self {
            sun_direction,
            jitter: Vec2::ZERO,
            ..self
        })
    }

    /// The camera's view for this sample; `size` is that of the picture or, with `tile`, of the tile, pixels.
    pub fn view(&self, camera: &Camera, size: UVec2, tile: Option<Window>) -> View {
        View {
            camera: *camera,
            size,
            jitter: self.jitter,
            sharpen: self.sharpen,
            window: tile,
        }
    }

    /// The sample of frame number `number` of a moving view: another point of the pixels, and the sun's centre. The points are Sobol's: those of an
    /// additive sequence, as [`sampling::r2`] is, fall into step with an even motion.
    pub fn moving(daylight: &Daylight, number: u32) -> Self {
        let sun = daylight.direct_light().direction.as_vec3();
        Self {
            jitter: offset(Filter::Box, sampling::sobol(number)),
            phase: sampling::radical_inverse(number) as f32,
            sharpen: MOVING_SHARPEN,
            ..Self::central(sun)
        }
    }

    /// Pixel centres and the sun's centre.
    fn central(sun: Vec3) -> Self {
        Self {
            jitter: Vec2::ZERO,
            sun_direction: sun,
            texel: Vec2::splat(0.5),
            phase: 0.0,
            sharpen: 0.0,
        }
    }

    /// Sample number `index` of a low-discrepancy sequence.
    fn new(sun: Vec3, index: u32, sampling_settings: &Sampling) -> Self {
        // The sequences must be independent: otherwise the mean over pixel and disc would not converge to the mean over all pairs of
        // points.
        let seed = sampling_settings.dome.seed;
        let disc = sampling::scrambled_sobol(index, seed ^ DISC);
        let index = seed.wrapping_mul(1 << 12).wrapping_add(index);
        let pixel = sampling::r2(index);
        Self {
            jitter: offset(sampling_settings.filter, pixel),
            sun_direction: on_disc(sun, disc),
            texel: sampling::richtmyer(index).as_vec2(),
            phase: sampling::radical_inverse(index) as f32,
            sharpen: 0.0,
        }
    }
}

/// Offset from the pixel's centre, pixels, distributed like the filter's weight (Ernst, Stamminger & Greiner 2006, "Filter
/// importance sampling"): the mean of the samples is the filtered pixel.
fn offset(filter: Filter, xi: DVec2) -> Vec2 {
    match filter {
        Filter::Box => (xi - 0.5).as_vec2(),
        Filter::BlackmanHarris => {
            DVec2::new(blackman_harris(xi.x), blackman_harris(xi.y)).as_vec2()
        }
    }
}

/// Half the width of the window, pixels.
const RADIUS: f64 = 1.5;

/// Inverse CDF of a Blackman-Harris window (Harris 1978, four terms) at `xi`, pixels; by bisection.
fn blackman_harris(xi: f64) -> f64 {
    // The window is 0.35875 - 0.48829 cos + 0.14128 cos 2 - 0.01168 cos 3 of 2 pi t, t over 0..1; this is its integral.
    let share = |t: f64| {
        let wave = |k: f64| (k * std::f64::consts::TAU * t).sin() / (k * std::f64::consts::TAU);
        t - (0.48829 * wave(1.0) - 0.14128 * wave(2.0) + 0.01168 * wave(3.0)) / 0.35875
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        if share(middle) < xi {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low + high - 1.0) * RADIUS
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_is_even_and_has_its_own_spread() {
        let n = 4096;
        let points = (0..n).map(|i| blackman_harris((f64::from(i) + 0.5) / f64::from(n)));
        let points: Vec<f64> = points.collect();
        assert!(points.is_sorted() && points[0] > -RADIUS && points[4095] < RADIUS);
        assert!(points.iter().sum::<f64>().abs() < 1e-6);
        // Variance of the window on -1/2..1/2, by its terms: 1/12 + sum of +-a_k / (2 pi^2 k^2 a_0).
        let pi2 = std::f64::consts::PI.powi(2);
        let unit = 1.0 / 12.0 - (0.48829 - 0.14128 / 4.0 + 0.01168 / 9.0) / (2.0 * pi2 * 0.35875);
        let variance = points.iter().map(|x| x * x).sum::<f64>() / f64::from(n);
        let expected = unit * (2.0 * RADIUS).powi(2);
        assert!(
            (variance / expected - 1.0).abs() < 1e-3,
            "{variance} {expected}"
        );
    }

    #[test]
    fn a_moving_view_samples_its_pixels_evenly() {
        let day = Daylight::new(&crate::daylight::sky::Conditions::default());
        let jitter = |number: u32| Sample::moving(&day, number).jitter.as_dvec2();
        let all: Vec<DVec2> = (0..64).map(jitter).collect();
        for eight in all.chunks(8) {
            // One in each eighth of the pixel along both axes.
            for axis in 0..2 {
                let eighth = |at: &DVec2| ((at[axis] + 0.5) * 8.0) as usize;
                let mut found: Vec<usize> = eight.iter().map(eighth).collect();
                found.sort_unstable();
                assert_eq!(found, [0, 1, 2, 3, 4, 5, 6, 7], "{eight:?}");
            }
        }
        let mean = all.iter().sum::<DVec2>() / 64.0;
        assert!(mean.length() < 0.03, "{mean}");
    }

    #[test]
    fn the_first_sample_is_the_pixels_centre() {
        for filter in [Filter::Box, Filter::BlackmanHarris] {
            let offset = offset(filter, sampling::r2(0));
            assert!(offset.length() < 1e-6, "{filter:?} {offset}");
        }
    }
}
