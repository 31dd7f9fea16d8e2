//! `skylight sequence`: pictures of one scene at equal steps of time. Scene and device are loaded once.

mod film;
mod frames;
mod merged;

use std::path::{Path, PathBuf};
use std::sync::Arc;

use chrono::{DateTime, FixedOffset};
use serde_json::Value;

use self::film::{check_ffmpeg, folder_of, is_film, write_film};
use self::frames::FrameNames;
pub(super) use self::merged::merge;
use self::merged::{DrawnFrame, DrawnShard};
use super::interrupt;
use super::job::Job;
use super::merge::{JobKey, Kind, write_part};
use super::progress;
use super::render::{check_anti_aliasing, check_layers};
use super::renderer::Renderer;
use super::sidecar;
use super::tiled::check_whole;
use crate::cli::{Expose, SequenceArgs};
use crate::daylight::colour::luminance;
use crate::daylight::place::Place;
use crate::daylight::sky::Daylight;
use crate::error::{Error, Result};
use crate::gpu::Context;
use crate::options::{OptionValues, Options, OptionsError};
use crate::output::{Metadata, check_writable, is_exr, print};
use crate::sensors::Shard;

/// Illuminance of open ground below which the exposure follows no further, lux: starlight.
const DARK_LUX: f64 = 1e-4;

/// What `--from` and `--to` give.
const GIVEN: [&str; 3] = ["when", "solar", "sun"];

/// Options that decide no picture.
const OF_NO_PICTURE: [&str; 6] = [
    "quiet",
    "no-warnings",
    "strict",
    "validate",
    "no-cache",
    "device",
];

/// Draws the frames.
///
/// # Errors
/// Any error up to writing the files. Frames that are finished stay.
pub fn run(args: &SequenceArgs, options: &OptionValues) -> Result<()> {
    if let Some(name) = GIVEN.iter().find(|name| options.get(name).is_some()) {
        return Err(Error::usage(format!(
            "--from and --to say when; leave out --{name}"
        )));
    }
    check_layers(options, is_exr(&args.output))?;
    check_writable(&args.output)?;
    let target = Target::new(args)?;
    let mut first = options.clone();
    first.set("when", args.from);
    let scene = args.scene.as_deref();
    let loaded = Job::on_device(scene, &first);
    let (job, context) = loaded.map_err(|error| renamed(error, "--when:", "--from:"))?;
    check_anti_aliasing(&job.settings, is_exr(&args.output))?;
    check_whole(&job, &context)?;
    let moments = moments(args, &job.settings).map_err(Error::usage)?;
    interrupt::listen();
    Sequence {
        args,
        options: first,
        shard: args.shard.unwrap_or(Shard::ALL),
        names: target.names(),
        moments,
        job,
        context,
        renderer: None,
        drawn: Vec::new(),
        reports: Vec::new(),
    }
    .run(&target)
}

/// Where the frames go.
struct Target {
    names: FrameNames,
    /// Folder of the frames of a film, removed at the end.
    film: Option<tempfile::TempDir>,
}

impl Target {
    fn new(args: &SequenceArgs) -> Result<Self> {
        let output = &args.output;
        if !is_film(output) {
            let names = FrameNames::parse(output)?;
            return Ok(Self { names, film: None });
        }
        if args.shard.is_some() {
            let stem = output.file_stem().unwrap_or_default().to_string_lossy();
            let what = format!(
                "a shard draws frames: -o {stem}_%04d.png; skylight merge -o {} makes the film of all of them",
                output.display()
            );
            return Err(Error::usage(what));
        }
        check_ffmpeg(output)?;
        let mut builder = tempfile::Builder::new();
        let folder = builder.prefix(".skylight-").tempdir_in(folder_of(output));
        let folder = folder.map_err(|e| Error::Write {
            path: output.clone(),
            reason: e.to_string(),
        })?;
        let names = FrameNames::parse(&folder.path().join("%06d.png"))?;
        let film = Some(folder);
        Ok(Self { names, film })
    }

    fn names(&self) -> FrameNames {
        self.names.clone()
    }
}

/// An error about one option as one about another, which gave its value.
fn renamed(error: Error, from: &str, to: &str) -> Error {
    match error {
        Error::Options(OptionsError(what)) => Error::usage(what.replacen(from, to, 1)),
        error => error,
    }
}

fn moments(
    args: &SequenceArgs,
    settings: &Options,
) -> std::result::Result<Vec<DateTime<FixedOffset>>, String> {
    let place = settings.sun.place();
    let (latitude, longitude, from) = place.ok_or("a sequence needs a place; give --place")?;
    let place = Place {
        latitude,
        longitude,
    };
    let to = args.to.at(place).map_err(|what| format!("--to: {what}"))?;
    args.step.moments(from, to, place)
}

/// A sequence while it is drawn.
struct Sequence<'a> {
    args: &'a SequenceArgs,
    options: OptionValues,
    shard: Shard,
    names: FrameNames,
    moments: Vec<DateTime<FixedOffset>>,
    job: Job,
    context: Arc<Context>,
    renderer: Option<Renderer>,
    drawn: Vec<DrawnFrame>,
    /// How the frames of a film were made, if that is to be told.
    reports: Vec<Value>,
}

impl Sequence<'_> {
    fn run(mut self, target: &Target) -> Result<()> {
        let key = self.key();
        let anchor = self.anchor()?;
        let mine: Vec<usize> = (0..self.moments.len())
            .filter(|number| self.shard.takes(*number))
            .collect();
        let bar = progress(mine.len() as u64, "frames", self.job.settings.quiet);
        for number in &mine {
            if interrupt::is_interrupted() || !self.draw(*number, anchor)? {
                break;
            }
            bar.inc(1);
        }
        bar.finish_and_clear();
        let (done, all) = (self.drawn.len(), mine.len());
        if let Some(folder) = target.film.as_ref().filter(|_| done > 0) {
            let pattern = folder.path().join("%06d.png");
            write_film(&pattern, self.args.fps, &self.args.output)?;
            if self.args.sidecar {
                let (film, frames) = (&self.args.output, &self.reports);
                sidecar::write(film, &sidecar::of_several(film, "frames", frames))?;
            }
        }
        if done < all {
            let what = if target.film.is_some() {
                "frames are in the film"
            } else {
                "frames are written"
            };
            return Err(Error::Interrupted { done, all, what });
        }
        if let Some(shard) = self.args.shard {
            let body = DrawnShard {
                frames: self.moments.len(),
                drawn: self.drawn.clone(),
            };
            write_part(&self.names.shard_file(shard), &key, shard, &body)?;
        }
        print(&self.summary(target.film.is_some()))
    }

    /// The job: what decides every frame.
    fn key(&self) -> JobKey {
        let values = self.job.settings.values().into_pairs().into_iter();
        let deciding = values.filter(|(name, _)| !OF_NO_PICTURE.contains(&name.as_str()));
        let mut decided_by: Vec<String> = deciding.map(|pair| format!("{pair:?}")).collect();
        let moments = self.moments.iter().map(DateTime::to_rfc3339);
        decided_by.extend(moments);
        decided_by.push(self.args.expose.to_string());
        decided_by.push(self.job.scene.digest());
        let name = self.args.output.file_name().unwrap_or_default();
        decided_by.push(name.to_string_lossy().into_owned());
        JobKey::new(Kind::Sequence, &decided_by)
    }

    /// Exposure and open ground's illuminance of the first frame, if others follow it. The frame is drawn for that.
    fn anchor(&mut self) -> Result<Option<[f64; 2]>> {
        let settings = &self.job.settings;
        let is_fixed = self.args.expose == Expose::First && settings.ev100.is_some();
        if is_fixed || self.args.expose == Expose::Each || is_exr(&self.args.output) {
            return Ok(None);
        }
        let lux = open_ground(&self.job.daylight);
        if let Some(ev100) = settings.ev100 {
            return Ok(Some([ev100, lux]));
        }
        let (renderer, job) = self.renderer()?;
        let Some(ev100) = renderer.picture(job)?.ev100 else {
            return Ok(None);
        };
        // As it is written: so that a single picture can have it by --ev100.
        Ok(Some([(1e3 * ev100).round() / 1e3, lux]))
    }

    /// The renderer with the frame of the job.
    fn renderer(&mut self) -> Result<(&mut Renderer, &Job)> {
        let (job, context) = (&self.job, &self.context);
        let renderer = match &mut self.renderer {
            Some(renderer) => {
                renderer.turn_to(job)?;
                renderer
            }
            none => {
                let exr = is_exr(&self.args.output);
                none.insert(Renderer::new(job, context, exr)?.without_progress())
            }
        };
        Ok((renderer, job))
    }

    /// Draws a frame; false if interrupted.
    fn draw(&mut self, number: usize, anchor: Option<[f64; 2]>) -> Result<bool> {
        let mut options = self.options.clone();
        options.set("when", self.moments[number].to_rfc3339());
        self.job.turn_to(&options)?;
        if let Some([ev100, lux]) = anchor {
            self.job.settings.ev100 = Some(self.exposure(ev100, lux));
        }
        let file = self.names.file(number);
        let (renderer, job) = self.renderer()?;
        let Some(saved) = renderer.save_whole(job, &file)? else {
            return Ok(false);
        };
        self.context.check_validation()?;
        if self.args.sidecar {
            self.tell_how(&file, &saved.metadata)?;
        }
        self.drawn
            .push(DrawnFrame::new(number, &file, saved.summary)?);
        Ok(true)
    }

    /// Writes the sidecar of a frame, or keeps it for that of the film.
    fn tell_how(&mut self, frame: &Path, metadata: &Metadata) -> Result<()> {
        let (job, film) = (&self.job, &self.args.output);
        if is_film(film) {
            self.reports
                .push(sidecar::report(job, &self.context, film, metadata));
            return Ok(());
        }
        sidecar::write(frame, &sidecar::report(job, &self.context, frame, metadata))
    }

    /// EV100 of the job's frame.
    fn exposure(&self, first: f64, lux_of_first: f64) -> f64 {
        if self.args.expose == Expose::First {
            return first;
        }
        let stops = (open_ground(&self.job.daylight) / lux_of_first).log2();
        let ev100 = first + stops;
        let least = self.job.settings.min_ev100.unwrap_or(f64::NEG_INFINITY);
        (1e3 * ev100.max(least)).round() / 1e3
    }

    fn summary(&self, is_film: bool) -> String {
        let (Some(first), Some(last)) = (self.drawn.first(), self.drawn.last()) else {
            return format!("no frames in shard {}\n", self.shard);
        };
        let count = self.drawn.len();
        let files: PathBuf = match count {
            _ if is_film => self.args.output.clone(),
            1 => first.file.clone(),
            _ => format!("{} .. {}", first.file.display(), last.file.display()).into(),
        };
        let of_first = &first.summary;
        format!(
            "{}: {count} frames, the first {of_first}\n",
            files.display()
        )
    }
}

/// Illuminance of open ground by sun and sky, lux.
fn open_ground(daylight: &Daylight) -> f64 {
    let sun = luminance(daylight.sun_illuminance) * daylight.sun_direction.y.max(0.0);
    (luminance(daylight.sky_irradiance_up) + sun).max(DARK_LUX)
}
