//! `skylight bench`: milliseconds of each pass and of the whole frame.
//!
//! Passes are timed by GPU timestamps; on software drivers, whose timestamps are attributed to the wrong pass, each pass
//! is submitted alone and waited for. The whole frame is one submission.

use std::path::Path;

use serde_json::{Value, json};

use super::job::Job;
use super::motion::Motion;
use crate::error::Result;
use crate::frame::Frame;
use crate::gpu::{DeviceSummary, Recorder, Stopwatch, Timing};
use crate::output::{check_writable, print, write_text};
use crate::passes::lighting::Precision;
use crate::settings::Options;

/// Frames that are drawn and forgotten: shaders are compiled at their first use.
const WARM_UP: u32 = 3;

/// Measures `frames` frames and prints a table.
///
/// # Errors
/// Whatever keeps frames from being drawn.
pub fn run(
    scene: Option<&Path>,
    json: Option<&Path>,
    frames: u32,
    motion: Motion,
    mut options: Options,
) -> Result<()> {
    if let Some(path) = json {
        check_writable(path)?;
    }
    options.samples = Some(1);
    let job = Job::new(scene, options)?;
    let context = job.context()?;
    let timing = trustworthy(context.summary());
    let passes = measure_passes(&job, Recorder::new(&context, timing)?, frames)?;
    let whole = measure_frames(&job, Recorder::new(&context, Timing::Off)?, frames, motion)?;
    context.check_validation()?;
    if let Some(path) = json {
        write_json(path, &job, &passes, (motion, &whole))?;
    }
    let (device, size) = (context.summary(), job.settings.size);
    print(&format!(
        "{} ({}), {}x{}, {} triangles, {frames} frames\n{}",
        device.name,
        device.driver.trim(),
        size.width,
        size.height,
        job.scene.triangles(),
        table(&passes, motion, &whole)
    ))
}

/// How a device's passes can be timed: software drivers attribute timestamps to the wrong pass.
fn trustworthy(device: &DeviceSummary) -> Timing {
    if device.kind == "software" {
        Timing::Isolated
    } else {
        Timing::Timestamps
    }
}

/// Times of one name, milliseconds.
#[derive(Default)]
struct Samples {
    wall: Vec<f64>,
    cpu: Vec<f64>,
}

impl Samples {
    fn push(&mut self, wall: f64, cpu: f64) {
        self.wall.push(wall);
        self.cpu.push(cpu);
    }
}

/// Every pass with everything drawn anew each frame.
fn measure_passes(
    job: &Job,
    mut recorder: Recorder,
    frames: u32,
) -> Result<Vec<(&'static str, Samples)>> {
    let mut frame = start(job, &mut recorder)?;
    let mut passes: Vec<(&'static str, Samples)> = Vec::new();
    for i in 0..WARM_UP + frames {
        frame.invalidate();
        recorder.begin()?;
        frame.record(&mut recorder, &job.daylight, &job.camera, 0);
        recorder.finish()?;
        if i < WARM_UP {
            continue;
        }
        for time in recorder.timings().passes() {
            let known = passes.iter().position(|p| p.0 == time.name);
            let index = known.unwrap_or(passes.len());
            if known.is_none() {
                passes.push((time.name, Samples::default()));
            }
            passes[index].1.push(time.ms, time.cpu_ms);
        }
    }
    Ok(passes)
}

/// The whole frame; what does not move was drawn before.
fn measure_frames(
    job: &Job,
    mut recorder: Recorder,
    frames: u32,
    motion: Motion,
) -> Result<Samples> {
    let mut frame = start(job, &mut recorder)?;
    while !frame.is_refined() {
        recorder.begin()?;
        frame.record_light(&mut recorder, &job.daylight);
        recorder.finish()?;
    }
    let mut times = Samples::default();
    for i in 0..WARM_UP + frames {
        let camera = motion.camera(&job.camera, i);
        let start = Stopwatch::start();
        let daylight = motion.daylight(job, i);
        recorder.begin()?;
        frame.record(&mut recorder, &daylight, &camera, 0);
        recorder.finish()?;
        if i >= WARM_UP {
            let (wall, cpu) = start.elapsed_ms();
            times.push(wall, cpu);
        }
    }
    Ok(times)
}

fn start(job: &Job, recorder: &mut Recorder) -> Result<Frame> {
    let settings = job.frame_settings(job.settings.show, Precision::Half);
    recorder.begin()?;
    let frame = Frame::new(recorder, &job.scene, settings)?;
    recorder.finish()?;
    Ok(frame)
}

/// The value below which the share `q` of the samples lies (nearest rank).
fn quantile(samples: &[f64], q: f64) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = (q * sorted.len() as f64).ceil() as usize;
    sorted
        .get(rank.saturating_sub(1))
        .copied()
        .unwrap_or(f64::NAN)
}

fn table(passes: &[(&'static str, Samples)], motion: Motion, whole: &Samples) -> String {
    let head = format!(
        "{:30} {:>9} {:>9} {:>9} {:>9}\n",
        "milliseconds", "median", "p5", "p95", "CPU"
    );
    let rows = passes.iter().map(|(name, times)| row(name, times));
    head + &rows.collect::<String>() + &row(motion.frame_name(), whole)
}

fn row(name: &str, times: &Samples) -> String {
    let [median, low, high] = [0.5, 0.05, 0.95].map(|q| quantile(&times.wall, q));
    let cpu = quantile(&times.cpu, 0.5);
    // Timestamps know nothing of the CPU.
    let cpu = if cpu.is_nan() {
        "-".to_owned()
    } else {
        format!("{cpu:.2}")
    };
    format!("{name:30} {median:9.2} {low:9.2} {high:9.2} {cpu:>9}\n")
}

fn write_json(
    path: &Path,
    job: &Job,
    passes: &[(&'static str, Samples)],
    (motion, whole): (Motion, &Samples),
) -> Result<()> {
    let times = |t: &Samples| {
        let [median, low, high] = [0.5, 0.05, 0.95].map(|q| quantile(&t.wall, q));
        let cpu = quantile(&t.cpu, 0.5);
        json!({ "median_ms": median, "p5_ms": low, "p95_ms": high, "cpu_median_ms": cpu })
    };
    let passes: Vec<Value> = passes
        .iter()
        .map(|(name, t)| {
            let mut value = times(t);
            value["name"] = json!(name);
            value
        })
        .collect();
    let size = job.settings.size;
    let report = json!({
        "scene": job.name,
        "size": [size.width, size.height],
        "triangles": job.scene.triangles(),
        "passes": passes,
        "motion": motion.frame_name(),
        "frame": times(whole),
    });
    write_text(path, &format!("{report:#}\n"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_samples() {
        let samples = [5.0, 1.0, 4.0, 2.0, 3.0];
        assert_eq!(quantile(&samples, 0.5), 3.0);
        assert_eq!(quantile(&samples, 0.05), 1.0);
        assert_eq!(quantile(&samples, 0.95), 5.0);
        assert!(quantile(&[], 0.5).is_nan());
    }
}
