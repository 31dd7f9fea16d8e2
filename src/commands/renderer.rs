//! Draws pictures of one scene, one after the other, and writes them. The scene is uploaded once.

use std::path::Path;
use std::sync::Arc;

use super::interrupt;
use super::job::Job;
use super::samples::{self, Drawn, Progress, Rule};
use crate::daylight::colour::luminance;
use crate::daylight::false_colour::{Colours, Quantity, Range};
use crate::error::Result;
use crate::frame::Frame;
use crate::gpu::{Context, Recorder, Timing, read_back};
use crate::options::name;
use crate::output::{
    Channels, Effort, Encoding, Layer, LayerKind, Metadata, draw_legend, write_exr, write_png,
};
use crate::passes::light::lighting::{Precision, Show};
use crate::passes::picture::tone_map::ToneSettings;

/// Number of samples from which drawing takes much longer than thorough compression.
const AVERAGED: u32 = 4;

/// Precision of the pictures of a file.
pub(super) fn precision(exr: bool) -> Precision {
    if exr {
        Precision::Float
    } else {
        Precision::Half
    }
}

/// The frame, and how its pictures are drawn.
pub(super) struct Renderer {
    recorder: Recorder,
    frame: Frame,
    precision: Precision,
    rule: Rule,
    progress: Progress,
}

/// A displayed picture, as it is written to a PNG file.
pub(super) struct Picture {
    /// Width and height, pixels.
    pub size: [u32; 2],
    /// Rows from the top, four bytes per pixel.
    pub rgba: Vec<u8>,
    /// What the bytes are.
    pub encoding: Encoding,
    /// EV100 that was used; `None` for quantities that are not exposed.
    pub ev100: Option<f64>,
    /// The samples.
    pub drawn: Drawn,
    /// What makes it again.
    pub metadata: Metadata,
    /// What it shows, for the line on stdout.
    summary: String,
}

/// What was written.
pub(super) struct Saved {
    /// Size, exposure and samples, for the line on stdout.
    pub summary: String,
    /// The parameters in the file.
    pub metadata: Metadata,
}

impl Renderer {
    /// Uploads the scene of a job.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(job: &Job, context: &Arc<Context>, exr: bool) -> Result<Self> {
        let precision = precision(exr);
        let settings = job.frame_settings(job.settings.show, precision);
        let mut recorder = Recorder::new(context, Timing::Off)?;
        recorder.begin()?;
        let frame = Frame::new(&mut recorder, &job.scene, settings)?;
        recorder.finish()?;
        let rule = Rule {
            most: settings.samples,
            noise: job.settings.noise,
        };
        Ok(Self {
            recorder,
            frame,
            precision,
            rule,
            progress: Progress::new(&rule, job.settings.quiet),
        })
    }

    /// Shows no progress of samples: the caller has a bar of its own.
    pub fn without_progress(self) -> Self {
        Self {
            progress: Progress::hidden(),
            ..self
        }
    }

    /// Turns to another camera or moment of the job's scene.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn turn_to(&mut self, job: &Job) -> Result<()> {
        let settings = job.frame_settings(job.settings.show, self.precision);
        self.recorder.begin()?;
        self.frame.apply(&mut self.recorder, settings)?;
        // The irradiance of another sky starts over, so that it is not taken as complete.
        self.frame.record_light(&mut self.recorder, &job.daylight);
        Ok(self.recorder.finish()?)
    }

    /// Draws a picture and writes it, with fewer samples if it is interrupted.
    ///
    /// # Errors
    /// Any error up to writing the file; an existing file is then left unchanged.
    pub fn save(&mut self, job: &Job, path: &Path) -> Result<Saved> {
        let saved = self.write(job, path, true)?;
        Ok(saved.unwrap_or_else(|| Saved {
            summary: String::new(),
            metadata: Metadata::new(),
        }))
    }

    /// As [`Renderer::save`], but `None` if it is interrupted: then nothing is written.
    ///
    /// # Errors
    /// See there.
    pub fn save_whole(&mut self, job: &Job, path: &Path) -> Result<Option<Saved>> {
        self.write(job, path, false)
    }

    fn write(&mut self, job: &Job, path: &Path, keeps_part: bool) -> Result<Option<Saved>> {
        if self.precision == Precision::Float {
            return self.write_exr(job, path, keeps_part);
        }
        let picture = self.picture(job)?;
        if picture.drawn.is_interrupted && !keeps_part {
            return Ok(None);
        }
        let effort = if picture.drawn.samples < AVERAGED {
            Effort::Quick
        } else {
            Effort::Small
        };
        let how = (picture.encoding, effort);
        write_png(path, picture.size, &picture.rgba, how, &picture.metadata)?;
        self.progress.clear();
        let samples = picture.drawn.summary(&self.rule);
        let [width, height] = picture.size;
        Ok(Some(Saved {
            summary: format!("{width}x{height}{}{samples}", picture.summary),
            metadata: picture.metadata,
        }))
    }

    /// Draws the displayed quantity.
    fn draw(&mut self, job: &Job, rule: Rule) -> Result<Drawn> {
        while !self.frame.is_refined() {
            self.recorder.begin()?;
            self.frame.record_light(&mut self.recorder, &job.daylight);
            self.recorder.finish()?;
        }
        interrupt::listen();
        samples::draw(
            &mut self.frame,
            &mut self.recorder,
            job,
            &rule,
            &self.progress,
        )
    }

    /// Draws a picture for display, with its legend.
    ///
    /// # Errors
    /// Fails when the device is lost or out of memory.
    pub fn picture(&mut self, job: &Job) -> Result<Picture> {
        let drawn = self.draw(job, self.rule)?;
        let colours = self.false_colours(job)?;
        let mut pixels = read_back(&mut self.recorder, self.frame.display())?;
        let ev100 = self.ev100(job)?;
        let mut metadata = job.metadata();
        metadata.extend(drawn.metadata(&self.rule));
        if let Some(ev100) = ev100 {
            metadata.push(("ev100 used".into(), format!("{ev100:.3}")));
        }
        let gamma = job.settings.gamma.filter(|_| colours.is_none());
        let mut summary = ev100.map_or(String::new(), |ev| format!(", EV100 {ev:.2}"));
        if let Some((quantity, colours)) = colours {
            draw_legend(&mut pixels.bytes, pixels.size, quantity, colours);
            let range = colours.range;
            let used = format!("{},{}", range.min, range.max);
            metadata.push(("false-colour-range used".into(), used));
            summary = format!(", {range} {}", quantity.unit());
        }
        Ok(Picture {
            size: pixels.size,
            rgba: pixels.bytes,
            encoding: gamma.map_or(Encoding::Srgb, Encoding::Gamma),
            ev100,
            drawn,
            metadata,
            summary,
        })
    }

    /// Quantity and colours of a false-colour picture. Without a given range, it is taken from the image, which is then tone mapped
    /// again.
    fn false_colours(&mut self, job: &Job) -> Result<Option<(Quantity, Colours)>> {
        let settings = &job.settings;
        let Some(quantity) = settings.false_colour else {
            return Ok(None);
        };
        let map = settings.colour_map;
        if settings.false_colour_range.is_some() || quantity == Quantity::SunHours {
            return Ok(job.colours(settings.show));
        }
        let texels = read_back(&mut self.recorder, self.frame.radiance())?.rgba();
        let luminance = |t: &[f32; 4]| luminance(glam::Vec3::from_slice(t).as_dvec3()) * 1e3;
        let range = Range::around(texels.iter().map(luminance)).unwrap_or(quantity.daytime());
        let colours = Colours { range, map };
        let tone = ToneSettings {
            false_colour: Some(colours),
            ..self.frame.settings().tone
        };
        self.recorder.begin()?;
        self.frame.retone(&mut self.recorder, tone)?;
        self.recorder.finish()?;
        Ok(Some((quantity, colours)))
    }

    /// EV100 used; `None` for quantities that are not exposed.
    fn ev100(&mut self, job: &Job) -> Result<Option<f64>> {
        let settings = &job.settings;
        let exposed = settings.scale.is_none() && settings.false_colour.is_none();
        if !exposed || settings.show.file_unit() == 1.0 {
            return Ok(None);
        }
        if let Some(ev100) = settings.ev100 {
            return Ok(Some(ev100));
        }
        let average = read_back(&mut self.recorder, self.frame.average_luminance())?.floats()[0];
        Ok(Some(job.automatic_ev100(f64::from(average) * 1e3)))
    }

    fn write_exr(&mut self, job: &Job, path: &Path, keeps_part: bool) -> Result<Option<Saved>> {
        let shown = job.settings.show;
        let (picture, drawn) = self.layer(job, (shown, ""), self.rule)?;
        let mut layers = vec![picture];
        let mut is_whole = !drawn.is_interrupted;
        if job.settings.layers {
            // Same sample count as the image, so that the addends sum to it.
            let same = Rule {
                most: drawn.samples,
                noise: None,
            };
            for show in extra_layers().take_while(|_| !drawn.is_interrupted) {
                self.progress.name(name(show));
                self.frame.show(show)?;
                let (layer, drawn) = self.layer(job, (show, name(show)), same)?;
                is_whole &= !drawn.is_interrupted;
                if !is_whole {
                    break;
                }
                layers.push(layer);
            }
        }
        if !is_whole && !keeps_part {
            return Ok(None);
        }
        let size = self.frame.settings().size.to_array();
        let mut metadata = job.metadata();
        metadata.extend(drawn.metadata(&self.rule));
        write_exr(path, size, &layers, &metadata)?;
        self.progress.clear();
        let (count, samples) = (layers.len(), drawn.summary(&self.rule));
        let [width, height] = size;
        Ok(Some(Saved {
            summary: format!("{width}x{height}, {count} layer(s){samples}"),
            metadata,
        }))
    }

    fn layer(
        &mut self,
        job: &Job,
        (show, name): (Show, &'static str),
        rule: Rule,
    ) -> Result<(Layer, Drawn)> {
        let drawn = self.draw(job, rule)?;
        let mut texels = read_back(&mut self.recorder, self.frame.radiance())?.rgba();
        let unit = job.file_unit(show);
        if unit != 1.0 {
            for texel in &mut texels {
                *texel = texel.map(|v| v * unit);
            }
        }
        if show == Show::SunHours {
            // Without a surface there is no sun.
            texels.iter_mut().for_each(|t| *t = t.map(|v| v.max(0.0)));
        }
        let layer = Layer {
            name,
            channels: channels(show, name),
            texels,
        };
        Ok((layer, drawn))
    }
}

/// The additional layers of an EXR file.
fn extra_layers() -> impl Iterator<Item = Show> {
    Show::ADDENDS.into_iter().chain(Show::INPUTS)
}

/// The image, and the additional layers if requested.
pub(super) fn wanted_layers(job: &Job) -> impl Iterator<Item = (Show, LayerKind)> {
    let shown = job.settings.show;
    let others = extra_layers().filter(|_| job.settings.layers);
    std::iter::once((shown, ("", channels(shown, ""))))
        .chain(others.map(|show| (show, (name(show), channels(show, name(show))))))
}

/// Channels of a layer. The image itself is always RGB, so that any viewer can show it.
fn channels(show: Show, name: &str) -> Channels {
    match show {
        _ if name.is_empty() => Channels::Rgb,
        Show::Visibility | Show::Occlusion => Channels::Single,
        Show::Depth => Channels::Depth,
        Show::Normal => Channels::Xyz,
        _ => Channels::Rgb,
    }
}
