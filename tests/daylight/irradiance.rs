//! Irradiances of Preetham's sky against `shared/reference/irradiance_reference.csv`: 15 skies, 26 normals each.
//!
//! All errors are relative to E of the up normal of the same sky, largest channel.

use crate::common::{Table, Worst};
use glam::{DVec2, DVec3};
use skylight::daylight::cube::{self, CubeMap};
use skylight::daylight::irradiance::{ExactIrradiance, SphericalHarmonics, monte_carlo, quasi};
use skylight::daylight::preetham::Preetham;
use skylight::daylight::quadrature::SphereQuadrature;

/// One sky of the file: its normals with E over black ground and over ground of albedo 0.2.
struct Case {
    name: String,
    sky: Preetham,
    up: DVec3,
    normals: Vec<(DVec3, DVec3, DVec3)>,
}

impl Case {
    fn radiance(&self, direction: DVec3) -> DVec3 {
        if direction.y >= 0.0 {
            self.sky.radiance(direction)
        } else {
            DVec3::ZERO
        }
    }

    fn error(&self, found: DVec3, expected: DVec3) -> f64 {
        (found - expected).abs().max_element() / self.up.max_element()
    }
}

fn cases() -> Option<Vec<Case>> {
    let table = Table::read("irradiance_reference.csv")?;
    let mut cases: Vec<Case> = Vec::new();
    for row in table.rows() {
        let name = format!("T {} theta_s {}", row.text("T"), row.text("theta_s_deg"));
        if cases.last().is_none_or(|case| case.name != name) {
            let theta_s = row.get("theta_s_deg").to_radians();
            let sky = Preetham::new(row.get("T"), DVec3::new(theta_s.sin(), theta_s.cos(), 0.0));
            cases.push(Case {
                name,
                sky,
                up: DVec3::ZERO,
                normals: Vec::new(),
            });
        }
        let Some(case) = cases.last_mut() else {
            continue;
        };
        // In the file z is up; its y becomes north.
        let normal = DVec3::new(row.get("nx"), row.get("nz"), -row.get("ny")).normalize();
        let black = row.get3(["E_R", "E_G", "E_B"]);
        case.normals
            .push((normal, black, row.get3(["Eg_R", "Eg_G", "Eg_B"])));
        if normal.y > 0.999_999 {
            case.up = black;
        }
    }
    assert!(
        cases
            .iter()
            .all(|case| case.up.min_element() > 0.0 && case.normals.len() == 26)
    );
    Some(cases)
}

/// Checks `irradiance` for every sky and normal; prints the rms and the largest error.
fn check<F: Fn(DVec3) -> DVec3>(
    what: &'static str,
    (rms_allowed, max_allowed): (f64, f64),
    prepare: impl Fn(&'static Case) -> F,
) {
    let Some(cases) = cases() else { return };
    let mut worst = Worst::new(what, max_allowed);
    let (mut squares, mut count) = (0.0, 0.0);
    // Leaked, so that the prepared closures may borrow the cases; the test process is short-lived.
    for case in cases.leak().iter() {
        let irradiance = prepare(case);
        for &(normal, expected, _) in &case.normals {
            let error = case.error(irradiance(normal), expected);
            worst.see(error, format!("{} n {normal}", case.name));
            squares += error * error;
            count += 1.0;
        }
    }
    let rms: f64 = f64::sqrt(squares / count);
    println!("{what}: rms {rms:.2e} (allowed {rms_allowed:.0e})");
    worst.finish();
    assert!(rms <= rms_allowed, "{what}: rms {rms:e}");
}

#[test]
fn quadrature() {
    check("quadrature 128 x 256", (2e-5, 1e-4), |case| {
        let nodes = SphereQuadrature::upper(128, 256).nodes;
        let values: Vec<_> = nodes
            .into_iter()
            .map(|(d, weight)| (d, case.radiance(d) * weight))
            .collect();
        move |n| {
            values
                .iter()
                .map(|&(d, value)| value * n.dot(d).max(0.0))
                .sum()
        }
    });
}

#[test]
fn ground_of_albedo_one_fifth() {
    let Some(cases) = cases() else { return };
    let mut worst = Worst::new("E with a ground of albedo 0.2", 3e-4);
    for case in &cases {
        let ground = case.up * (0.2 / std::f64::consts::PI);
        let radiance = |d: DVec3| if d.y < 0.0 { ground } else { case.radiance(d) };
        let exact = ExactIrradiance::new(&CubeMap::from_fn(64, radiance));
        for &(normal, _, expected) in &case.normals {
            worst.see(case.error(exact.at(normal), expected), &case.name);
        }
    }
    worst.finish();
}

#[test]
fn exact_of_a_32_cube() {
    check("exact, 32 texels", (2e-4, 1e-3), |case| {
        let exact = ExactIrradiance::new(&CubeMap::from_fn(32, |d| case.radiance(d)));
        move |n| exact.at(n)
    });
}

#[test]
fn exact_of_a_64_cube() {
    check("exact, 64 texels", (3e-5, 2e-4), |case| {
        let exact = ExactIrradiance::new(&CubeMap::from_fn(64, |d| case.radiance(d)));
        move |n| exact.at(n)
    });
}

/// The sum a shader may use: L · Ω · max(n·d, 0) with the exact solid angle and the direction of the centre, without clipping.
fn plain_sum(case: &Case, size: usize) -> impl Fn(DVec3) -> DVec3 + use<> {
    let map = CubeMap::from_fn(size, |d| case.radiance(d));
    let texels: Vec<_> = map
        .iter()
        .map(|((face, i, j), value)| {
            let solid_angle = cube::texel_solid_angle(i, j, size);
            (cube::texel_direction(face, i, j, size), value * solid_angle)
        })
        .collect();
    move |n| {
        texels
            .iter()
            .map(|&(d, value)| value * n.dot(d).max(0.0))
            .sum()
    }
}

#[test]
fn plain_sum_over_a_32_cube() {
    check("plain sum, 32 texels", (3e-4, 1e-3), |case| {
        plain_sum(case, 32)
    });
}

#[test]
fn plain_sum_over_a_64_cube() {
    check("plain sum, 64 texels", (5e-5, 3e-4), |case| {
        plain_sum(case, 64)
    });
}

#[test]
fn spherical_harmonics() {
    check("spherical harmonics, order 2", (2e-2, 5e-2), |case| {
        let coefficients = SphericalHarmonics::project(|d| case.radiance(d));
        move |n| coefficients.at(n)
    });
}

#[test]
fn quasi_monte_carlo() {
    check("R2, 4096 points", (2e-3, 1e-2), |case| {
        |n| quasi(|d| case.radiance(d), n, 4096, DVec2::ZERO)
    });
}

#[test]
fn monte_carlo_meets_its_own_standard_error() {
    let Some(cases) = cases() else { return };
    let (samples, runs) = (512, 16);
    let mut worst = Worst::new("Monte Carlo, standard errors of its mean", 5.0);
    for case in &cases {
        for (k, &(normal, expected, _)) in case.normals.iter().enumerate() {
            let seed = |run| 1000 * k as u32 + run;
            let estimates: Vec<f64> = (0..runs)
                .map(|run| monte_carlo(|d| case.radiance(d), normal, samples, seed(run)).y)
                .collect();
            let mean = estimates.iter().sum::<f64>() / f64::from(runs);
            let variance =
                estimates.iter().map(|e| (e - mean).powi(2)).sum::<f64>() / f64::from(runs - 1);
            let standard_error = (variance / f64::from(runs)).sqrt();
            if expected.y > 0.0 {
                worst.see(
                    (mean - expected.y) / standard_error,
                    format!("{} {normal}", case.name),
                );
            } else {
                assert_eq!(mean, 0.0);
            }
        }
    }
    worst.finish();
}
