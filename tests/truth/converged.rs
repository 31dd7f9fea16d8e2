//! Converged renders of direct light against path-traced references under identical light (`../shared/truth`), edges included.
//!
//! 64 samples, or SKYLIGHT_TRUTH_SAMPLES. Sky light in the references has about 1 % of noise per pixel, which averages out
//! over many pixels.

use std::fs;
use std::path::{Path, PathBuf};

use crate::truth::{Exr, VIEWS};
use serde_json::Value;
use skylight::compare::{Picture, Referred, Statistics, eroded, exposure_of, flip};

const SAMPLES: u32 = 64;

/// Limits for any number of samples.
const MEAN_RATIO: f64 = 0.01;
const FLIP: f64 = 0.03;
/// Limits for 64 samples.
const RMSE_OF_FEW: f64 = 0.03;
const MEDIAN_OF_FEW: f64 = 0.015;
/// Limits for 256 samples. With 1 024 samples the median is 1.18 % under the low sun: the reference's own noise.
const RMSE: f64 = 0.03;
const MEDIAN: f64 = 0.012;

pub fn samples() -> u32 {
    match std::env::var("SKYLIGHT_TRUTH_SAMPLES") {
        Ok(text) => text.parse().expect("SKYLIGHT_TRUTH_SAMPLES is a number"),
        Err(_) => SAMPLES,
    }
}

/// A view's reference and our render.
pub struct Compared {
    folder: PathBuf,
    name: &'static str,
    reference: Picture,
    ours: Picture,
    /// Pixels with geometry, eroded by one pixel.
    pub inside: Vec<bool>,
}

fn picture(exr: &Exr) -> Picture {
    let [r, g, b] = ["R", "G", "B"].map(|name| exr.channel(name));
    Picture {
        size: exr.size,
        rgb: (0..r.len()).map(|i| [r[i], g[i], b[i]]).collect(),
        referred: Referred::Scene,
    }
}

impl Compared {
    /// Renders a view with `further` options; `reference` is the light of the reference: `direct` or `full`.
    pub fn new(shared: &Path, name: &'static str, reference: &str, further: &[&str]) -> Self {
        let folder = shared.join("truth");
        let read = |what: &str| Exr::read(&folder.join(format!("{name}_{what}.exr")));
        let json = fs::read(folder.join(format!("{name}.json"))).expect("the view");
        let view: Value = serde_json::from_slice(&json).expect("JSON");
        let aov = read("aov");
        let geometry: Vec<bool> = aov.channel("depth.T").iter().map(|d| *d > 0.0).collect();
        Self {
            name,
            reference: picture(&read(reference)),
            ours: picture(&crate::truth::render(shared, &view, further)),
            inside: eroded(aov.size, &geometry),
            folder,
        }
    }

    /// Our render against the reference.
    pub fn statistics(&self, mask: &[bool]) -> Statistics {
        Statistics::new(&self.reference, &self.ours, mask).expect("figures")
    }

    /// FLIP of the tone-mapped pictures.
    fn flip(&self) -> f64 {
        let exposure = exposure_of(&self.reference, &self.inside);
        let shown = |p: &Picture| p.masked(&self.inside).exposed(exposure);
        let map = flip::ldr(&shown(&self.reference), &shown(&self.ours));
        let kept = map.iter().zip(&self.inside).filter(|(_, kept)| **kept);
        flip::mean(&kept.map(|(v, _)| *v).collect::<Vec<_>>())
    }

    /// Pixels whose visible fraction of the sky is in `range`; with `up`, only those that face up.
    fn region(&self, range: std::ops::Range<f32>, up: bool) -> Vec<bool> {
        let read = |what: &str| Exr::read(&self.folder.join(format!("{}_{what}.exr", self.name)));
        let (share, aov) = (read("ao_inf"), read("aov"));
        let (share, height) = (share.channel("Y"), aov.channel("normal.Y"));
        let of = |i: usize| range.contains(&share[i]) && (!up || height[i] > 0.999);
        eroded(aov.size, &(0..share.len()).map(of).collect::<Vec<_>>())
    }
}

#[test]
fn every_view_converges_to_the_path_tracers() {
    let Some(shared) = crate::common::shared() else {
        return;
    };
    let is_few = samples() < 256;
    let (rmse, median) = if is_few {
        (RMSE_OF_FEW, MEDIAN_OF_FEW)
    } else {
        (RMSE, MEDIAN)
    };
    let mut faults = Vec::new();
    for name in VIEWS {
        let count = samples().to_string();
        let direct = [
            "--visibility",
            "dome",
            "--samples",
            &count,
            "--bounces",
            "0",
        ];
        let compared = Compared::new(&shared, name, "direct", &direct);
        let (s, flip) = (compared.statistics(&compared.inside), compared.flip());
        println!(
            "{name:10} {} samples: ratio {:.4} RMSE/mean {:.4} median {:.4} p95 {:.4} FLIP {flip:.4}",
            samples(),
            s.mean_ratio,
            s.rmse_over_mean,
            s.median,
            s.p95
        );
        for (what, value, limit) in [
            ("mean ratio - 1", (s.mean_ratio - 1.0).abs(), MEAN_RATIO),
            ("RMSE/mean", s.rmse_over_mean, rmse),
            ("median", s.median, median),
            ("FLIP", flip, FLIP),
        ] {
            if value.is_nan() || value > limit {
                faults.push(format!("{name}: {what} is {value:.4}, allowed {limit}"));
            }
        }
        if name == "colonnade" {
            // Floor and columns that see little of the sky, and ground that sees nearly all of it.
            let under = compared.region(0.0..0.4, false);
            let open = compared.region(0.97..1.1, true);
            let of = |mask: &[bool]| {
                (
                    mask.iter().filter(|m| **m).count(),
                    compared.statistics(mask).mean_ratio,
                )
            };
            let [(n, a), (m, b)] = [of(&under), of(&open)];
            println!("{name:10} under its roof {a:.4} of {n} pixels, open ground {b:.4} of {m}");
            assert!(n > 1000 && m > 1000, "{n} {m}");
            if (a - 1.0).abs() > 0.01 || (b - 1.0).abs() > 0.003 {
                faults.push(format!(
                    "{name}: bias under the roof {a}, on open ground {b}"
                ));
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}
