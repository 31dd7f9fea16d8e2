//! Reflection by a rough metal, prefiltered for image-based lighting: the first factor of the split sum.
//!
//! Karis 2013, *Real Shading in Unreal Engine 4*: the reflected light is the product of two integrals. The first, here, is the
//! radiance about the reflected direction r, weighted by the lobe of an eye and a normal in that same direction, v = n = r:
//!
//! L(r, α) = ∫ L(l) D(h) (n·l)⁺ dl / ∫ D(h) (n·l)⁺ dl,  h half way between r and l
//!
//! D is Trowbridge & Reitz 1975 (Walter et al. 2007, "GGX"), α = roughness² (Burley 2012). The lobe is a function of the angle
//! between r and l alone. A uniform sky stays what it is, and α = 0 is the sky itself.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use super::cube_pyramid::CubePyramid;
use super::sample_count::FilteredSample;
use super::tangent_frame;

/// Edge of the level of the greatest roughness, texels: the lobe of α = 1 is nearly as wide as a hemisphere.
pub const ROUGHEST_EDGE: u32 = 16;

/// Samples of one texel of a prefiltered cube in a file: rms errors of 0.25 % of the integral over the lobe.
pub const SAMPLES: u32 = 1024;

/// Factor on the solid angles of samples: lookups as wide as the solid angle blur the sky once more, by 0.1 % of its gradient.
const NARROWED: f64 = 0.5;

/// Number of mip levels of a prefiltered cube whose first has `edge` texels, a power of two: down to [`ROUGHEST_EDGE`].
pub fn levels(edge: u32) -> u32 {
    (edge / ROUGHEST_EDGE).max(1).ilog2() + 1
}

/// Roughness of a mip level: level / (levels − 1).
pub fn roughness(level: u32, levels: u32) -> f64 {
    f64::from(level) / f64::from(levels.max(2) - 1)
}

/// Walter et al. 2007, *Microfacet Models for Refraction through Rough Surfaces*, eq. 33: D(h), 1/sr, of the cosine n·h ≥ 0.
pub fn distribution(alpha: f64, cosine: f64) -> f64 {
    let a2 = alpha * alpha;
    let base = (a2 - 1.0) * cosine * cosine + 1.0;
    a2 / (PI * base * base)
}

/// `count` directions l about +Z, which is r, with the density of D(h) over n·l > 0, and the solid angles of their lookups. A
/// sample's weight is the cosine n·l, its z.
///
/// eq. 35 and 38: cos²θ_h = (1 − ξ)/(1 + (α² − 1) ξ), and the density of l is D(h)/4, because v = n. The points end at the ξ
/// where n·l = 0, 1/(1 + α²). They lie on a spiral of golden angles (Vogel 1979), evener than Hammersley's.
/// Roughness 0 needs one sample.
pub fn filtered_samples(roughness: f64, count: u32) -> Vec<FilteredSample> {
    let alpha = roughness * roughness;
    if alpha == 0.0 {
        let (direction, solid_angle) = (DVec3::Z, 0.0);
        return vec![FilteredSample {
            direction,
            solid_angle,
        }];
    }
    let most = 1.0 / (1.0 + alpha * alpha);
    let sample = |index: u32| {
        let xi = most * (f64::from(index) + 0.5) / f64::from(count);
        let turn = (f64::from(index) * 0.5 * (5f64.sqrt() - 1.0)).fract();
        let cosine_h2 = (1.0 - xi) / (1.0 + (alpha * alpha - 1.0) * xi);
        let density = distribution(alpha, cosine_h2.sqrt()) / (4.0 * most);
        // Reflected about h: twice the angle.
        let cosine = 2.0 * cosine_h2 - 1.0;
        let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
        let (sin_phi, cos_phi) = (2.0 * PI * turn).sin_cos();
        FilteredSample {
            direction: DVec3::new(cos_phi * sine, sin_phi * sine, cosine),
            solid_angle: NARROWED / (f64::from(count) * density),
        }
    };
    (0..count).map(sample).collect()
}

/// L(r, α) of the sky about the unit `direction` r, by the samples of [`filtered_samples`].
pub fn prefiltered(sky: &CubePyramid, direction: DVec3, samples: &[FilteredSample]) -> Vec3 {
    let edge = sky.edge();
    let mut sum = Vec3::ZERO;
    let mut weights = 0.0;
    let (b1, b2) = tangent_frame::duff(direction);
    for sample in samples {
        let local = sample.direction;
        let l = local.x * b1 + local.y * b2 + local.z * direction;
        let weight = local.z as f32;
        sum += weight * sky.trilinear(l, sample.level(edge));
        weights += weight;
    }
    sum / weights
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::cube::CubeMap;
    use crate::daylight::quadrature::gauss_legendre;
    use crate::daylight::sampling::{hammersley, uniform_sphere};

    const ROUGHNESSES: [f64; 5] = [0.25, 1.0 / 3.0, 0.5, 0.75, 1.0];

    fn directions() -> impl Iterator<Item = DVec3> {
        (0..60).map(|k| uniform_sphere(hammersley(k, 60)))
    }

    /// ∫ f(n·l) D(h) (n·l) dl / ∫ D(h) (n·l) dl over the hemisphere, by quadrature over the angle θ of h: n·l = cos 2θ.
    fn mean_over_lobe(alpha: f64, f: impl Fn(f64) -> f64) -> f64 {
        // Nodes dense about θ = 0, where the lobe is.
        let (mut sum, mut weights) = (0.0, 0.0);
        for (x, weight) in gauss_legendre(400) {
            let theta = PI / 4.0 * x * x * x;
            let cosine = (2.0 * theta).cos();
            let lobe = distribution(alpha, theta.cos()) * cosine * (2.0 * theta).sin() * x * x;
            sum += weight * lobe * f(cosine);
            weights += weight * lobe;
        }
        sum / weights
    }

    #[test]
    fn the_distribution_is_normalised() {
        // ∫ D(h) (n·h) dh = 1 over the hemisphere.
        for roughness in ROUGHNESSES {
            let alpha = roughness * roughness;
            let sum: f64 = gauss_legendre(400)
                .into_iter()
                .map(|(x, weight)| {
                    let theta = PI / 2.0 * x * x * x;
                    let (sine, cosine) = theta.sin_cos();
                    let step = 3.0 * PI / 2.0 * x * x * weight;
                    2.0 * PI * distribution(alpha, cosine) * cosine * sine * step
                })
                .sum();
            assert!((sum - 1.0).abs() < 1e-9, "{roughness} {sum}");
        }
    }

    #[test]
    fn a_uniform_sky_stays_what_it_is() {
        let sky = CubePyramid::new(CubeMap::from_fn(64, |_| DVec3::new(3.0, 1.0, 0.5)));
        for roughness in ROUGHNESSES {
            let samples = filtered_samples(roughness, SAMPLES);
            for r in directions() {
                let error = prefiltered(&sky, r, &samples) / Vec3::new(3.0, 1.0, 0.5) - 1.0;
                assert!(error.abs().max_element() < 1e-5, "{roughness} {r} {error}");
            }
        }
    }

    #[test]
    fn skies_of_degree_1_and_2_are_dimmed_by_the_moments_of_the_lobe() {
        // The lobe is a function of one angle, so that it multiplies harmonics of degree l by the mean of P_l (Funk and Hecke).
        let axis = DVec3::new(0.3, 0.8, -0.52).normalize();
        let p2 = |c: f64| 1.5 * c * c - 0.5;
        let linear = CubePyramid::new(CubeMap::from_fn(128, |d| DVec3::splat(1.0 + d.dot(axis))));
        let quadratic = CubePyramid::new(CubeMap::from_fn(128, |d| {
            DVec3::splat(1.0 + p2(d.dot(axis)))
        }));
        for roughness in ROUGHNESSES {
            let alpha = roughness * roughness;
            let (f1, f2) = (mean_over_lobe(alpha, |c| c), mean_over_lobe(alpha, p2));
            let samples = filtered_samples(roughness, SAMPLES);
            let mut worst = [0.0f64; 2];
            for r in directions() {
                let expected = [1.0 + f1 * r.dot(axis), 1.0 + f2 * p2(r.dot(axis))];
                let found =
                    [&linear, &quadratic].map(|sky| f64::from(prefiltered(sky, r, &samples).x));
                for k in 0..2 {
                    worst[k] = worst[k].max((found[k] - expected[k]).abs());
                }
            }
            println!(
                "roughness {roughness:.3}: factors {f1:.5} {f2:.5}, worst {:.1e} {:.1e}",
                worst[0], worst[1]
            );
            assert!(worst[0] < 1e-3 && worst[1] < 1e-3, "{roughness} {worst:?}");
        }
        // D of α = 1 is 1/π everywhere, so that the lobe is a cosine: 2/3 and 1/4.
        assert!((mean_over_lobe(1.0, |c| c) - 2.0 / 3.0).abs() < 1e-9);
        assert!((mean_over_lobe(1.0, p2) - 0.25).abs() < 1e-9);
    }

    #[test]
    fn a_smooth_metal_reflects_the_sky() {
        let map = CubeMap::from_fn(32, |d| d + DVec3::splat(2.0));
        let sky = CubePyramid::new(map.clone());
        for roughness in [0.0, 1e-3] {
            let samples = filtered_samples(roughness, SAMPLES);
            for r in directions() {
                let error = prefiltered(&sky, r, &samples).as_dvec3() - map.bilinear(r);
                assert!(error.length() < 1e-4, "{roughness} {r} {error}");
            }
        }
    }

    #[test]
    fn levels_go_down_to_the_roughest_edge() {
        assert_eq!([16, 32, 256].map(levels), [1, 2, 5]);
        assert_eq!([0, 1, 4].map(|level| roughness(level, 5)), [0.0, 0.25, 1.0]);
    }
}
