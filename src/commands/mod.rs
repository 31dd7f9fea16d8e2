//! The program's commands. Those that draw all use the same [`Frame`](crate::frame::Frame).

mod bake;
mod bench;
mod compare;
mod daylight;
mod info;
mod interrupt;
mod job;
mod light;
mod motion;
mod noise;
mod panorama;
mod plot_spectrum;
mod plot_study;
mod render;
mod samples;
mod sky;
mod sky_almanac;
mod sky_compare;
mod sky_report;
mod sky_table;
mod startup;
mod tiled;
#[cfg(feature = "window")]
pub mod view;

use indicatif::{ProgressBar, ProgressStyle};

use crate::cli::Command;
use crate::error::Result;

/// Runs a command.
///
/// # Errors
/// The reason for the failure, in one line.
pub fn run(command: Command) -> Result<()> {
    match command {
        Command::Render {
            scene,
            output,
            options,
        } => render::run(scene.as_deref(), &output, &options),
        #[cfg(feature = "window")]
        Command::View {
            scene,
            resume,
            options,
        } => view::run(scene.as_deref(), resume, options),
        #[cfg(not(feature = "window"))]
        Command::View { .. } => Err(crate::error::Error::NoWindow),
        Command::Bench { args, options } => bench::run(&args, options),
        Command::Sky { args, options } => sky::run(&args, options),
        Command::Daylight { args, options } => daylight::run(&args, &options),
        Command::Bake { args, options } => bake::run(&args, options),
        Command::Compare { args } => compare::run(&args),
        Command::Info {
            startup: true,
            device,
            without,
        } => startup::run(device, without),
        Command::Info { without, .. } => info::run(without.as_slice()),
    }
}

/// A progress bar; hidden in a pipe, when `quiet`, or with fewer than two steps.
fn progress(steps: u64, unit: &'static str, quiet: bool) -> ProgressBar {
    if quiet || steps < 2 {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(steps);
    // The template is constant and valid; a fault in it would only leave the default style.
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}, {eta} left") {
        bar.set_style(style);
    }
    bar.with_message(unit)
}
