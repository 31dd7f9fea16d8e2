//! `skylight bench`: time of each pass and of the whole frame, milliseconds.
//!
//! Passes are timed by GPU timestamps. Software drivers attribute timestamps to the wrong pass, so there each pass is
//! submitted alone and waited for. The whole frame is one submission.

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

use super::job::Job;
use crate::cli::BenchArgs;
use crate::error::Result;
use crate::options::OptionValues;
use crate::output::{check_writable, is_stdout, print_beside, write_text};
use baseline::Baseline;
use measure::{Bench, Subject};
use report::{Head, Report};

impl BenchArgs {
    /// Prints a table; on standard error where a file of it is standard output.
    fn print(&self, table: &str) -> Result<()> {
        let stdout = self.files().find(|file| is_stdout(file));
        print_beside(stdout.unwrap_or(Path::new("")), table)
    }

    fn files(&self) -> impl Iterator<Item = &Path> {
        let files = [&self.json, &self.csv];
        files.into_iter().filter_map(|file| file.as_deref())
    }
}

/// Runs the benchmark and prints its table.
///
/// # Errors
/// Fails when frames cannot be drawn, or when something is slower than `--fail-above` allows.
pub fn run(args: &BenchArgs, mut options: OptionValues) -> Result<()> {
    args.files().try_for_each(check_writable)?;
    let baseline = args.compare.as_deref().map(Baseline::read).transpose()?;
    options.set("samples", 1);
    let (job, context) = Job::on_device(args.scene.as_deref(), &options)?;
    let head = Head::new(&job, &context, args);
    if let Some(sweep) = args.sweep {
        let report = sweep::run(sweep, &job, &context, args.motion, head)?;
        context.check_validation()?;
        write(&args.json, || report.json())?;
        write(&args.csv, || report.csv())?;
        return args.print(&report.to_string());
    }
    let subject = Subject::new(&job);
    let mut bench = Bench::new(&subject, &job.scene, &context, args.motion)?;
    let measured = bench.run(args.frames)?;
    let report = Report::new(head, &measured);
    context.check_validation()?;
    write(&args.json, || report.json())?;
    write(&args.csv, || sheet::csv(&report))?;
    args.print(&report.to_string())?;
    let Some(baseline) = baseline else {
        return Ok(());
    };
    args.print(&baseline.table(&report))?;
    args.fail_above
        .map_or(Ok(()), |factor| baseline.check(&report, factor))
}

/// Writes `text` to `path`, if there is one.
fn write(path: &Option<PathBuf>, text: impl FnOnce() -> String) -> Result<()> {
    match path {
        Some(path) => write_text(path, &text()),
        None => Ok(()),
    }
}
