//! Irradiance E(n) = ∫ L(ω) (n·ω)⁺ dω of a radiance function: lux for cd/m².
//!
//! Four methods behind one interface, [`IrradianceEstimator`]:
//!
//! - [`monte_carlo`]: the lecture's estimator, random directions of density cos θ/π. Its mean of L estimates E/π; the
//!   functions here return **E**.
//! - [`quasi`]: the same with the R2 sequence instead of random numbers; the error falls about as 1/N instead of 1/√N.
//! - [`ExactIrradiance`]: a sum over the texels of a cube map. The radiance is constant within a texel; the cosine is
//!   integrated *exactly* over each texel, clipped at the horizon of n, by Lambert's formula.
//! - [`SphericalHarmonics`]: order 2, nine coefficients; fast and smooth, with errors of some percent of E(up).
//!
//! # How fast they converge
//!
//! `skylight sky --irradiance-study --sky preetham --sun 180,45 --ground-albedo 0`: rms over the 26 normals to the faces, edges and
//! corners of a cube, largest channel, relative to E(up). Samples are directions for each normal; for `exact` the texels of a
//! cube (of 4, 8, 16, 32 and 64 along an edge), for `sh` the nodes of its projection, both for all normals together.
//! A low sun in clear air is worse for both sampling methods: at turbidity 2 and 10° `quasi` has 0.7 % with 1024 directions.
//!
//! | method | samples | rms error of E(up) |
//! |---|---|---|
//! | monte-carlo | 16 | 10.8083 % |
//! | monte-carlo | 32 | 7.7366 % |
//! | monte-carlo | 64 | 5.5436 % |
//! | monte-carlo | 128 | 3.7287 % |
//! | monte-carlo | 256 | 2.6472 % |
//! | monte-carlo | 512 | 2.0534 % |
//! | monte-carlo | 1024 | 1.3864 % |
//! | monte-carlo | 2048 | 0.9670 % |
//! | monte-carlo | 4096 | 0.6728 % |
//! | quasi | 16 | 8.2971 % |
//! | quasi | 32 | 4.9319 % |
//! | quasi | 64 | 2.3094 % |
//! | quasi | 128 | 1.2017 % |
//! | quasi | 256 | 0.4673 % |
//! | quasi | 512 | 0.2805 % |
//! | quasi | 1024 | 0.1748 % |
//! | quasi | 2048 | 0.0873 % |
//! | quasi | 4096 | 0.0566 % |
//! | exact | 96 | 1.0449 % |
//! | exact | 384 | 0.1041 % |
//! | exact | 1536 | 0.0346 % |
//! | exact | 6144 | 0.0050 % |
//! | exact | 24576 | 0.0011 % |
//! | sh | 16384 | 0.3889 % |
//!
//! monte-carlo: error falls as samples^-0.50
//! quasi: error falls as samples^-0.93
//!
//! # Differences from the device's methods of the same names
//!
//! - `quasi` here: the first N points of R2, the radiance evaluated in each direction, one tangent frame per normal. On the
//!   device: Hammersley points in golden-ratio order, lookups in the mip level of each sample's solid angle
//!   ([`super::sample_count`]), the frame turned about the normal by an angle per texel: about a third of the error.
//! - `exact` here: a cube of [`EXACT_CUBE_SIZE`]² texels a face, the clipped cosine integrated over each texel in closed form.
//!   On the device: a cube of 32² texels a face, the cosine at each texel's centre times the texel's solid angle.
//! - `monte-carlo` uses the same generator, but the device looks the radiance up in the sky cube (bilinear) and seeds by texel.
//! - `sh` is the same; the device clamps negative channels to 0.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::cube::{self, CubeMap};
use super::quadrature::SphereQuadrature;
use super::sampling::{cosine_hemisphere, r2, rnd, rotate, tea};
use super::tangent_frame;

/// How the irradiance map is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IrradianceMethod {
    /// Random cosine-weighted directions, as in the lecture.
    MonteCarlo,
    /// Low-discrepancy cosine-weighted directions.
    #[default]
    Quasi,
    /// Sum over the sky cube's texels.
    Exact,
    /// Spherical harmonics of order 2.
    Sh,
}

impl IrradianceMethod {
    /// Whether the method samples directions, so that more samples lower its error.
    pub fn is_sampled(self) -> bool {
        matches!(self, Self::MonteCarlo | Self::Quasi)
    }
}

/// Edge of the cube for [`IrradianceMethod::Exact`] on the CPU, texels: the error is 2e-5 of E(up) rms, 1.3e-4 at worst.
pub const EXACT_CUBE_SIZE: usize = 64;

/// Irradiance of a radiance function by any of the methods. Prepared once, evaluated for many normals.
pub enum IrradianceEstimator<L> {
    /// Radiance and number of samples.
    MonteCarlo(L, u32),
    /// Radiance and number of samples.
    Quasi(L, u32),
    /// Texels with their cosine integrals.
    Exact(ExactIrradiance),
    /// Nine coefficients.
    Sh(SphericalHarmonics),
}

impl<L: Fn(DVec3) -> DVec3> IrradianceEstimator<L> {
    /// Prepares `radiance` (unit direction to cd/m²); `samples` directions per normal for the two sampling methods.
    pub fn new(method: IrradianceMethod, radiance: L, samples: u32) -> Self {
        match method {
            IrradianceMethod::MonteCarlo => Self::MonteCarlo(radiance, samples),
            IrradianceMethod::Quasi => Self::Quasi(radiance, samples),
            IrradianceMethod::Exact => Self::Exact(ExactIrradiance::new(&CubeMap::from_fn(
                EXACT_CUBE_SIZE,
                radiance,
            ))),
            IrradianceMethod::Sh => Self::Sh(SphericalHarmonics::project(radiance)),
        }
    }

    /// E(n) for a unit `normal`, lux.
    pub fn at(&self, normal: DVec3) -> DVec3 {
        match self {
            Self::MonteCarlo(radiance, samples) => monte_carlo(radiance, normal, *samples, 0),
            Self::Quasi(radiance, samples) => quasi(radiance, normal, *samples, DVec2::ZERO),
            Self::Exact(texels) => texels.at(normal),
            Self::Sh(coefficients) => coefficients.at(normal),
        }
    }
}

/// Lecture, "Integrating skylight": E(n) from `samples` random directions of density cos θ/π; `seed` selects the sequence.
pub fn monte_carlo(
    radiance: impl Fn(DVec3) -> DVec3,
    normal: DVec3,
    samples: u32,
    seed: u32,
) -> DVec3 {
    let mut state = tea::<4>(seed, 0);
    mean_cosine(radiance, normal, samples, |_| {
        let first = rnd(&mut state);
        DVec2::new(first, rnd(&mut state))
    })
}

/// E(n) from the first `samples` points of R2, shifted on the torus by `shift` (0 for none).
pub fn quasi(
    radiance: impl Fn(DVec3) -> DVec3,
    normal: DVec3,
    samples: u32,
    shift: DVec2,
) -> DVec3 {
    mean_cosine(radiance, normal, samples, |index| rotate(r2(index), shift))
}

/// π times the mean radiance over cosine-weighted directions: each term is L cos θ / (cos θ/π).
fn mean_cosine(
    radiance: impl Fn(DVec3) -> DVec3,
    normal: DVec3,
    samples: u32,
    mut point: impl FnMut(u32) -> DVec2,
) -> DVec3 {
    let sum: DVec3 = (0..samples)
        .map(|index| {
            radiance(tangent_frame::to_world(
                cosine_hemisphere(point(index)),
                normal,
            ))
        })
        .sum();
    sum * (PI / f64::from(samples.max(1)))
}

/// A cube map prepared for exact sums: each texel with its vector ∫ ω dω.
pub struct ExactIrradiance {
    texels: Vec<Texel>,
}

struct Texel {
    radiance: DVec3,
    corners: [DVec3; 4],
    /// ∫ ω dω over the texel, sr.
    moment: DVec3,
}

impl ExactIrradiance {
    /// Prepares the texels of `map`, which hold the radiance at their centres.
    ///
    /// Texel *averages* would be worse (1.6e-4 rms instead of 1.4e-4 at 32 texels): L and the cosine are correlated at the
    /// horizon, and the mean of the product is closer to the product at the centre than to the product of the means.
    pub fn new(map: &CubeMap) -> Self {
        let size = map.size();
        let prepare = |((face, i, j), radiance)| {
            let corners = cube::texel_corners(face, i, j, size);
            Texel {
                radiance,
                corners,
                moment: polygon_moment(&corners),
            }
        };
        Self {
            texels: map.iter().map(prepare).collect(),
        }
    }

    /// E(n), exact for a radiance that is constant within each texel.
    pub fn at(&self, normal: DVec3) -> DVec3 {
        self.texels
            .iter()
            .map(|texel| texel.radiance * texel.cosine(normal))
            .sum()
    }
}

impl Texel {
    /// ∫ (n·ω)⁺ dω over the texel.
    fn cosine(&self, normal: DVec3) -> f64 {
        let heights = self.corners.map(|corner| corner.dot(normal));
        if heights.iter().all(|&h| h >= 0.0) {
            normal.dot(self.moment)
        } else if heights.iter().all(|&h| h <= 0.0) {
            0.0
        } else {
            normal
                .dot(polygon_moment(&clip(&self.corners, &heights)))
                .max(0.0)
        }
    }
}

/// Lambert 1760 (Arvo 1995, irradiance of a polygon): ∫ ω dω over the spherical polygon with the unit `corners`.
///
/// ½ Σ θ_k Γ_k over the edges: θ the arc, Γ the unit normal of its plane. The sign follows the winding; here the moment is
/// flipped to the side of the corners, which is right for polygons smaller than a hemisphere.
fn polygon_moment(corners: &[DVec3]) -> DVec3 {
    let edge = |k: usize| {
        let (a, b) = (corners[k], corners[(k + 1) % corners.len()]);
        let cross = a.cross(b);
        let sine = cross.length();
        if sine > 0.0 {
            cross * (sine.atan2(a.dot(b)) / sine)
        } else {
            DVec3::ZERO
        }
    };
    let moment: DVec3 = 0.5 * (0..corners.len()).map(edge).sum::<DVec3>();
    let middle: DVec3 = corners.iter().sum();
    if moment.dot(middle) < 0.0 {
        -moment
    } else {
        moment
    }
}

/// Sutherland & Hodgman 1974, on the sphere: the part of a convex polygon whose heights over the plane are not negative.
fn clip(corners: &[DVec3; 4], heights: &[f64; 4]) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(6);
    for k in 0..4 {
        let next = (k + 1) % 4;
        if heights[k] >= 0.0 {
            kept.push(corners[k]);
        }
        if (heights[k] > 0.0 && heights[next] < 0.0) || (heights[k] < 0.0 && heights[next] > 0.0) {
            // The point where the chord crosses the plane, normalised, is where the arc does.
            let crossing = corners[k] * heights[next] - corners[next] * heights[k];
            kept.push(crossing.normalize() * (heights[next] - heights[k]).signum());
        }
    }
    kept
}

/// Ramamoorthi & Hanrahan 2001, *An Efficient Representation for Irradiance Environment Maps*: nine coefficients.
///
/// Error 0.4..1.5 % of E(up) for a high sun, 4.5 % at turbidity 2 with the sun at 10°; may be slightly negative downward.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SphericalHarmonics {
    /// Coefficients L_lm of the radiance, linear RGB in cd/m² · sr½, in the order 00, 1-1, 10, 11, 2-2, 2-1, 20, 21, 22.
    pub radiance: [DVec3; 9],
}

impl SphericalHarmonics {
    /// Projects a radiance function by 64 × 128 nodes per hemisphere.
    pub fn project(radiance: impl Fn(DVec3) -> DVec3) -> Self {
        let mut coefficients = [DVec3::ZERO; 9];
        for (direction, weight) in SphereQuadrature::sphere(64, 128).nodes {
            let value = radiance(direction) * weight;
            for (sum, basis) in coefficients.iter_mut().zip(basis(direction)) {
                *sum += value * basis;
            }
        }
        Self {
            radiance: coefficients,
        }
    }

    /// E(n) = Σ Â_l L_lm Y_lm(n), lux; Â = π, 2π/3, π/4 (their eq. 8).
    pub fn at(&self, normal: DVec3) -> DVec3 {
        let a = [PI, 2.0 * PI / 3.0, PI / 4.0];
        let band = [a[0], a[1], a[1], a[1], a[2], a[2], a[2], a[2], a[2]];
        let terms = self.radiance.iter().zip(basis(normal)).zip(band);
        terms
            .map(|((coefficient, basis), a)| *coefficient * basis * a)
            .sum()
    }
}

/// Ramamoorthi & Hanrahan 2001, eq. 3: the nine real harmonics up to order 2 at a unit direction.
fn basis(d: DVec3) -> [f64; 9] {
    let DVec3 { x, y, z } = d;
    let c0 = 0.5 * (1.0 / PI).sqrt();
    let c1 = 0.5 * (3.0 / PI).sqrt();
    let c2 = 0.5 * (15.0 / PI).sqrt();
    let c3 = 0.25 * (5.0 / PI).sqrt();
    [
        c0,
        c1 * y,
        c1 * z,
        c1 * x,
        c2 * x * y,
        c2 * y * z,
        c3 * (3.0 * z * z - 1.0),
        c2 * x * z,
        0.5 * c2 * (x * x - y * y),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::sampling::{hammersley, uniform_sphere};

    const METHODS: [IrradianceMethod; 4] = [
        IrradianceMethod::MonteCarlo,
        IrradianceMethod::Quasi,
        IrradianceMethod::Exact,
        IrradianceMethod::Sh,
    ];

    fn normals() -> impl Iterator<Item = DVec3> {
        (0..50).map(|i| uniform_sphere(hammersley(i, 50)))
    }

    #[test]
    fn a_constant_sky_gives_pi_by_every_method() {
        for method in METHODS {
            let e = IrradianceEstimator::new(method, |_| DVec3::ONE, 16);
            for normal in normals() {
                let error = (e.at(normal) - DVec3::splat(PI)).abs().max_element();
                assert!(error < 1e-9, "{method:?} {normal} {error:e}");
            }
        }
    }

    #[test]
    fn a_linear_radiance_gives_two_thirds_pi_along_its_axis() {
        // L = 1 + ω·a has E(n) = π + 2π/3 n·a, also for n below the horizon of a.
        let axis = DVec3::new(0.2, 0.5, -0.3);
        let radiance = |d: DVec3| DVec3::splat(1.0 + d.dot(axis));
        for (method, tolerance) in METHODS.into_iter().zip([5e-2, 3e-3, 1e-3, 1e-10]) {
            let e = IrradianceEstimator::new(method, radiance, 4096);
            for n in normals() {
                let error = (e.at(n).x - PI - 2.0 * PI / 3.0 * n.dot(axis)).abs();
                assert!(error < tolerance, "{method:?} {n} {error:e}");
            }
        }
    }

    #[test]
    fn half_a_sky_gives_half_to_a_wall_and_nothing_to_a_ceiling() {
        let sky = |d: DVec3| if d.y >= 0.0 { DVec3::ONE } else { DVec3::ZERO };
        let e = ExactIrradiance::new(&CubeMap::from_fn(8, sky));
        assert!((e.at(DVec3::Y).x - PI).abs() < 1e-12);
        assert!((e.at(DVec3::X).x - PI / 2.0).abs() < 1e-12);
        assert!(e.at(DVec3::NEG_Y).x.abs() < 1e-12);
        // A slope with the angle a sees (1 + cos a)/2 of the sky.
        let slope = DVec3::new(0.6, 0.8, 0.0);
        assert!((e.at(slope).x - PI * 0.9).abs() < 1e-12);
    }

    #[test]
    fn moments_of_a_faces_texels_add_up() {
        // ∫ (n·ω) dω over a cube face along its axis, in closed form: 2 √2 atan(1/√2) (Lambert).
        let exact = 2.0 * 2f64.sqrt() * (0.5f64.sqrt()).atan();
        let corners = cube::texel_corners(0, 0, 0, 1);
        assert!((polygon_moment(&corners).x - exact).abs() < 1e-14);
        let sum: f64 = (0..64)
            .map(|k| polygon_moment(&cube::texel_corners(0, k % 8, k / 8, 8)).x)
            .sum();
        assert!((sum - exact).abs() < 1e-13, "{sum}");
    }
}
