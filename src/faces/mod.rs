//! The faces of the program: drivers of the same [`Frame`](crate::frame::Frame).

mod bench;
mod info;
mod job;
mod light;
mod plot_spectrum;
mod plot_study;
mod render;
mod sky;
mod sky_report;
mod sky_table;

pub use sky::SkyWishes;

use crate::cli::Command;
use crate::error::Result;

/// Does what the user asked for.
///
/// # Errors
/// Whatever keeps it from being done, in one line.
pub fn run(command: Command) -> Result<()> {
    match command {
        Command::Render {
            scene,
            output,
            options,
        } => render::run(scene.as_deref(), &output, *options),
        Command::Bench {
            scene,
            json,
            frames,
            options,
        } => bench::run(scene.as_deref(), json.as_deref(), frames, *options),
        Command::Sky { wishes, options } => sky::run(&wishes, *options),
        Command::Info => info::run(),
    }
}
