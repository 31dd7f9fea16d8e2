//! `skylight render`: renders images to files, without a window.

use std::path::Path;

use super::interrupt;
use super::job::Job;
use super::names::files;
use super::renderer::{Renderer, Saved, precision, wanted_layers};
use super::sidecar;
use super::tiled::Tiled;
use crate::error::{Error, Result};
use crate::options::{AntiAliasing, OptionValues, Options, SeveralPictures};
use crate::output::{check_writable, is_exr, print_beside};
use crate::passes::light::lighting::Show;
use crate::passes::picture::tone_map::is_light;

/// Renders pictures of `scene` to `output`, whose placeholders tell several apart, each with a sidecar if wanted. Scene and device are
/// loaded once.
///
/// # Errors
/// Any error up to writing the files; existing files are then left unchanged.
pub fn run(
    scene: Option<&Path>,
    (output, has_sidecar): (&Path, bool),
    options: &SeveralPictures,
) -> Result<()> {
    let exr = is_exr(output);
    check_layers(&options.first, exr)?;
    check_writable(output)?;
    if has_sidecar {
        sidecar::check(output)?;
    }
    let pictures = options.pictures()?;
    let (mut job, context) = Job::on_device(scene, &pictures[0])?;
    check_anti_aliasing(&job.settings, exr)?;
    let files = files(output, &pictures, &job.loaded)?;
    let mut renderer: Option<Renderer> = None;
    for (done, (options, file)) in pictures.iter().zip(&files).enumerate() {
        if interrupt::is_interrupted() {
            let (all, what) = (files.len(), "pictures are written");
            return Err(Error::Interrupted { done, all, what });
        }
        if done > 0 {
            job.turn_to(options)?;
        }
        let saved = if let Some(tiled) = Tiled::new(&job, &context, precision(exr))? {
            save_tiled(tiled, &job, file)?
        } else {
            let renderer = match &mut renderer {
                Some(renderer) => {
                    renderer.turn_to(&job)?;
                    renderer
                }
                none => none.insert(Renderer::new(&job, &context, exr)?),
            };
            renderer.save(&job, file)?
        };
        context.check_validation()?;
        if has_sidecar {
            let report = sidecar::report(&job, &context, file, &saved.metadata);
            sidecar::write(file, &report)?;
        }
        print_beside(file, &format!("{}: {}\n", file.display(), saved.summary))?;
    }
    Ok(())
}

/// Fails if there is nowhere to put layers.
pub(super) fn check_layers(options: &OptionValues, exr: bool) -> Result<()> {
    let settings = options.alone()?;
    if settings.layers && settings.show == Show::SunHours {
        let what = "--show sun-hours has no layers: each sun is a frame; leave out --layers";
        return Err(Error::usage(what));
    }
    if settings.layers && !exr {
        let what = "--layers needs an .exr file; choose one with -o";
        return Err(Error::usage(what));
    }
    Ok(())
}

fn save_tiled(tiled: Tiled<'_>, job: &Job, file: &Path) -> Result<Saved> {
    if !is_exr(file) {
        return tiled.save_png(file);
    }
    let (shows, kinds): (Vec<Show>, Vec<_>) = wanted_layers(job).unzip();
    tiled.save_exr(file, &shows, &kinds)
}

/// Fails where `--aa` would have no effect on a single frame. Pictures of several samples are smooth without it.
pub(super) fn check_anti_aliasing(options: &Options, exr: bool) -> Result<()> {
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
    Err(Error::usage(what))
}
