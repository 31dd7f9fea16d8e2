//! `skylight daylight`: light at the sensors of a grid, at a moment or over a year. Needs no device.

mod drawings;
mod exact;
mod ill;
mod moment;
mod outcome;
mod report;
mod results;
mod shards;
mod study;
mod summary;
mod table;
mod unreflected;
mod verdict;
mod year;

use std::path::Path;

pub(super) use self::shards::merge;
/// What the window shares with the command.
#[cfg(feature = "window")]
pub(super) use self::{
    drawings::{Scale, is_share},
    exact::Exact,
    report::{LEED_EXPOSED, LEED_PERCENT},
    summary::{Asked, LEVELS, Summary},
    table::{Column, csv, place},
    verdict::Verdict,
};
use super::hour;
use crate::cli::{DaylightArgs, Variant};
use crate::daylight::metrics::Blinds;
use crate::error::Result;
use crate::options::{OptionValues, Options};
use crate::output::{check_writable, print, write_text};
use crate::passes::bounces::cells::Bounces;
use crate::scene::Scene;
use crate::sensors::{ALL_BOUNCES, Facades, Planes, Sensor, make_facades, make_grid, read_grid};

/// Measures metrics if there is a weather file without an hour or some are asked for, else a moment; all variants, if there are some.
///
/// # Errors
/// A grid, a model or a weather file that cannot be read, or invalid options.
pub fn run(args: &DaylightArgs, options: &OptionValues, variants: &[Variant]) -> Result<()> {
    if let Some(output) = &args.output {
        check_writable(output)?;
    }
    if !variants.is_empty() {
        return study::run(args, options, variants);
    }
    if args.asks_for_metrics() {
        return year::run(args, options);
    }
    moment::run(
        args,
        &hour::applied(&args.at(), Some(&args.scene), options.clone())?,
    )
}

/// The sensors of the file, or those that are made.
///
/// # Errors
/// A file that cannot be read, or no place for a sensor.
fn sensors(args: &DaylightArgs, scene: &Scene) -> Result<Vec<Sensor>> {
    if let Some(path) = &args.grid {
        return Ok(read_grid(path, scene.origin)?);
    }
    if let Some(names) = &args.facade {
        let facades = Facades {
            spacing: args.spacing as f32,
            offset: args.offset as f32,
            materials: names.iter().filter(|n| !n.is_empty()).cloned().collect(),
        };
        return Ok(make_facades(scene, &facades)?);
    }
    let planes = Planes {
        height: args.plane.unwrap_or_default() as f32,
        spacing: args.spacing as f32,
        inset: args.inset as f32,
        floors: args.rooms.clone(),
    };
    Ok(make_grid(scene, &planes)?)
}

/// What is said of blinds, always.
fn blinds(args: &DaylightArgs) -> &'static str {
    match args.blinds {
        Blinds::None => "no blinds",
        Blinds::Lm83 => "blinds by LM-83",
    }
}

/// Prints a result, or writes it to a file.
///
/// # Errors
/// It cannot be written.
fn deliver(output: Option<&Path>, text: &str) -> Result<()> {
    match output {
        Some(path) => write_text(path, text),
        None => print(text),
    }
}

/// The limit of bounces.
fn bounces(settings: &Options) -> u32 {
    match settings.bounces {
        Bounces::All => ALL_BOUNCES,
        Bounces::UpTo(count) => count,
    }
}
