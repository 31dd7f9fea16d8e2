//! Convergence of the irradiance methods: error against number of samples over a set of normals.

use glam::{DVec2, DVec3};

use super::cube::CubeMap;
use super::irradiance::{
    ExactIrradiance, IrradianceMethod, SphericalHarmonics, monte_carlo, quasi,
};
use super::quadrature::SphereQuadrature;
use super::sample_count::normals;

/// Sample counts of the two sampling methods.
pub const SAMPLES: [u32; 9] = [16, 32, 64, 128, 256, 512, 1024, 2048, 4096];

/// Edges of the cubes for the exact sum, texels.
pub const CUBE_SIZES: [usize; 5] = [4, 8, 16, 32, 64];

/// Independent runs of the random method whose mean square is taken, since a single run varies too much.
const RUNS: u32 = 16;

/// Error of one method with one sample count.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Convergence {
    /// The method.
    pub method: IrradianceMethod,
    /// Radiances evaluated: directions for each normal, or texels or nodes for all normals together.
    pub samples: u32,
    /// Root mean square over the normals of the largest channel's error, relative to E(up).
    pub rms: f64,
}

/// E at each of `normals`, by 256 × 512 nodes per hemisphere: within 1e-5 of E(up) of 512 × 1024 for the skies of this crate.
pub fn reference(radiance: impl Fn(DVec3) -> DVec3, normals: &[DVec3]) -> Vec<DVec3> {
    let nodes: Vec<_> = SphereQuadrature::sphere(256, 512)
        .nodes
        .into_iter()
        .map(|(direction, weight)| (direction, radiance(direction) * weight))
        .collect();
    let at = |n: &DVec3| {
        let terms = nodes.iter().map(|(d, value)| *value * n.dot(*d).max(0.0));
        terms.sum()
    };
    normals.iter().map(at).collect()
}

/// Every method with every sample count, for one sky.
pub fn study(radiance: impl Fn(DVec3) -> DVec3) -> Vec<Convergence> {
    let normals = normals().collect::<Vec<_>>();
    let expected = reference(&radiance, &normals);
    let rms = |runs: u32, e: &dyn Fn(usize, u32) -> DVec3| {
        let up = reference_up(&normals, &expected);
        let error = |k: usize, run| (e(k, run) - expected[k]).abs().max_element() / up;
        let all = (0..normals.len()).flat_map(|k| (0..runs).map(move |run| (k, run)));
        let squares: f64 = all.map(|(k, run)| error(k, run).powi(2)).sum();
        (squares / f64::from(runs) / normals.len() as f64).sqrt()
    };
    let row = |method, samples, rms| Convergence {
        method,
        samples,
        rms,
    };
    let mut rows = Vec::new();
    for n in SAMPLES {
        let seed = |k: usize, run| 1000 * k as u32 + run;
        let e = |k, run| monte_carlo(&radiance, normals[k], n, seed(k, run));
        rows.push(row(IrradianceMethod::MonteCarlo, n, rms(RUNS, &e)));
    }
    for n in SAMPLES {
        let e = |k, _| quasi(&radiance, normals[k], n, DVec2::ZERO);
        rows.push(row(IrradianceMethod::Quasi, n, rms(1, &e)));
    }
    for size in CUBE_SIZES {
        let exact = ExactIrradiance::new(&CubeMap::from_fn(size, &radiance));
        let texels = 6 * (size * size) as u32;
        let e = |k, _| exact.at(normals[k]);
        rows.push(row(IrradianceMethod::Exact, texels, rms(1, &e)));
    }
    let sh = SphericalHarmonics::project(&radiance);
    let e = |k, _| sh.at(normals[k]);
    rows.push(row(IrradianceMethod::Sh, 2 * 64 * 128, rms(1, &e)));
    rows
}

fn reference_up(normals: &[DVec3], expected: &[DVec3]) -> f64 {
    let up = normals.iter().position(|n| *n == DVec3::Y);
    up.map_or(1.0, |k| expected[k].max_element())
}

/// Exponent p in error ∝ samples^p.
pub fn exponent(rows: &[Convergence], method: IrradianceMethod) -> f64 {
    let points: Vec<(f64, f64)> = rows
        .iter()
        .filter(|row| row.method == method)
        .map(|row| (f64::from(row.samples), row.rms))
        .collect();
    power(&points)
}

/// Exponent p in y ∝ x^p: slope of the least-squares line through the logarithms. Points without a logarithm are skipped; NaN
/// if fewer than two distinct x remain.
pub fn power(points: &[(f64, f64)]) -> f64 {
    let points: Vec<(f64, f64)> = points
        .iter()
        .filter(|(x, y)| *x > 0.0 && *y > 0.0)
        .map(|(x, y)| (x.ln(), y.ln()))
        .collect();
    let n = points.len() as f64;
    let mean_x = points.iter().map(|p| p.0).sum::<f64>() / n;
    let mean_y = points.iter().map(|p| p.1).sum::<f64>() / n;
    let xy: f64 = points.iter().map(|p| (p.0 - mean_x) * (p.1 - mean_y)).sum();
    let xx: f64 = points.iter().map(|p| (p.0 - mean_x).powi(2)).sum();
    xy / xx
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::{Conditions, Daylight};

    #[test]
    fn the_exponent_of_a_power_is_found() {
        let squares = [1.0, 2.0, 5.0].map(|x: f64| (x, 3.0 * x * x));
        assert!((power(&squares) - 2.0).abs() < 1e-12);
        assert!((power(&[(1.0, 4.0), (10.0, 4.0), (0.0, 9.0)])).abs() < 1e-12);
        assert!(power(&[(2.0, 4.0)]).is_nan() && power(&[]).is_nan());
    }

    #[test]
    fn random_samples_converge_as_the_square_root() {
        let daylight = Daylight::new(&Conditions::default());
        let rows = study(|d| daylight.radiance(d));
        for row in &rows {
            println!("{row:?}");
        }
        let slope = exponent(&rows, IrradianceMethod::MonteCarlo);
        let quasi = exponent(&rows, IrradianceMethod::Quasi);
        println!("exponents: monte-carlo {slope:.3}, quasi {quasi:.3}");
        assert!((slope + 0.5).abs() <= 0.05, "{slope}");
    }
}
