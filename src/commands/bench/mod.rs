//! `skylight bench`: milliseconds of each pass and of the whole frame.
//!
//! Passes are timed by GPU timestamps; on software drivers, whose timestamps are attributed to the wrong pass, each pass
//! is submitted alone and waited for. The whole frame is one submission.

mod baseline;
mod hills;
mod measure;
mod report;
mod sheet;
mod statistics;
mod subdivide;
mod sweep;
mod table;
mod work;

use std::path::{Path, PathBuf};

use clap::Args;

use super::job::Job;
use super::motion::Motion;
use crate::error::Result;
use crate::output::{check_writable, print, write_text};
use crate::settings::Options;
use baseline::Baseline;
use measure::{Bench, Subject};
use report::{Head, Report};
use sweep::Sweep;

/// What to measure, and where to put it.
#[derive(Debug, Clone, Default, PartialEq, Args)]
pub struct BenchWishes {
    /// Scene file (.toml), model (.obj, .gltf, .glb), or bundled scene (colonnade, island) [default: colonnade].
    pub scene: Option<PathBuf>,
    /// Write the table as JSON too.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write the table as CSV too, every row complete: device, commit, scene, size ..
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Frames to measure [default: 100; 10 at each step of a sweep].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub frames: Option<u32>,
    /// What moves from frame to frame while whole frames are timed.
    #[arg(long, value_name = "WHAT", value_enum, default_value_t)]
    pub motion: Motion,
    /// Measure again and again with more of one thing: cost against size, with the exponent of the growth.
    #[arg(long, value_name = "WHAT", value_enum, conflicts_with = "compare")]
    pub sweep: Option<Sweep>,
    /// Compare with an earlier run's --json: the ratio of every time, and how far noise alone would move it.
    #[arg(long, value_name = "OLD.json")]
    pub compare: Option<PathBuf>,
    /// With --compare: exit code 1 when something takes more than R times as long as before, and not by noise alone.
    #[arg(long, value_name = "R", requires = "compare", allow_hyphen_values = true, value_parser = crate::settings::ratio)]
    pub fail_above: Option<f64>,
}

impl BenchWishes {
    fn frames(&self) -> u32 {
        let usual = if self.sweep.is_some() { 10 } else { 100 };
        self.frames.unwrap_or(usual)
    }

    fn files(&self) -> impl Iterator<Item = &Path> {
        let files = [&self.json, &self.csv];
        files.into_iter().filter_map(|file| file.as_deref())
    }
}

/// Measures and prints a table.
///
/// # Errors
/// Whatever keeps frames from being drawn; or something that became slower than it may.
pub fn run(wishes: &BenchWishes, mut options: Options) -> Result<()> {
    wishes.files().try_for_each(check_writable)?;
    let baseline = wishes.compare.as_deref().map(Baseline::read).transpose()?;
    options.samples = Some(1);
    let (job, context) = Job::on_device(wishes.scene.as_deref(), options)?;
    let head = Head::new(&job, &context, wishes);
    if let Some(sweep) = wishes.sweep {
        let report = sweep::run(sweep, &job, &context, wishes.motion, head)?;
        context.check_validation()?;
        write(&wishes.json, || report.json())?;
        write(&wishes.csv, || report.csv())?;
        return print(&report.to_string());
    }
    let subject = Subject::new(&job);
    let mut bench = Bench::new(&subject, &job.scene, &context, wishes.motion)?;
    let measured = bench.run(wishes.frames())?;
    let report = Report::new(head, &measured);
    context.check_validation()?;
    write(&wishes.json, || report.json())?;
    write(&wishes.csv, || sheet::csv(&report))?;
    print(&report.to_string())?;
    let Some(baseline) = baseline else {
        return Ok(());
    };
    print(&baseline.table(&report))?;
    wishes
        .fail_above
        .map_or(Ok(()), |factor| baseline.check(&report, factor))
}

/// Writes a file that is wanted.
fn write(path: &Option<PathBuf>, text: impl FnOnce() -> String) -> Result<()> {
    match path {
        Some(path) => write_text(path, &text()),
        None => Ok(()),
    }
}
