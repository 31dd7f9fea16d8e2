//! Renders with all bounces against path-traced references with all bounces (`../shared/truth`, `NAME_full.exr`).

use crate::converged::{Compared, samples};

/// Limits of a view: ratio of the means below and above 1, and RMSE over mean.
struct Limits {
    name: &'static str,
    ratio: f64,
    rmse: f64,
}

const fn limits(name: &'static str, ratio: f64, rmse: f64) -> Limits {
    Limits { name, ratio, rmse }
}

/// Limits of converged pictures with 64 samples. The references have 1 to 3 % of noise per pixel themselves.
const CONVERGED: [Limits; 5] = [
    limits("colonnade", 0.005, 0.04),
    limits("house", 0.005, 0.04),
    limits("house_low", 0.005, 0.04),
    limits("medieval", 0.005, 0.05),
    limits("teapot", 0.005, 0.04),
];

/// Limits of single frames, whose light is interpolated between cells.
const SINGLE: [Limits; 5] = [
    limits("colonnade", 0.03, 0.12),
    limits("house", 0.03, 0.13),
    limits("house_low", 0.03, 0.19),
    limits("medieval", 0.03, 0.11),
    limits("teapot", 0.03, 0.06),
];

/// Renders every view with these options and compares it with its reference.
fn check(views: &[Limits], what: &str, options: &[&str]) {
    let Some(shared) = crate::common::shared() else {
        return;
    };
    let mut faults = Vec::new();
    for Limits { name, ratio, rmse } in views {
        let compared = Compared::new(&shared, name, "full", options);
        let s = compared.statistics(&compared.inside);
        println!(
            "{name:10} {what}: ratio {:.4} RMSE/mean {:.4} median {:.4} p95 {:.4}",
            s.mean_ratio, s.rmse_over_mean, s.median, s.p95
        );
        let off = (s.mean_ratio - 1.0).abs();
        for (what, value, limit) in [
            ("mean ratio - 1", off, *ratio),
            ("RMSE/mean", s.rmse_over_mean, *rmse),
        ] {
            if value.is_nan() || value > limit {
                faults.push(format!("{name}: {what} is {value:.4}, allowed {limit}"));
            }
        }
    }
    assert!(faults.is_empty(), "{what}: {faults:#?}");
}

#[test]
fn converged_pictures_have_all_bounces_of_the_path_tracer() {
    let count = samples().to_string();
    let options = ["--visibility", "dome", "--samples", &count];
    check(&CONVERGED, "converged", &options);
}

#[test]
fn single_frames_have_all_bounces_of_the_path_tracer() {
    check(&SINGLE, "single frame", &[]);
}
