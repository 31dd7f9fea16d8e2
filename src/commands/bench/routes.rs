//! The sky's irradiance by three routes, side by side: layered rendering through a geometry shader, compute, and the exact
//! sum over the texels of a coarse sky.

use std::fmt::{self, Formatter};
use std::sync::Arc;

use glam::{DVec3, Vec4};
use serde::{Deserialize, Serialize};

use super::measure::{WARM_UP, trustworthy};
use super::statistics::{Samples, Summary};
use crate::commands::job::Job;
use crate::daylight::IrradianceMethod;
use crate::error::Result;
use crate::gpu::{Context, Optional, Recorder, read_back};
use crate::passes::light::lighting::Precision;
use crate::passes::sky::cube::SkyCube;
use crate::passes::sky::irradiance::{Irradiance, IrradianceSettings};
use crate::passes::sky::route::CubeRoute;

/// More frames tell nothing new: a map is drawn within one pass.
const MOST_FRAMES: u32 = 30;

/// One way to the whole map.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Route {
    /// In words.
    pub name: String,
    /// Radiances looked up for each texel.
    pub samples: u32,
    /// Time of the whole map.
    #[serde(flatten)]
    pub time: Summary,
    /// Root of the mean square of its distance to the exact sum, relative to the largest E.
    pub rms: f64,
    /// The largest distance.
    pub largest: f64,
}

/// Times every route that the device can go and compares their maps.
///
/// # Errors
/// When the device refuses.
pub fn measure(job: &Job, context: &Arc<Context>, frames: u32) -> Result<Vec<Route>> {
    let base = job.frame_settings(job.settings.show, Precision::Half);
    let samples = job.settings.irradiance_samples;
    let sampled = |route| IrradianceSettings {
        method: IrradianceMethod::Quasi,
        samples,
        samples_per_pass: samples,
        route: Some(route),
        ..base.irradiance
    };
    let exact = IrradianceSettings {
        method: IrradianceMethod::Exact,
        route: None,
        ..base.irradiance
    };
    let mut routes = vec![("compute shader", sampled(CubeRoute::Compute))];
    if context.summary().has(Optional::GeometryShader) {
        routes.insert(0, ("geometry shader", sampled(CubeRoute::Geometry)));
    }
    let mut sky = SkyCube::new(context, base.sky_edge)?;
    let mut recorder = Recorder::new(context, trustworthy(context.summary()))?;
    let (time, truth) = draw(job, &mut recorder, &mut sky, exact, frames)?;
    let coarse = crate::passes::sky::cube::COARSE_EDGE;
    let mut table = Vec::new();
    for (name, settings) in routes {
        let (time, map) = draw(job, &mut recorder, &mut sky, settings, frames)?;
        table.push(Route::new(name, samples, time, &map, &truth));
    }
    table.push(Route::new(
        "exact sum of texels",
        6 * coarse * coarse,
        time,
        &truth,
        &truth,
    ));
    Ok(table)
}

/// Draws the map again and again; gives its times, and E of each texel (klx).
fn draw(
    job: &Job,
    recorder: &mut Recorder,
    sky: &mut SkyCube,
    settings: IrradianceSettings,
    frames: u32,
) -> Result<(Summary, Vec<DVec3>)> {
    recorder.begin()?;
    let mut irradiance = Irradiance::new(recorder, settings)?;
    recorder.finish()?;
    let mut samples = Samples::default();
    for i in 0..WARM_UP + frames.min(MOST_FRAMES) {
        sky.invalidate();
        recorder.begin()?;
        let images = sky.record(recorder, &job.daylight);
        irradiance.record(recorder, &images, &job.daylight);
        recorder.finish()?;
        let passes = recorder.timings().passes();
        if let (true, Some(time)) = (i >= WARM_UP, passes.iter().find(|p| p.name == "irradiance")) {
            samples.push(time.ms, time.cpu_ms);
        }
    }
    let sums = read_back(recorder, irradiance.sums())?.rgba();
    let mean = |sum: [f32; 4]| {
        let sum = Vec4::from(sum).as_dvec4();
        sum.truncate() / sum.w
    };
    Ok((samples.summary(), sums.into_iter().map(mean).collect()))
}

impl Route {
    fn new(name: &str, samples: u32, time: Summary, map: &[DVec3], truth: &[DVec3]) -> Self {
        let up = truth.iter().map(|e| e.max_element()).fold(0.0, f64::max);
        let distances = map
            .iter()
            .zip(truth)
            .map(|(a, b)| (*a - *b).abs().max_element());
        // Night: nothing differs from nothing.
        let relative: Vec<f64> = distances
            .map(|d| if up > 0.0 { d / up } else { 0.0 })
            .collect();
        let square: f64 = relative.iter().map(|d| d * d).sum();
        Self {
            name: name.to_owned(),
            samples,
            time,
            rms: (square / relative.len().max(1) as f64).sqrt(),
            largest: relative.into_iter().fold(0.0, f64::max),
        }
    }
}

/// The table for people.
pub fn table(f: &mut Formatter<'_>, routes: &[Route]) -> fmt::Result {
    let [name, samples, median, low, high, cpu, rms, largest] = [
        "irradiance, the whole map by",
        "samples",
        "median",
        "p5",
        "p95",
        "CPU",
        "rms %",
        "largest %",
    ];
    writeln!(
        f,
        "{name:28} {samples:>8} {median:>8} {low:>8} {high:>8} {cpu:>8} {rms:>8} {largest:>9}"
    )?;
    for r in routes {
        let t = &r.time;
        let cpu = t
            .cpu_median_ms
            .map_or("-".to_owned(), |ms| format!("{ms:.2}"));
        writeln!(
            f,
            "{:28} {:8} {:8.2} {:8.2} {:8.2} {cpu:>8} {:8.4} {:9.4}",
            r.name,
            r.samples,
            t.median_ms,
            t.p5_ms,
            t.p95_ms,
            100.0 * r.rms,
            100.0 * r.largest
        )?;
    }
    writeln!(
        f,
        "(%: distance to the exact sum, of the largest irradiance)"
    )
}
