//! The commands of the program: drivers of the same [`Frame`](crate::frame::Frame).

mod bake;
mod bench;
mod compare;
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
mod sky_report;
mod sky_table;
mod startup;
mod tiled;
#[cfg(feature = "window")]
pub mod view;

pub use bake::{BakeWishes, Layout, Map};
pub use bench::BenchWishes;
pub use compare::CompareWishes;
pub use motion::Motion;
pub use sky::SkyWishes;

use std::path::PathBuf;

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
        } => render::run(scene.as_deref(), &output, *options),
        #[cfg(feature = "window")]
        Command::View {
            scene,
            resume,
            options,
        } => view::run(scene.as_deref(), resume, *options),
        #[cfg(not(feature = "window"))]
        Command::View { .. } => Err(crate::error::Error::NoWindow),
        Command::Bench { wishes, options } => bench::run(&wishes, *options),
        Command::Sky { wishes, options } => sky::run(&wishes, *options),
        Command::Bake { wishes, options } => bake::run(&wishes, *options),
        Command::Compare { wishes } => compare::run(&wishes),
        Command::Info {
            startup: true,
            device,
            without,
        } => startup::run(device, without),
        Command::Info { without, .. } => info::run(without.as_slice()),
    }
}

/// Parses the name of an `.svg` file.
fn svg_path(text: &str) -> std::result::Result<PathBuf, String> {
    let path = PathBuf::from(text);
    match path.extension() {
        Some(extension) if extension.eq_ignore_ascii_case("svg") => Ok(path),
        _ => Err("the name must end in .svg".to_owned()),
    }
}

/// A progress bar on a terminal; hidden in a pipe, when `quiet`, and for a single step.
fn progress(steps: u64, unit: &'static str, quiet: bool) -> ProgressBar {
    if quiet || steps < 2 {
        return ProgressBar::hidden();
    }
    let bar = ProgressBar::new(steps);
    // The template is constant; were it wrong, the default style would do.
    if let Ok(style) = ProgressStyle::with_template("{bar:40} {pos}/{len} {msg}, {eta} left") {
        bar.set_style(style);
    }
    bar.with_message(unit)
}
