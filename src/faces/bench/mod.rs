//! `skylight bench`: milliseconds of each pass and of the whole frame.
//!
//! Passes are timed by GPU timestamps; on software drivers, whose timestamps are attributed to the wrong pass, each pass
//! is submitted alone and waited for. The whole frame is one submission.

mod baseline;
mod chart;
mod measure;
mod report;
mod sheet;
mod statistics;
mod table;
mod work;

use std::path::{Path, PathBuf};

use clap::Args;

use super::job::Job;
use super::motion::Motion;
use super::svg_path;
use crate::error::Result;
use crate::output::{check_writable, print, write_text};
use crate::settings::Options;
use baseline::Baseline;
use measure::Bench;
use report::{Head, Report};

/// What to measure, and where to put it.
#[derive(Debug, Clone, Default, PartialEq, Args)]
pub struct BenchWishes {
    /// Scene file (.toml) or model (.obj) [default: the bundled scene].
    pub scene: Option<PathBuf>,
    /// Write the table as JSON too.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Write the table as CSV too, every row complete: device, commit, scene, size ..
    #[arg(long, value_name = "FILE")]
    pub csv: Option<PathBuf>,
    /// Draw the table as a chart too.
    #[arg(long, value_name = "FILE.svg", value_parser = svg_path)]
    pub svg: Option<PathBuf>,
    /// Frames to measure [default: 100].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub frames: Option<u32>,
    /// What moves from frame to frame while whole frames are timed.
    #[arg(long, value_name = "WHAT", value_enum, default_value_t)]
    pub motion: Motion,
    /// Compare with an earlier run's --json: the ratio of every time, and how far noise alone would move it.
    #[arg(long, value_name = "OLD.json")]
    pub compare: Option<PathBuf>,
    /// With --compare: exit code 1 when something takes more than R times as long as before, and not by noise alone.
    #[arg(long, value_name = "R", requires = "compare", allow_hyphen_values = true, value_parser = crate::settings::ratio)]
    pub fail_above: Option<f64>,
}

impl BenchWishes {
    fn frames(&self) -> u32 {
        self.frames.unwrap_or(100)
    }

    fn files(&self) -> impl Iterator<Item = &Path> {
        let files = [&self.json, &self.csv, &self.svg];
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
    let job = Job::new(wishes.scene.as_deref(), options)?;
    let context = job.context()?;
    let measured = Bench::new(&job, &context, wishes.motion)?.run(wishes.frames())?;
    context.check_validation()?;
    let report = Report::new(Head::new(&job, &context, wishes), &measured);
    write_files(wishes, &report)?;
    print(&report.to_string())?;
    let Some(baseline) = baseline else {
        return Ok(());
    };
    print(&baseline.table(&report))?;
    wishes
        .fail_above
        .map_or(Ok(()), |factor| baseline.check(&report, factor))
}

fn write_files(wishes: &BenchWishes, report: &Report) -> Result<()> {
    if let Some(path) = &wishes.json {
        write_text(path, &report.json())?;
    }
    if let Some(path) = &wishes.csv {
        write_text(path, &sheet::csv(report))?;
    }
    if let Some(path) = &wishes.svg {
        write_text(path, &chart::draw(report))?;
    }
    Ok(())
}
