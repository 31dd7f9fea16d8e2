//! Sweeps: cost against the size of one parameter.

use std::fmt::{self, Display, Formatter};
use std::sync::Arc;

use glam::UVec2;
use serde::Serialize;

use super::hills::{Ground, narrowed};
use super::measure::{Bench, Measured, Subject};
use super::report::Head;
use super::sheet::written;
use super::statistics::Summary;
use crate::cli::{Motion, Sweep};
use crate::commands::job::Job;
use crate::daylight::convergence::power;
use crate::error::Result;
use crate::gpu::Context;

/// Largest triangle count that a sweep subdivides a scene to.
const MOST_TRIANGLES: usize = 2_000_000;
/// Triangle counts of the generated hills.
const HILLS: [usize; 6] = [10_000, 30_000, 100_000, 300_000, 1_000_000, 2_000_000];
/// Share of triangles in view of the second, narrow camera.
const NARROW: f64 = 0.05;
/// Passes that draw triangles.
const GEOMETRY: [&str; 4] = [
    "G-buffer",
    "G-buffer, details",
    "shadow map",
    "shadow map, cut-outs",
];

impl Sweep {
    /// Unit of the sizes.
    fn unit(self) -> &'static str {
        match self {
            Self::Resolution => "pixels",
            Self::Triangles => "triangles",
            Self::Samples => "irradiance samples a pass",
            Self::Shadow => "texels of the shadow map",
            Self::Ssao => "depth samples a pixel",
        }
    }

    /// Steps of the sweep: size, label and what to draw.
    fn steps<'j>(self, job: &'j Job, limit: u32) -> Vec<(f64, String, Subject<'j>)> {
        let base = || Subject::new(job);
        let step = |size: f64, label: String, change: &dyn Fn(&mut Subject<'j>)| {
            let mut subject = base();
            change(&mut subject);
            (size, label, subject)
        };
        match self {
            Self::Resolution => [360, 540, 720, 1080, 1440, 2160]
                .into_iter()
                .map(|h| UVec2::new(16 * h / 9, h))
                .filter(|size| size.max_element() <= limit)
                .map(|size| {
                    let pixels = f64::from(size.x) * f64::from(size.y);
                    let label = format!("{}x{}", size.x, size.y);
                    step(pixels, label, &|s| s.settings.size = size)
                })
                .collect(),
            Self::Triangles => grounds(job)
                .into_iter()
                .map(|(triangles, ground)| {
                    // The scene is built when its step runs: all of them at once would not fit into memory.
                    step(triangles as f64, triangles.to_string(), &|s| {
                        s.ground = ground
                    })
                })
                .collect(),
            Self::Samples => [64, 128, 256, 512, 1024, 2048, 4096]
                .into_iter()
                .map(|n| {
                    step(f64::from(n), n.to_string(), &|s| {
                        s.settings.irradiance.samples = n;
                        s.settings.irradiance.samples_per_pass = n;
                    })
                })
                .collect(),
            Self::Shadow => [256, 512, 1024, 2048, 4096]
                .into_iter()
                .filter(|edge| *edge <= limit)
                .map(|edge| {
                    let texels = f64::from(edge) * f64::from(edge);
                    let label = format!("{edge}²");
                    step(texels, label, &|s| s.settings.shadow_resolution = edge)
                })
                .collect(),
            Self::Ssao => [4, 8, 16, 32]
                .into_iter()
                .map(|steps| {
                    let samples = 2 * steps;
                    let change = |s: &mut Subject<'j>| s.settings.ssao.steps = steps;
                    step(f64::from(samples), samples.to_string(), &change)
                })
                .collect(),
        }
    }
}

/// Scenes of increasing triangle count: the given scene subdivided, or hills instead of the bundled scene.
fn grounds(job: &Job) -> Vec<(usize, Ground)> {
    if job.path.is_none() {
        return HILLS.map(|n| (n, Ground::Hills(n))).to_vec();
    }
    let pieces = [1, 2, 3, 4, 6, 8, 12, 16].into_iter();
    let finer = pieces.map(|k| (job.scene.triangles() * (k * k) as usize, Ground::Finer(k)));
    let is_sound =
        |(n, ground): &(usize, Ground)| *ground == Ground::Finer(1) || *n <= MOST_TRIANGLES;
    finer.filter(is_sound).collect()
}

/// Results of a sweep.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct SweepReport {
    /// Conditions of the measurement; size and triangle count are those before the sweep.
    #[serde(flatten)]
    pub head: Head,
    /// Sweep name.
    pub sweep: String,
    /// Unit of the sizes.
    pub unit: String,
    /// Size at each step.
    pub sizes: Vec<f64>,
    /// Label of each step.
    pub labels: Vec<String>,
    /// One row per pass and per whole frame.
    pub rows: Vec<Curve>,
}

/// Cost of one pass or frame against size.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Curve {
    /// Pass or frame name.
    pub name: String,
    /// Time at each size.
    pub times: Vec<Summary>,
    /// Exponent p of wall time ∝ size^p.
    pub exponent: f64,
    /// Exponent of the CPU time, if known.
    pub cpu_exponent: Option<f64>,
}

impl Curve {
    fn new(name: &str, sizes: &[f64], times: Vec<Summary>) -> Self {
        let fit = |of: &dyn Fn(&Summary) -> Option<f64>| {
            let points = sizes.iter().zip(&times);
            let points: Option<Vec<_>> = points.map(|(x, t)| Some((*x, of(t)?))).collect();
            points.map(|points| power(&points))
        };
        Self {
            name: name.to_owned(),
            exponent: fit(&|t| Some(t.median_ms)).unwrap_or(f64::NAN),
            cpu_exponent: fit(&|t| t.cpu_median_ms),
            times,
        }
    }
}

/// Runs all steps of a sweep.
///
/// # Errors
/// Fails when a frame cannot be drawn.
pub fn run(
    sweep: Sweep,
    job: &Job,
    context: &Arc<Context>,
    motion: Motion,
    mut head: Head,
) -> Result<SweepReport> {
    if let (Sweep::Triangles, None) = (sweep, &job.path) {
        (head.scene, head.triangles) = ("hills".to_owned(), HILLS[0]);
    }
    let (mut sizes, mut labels) = (Vec::new(), Vec::new());
    let mut table: Vec<(String, Vec<Summary>)> = Vec::new();
    let limit = context.summary().max_image_edge;
    for (size, label, mut subject) in sweep.steps(job, limit) {
        let scene = subject.ground.scene(job);
        if let Ground::Hills(_) = subject.ground {
            subject.camera = job.settings.framing(&scene.bounds);
        }
        let mut bench = Bench::new(&subject, &scene, context, motion)?;
        let narrow = (sweep == Sweep::Triangles)
            .then(|| narrowed(&subject.camera, &scene, subject.settings.size, NARROW));
        let (measured, beside) = bench.run_beside(head.frames, narrow.as_ref())?;
        let mut rows = times(&measured, &head.frame_name);
        if narrow.is_some() {
            rows.extend(geometry(&measured).map(|t| ("G-buffer and shadow map".to_owned(), t)));
            rows.extend(geometry(&beside).map(|t| ("the same, 5 % in view".to_owned(), t)));
        }
        for (name, time) in rows {
            match table.iter_mut().find(|(known, _)| *known == name) {
                Some((_, times)) => times.push(time),
                None => table.push((name, vec![time])),
            }
        }
        sizes.push(size);
        labels.push(label);
    }
    let rows = table
        .into_iter()
        .map(|(name, times)| Curve::new(&name, &sizes, times));
    Ok(SweepReport {
        rows: rows.collect(),
        head,
        sweep: sweep.to_string(),
        unit: sweep.unit().to_owned(),
        sizes,
        labels,
    })
}

/// Summed time of the passes that draw triangles.
fn geometry(measured: &Measured) -> Option<Summary> {
    let passes = measured.passes.iter();
    let drawing = passes.filter(|(name, _)| GEOMETRY.contains(name));
    let times = drawing.map(|(_, samples)| samples.clone());
    Some(times.reduce(|a, b| a.with(&b))?.summary())
}

fn times(measured: &Measured, frame_name: &str) -> Vec<(String, Summary)> {
    let passes = measured.passes.iter();
    let passes = passes.map(|(name, samples)| ((*name).to_owned(), samples.summary()));
    let frames = [
        (frame_name, &measured.moving),
        ("whole frame, everything anew", &measured.anew),
    ];
    let frames = frames.map(|(name, whole)| (name.to_owned(), whole.frame.summary()));
    passes.chain(frames).collect()
}

impl Display for SweepReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.head)?;
        writeln!(
            f,
            "median milliseconds against {}; exponent p of time ∝ size^p",
            self.unit
        )?;
        write!(f, "{:32}", "")?;
        for label in &self.labels {
            write!(f, " {label:>10}")?;
        }
        writeln!(f, " {:>9} {:>9}", "exponent", "of CPU")?;
        for row in &self.rows {
            write!(f, "{:32}", row.name)?;
            for time in &row.times {
                write!(f, " {:10.2}", time.median_ms)?;
            }
            let cpu = row
                .cpu_exponent
                .map_or("-".to_owned(), |p| format!("{p:.2}"));
            writeln!(f, " {:9.2} {cpu:>9}", row.exponent)?;
        }
        Ok(())
    }
}

#[derive(Serialize)]
struct Line<'r> {
    device: &'r str,
    commit: &'r str,
    scene: &'r str,
    sweep: &'r str,
    size: f64,
    label: &'r str,
    name: &'r str,
    median_ms: f64,
    p5_ms: f64,
    p95_ms: f64,
    cpu_median_ms: Option<f64>,
    exponent: f64,
    cpu_exponent: Option<f64>,
}

impl SweepReport {
    /// The report as JSON.
    pub fn json(&self) -> String {
        format!("{:#}\n", serde_json::json!(self))
    }

    /// The report as CSV: one row per size and per pass or frame.
    pub fn csv(&self) -> String {
        let line = |row: &'_ Curve, i: usize| -> Option<(usize, Summary)> {
            row.times.get(i).map(|time| (i, *time))
        };
        let cells = self.rows.iter().flat_map(|row| {
            (0..self.sizes.len()).filter_map(move |i| line(row, i).map(|cell| (row, cell)))
        });
        written(cells.map(|(row, (i, time))| Line {
            device: &self.head.device.name,
            commit: &self.head.commit,
            scene: &self.head.scene,
            sweep: &self.sweep,
            size: self.sizes[i],
            label: &self.labels[i],
            name: &row.name,
            median_ms: time.median_ms,
            p5_ms: time.p5_ms,
            p95_ms: time.p95_ms,
            cpu_median_ms: time.cpu_median_ms,
            exponent: row.exponent,
            cpu_exponent: row.cpu_exponent,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_curve_knows_its_exponents() {
        let time = |median_ms: f64, cpu: Option<f64>| Summary {
            median_ms,
            p5_ms: median_ms,
            p95_ms: median_ms,
            cpu_median_ms: cpu,
            mean_ms: None,
            cpu_mean_ms: None,
        };
        let sizes = [1e3, 1e4, 1e5];
        let times = sizes.map(|s| time(2.0 * s, Some(s.sqrt()))).to_vec();
        let curve = Curve::new("x", &sizes, times);
        assert!((curve.exponent - 1.0).abs() < 1e-9, "{}", curve.exponent);
        assert!(curve.cpu_exponent.is_some_and(|p| (p - 0.5).abs() < 1e-9));
        let unknown = sizes.map(|s| time(s, None)).to_vec();
        assert_eq!(Curve::new("x", &sizes, unknown).cpu_exponent, None);
    }
}
