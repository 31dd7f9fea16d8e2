//! The arguments of series of pictures, and of merging what several machines made.

use std::path::PathBuf;

use clap::{Args, value_parser};

use super::args::named;
use crate::daylight::moment::When;
use crate::daylight::steps::{DayTime, Step};
use crate::daylight::sun_hours::SunDate;
use crate::options::{choice, choice_enum};
use crate::sensors::Shard;

/// Which moments, and where to put the frames.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct SequenceArgs {
    /// Scene file (.toml), model (.obj, .gltf, .glb), or bundled scene (colonnade, the default; island).
    pub scene: Option<PathBuf>,
    /// First moment, in the forms of --when: local time of --place, or with a UTC offset or a time zone.
    #[arg(long, value_name = "MOMENT", allow_hyphen_values = true)]
    pub from: When,
    /// Last moment; the last frame is at it or less than a step before.
    #[arg(long, value_name = "MOMENT", allow_hyphen_values = true)]
    pub to: When,
    /// Time from frame to frame: 30s, 10min, 1h; days (1d) keep the time of the clock.
    #[arg(long, value_name = "STEP", allow_hyphen_values = true)]
    pub step: Step,
    /// Frames, with the place of their number as in frame_%04d.png or .exr, from 0; or a film, .mp4, made by ffmpeg.
    #[arg(short, long, value_name = "FILE", value_parser = named(&["png", "exr", "mp4"]))]
    pub output: PathBuf,
    /// Frames of a film in a second.
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=240), default_value_t = 24)]
    pub fps: u32,
    /// How the exposure of .png and .mp4 follows the light. --ev100 is that of the first frame.
    #[arg(long, value_name = "HOW", value_parser = choice::<Expose>(), default_value_t)]
    pub expose: Expose,
    /// Draw the frames of one part of the job, for instance 3/12: another machine draws the others. Beside the frames a file is written, here
    /// frame_3-of-12.shard, by which skylight merge finds whether all are there.
    #[arg(long, value_name = "I/N")]
    pub shard: Option<Shard>,
    /// Also write FRAME.json beside each frame, or FILM.json: every option as resolved, command, place and moment, sun, exposure, device, version.
    #[arg(long)]
    pub sidecar: bool,
}

choice_enum! {
    /// How the exposure of a sequence follows the light.
    #[derive(Default)]
    pub enum Expose {
        #[default]
        First = "first": "All frames have the exposure of the first: what darkens is drawn darker",
        Smooth = "smooth": "It follows the illuminance of open ground from frame to frame, without flicker, whatever the picture shows",
        Each = "each": "Every frame is exposed by itself, as single pictures are",
    }
}

/// Which days and hours are shown on a sheet.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct StudyArgs {
    /// Scene file (.toml), model (.obj, .gltf, .glb), or bundled scene (colonnade, the default; island).
    pub scene: Option<PathBuf>,
    /// Days, separated by commas, a row for each: 3-21, or 2026-3-21. Without a year they are of that of --when, 2026 by default.
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "3-21,6-21,12-21"
    )]
    pub dates: Vec<SunDate>,
    /// Hours, separated by commas, a column for each: 9, or 9:30; local time of --place with daylight saving. With --show sun-hours there is one
    /// picture for each day.
    #[arg(
        long,
        value_name = "LIST",
        value_delimiter = ',',
        default_value = "9,12,15,17"
    )]
    pub hours: Vec<DayTime>,
    /// Look straight down, north at the top, instead of by a camera: in perspective, from so far above that verticals hardly lean. A number
    /// (--plan=60) is the width of what is shown, metres, around --target or the middle of the model.
    #[arg(long, value_name = "METRES", num_args = 0..=1, require_equals = true, default_missing_value = "0",
          value_parser = crate::options::plan_width, conflicts_with_all = ["camera", "eye", "fov"])]
    pub plan: Option<f64>,
    /// The sheet.
    #[arg(short, long, value_name = "FILE.png", value_parser = named(&["png"]), default_value = "study.png")]
    pub output: PathBuf,
    /// Also write FILE.json: every option as resolved, command, place and moment, sun, exposure, device, version of each picture.
    #[arg(long)]
    pub sidecar: bool,
}

/// What to put together.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct MergeArgs {
    /// Files that --shard wrote, in any order.
    #[arg(required = true, value_name = "FILE.shard")]
    pub shards: Vec<PathBuf>,
    /// Where to: the result of skylight daylight, by default printed; or a film of the frames of a sequence, .mp4.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Where to put the hourly matrix of shards that were measured with --ill; their own lie beside the shards.
    #[arg(long, value_name = "FILE.ill")]
    pub ill: Option<PathBuf>,
    /// Frames of a film in a second.
    #[arg(long, value_name = "N", value_parser = value_parser!(u32).range(1..=240), default_value_t = 24)]
    pub fps: u32,
}
