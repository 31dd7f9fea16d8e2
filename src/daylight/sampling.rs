//! Points and directions: the course framework's random numbers, low-discrepancy points, warps.
//!
//! The integer functions match the shader's bit for bit.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

/// Zafar, Olano & Curtis 2010 (after Wheeler & Needham's TEA): hash of two words in `ROUNDS` rounds. The framework
/// seeds with four rounds of (pixel index, layer + 6 · iteration).
pub fn tea<const ROUNDS: u32>(mut v0: u32, mut v1: u32) -> u32 {
    let mut sum = 0u32;
    for _ in 0..ROUNDS {
        sum = sum.wrapping_add(0x9e37_79b9);
        v0 = v0.wrapping_add(
            (v1 << 4).wrapping_add(0xa341_316c)
                ^ v1.wrapping_add(sum)
                ^ (v1 >> 5).wrapping_add(0xc801_3ea4),
        );
        v1 = v1.wrapping_add(
            (v0 << 4).wrapping_add(0xad90_777d)
                ^ v0.wrapping_add(sum)
                ^ (v0 >> 5).wrapping_add(0x7e95_761e),
        );
    }
    v0
}

/// Linear congruential generator of Numerical Recipes: advances `state`, returns its low 24 bits.
pub fn lcg(state: &mut u32) -> u32 {
    *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    *state & 0x00ff_ffff
}

/// Random number in [0, 1) on a grid of 2⁻²⁴: the framework's `rnd(t)`.
pub fn rnd(state: &mut u32) -> f64 {
    f64::from(lcg(state)) / f64::from(0x0100_0000u32)
}

/// Roberts 2018, R2 sequence: point `index` in [0, 1)²; progressive (every prefix is well spread).
pub fn r2(index: u32) -> DVec2 {
    // 1/g and 1/g² for the plastic number g, the real root of g³ = g + 1.
    const A: DVec2 = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_2);
    (DVec2::splat(0.5) + f64::from(index) * A).fract()
}

/// Van der Corput's radical inverse in base 2, in [0, 1): the bits of `index` behind the binary point.
pub fn radical_inverse(index: u32) -> f64 {
    f64::from(index.reverse_bits()) / 2f64.powi(32)
}

/// Hammersley point `index` of `count` in [0, 1)²; not progressive.
pub fn hammersley(index: u32, count: u32) -> DVec2 {
    DVec2::new(
        (f64::from(index) + 0.5) / f64::from(count),
        radical_inverse(index),
    )
}

/// Sobol' 1967, first two dimensions: point `index` in [0, 1)²; progressive, best at powers of two.
pub fn sobol(index: u32) -> DVec2 {
    let (mut bits, mut direction, mut left) = (0u32, 1u32 << 31, index);
    while left != 0 {
        if left & 1 == 1 {
            bits ^= direction;
        }
        direction ^= direction >> 1;
        left >>= 1;
    }
    DVec2::new(radical_inverse(index), f64::from(bits) / 2f64.powi(32))
}

/// Laine & Karras 2011, "Stratified Sampling for Stochastic Transparency": nested uniform scrambling, which flips each bit
/// depending on the bits above it (Owen 1995); multipliers of Burley 2020, "Practical Hash-based Owen Scrambling".
fn scrambled(bits: u32, seed: u32) -> u32 {
    let mut v = bits.reverse_bits();
    v ^= v.wrapping_mul(0x3d20_adea);
    v = v.wrapping_add(seed);
    v = v.wrapping_mul((seed >> 16) | 1);
    v ^= v.wrapping_mul(0x0552_6c56);
    v ^= v.wrapping_mul(0x53a2_2864);
    v.reverse_bits()
}

/// Point `index` of [`sobol`], scrambled by `seed`. Every seed gives different points with the same uniformity, independent of
/// those of other seeds and of [`r2`].
pub fn scrambled_sobol(index: u32, seed: u32) -> DVec2 {
    // At most 32 bits, so the casts are exact.
    let bits = (sobol(index) * 2f64.powi(32)).to_array().map(|v| v as u32);
    let seeds = [tea::<4>(seed, 0), tea::<4>(seed, 1)];
    DVec2::new(
        f64::from(scrambled(bits[0], seeds[0])) / 2f64.powi(32),
        f64::from(scrambled(bits[1], seeds[1])) / 2f64.powi(32),
    )
}

/// [`scrambled_sobol`] in an order shuffled by `seed` (Burley 2020, "Practical hash-based Owen scrambling"): sequences of different
/// seeds can be the pairs of one point in many dimensions. Every aligned block of 2ⁿ points is as well spread as the unshuffled one.
pub fn shuffled_sobol(index: u32, seed: u32) -> DVec2 {
    scrambled_sobol(scrambled(index, tea::<4>(seed, 2)), seed)
}

/// Multiples of √2 and √3 (Richtmyer 1951), point `index` in [0, 1)²: less uniform than [`r2`], but not correlated with it.
pub fn richtmyer(index: u32) -> DVec2 {
    let roots = DVec2::new(std::f64::consts::SQRT_2, 3f64.sqrt());
    (DVec2::splat(0.5) + f64::from(index) * roots).fract()
}

/// Cranley & Patterson 1976: shifts a point set on the torus, so that texels differ while uniformity is kept.
pub fn rotate(point: DVec2, shift: DVec2) -> DVec2 {
    (point + shift).fract()
}

/// Lecture, "Integrating skylight": direction about +z with density cos θ / π from a point in [0, 1)²:
/// θ = acos √(1 - ξ1), φ = 2π ξ2.
pub fn cosine_hemisphere(xi: DVec2) -> DVec3 {
    let (sin_phi, cos_phi) = (2.0 * PI * xi.y).sin_cos();
    let (cos_theta, sin_theta) = ((1.0 - xi.x).sqrt(), xi.x.sqrt());
    DVec3::new(cos_phi * sin_theta, sin_phi * sin_theta, cos_theta)
}

/// Direction with density 1/(4π) from a point in [0, 1)².
pub fn uniform_sphere(xi: DVec2) -> DVec3 {
    let (sin_phi, cos_phi) = (2.0 * PI * xi.y).sin_cos();
    let z = 1.0 - 2.0 * xi.x;
    let r = (1.0 - z * z).max(0.0).sqrt();
    DVec3::new(r * cos_phi, r * sin_phi, z)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tea_without_rounds_is_its_input_and_with_four_mixes_well() {
        assert_eq!(tea::<0>(7, 9), 7);
        // One round by hand: v0 = (0 + 0xa341316c) ^ 0x9e3779b9 ^ 0xc8013ea4.
        assert_eq!(tea::<1>(0, 0), 0xa341_316c ^ 0x9e37_79b9 ^ 0xc801_3ea4);
        let flipped: u32 = (0..1000)
            .map(|i| (tea::<4>(i, 0) ^ tea::<4>(i, 1)).count_ones())
            .sum();
        assert!(
            (14_000..18_000).contains(&flipped),
            "{flipped} of 32000 bits"
        );
    }

    #[test]
    fn lcg_follows_its_recurrence() {
        let mut state = 1;
        assert_eq!(lcg(&mut state), (1_664_525 + 1_013_904_223) & 0x00ff_ffff);
        assert_eq!(state, 1_664_525 + 1_013_904_223);
    }

    #[test]
    fn rnd_is_uniform() {
        let mut state = tea::<4>(3, 5);
        let mean: f64 = (0..100_000).map(|_| rnd(&mut state)).sum::<f64>() / 1e5;
        assert!((mean - 0.5).abs() < 5e-3, "{mean}");
    }

    #[test]
    fn low_discrepancy_points_integrate_better_than_chance() {
        let exact = 0.25;
        let error = |point: &dyn Fn(u32) -> DVec2| {
            let sum: f64 = (0..4096).map(point).map(|p| p.x * p.y).sum();
            (sum / 4096.0 - exact).abs()
        };
        for (name, e) in [
            ("r2", error(&r2)),
            ("hammersley", error(&|i| hammersley(i, 4096))),
            ("sobol", error(&sobol)),
        ] {
            assert!(e < 5e-4, "{name} {e}");
        }
    }

    #[test]
    fn sobol_fills_every_elementary_square() {
        let mut seen = [false; 64];
        for i in 0..64 {
            let p = sobol(i) * 8.0;
            // Points lie in [0, 1)²: the cast truncates.
            seen[p.y as usize * 8 + p.x as usize] = true;
        }
        assert!(seen.iter().all(|&s| s));
    }

    #[test]
    fn scrambling_keeps_one_point_in_every_elementary_interval() {
        for seed in 0..20 {
            for (columns, rows) in [(64, 1), (16, 4), (8, 8), (2, 32)] {
                let mut seen = [false; 64];
                for i in 0..64 {
                    let p =
                        scrambled_sobol(i, seed) * DVec2::new(f64::from(columns), f64::from(rows));
                    seen[p.y as usize * columns as usize + p.x as usize] = true;
                }
                assert!(seen.iter().all(|&s| s), "{seed} {columns} {rows}");
            }
        }
        assert_ne!(scrambled_sobol(5, 0), scrambled_sobol(5, 1));
    }

    /// Variance of the counts of point pairs of two sequences in 8x8x8x8 cells, relative to that of independent points.
    fn dependence(a: &dyn Fn(u32) -> DVec2, b: &dyn Fn(u32) -> DVec2) -> f64 {
        const CELLS: usize = 4096;
        let mut counts = vec![0u32; CELLS];
        for i in 0..16 * CELLS as u32 {
            let cell = |p: DVec2| (p.x * 8.0) as usize * 8 + (p.y * 8.0) as usize;
            counts[cell(a(i)) * 64 + cell(b(i))] += 1;
        }
        // The expected count is 16.
        let squares: f64 = counts.iter().map(|n| (f64::from(*n) - 16.0).powi(2)).sum();
        // For independent points the variance of a count is 16.
        squares / CELLS as f64 / 16.0
    }

    #[test]
    fn sequences_that_are_drawn_together_are_not_in_step() {
        let far = |i: u32| r2(i + (1 << 20));
        let disc = |i: u32| scrambled_sobol(i, 9);
        let pixel_of_eight = |i: u32| r2(i / 8);
        let direction = |i: u32| scrambled_sobol(i, 4);
        assert!(dependence(&r2, &far) > 100.0);
        for (name, d) in [
            ("pixel and disc", dependence(&r2, &disc)),
            (
                "pixel and direction",
                dependence(&pixel_of_eight, &direction),
            ),
            ("pixel and texel", dependence(&r2, &richtmyer)),
            ("disc and texel", dependence(&disc, &richtmyer)),
        ] {
            assert!(d < 3.0, "{name}: {d}");
        }
    }

    #[test]
    fn the_warps_have_the_moments_of_their_densities() {
        let n = 4096;
        let mean = |f: &dyn Fn(DVec3) -> f64, warp: fn(DVec2) -> DVec3| {
            (0..n).map(|i| f(warp(hammersley(i, n)))).sum::<f64>() / f64::from(n)
        };
        assert!((mean(&|d| d.z, cosine_hemisphere) - 2.0 / 3.0).abs() < 1e-4);
        assert!((mean(&|d| d.x * d.x, cosine_hemisphere) - 0.25).abs() < 1e-3);
        assert!((mean(&|d| d.x * d.x, uniform_sphere) - 1.0 / 3.0).abs() < 1e-3);
        assert!((0..n).all(|i| cosine_hemisphere(hammersley(i, n)).is_normalized()));
    }
}
