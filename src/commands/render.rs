//! `skylight render`: renders one image to a file, without a window.

use std::path::Path;

use super::interrupt;
use super::job::Job;
use super::samples::{self, Drawn, Progress, Rule};
use super::tiled::Tiled;
use crate::daylight::colour::luminance;
use crate::daylight::false_colour::{Colours, Quantity, Range};
use crate::error::Result;
use crate::frame::Frame;
use crate::gpu::{Recorder, Timing, read_back};
use crate::options::{AntiAliasing, OptionValues, Options, OptionsError, name};
use crate::output::{
    Channels, Effort, Encoding, Layer, LayerKind, check_writable, draw_legend, is_exr,
    print_beside, write_exr, write_png,
};
use crate::passes::light::lighting::{Precision, Show};
use crate::passes::picture::tone_map::{ToneSettings, is_light};

/// Number of samples from which drawing takes much longer than thorough compression.
const AVERAGED: u32 = 4;

/// Renders `scene` to `output`.
///
/// # Errors
/// Any error up to writing the file; an existing file is then left unchanged.
pub fn run(scene: Option<&Path>, output: &Path, options: &OptionValues) -> Result<()> {
    let exr = is_exr(output);
    if options.alone()?.layers && !exr {
        let what = "--layers needs an .exr file; choose one with -o";
        return Err(OptionsError(what.to_owned()).into());
    }
    check_writable(output)?;
    let (job, context) = Job::on_device(scene, options)?;
    check_anti_aliasing(&job.settings, exr)?;
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
        return print_beside(output, &format!("{}: {summary}\n", output.display()));
    }
    let mut renderer = Renderer::new(&job, Recorder::new(&context, Timing::Off)?, exr)?;
    let summary = if exr {
        renderer.save_exr(output)
    } else {
        renderer.save_png(output)
    }?;
    context.check_validation()?;
    print_beside(output, &format!("{}: {summary}\n", output.display()))
}

/// Fails where `--aa` would have no effect on a single frame. Pictures of several samples are smooth without it.
fn check_anti_aliasing(options: &Options, exr: bool) -> Result<()> {
    let is_picture = is_light(options.show) && options.false_colour.is_none();
    let what = match options.aa {
        _ if options.samples > 1 => return Ok(()),
        AntiAliasing::Off => return Ok(()),
        AntiAliasing::Taa => {
            "--aa taa takes the samples of frames before, and a file has none; choose smaa, or --samples 4 or more"
        }
        AntiAliasing::Smaa if exr => {
            "--aa smaa smooths what is displayed, not the values of .exr; leave it out, write .png, or choose --samples 4 or more"
        }
        AntiAliasing::Smaa if !is_picture => {
            "--aa smaa smooths pictures, not other quantities and false colours; leave it out, or choose --samples 4 or more"
        }
        AntiAliasing::Smaa => return Ok(()),
    };
    Err(OptionsError(what.to_owned()).into())
}

struct Renderer<'j> {
    job: &'j Job,
    recorder: Recorder,
    frame: Frame,
    rule: Rule,
    progress: Progress,
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
        let rule = Rule {
            most: settings.samples,
            noise: job.settings.noise,
        };
        Ok(Self {
            job,
            recorder,
            frame,
            rule,
            progress: Progress::new(&rule, job.settings.quiet),
        })
    }

    /// Draws the displayed quantity.
    fn draw(&mut self, rule: Rule) -> Result<Drawn> {
        while !self.frame.is_refined() {
            self.recorder.begin()?;
            self.frame
                .record_light(&mut self.recorder, &self.job.daylight);
            self.recorder.finish()?;
        }
        interrupt::listen();
        samples::draw(
            &mut self.frame,
            &mut self.recorder,
            self.job,
            &rule,
            &self.progress,
        )
    }

    fn save_png(&mut self, path: &Path) -> Result<String> {
        let drawn = self.draw(self.rule)?;
        let colours = self.false_colours()?;
        let mut pixels = read_back(&mut self.recorder, self.frame.display())?;
        let ev100 = self.ev100()?;
        let mut metadata = self.job.metadata();
        metadata.extend(drawn.metadata(&self.rule));
        if let Some(ev100) = ev100 {
            metadata.push(("ev100 used".into(), format!("{ev100:.3}")));
        }
        let gamma = self.job.settings.gamma.filter(|_| colours.is_none());
        let encoding = gamma.map_or(Encoding::Srgb, Encoding::Gamma);
        let mut summary = ev100.map_or(String::new(), |ev| format!(", EV100 {ev:.2}"));
        if let Some((quantity, colours)) = colours {
            draw_legend(&mut pixels.bytes, pixels.size, quantity, colours);
            let range = colours.range;
            let used = format!("{},{}", range.min, range.max);
            metadata.push(("false-colour-range used".into(), used));
            summary = format!(", {range} {}", quantity.unit());
        }
        let effort = if drawn.samples < AVERAGED {
            Effort::Quick
        } else {
            Effort::Small
        };
        let how = (encoding, effort);
        write_png(path, pixels.size, &pixels.bytes, how, &metadata)?;
        self.progress.clear();
        let samples = drawn.summary(&self.rule);
        let [width, height] = pixels.size;
        Ok(format!("{width}x{height}{summary}{samples}"))
    }

    /// Quantity and colours of a false-colour picture. Without a given range, it is taken from the image, which is then tone mapped
    /// again.
    fn false_colours(&mut self) -> Result<Option<(Quantity, Colours)>> {
        let settings = &self.job.settings;
        let Some(quantity) = settings.false_colour else {
            return Ok(None);
        };
        let map = settings.colour_map;
        if let Some(range) = settings.false_colour_range {
            return Ok(Some((quantity, Colours { range, map })));
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
    fn ev100(&mut self) -> Result<Option<f64>> {
        let settings = &self.job.settings;
        let exposed = settings.scale.is_none() && settings.false_colour.is_none();
        if !exposed || settings.show.file_unit() == 1.0 {
            return Ok(None);
        }
        if let Some(ev100) = settings.ev100 {
            return Ok(Some(ev100));
        }
        let average = read_back(&mut self.recorder, self.frame.average_luminance())?.floats()[0];
        Ok(Some(self.job.automatic_ev100(f64::from(average) * 1e3)))
    }

    fn save_exr(&mut self, path: &Path) -> Result<String> {
        let shown = self.job.settings.show;
        let (picture, drawn) = self.layer(shown, "", self.rule)?;
        let mut layers = vec![picture];
        if self.job.settings.layers {
            // Same sample count as the image, so that the addends sum to it.
            let same = Rule {
                most: drawn.samples,
                noise: None,
            };
            for show in extra_layers().take_while(|_| !drawn.is_interrupted) {
                self.progress.name(name(show));
                self.frame.show(show)?;
                let (layer, drawn) = self.layer(show, name(show), same)?;
                if drawn.is_interrupted {
                    break;
                }
                layers.push(layer);
            }
        }
        let size = self.frame.settings().size.to_array();
        let mut metadata = self.job.metadata();
        metadata.extend(drawn.metadata(&self.rule));
        write_exr(path, size, &layers, &metadata)?;
        self.progress.clear();
        let (count, samples) = (layers.len(), drawn.summary(&self.rule));
        Ok(format!(
            "{}x{}, {count} layer(s){samples}",
            size[0], size[1]
        ))
    }

    fn layer(&mut self, show: Show, name: &'static str, rule: Rule) -> Result<(Layer, Drawn)> {
        let drawn = self.draw(rule)?;
        let mut texels = read_back(&mut self.recorder, self.frame.radiance())?.rgba();
        let unit = show.file_unit();
        if unit != 1.0 {
            for texel in &mut texels {
                *texel = texel.map(|v| v * unit);
            }
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
fn wanted_layers(job: &Job) -> impl Iterator<Item = (Show, LayerKind)> {
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
