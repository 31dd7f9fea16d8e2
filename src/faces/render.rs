//! `skylight render`: one picture to a file, without a window.

use std::path::Path;

use indicatif::ProgressBar;

use super::job::Job;
use super::progress;
use super::tiled::Tiled;
use crate::daylight::colour::luminance;
use crate::daylight::exposure::automatic;
use crate::daylight::false_colour::{Quantity, Range};
use crate::error::Result;
use crate::frame::Frame;
use crate::gpu::{Recorder, Timing, read_back};
use crate::output::{
    Channels, Encoding, Layer, LayerKind, check_writable, draw_legend, print, write_exr, write_png,
};
use crate::passes::lighting::{Precision, Show};
use crate::passes::tone_map::ToneSettings;
use crate::settings::{Exposure, Options, SettingsError};

/// Renders `scene` to `output`.
///
/// # Errors
/// Whatever keeps the file from being written; an older file is left alone then.
pub fn run(scene: Option<&Path>, output: &Path, options: Options) -> Result<()> {
    let exr = output
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("exr"));
    if options.layers && !exr {
        let what = "--layers needs an .exr file; choose one with -o";
        return Err(SettingsError(what.to_owned()).into());
    }
    check_writable(output)?;
    let job = Job::new(scene, options)?;
    let context = job.context()?;
    let precision = if exr {
        Precision::Float
    } else {
        Precision::Half
    };
    if let Some(tiled) = Tiled::new(&job, &context, precision)? {
        let summary = if exr {
            let (shows, kinds): (Vec<Show>, Vec<_>) = wanted_layers(&job).unzip();
            tiled.save_exr(output, &shows, &kinds)
        } else {
            tiled.save_png(output)
        }?;
        context.check_validation()?;
        return print(&format!("{}: {summary}\n", output.display()));
    }
    let mut renderer = Renderer::new(&job, Recorder::new(&context, Timing::Off)?, exr)?;
    let summary = if exr {
        renderer.save_exr(output)
    } else {
        renderer.save_png(output)
    }?;
    context.check_validation()?;
    print(&format!("{}: {summary}\n", output.display()))
}

struct Renderer<'j> {
    job: &'j Job,
    recorder: Recorder,
    frame: Frame,
    progress: ProgressBar,
}

impl<'j> Renderer<'j> {
    fn new(job: &'j Job, mut recorder: Recorder, exr: bool) -> Result<Self> {
        let precision = if exr {
            Precision::Float
        } else {
            Precision::Half
        };
        let settings = job.frame_settings(job.settings.show, precision);
        recorder.begin()?;
        let frame = Frame::new(&mut recorder, &job.scene, settings)?;
        recorder.finish()?;
        let layers = if job.settings.layers {
            1 + extra_layers().count()
        } else {
            1
        };
        let steps = layers as u64 * u64::from(settings.samples);
        Ok(Self {
            job,
            recorder,
            frame,
            progress: progress(steps, "samples", job.settings.quiet),
        })
    }

    /// Draws the picture, or the quantity that the frame shows.
    fn draw(&mut self) -> Result<()> {
        while !self.frame.is_refined() {
            self.recorder.begin()?;
            self.frame
                .record_light(&mut self.recorder, &self.job.daylight);
            self.recorder.finish()?;
        }
        for index in 0..self.job.settings.samples {
            self.recorder.begin()?;
            self.frame.record(
                &mut self.recorder,
                &self.job.daylight,
                &self.job.camera,
                index,
            );
            self.recorder.finish()?;
            self.progress.inc(1);
        }
        Ok(())
    }

    fn save_png(&mut self, path: &Path) -> Result<String> {
        self.draw()?;
        let colours = self.false_colours()?;
        let mut pixels = read_back(&mut self.recorder, self.frame.display())?;
        let ev100 = self.ev100()?;
        let mut metadata = self.job.metadata();
        if let Some(ev100) = ev100 {
            metadata.push(("ev100 used".into(), format!("{ev100:.3}")));
        }
        let gamma = self.job.settings.gamma.filter(|_| colours.is_none());
        let encoding = gamma.map_or(Encoding::Srgb, Encoding::Gamma);
        let mut summary = ev100.map_or(String::new(), |ev| format!(", EV100 {ev:.2}"));
        if let Some((quantity, range)) = colours {
            draw_legend(&mut pixels.bytes, pixels.size, quantity, range);
            let used = format!("{},{}", range.min, range.max);
            metadata.push(("false-colour-range used".into(), used));
            summary = format!(", {range} {}", quantity.unit());
        }
        write_png(path, pixels.size, &pixels.bytes, encoding, &metadata)?;
        self.progress.finish_and_clear();
        Ok(format!("{}x{}{summary}", pixels.size[0], pixels.size[1]))
    }

    /// What false colours show, and their range; one that was not given is looked for in the picture, which is then mapped
    /// again.
    fn false_colours(&mut self) -> Result<Option<(Quantity, Range)>> {
        let settings = &self.job.settings;
        let Some(quantity) = settings.false_colour else {
            return Ok(None);
        };
        if let Some(range) = settings.false_colour_range {
            return Ok(Some((quantity, range)));
        }
        let texels = read_back(&mut self.recorder, self.frame.radiance())?.rgba();
        let luminance = |t: &[f32; 4]| luminance(glam::Vec3::from_slice(t).as_dvec3()) * 1e3;
        let range = Range::around(texels.iter().map(luminance)).unwrap_or(quantity.daytime());
        let tone = ToneSettings {
            false_colour: Some(range),
            ..self.frame.settings().tone
        };
        self.recorder.begin()?;
        self.frame.develop(&mut self.recorder, tone)?;
        self.recorder.finish()?;
        Ok(Some((quantity, range)))
    }

    /// The exposure used, of quantities that are exposed.
    fn ev100(&mut self) -> Result<Option<f64>> {
        let settings = &self.job.settings;
        let exposed = settings.scale.is_none() && settings.false_colour.is_none();
        if !exposed || settings.show.file_unit() == 1.0 {
            return Ok(None);
        }
        if let Exposure::Ev100(ev100) = self.job.settings.exposure {
            return Ok(Some(ev100));
        }
        let average = read_back(&mut self.recorder, self.frame.average_luminance())?.floats()[0];
        Ok(Some(automatic(f64::from(average) * 1e3)))
    }

    fn save_exr(&mut self, path: &Path) -> Result<String> {
        let shown = self.job.settings.show;
        let mut layers = vec![self.layer(shown, "")?];
        if self.job.settings.layers {
            for show in extra_layers() {
                self.frame.show(show)?;
                layers.push(self.layer(show, show.name())?);
            }
        }
        let size = self.frame.settings().size.to_array();
        write_exr(path, size, &layers, &self.job.metadata())?;
        self.progress.finish_and_clear();
        Ok(format!(
            "{}x{}, {} layer(s)",
            size[0],
            size[1],
            layers.len()
        ))
    }

    fn layer(&mut self, show: Show, name: &'static str) -> Result<Layer> {
        self.draw()?;
        let mut texels = read_back(&mut self.recorder, self.frame.radiance())?.rgba();
        let unit = show.file_unit();
        if unit != 1.0 {
            for texel in &mut texels {
                *texel = texel.map(|v| v * unit);
            }
        }
        Ok(Layer {
            name,
            channels: channels(show, name),
            texels,
        })
    }
}

/// The layers beside the picture.
fn extra_layers() -> impl Iterator<Item = Show> {
    Show::ADDENDS.into_iter().chain(Show::INPUTS)
}

/// The picture, and the layers beside it that are asked for.
fn wanted_layers(job: &Job) -> impl Iterator<Item = (Show, LayerKind)> {
    let shown = job.settings.show;
    let others = extra_layers().filter(|_| job.settings.layers);
    std::iter::once((shown, ("", channels(shown, ""))))
        .chain(others.map(|show| (show, (show.name(), channels(show, show.name())))))
}

/// The picture itself is always RGB, so that every program shows it.
fn channels(show: Show, name: &str) -> Channels {
    match show {
        _ if name.is_empty() => Channels::Rgb,
        Show::Visibility | Show::Occlusion => Channels::Single,
        Show::Depth => Channels::Depth,
        Show::Normal => Channels::Xyz,
        _ => Channels::Rgb,
    }
}
