//! The program's commands. Those that draw all use the same [`Frame`](crate::frame::Frame).

mod bake;
mod bench;
mod compare;
mod config;
mod daylight;
mod hour;
mod info;
mod interrupt;
mod job;
mod light;
mod merge;
mod motion;
mod names;
mod noise;
mod panorama;
mod plot_spectrum;
mod plot_study;
mod render;
mod renderer;
mod samples;
mod sequence;
mod sidecar;
mod sky;
mod sky_almanac;
mod sky_compare;
mod sky_report;
mod sky_table;
mod startup;
mod study;
mod sun_series;
mod tiled;
mod validate;
#[cfg(feature = "window")]
pub mod view;
mod weather;

use indicatif::{ProgressBar, ProgressStyle};

use crate::cli::Command;
use crate::error::{Error, Result};
use crate::options::Options;
use crate::output::message;
use crate::scene::shortened;

/// Runs a command.
///
/// # Errors
/// The reason for the failure, in one line.
pub fn run(command: Command) -> Result<()> {
    match config::applied(command)? {
        Command::PrintConfig => config::show(),
        Command::Render {
            scene,
            output,
            sidecar,
            at,
            mut options,
        } => {
            options.first = hour::applied(&at, scene.as_deref(), options.first)?;
            render::run(scene.as_deref(), (&output, sidecar), &options)
        }
        Command::Sequence { args, options } => sequence::run(&args, &options),
        Command::Study { args, options } => study::run(&args, &options),
        Command::Merge { args } => merge::run(&args),
        #[cfg(feature = "window")]
        Command::View { args, options } => view::run(&args, options),
        #[cfg(not(feature = "window"))]
        Command::View { .. } => Err(crate::error::Error::NoWindow),
        Command::Bench { args, options } => {
            let options = hour::applied(&args.at, args.scene.as_deref(), options)?;
            bench::run(&args, options)
        }
        Command::Sky { args, options } => sky::run(&args, hour::applied(&args.at, None, options)?),
        Command::Daylight {
            args,
            options,
            variants,
        } => daylight::run(&args, &options, &variants),
        Command::Weather { args, options } => weather::run(&args, &options),
        Command::Bake { args, options } => {
            bake::run(&args, hour::applied(&args.at, None, options)?)
        }
        Command::Compare { args } => compare::run(&args),
        Command::Validate {
            device,
            without,
            json,
        } => validate::run(device, without, json),
        Command::Info {
            startup: true,
            device,
            without,
            json,
        } => startup::run(device, without, json),
        Command::Info { without, json, .. } => info::run(without.as_slice(), json),
    }
}

/// Longest first warning in the error of `--strict`, characters.
const MAX_STRICT: usize = 120;

/// Tells warnings on stderr, unless `--no-warnings` is set.
///
/// # Errors
/// With `--strict`, the first warning.
fn tell<'w>(settings: &Options, warnings: impl Iterator<Item = &'w String> + Clone) -> Result<()> {
    check_strict(settings, warnings.clone())?;
    if !settings.no_warnings {
        warnings.for_each(message::warning);
    }
    Ok(())
}

/// Tells on stderr which options of a device have no effect in `command`, which needs none.
fn tell_no_device(command: &str, settings: &Options) {
    if settings.quiet || settings.no_warnings {
        return;
    }
    let given = [
        ("--device", settings.device.is_some()),
        ("--validate", settings.validate),
        ("--without", settings.without.is_some()),
    ];
    for (option, _) in given.iter().filter(|(_, is_given)| *is_given) {
        message::notice(format!("{command} needs no device: {option} has no effect"));
    }
}

/// Fails with the first warning if `--strict` is set.
fn check_strict<'w>(settings: &Options, warnings: impl Iterator<Item = &'w String>) -> Result<()> {
    let mut warnings = warnings.filter(|_| settings.strict);
    let Some(first) = warnings.next() else {
        return Ok(());
    };
    Err(Error::Strict {
        first: shortened(first, MAX_STRICT),
        more: match warnings.count() {
            0 => String::new(),
            n => format!(" (and {n} more)"),
        },
    })
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
