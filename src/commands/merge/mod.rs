//! `skylight merge`: the parts of a job that several machines did, checked and put together.

mod part;

pub(super) use self::part::{FileBeside, JobKey, Kind, Parts, write_part};

use crate::cli::MergeArgs;
use crate::error::{Error, Result};

/// Merges the files of all shards of a job.
///
/// # Errors
/// One line with what is missing, doubled or damaged, and which shards to run again.
pub fn run(args: &MergeArgs) -> Result<()> {
    let parts = self::part::gather(&args.shards)?;
    if args.ill.is_some() && parts.kind != Kind::Year {
        let what = "only the shards of a year have hourly matrices; leave out --ill";
        return Err(Error::Merge(what.to_owned()));
    }
    match parts.kind {
        Kind::Sequence => super::sequence::merge(&parts, args),
        Kind::Moment | Kind::Year | Kind::Study => super::daylight::merge(&parts, args),
    }
}
