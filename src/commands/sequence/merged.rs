//! What shards of a sequence have drawn, and whether it is all there.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::film::{check_ffmpeg, folder_of, is_film, write_film};
use crate::cli::MergeArgs;
use crate::commands::merge::{FileBeside, Parts};
use crate::error::{Error, Result};
use crate::output::{check_writable, print};
use crate::sensors::Shard;

/// A frame that is written.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct DrawnFrame {
    number: usize,
    /// Its file.
    #[serde(skip)]
    pub file: PathBuf,
    /// What it must be.
    #[serde(flatten)]
    written: FileBeside,
    /// What was drawn, for the line on stdout.
    #[serde(skip)]
    pub summary: String,
}

impl DrawnFrame {
    /// # Errors
    /// The file cannot be read again.
    pub fn new(number: usize, file: &Path, summary: String) -> Result<Self> {
        Ok(Self {
            number,
            file: file.to_owned(),
            written: FileBeside::new(file)?,
            summary,
        })
    }
}

/// Frames of a shard.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct DrawnShard {
    /// How many frames the whole sequence has.
    pub frames: usize,
    /// Those of the shard.
    pub drawn: Vec<DrawnFrame>,
}

/// Checks the frames of all shards, which are beside their files; makes a film of them if one is asked for.
///
/// # Errors
/// One line with the shards whose frames are missing or changed, or the film cannot be made.
pub(in crate::commands) fn merge(parts: &Parts, args: &MergeArgs) -> Result<()> {
    if let Some(output) = &args.output {
        check_writable(output)?;
        if !is_film(output) {
            let what = format!("{}: frames are merged to an .mp4", output.display());
            return Err(Error::Merge(what));
        }
        check_ffmpeg(output)?;
    }
    let frames = frames_of(&parts.bodies()?)?;
    let Some(output) = &args.output else {
        return print(&format!("{} frames, all whole\n", frames.len()));
    };
    film_of(&frames, args.fps, output)?;
    print(&format!("{}: {} frames\n", output.display(), frames.len()))
}

/// The files of all frames.
///
/// # Errors
/// One line with those that are missing or changed, and the shards to run again.
fn frames_of(shards: &[(PathBuf, DrawnShard)]) -> Result<Vec<PathBuf>> {
    let of = shards.len() as u32;
    let mut faults = Vec::new();
    let mut frames: Vec<Option<PathBuf>> = vec![None; shards.first().map_or(0, |s| s.1.frames)];
    for (number, (path, shard)) in (1..).zip(shards) {
        let mut odd = Vec::new();
        for frame in &shard.drawn {
            let (file, fault) = frame.written.found(path);
            odd.extend(fault);
            if let Some(place) = frames.get_mut(frame.number) {
                *place = Some(file);
            }
        }
        if let Some(first) = odd.first() {
            let more = match odd.len() {
                1 => String::new(),
                count => format!(" (and {} more)", count - 1),
            };
            let shard = Shard { number, of };
            faults.push(format!("{first}{more}: run again with --shard {shard}"));
        }
    }
    if faults.is_empty() {
        return Ok(frames.into_iter().flatten().collect());
    }
    Err(Error::Merge(faults.join("; ")))
}

/// A film of frames with any names.
fn film_of(frames: &[PathBuf], per_second: u32, film: &Path) -> Result<()> {
    let failed = |error: std::io::Error| Error::Write {
        path: film.to_owned(),
        reason: error.to_string(),
    };
    let mut builder = tempfile::Builder::new();
    let folder = builder.prefix(".skylight-").tempdir_in(folder_of(film));
    let folder = folder.map_err(failed)?;
    let extension = frames.first().and_then(|frame| frame.extension());
    let extension = extension.unwrap_or_default().to_string_lossy();
    for (number, frame) in frames.iter().enumerate() {
        let name = folder.path().join(format!("{number:06}.{extension}"));
        std::fs::copy(frame, name).map_err(failed)?;
    }
    let pattern = folder.path().join(format!("%06d.{extension}"));
    write_film(&pattern, per_second, film)
}
