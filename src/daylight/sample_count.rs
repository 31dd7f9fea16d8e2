//! The samples of the device's irradiance map, and how many are needed for a given error.
//!
//! [`filtered_samples`] is the table that the shader reads for `quasi`. [`ErrorEstimate`] evaluates it on the CPU, in
//! milliseconds, with lookups like those of the device's sampler (trilinear, but in a cube of 64 texels).

use std::f64::consts::PI;

use glam::DVec3;

use super::colour::luminance;
use super::cube::CubeMap;
use super::cube_pyramid::CubePyramid;
use super::irradiance::IrradianceMethod;
use super::quadrature::SphereQuadrature;
use super::sampling::{cosine_hemisphere, hammersley};
use super::tangent_frame;

/// Edge of the coarsest mip level used for lookups, texels: coarser ones leak light across the horizon without reducing the
/// error.
const COARSEST_EDGE: f64 = 8.0;
/// Edge of the cube for error estimates, texels.
const ESTIMATE_EDGE: usize = 64;
/// Subtracted from the mip level of a sample's solid angle, since bilinear filtering widens the lookup. Together with
/// [`MIN_COSINE`], chosen for the least error on the reference normals and skies: 0.10 % with 1024 samples, 0.12 % without both.
const LEVEL_BIAS: f64 = 0.125;
/// Lower limit of the cosine in a sample's solid angle, that of 45°. Without it samples grow toward the normal's horizon, and
/// for an upward normal their wide lookups mix the ground into the brightest part of a low sun's sky.
const MIN_COSINE: f64 = 0.7;
/// Least number of samples; fewer are not worth a pass.
const MIN_SAMPLES: u32 = 32;

/// A sample direction about +Z with its solid angle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FilteredSample {
    /// Unit direction.
    pub direction: DVec3,
    /// 1/(N pdf), sr.
    pub solid_angle: f64,
}

impl FilteredSample {
    /// Křivánek & Colbert 2008, *Real-time Shading with Filtered Importance Sampling*, eq. 12: the mip level at which a texel of a
    /// cube with `edge` texels has the sample's solid angle.
    pub fn level(&self, edge: u32) -> f64 {
        let texel = 4.0 * PI / (6.0 * f64::from(edge) * f64::from(edge));
        let coarsest = (f64::from(edge) / COARSEST_EDGE).log2().max(0.0);
        (0.5 * (self.solid_angle / texel).log2() - LEVEL_BIAS).clamp(0.0, coarsest)
    }
}

/// Hammersley's `count` points as cosine-weighted directions, their solid angles π/(N cos θ) with cos θ at least that of 45°, permuted by a golden-ratio stride so that every prefix covers
/// the hemisphere.
pub fn filtered_samples(count: u32) -> Vec<FilteredSample> {
    let stride = golden_stride(count);
    let sample = |k: u32| {
        let index = (u64::from(k) * u64::from(stride) % u64::from(count)) as u32;
        let direction = cosine_hemisphere(hammersley(index, count));
        let solid_angle = PI / (f64::from(count) * direction.z.max(MIN_COSINE));
        FilteredSample {
            direction,
            solid_angle,
        }
    };
    (0..count).map(sample).collect()
}

/// The largest number below 0.618 `count` that is coprime to it: its multiples visit every index.
fn golden_stride(count: u32) -> u32 {
    let divisor = |mut a: u32, mut b: u32| {
        while b != 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let golden = (0.5 * (5f64.sqrt() - 1.0) * f64::from(count)) as u32;
    (1..=golden)
        .rev()
        .find(|stride| divisor(*stride, count) == 1)
        .unwrap_or(1)
}

/// The 26 directions to a cube's faces, edges and corners.
pub fn normals() -> impl Iterator<Item = DVec3> {
    let steps = || [-1.0, 0.0, 1.0].into_iter();
    steps()
        .flat_map(move |x| steps().flat_map(move |y| steps().map(move |z| DVec3::new(x, y, z))))
        .filter_map(DVec3::try_normalize)
}

/// Error of the sampled irradiance of one sky, as a function of the number of samples.
pub struct ErrorEstimate {
    sky: CubePyramid,
    /// Normals with their E, lux.
    exact: Vec<(DVec3, f64)>,
    /// Mean over the normals of the variance of π L, lux².
    variance: f64,
    up: f64,
}

impl ErrorEstimate {
    /// Prepares a radiance function (unit direction to cd/m²).
    pub fn new(radiance: impl Fn(DVec3) -> DVec3) -> Self {
        let sky = CubePyramid::new(CubeMap::from_fn(ESTIMATE_EDGE, &radiance));
        let nodes: Vec<(DVec3, f64, f64)> = SphereQuadrature::sphere(64, 128)
            .nodes
            .into_iter()
            .map(|(direction, weight)| (direction, luminance(radiance(direction)), weight))
            .collect();
        // E = ∫ L cos, and the second moment of the estimator π L under the density cos/π: π ∫ L² cos.
        let moments = |n: DVec3| {
            nodes
                .iter()
                .fold((0.0, 0.0), |(e, second), &(direction, l, weight)| {
                    let cosine = n.dot(direction).max(0.0) * weight;
                    (e + l * cosine, second + PI * l * l * cosine)
                })
        };
        let all: Vec<(DVec3, (f64, f64))> = normals().map(|n| (n, moments(n))).collect();
        let variance = all
            .iter()
            .map(|(_, (e, second))| (second - e * e).max(0.0))
            .sum::<f64>();
        Self {
            sky,
            variance: variance / all.len() as f64,
            exact: all.iter().map(|&(n, (e, _))| (n, e)).collect(),
            up: moments(DVec3::Y).0,
        }
    }

    /// rms error over the normals with `count` filtered samples, relative to E of the up normal.
    pub fn quasi_error(&self, count: u32) -> f64 {
        let samples = filtered_samples(count);
        let square = |&(normal, exact): &(DVec3, f64)| {
            let sum: f64 = samples.iter().map(|s| self.look_up(s, normal)).sum();
            (sum * PI / f64::from(count) - exact).powi(2)
        };
        let mean = self.exact.iter().map(square).sum::<f64>() / self.exact.len() as f64;
        mean.sqrt() / self.up
    }

    /// Expected rms error over the normals with `count` random samples, relative to E of the up normal: σ/√N.
    pub fn monte_carlo_error(&self, count: u32) -> f64 {
        (self.variance / f64::from(count)).sqrt() / self.up
    }

    /// Least number of samples (a power of two, or `most`) whose error, relative to E of the up normal, is at most `error`; 1 for
    /// methods that do not sample.
    pub fn samples(&self, method: IrradianceMethod, error: f64, most: u32) -> u32 {
        let enough = |count: u32| match method {
            IrradianceMethod::MonteCarlo => self.monte_carlo_error(count) <= error,
            IrradianceMethod::Quasi => self.quasi_error(count) <= error,
            IrradianceMethod::Exact | IrradianceMethod::Sh => true,
        };
        if !method.is_sampled() || self.up <= 0.0 {
            return 1;
        }
        let mut counts = std::iter::successors(Some(MIN_SAMPLES), |n| n.checked_mul(2))
            .take_while(|n| *n < most);
        counts.find(|n| enough(*n)).unwrap_or(most)
    }

    /// Luminance at a sample around `normal`, cd/m²; trilinear.
    fn look_up(&self, sample: &FilteredSample, normal: DVec3) -> f64 {
        let direction = tangent_frame::to_world(sample.direction, normal);
        let level = sample.level(ESTIMATE_EDGE as u32);
        luminance(self.sky.trilinear(direction, level).as_dvec3())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::sky::{Conditions, Daylight};

    fn sky(elevation: f64) -> ErrorEstimate {
        let conditions = Conditions {
            sun_elevation_deg: elevation,
            ground_albedo: 0.0,
            ..Conditions::default()
        };
        let daylight = Daylight::new(&conditions);
        ErrorEstimate::new(|direction| daylight.radiance(direction))
    }

    #[test]
    fn samples_cover_the_hemisphere() {
        for count in [64, 100, 1024] {
            let samples = filtered_samples(count);
            assert_eq!(samples.len(), count as usize);
            // Away from the horizon, solid angle times cosine is π/N.
            let expected = PI / f64::from(count);
            for sample in samples.iter().filter(|s| s.direction.z > MIN_COSINE) {
                assert!((sample.solid_angle * sample.direction.z - expected).abs() < 1e-12);
            }
            // The first quarter is centred as well.
            let quarter = &samples[..samples.len() / 4];
            let mean = quarter.iter().map(|s| s.direction).sum::<DVec3>() / quarter.len() as f64;
            assert!(mean.truncate().length() < 0.1, "{mean}");
        }
    }

    #[test]
    fn a_constant_sky_needs_no_samples() {
        let constant = ErrorEstimate::new(|_| DVec3::ONE);
        assert!(constant.quasi_error(MIN_SAMPLES) < 1e-4);
        assert!(constant.monte_carlo_error(MIN_SAMPLES) < 1e-2);
        assert_eq!(
            constant.samples(IrradianceMethod::Quasi, 1e-3, 4096),
            MIN_SAMPLES
        );
    }

    #[test]
    fn errors_fall_and_counts_follow() {
        let sky = sky(40.0);
        let errors: Vec<f64> = [64, 256, 1024]
            .iter()
            .map(|n| sky.quasi_error(*n))
            .collect();
        println!("filtered quasi, 64, 256, 1024 samples: {errors:?}");
        assert!(errors[0] > errors[1] && errors[1] > errors[2], "{errors:?}");
        assert!(errors[2] < 1.5e-3, "{errors:?}");
        let method = IrradianceMethod::Quasi;
        assert!(sky.samples(method, 1e-2, 4096) < sky.samples(method, 2e-3, 4096));
        assert_eq!(sky.samples(method, 0.0, 512), 512);
        let (few, many) = (sky.monte_carlo_error(100), sky.monte_carlo_error(400));
        assert!((few / many - 2.0).abs() < 1e-9);
        assert_eq!(sky.samples(IrradianceMethod::Exact, 0.0, 512), 1);
    }
}
