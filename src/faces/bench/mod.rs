//! `skylight bench`: milliseconds of each pass and of the whole frame.
//!
//! Passes are timed by GPU timestamps; on software drivers, whose timestamps are attributed to the wrong pass, each pass
//! is submitted alone and waited for. The whole frame is one submission.

mod measure;
mod report;
mod statistics;
mod table;

use std::path::PathBuf;

use clap::Args;

use super::job::Job;
use super::motion::Motion;
use crate::error::Result;
use crate::output::{check_writable, print, write_text};
use crate::settings::Options;
use measure::Bench;
use report::Report;

/// What to measure, and where to put it.
#[derive(Debug, Clone, Default, PartialEq, Args)]
pub struct BenchWishes {
    /// Scene file (.toml) or model (.obj) [default: the bundled scene].
    pub scene: Option<PathBuf>,
    /// Write the table as JSON too.
    #[arg(long, value_name = "FILE")]
    pub json: Option<PathBuf>,
    /// Frames to measure.
    #[arg(long, value_name = "N", default_value_t = 100, value_parser = clap::value_parser!(u32).range(1..=1_000_000))]
    pub frames: u32,
    /// What moves from frame to frame while whole frames are timed.
    #[arg(long, value_name = "WHAT", value_enum, default_value_t)]
    pub motion: Motion,
}

/// Measures and prints a table.
///
/// # Errors
/// Whatever keeps frames from being drawn.
pub fn run(wishes: &BenchWishes, mut options: Options) -> Result<()> {
    if let Some(path) = &wishes.json {
        check_writable(path)?;
    }
    options.samples = Some(1);
    let job = Job::new(wishes.scene.as_deref(), options)?;
    let context = job.context()?;
    let measured = Bench::new(&job, &context, wishes.motion)?.run(wishes.frames)?;
    context.check_validation()?;
    let report = Report::new(&job, &context, &measured, wishes);
    if let Some(path) = &wishes.json {
        write_text(path, &report.json())?;
    }
    print(&report.to_string())
}
