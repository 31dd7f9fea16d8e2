//! Parts of a grid that several machines measure.

use std::path::PathBuf;

use serde::{Deserialize, Serialize};

use super::moment::MomentReport;
use super::outcome::Outcome;
use super::study::Study;
use super::{deliver, ill};
use crate::cli::{DaylightArgs, MergeArgs};
use crate::commands::merge::{FileBeside, JobKey, Kind, Parts, write_part};
use crate::error::{Error, Result};
use crate::options::Options;
use crate::output::{check_writable, print};
use crate::scene::Scene;
use crate::sensors::{Sensor, Shard};

/// Options that decide no number.
const OF_NO_NUMBER: [&str; 7] = [
    "quiet",
    "no-warnings",
    "strict",
    "validate",
    "no-cache",
    "device",
    "without",
];

/// What a shard of a year found.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct YearPart {
    /// Its sensors.
    pub outcome: Outcome,
    /// Their illuminances in every hour, if they are kept.
    pub ill: Option<FileBeside>,
}

/// The job: arguments and options, the model, the grid and the weather by what they hold, wherever their files are.
pub(super) fn key(
    kind: Kind,
    args: &DaylightArgs,
    settings: &Options,
    (scene, sensors): (&Scene, &[Sensor]),
    weather: String,
) -> JobKey {
    let args = DaylightArgs {
        scene: "".into(),
        grid: None,
        weather: None,
        output: None,
        shard: None,
        ill: args.ill.as_ref().map(|_| "".into()),
        ..args.clone()
    };
    let mut decided_by = vec![
        format!("{args:?}"),
        weather,
        format!("{sensors:?}"),
        scene.digest(),
    ];
    let values = settings.values().into_pairs().into_iter();
    let deciding = values.filter(|(name, _)| !OF_NO_NUMBER.contains(&name.as_str()));
    decided_by.extend(deciding.map(|pair| format!("{pair:?}")));
    JobKey::new(kind, &decided_by)
}

/// Writes the result of a shard, unless it was interrupted: `done` of `all` sensors, or of what else its units are.
///
/// # Errors
/// See above, or the file cannot be written.
pub(super) fn write(
    args: &DaylightArgs,
    (key, shard): (&JobKey, Shard),
    report: &impl Serialize,
    ([done, all], units): ([usize; 2], &str),
) -> Result<()> {
    if done < all {
        let what = "sensors were measured, and no shard is written";
        return Err(Error::Interrupted { done, all, what });
    }
    let Shard { number, of } = shard;
    let own = format!("daylight_{number}-of-{of}.shard").into();
    let output = args.output.as_ref().unwrap_or(&own);
    write_part(output, key, shard, report)?;
    print(&format!(
        "{}: shard {shard}, {all} {units}\n",
        output.display()
    ))
}

/// Merges all shards of a grid into the result of the single run.
///
/// # Errors
/// Parts that do not make a whole, or the result cannot be written.
pub(in crate::commands) fn merge(parts: &Parts, args: &MergeArgs) -> Result<()> {
    let output = args.output.as_deref();
    output.map_or(Ok(()), check_writable)?;
    let (text, odd) = match parts.kind {
        Kind::Moment => {
            let merged = MomentReport::merged(bodies(parts)?).ok_or_else(not_whole)?;
            (merged.text(), merged.oddities())
        }
        Kind::Study => Study::merged(bodies(parts)?)
            .ok_or_else(not_whole)?
            .finished(),
        _ => {
            let read = parts.bodies::<YearPart>()?;
            let matrices = matrices(&read, args)?;
            let outcomes = read.into_iter().map(|(_, part)| part.outcome);
            let merged = Outcome::merged(outcomes.collect()).ok_or_else(not_whole)?;
            if let (Some(path), Some(matrices)) = (&args.ill, matrices) {
                ill::merge(path, &matrices)?;
            }
            (merged.text(), merged.oddities())
        }
    };
    odd.iter().for_each(crate::output::message::warning);
    deliver(output, &text)
}

/// The matrices of the shards with the numbers of their sensors, if they are to be merged.
///
/// # Errors
/// One line with those that are missing or damaged and the shards to run again, or shards without.
fn matrices(parts: &[(PathBuf, YearPart)], args: &MergeArgs) -> Result<Option<Matrices>> {
    let has_them = parts.iter().all(|(_, part)| part.ill.is_some());
    let Some(path) = &args.ill else {
        if has_them {
            eprintln!("notice: the shards have hourly matrices; --ill FILE.ill merges them, too");
        }
        return Ok(None);
    };
    if !has_them {
        let what = "the shards were measured without --ill; run them again with it";
        return Err(Error::Merge(what.to_owned()));
    }
    check_writable(path)?;
    let (mut list, mut faults) = (Vec::new(), Vec::new());
    for (number, (shard, part)) in (1..).zip(parts) {
        if let Some(matrix) = &part.ill {
            let (file, fault) = matrix.found(shard);
            let of = parts.len() as u32;
            let again = Shard { number, of };
            let again = |what| format!("{what}: run again with --shard {again}");
            faults.extend(fault.map(again));
            list.push((file, part.outcome.numbers.clone()));
        }
    }
    if faults.is_empty() {
        return Ok(Some(list));
    }
    Err(Error::Merge(faults.join("; ")))
}

/// Files with the numbers of their sensors.
type Matrices = Vec<(PathBuf, Vec<usize>)>;

fn bodies<T: serde::de::DeserializeOwned>(parts: &Parts) -> Result<Vec<T>> {
    let bodies = parts.bodies()?.into_iter();
    Ok(bodies.map(|(_, body)| body).collect())
}

fn not_whole() -> Error {
    let what = "the shards do not have every sensor and variant once; run all of them again";
    Error::Merge(what.to_owned())
}
