//! Parts of a grid that several machines measure.

use serde::Serialize;

use super::deliver;
use super::moment::MomentReport;
use super::outcome::Outcome;
use crate::cli::{DaylightArgs, MergeArgs};
use crate::commands::merge::{JobKey, Kind, Parts, write_part};
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

/// Writes the result of a shard, unless it was interrupted: `done` of `all` sensors.
///
/// # Errors
/// See above, or the file cannot be written.
pub(super) fn write(
    args: &DaylightArgs,
    (key, shard): (&JobKey, Shard),
    report: &impl Serialize,
    [done, all]: [usize; 2],
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
        "{}: shard {shard}, {all} sensors\n",
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
        _ => {
            let merged = Outcome::merged(bodies(parts)?).ok_or_else(not_whole)?;
            (merged.text(), merged.oddities())
        }
    };
    odd.iter().for_each(crate::output::message::warning);
    deliver(output, &text)
}

fn bodies<T: serde::de::DeserializeOwned>(parts: &Parts) -> Result<Vec<T>> {
    let bodies = parts.bodies()?.into_iter();
    Ok(bodies.map(|(_, body)| body).collect())
}

fn not_whole() -> Error {
    let what = "the shards do not have every sensor once; run all of them again";
    Error::Merge(what.to_owned())
}
