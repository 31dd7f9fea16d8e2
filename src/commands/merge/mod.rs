//! `skylight merge`: the parts of a job that several machines did, checked and put together.

mod part;

pub(super) use self::part::{JobKey, Kind, Parts, write_part};

use crate::cli::MergeArgs;
use crate::error::Result;

/// Merges the files of all shards of a job.
///
/// # Errors
/// One line with what is missing, doubled or damaged, and which shards to run again.
pub fn run(args: &MergeArgs) -> Result<()> {
    let parts = self::part::gather(&args.shards)?;
    match parts.kind {
        Kind::Sequence => super::sequence::merge(&parts, args),
        Kind::Moment | Kind::Year => super::daylight::merge(&parts, args),
    }
}
