//! Images too large to be drawn in one piece: tiles are drawn and stitched row by row into the file.
//!
//! All tiles share the same light. Shadow map, sky and cells are those of the whole image; exposure and ambient occlusion come from an
//! overview. Up to 36 million pixels the overview has full resolution, and the result is identical to the image drawn in one
//! piece; above that, ambient occlusion is coarser. There are no seams either way.

mod plan;

use std::path::Path;
use std::sync::Arc;

use indicatif::ProgressBar;

use self::plan::{Plan, Span};
use super::job::Job;
use super::progress;
use super::renderer::Saved;
use crate::daylight::colour::luminance;
use crate::daylight::exposure::automatic;
use crate::daylight::false_colour::Range;
use crate::error::{Error, Result};
use crate::frame::{Frame, FrameSettings, Visibility};
use crate::gpu::{Context, Image, Pixels, Recorder, Timing, read_back};
use crate::options::AntiAliasing;
use crate::output::{Encoding, LayerKind, PngRows, write_exr_rows};
use crate::passes::light::lighting::{Ambient, Precision, Show};
use crate::passes::picture::tone_map::Scale;

/// Draws a job's image in tiles.
pub(super) struct Tiled<'j> {
    job: &'j Job,
    plan: Plan,
    recorder: Recorder,
    frame: Frame,
    /// Log-average luminance, cd/m², if the exposure is automatic.
    average: Option<f64>,
    progress: ProgressBar,
}

/// The tiles; `None` if the image can be drawn in one piece.
fn plan(job: &Job, context: &Context) -> Option<Plan> {
    let size = job.settings.size;
    let limit = context.summary().max_image_edge;
    Plan::new(
        glam::UVec2::new(size.width, size.height),
        job.settings.tile,
        limit,
    )
}

/// Fails if the pictures of a job are too large to be drawn in one piece.
///
/// # Errors
/// See above.
pub(super) fn check_whole(job: &Job, context: &Context) -> Result<()> {
    if plan(job, context).is_none() {
        return Ok(());
    }
    let what = "pictures of a series are drawn in one piece, not in tiles; choose a smaller --size, and leave out --tile";
    Err(Error::usage(what))
}

impl<'j> Tiled<'j> {
    /// Draws the overview. `None` if the image can be drawn in one piece.
    ///
    /// # Errors
    /// Options that do not apply to tiles, or a device that cannot create the resources.
    pub fn new(job: &'j Job, context: &Arc<Context>, precision: Precision) -> Result<Option<Self>> {
        let Some(plan) = plan(job, context) else {
            return Ok(None);
        };
        if job.suns.is_some() {
            let what = "--show sun-hours is drawn in one piece, not in tiles; choose a smaller --size, and leave out --tile";
            return Err(Error::usage(what));
        }
        if job.settings.noise.is_some() {
            let what = "--noise is judged on whole pictures, not in tiles; say how many --samples, or choose a smaller --size";
            return Err(Error::usage(what));
        }
        if job.settings.samples == 1 && job.settings.aa == AntiAliasing::Smaa {
            let what = "--aa smaa smooths whole pictures, not tiles; choose --samples 4 or more, or a smaller --size";
            return Err(Error::usage(what));
        }
        let occludes = job.settings.visibility == Visibility::Ssao
            && job.settings.ambient == Ambient::Ssao
            && job.settings.ao_radius > 0.0;
        let (size, coarser, window) = plan.overview(occludes);
        let settings = FrameSettings {
            size,
            of_picture: Some(job.frame_settings(job.settings.show, precision).size),
            ..job.frame_settings(job.settings.show, precision)
        };
        let mut recorder = Recorder::new(context, Timing::Off)?;
        recorder.begin()?;
        let mut frame = Frame::new(&mut recorder, &job.scene, settings)?;
        recorder.finish()?;
        frame.set_tile(window);
        let tiles = plan.bands.len() * plan.columns.len();
        let progress = progress(tiles as u64 + 1, "tiles", job.settings.quiet);
        let mut tiled = Self {
            job,
            plan,
            recorder,
            frame,
            average: None,
            progress,
        };
        tiled.draw_overview(settings, occludes, coarser)?;
        Ok(Some(tiled))
    }

    /// Draws the overview, keeps what the tiles share, and sets up the frame for tiles.
    fn draw_overview(
        &mut self,
        settings: FrameSettings,
        occludes: bool,
        coarser: u32,
    ) -> Result<()> {
        while !self.frame.is_refined() {
            self.recorder.begin()?;
            self.frame
                .record_light(&mut self.recorder, &self.job.daylight);
            self.recorder.finish()?;
        }
        let averages = matches!(settings.tone.scale, Scale::Average { .. });
        let has_range = self.job.settings.false_colour.is_some();
        let mut occlusion = Vec::new();
        if occludes || averages || has_range {
            for index in 0..self.job.settings.samples {
                self.draw_sample(index)?;
                if occludes && occlusion.len() < MAX_OCCLUSION_IMAGES {
                    occlusion.extend(self.frame.take_occlusion()?);
                }
            }
        }
        let tone = self.tone(&settings)?;
        let mut tile = FrameSettings {
            size: self.plan.tile,
            tone,
            ..settings
        };
        tile.lighting.occlusion_downscale *= coarser;
        self.recorder.begin()?;
        self.frame.apply(&mut self.recorder, tile)?;
        self.recorder.finish()?;
        self.frame.share_occlusion(occlusion);
        self.progress.inc(1);
        Ok(())
    }

    /// Tone settings for the tiles. Values that depend on the whole image come from the overview.
    fn tone(
        &mut self,
        settings: &FrameSettings,
    ) -> Result<crate::passes::picture::tone_map::ToneSettings> {
        let mut tone = settings.tone;
        if let Scale::Average { key, least } = tone.scale {
            let average = self.read(|frame| frame.average_luminance())?.floats()[0];
            let average = (f64::from(average) * 1e3).max(least);
            self.average = Some(average);
            // As in the tone mapping pass: irradiance is exposed as such, not as white paper.
            let paper = if tone.show == Show::Irradiance {
                std::f64::consts::PI
            } else {
                1.0
            };
            tone.scale = Scale::Fixed(key / average * paper);
        }
        if let Some(colours) = &mut tone.false_colour
            && self.job.settings.false_colour_range.is_none()
        {
            let texels = self.read(Frame::radiance)?.rgba();
            let luminance = |t: &[f32; 4]| luminance(glam::Vec3::from_slice(t).as_dvec3()) * 1e3;
            let around = Range::around(texels.iter().map(luminance));
            colours.range = around.unwrap_or(colours.range);
        }
        Ok(tone)
    }

    fn read(&mut self, image: impl FnOnce(&Frame) -> &Image) -> Result<Pixels> {
        Ok(read_back(&mut self.recorder, image(&self.frame))?)
    }

    fn draw_sample(&mut self, index: u32) -> Result<()> {
        self.recorder.begin()?;
        self.frame.record(
            &mut self.recorder,
            &self.job.daylight,
            &self.job.camera,
            index,
        );
        Ok(self.recorder.finish()?)
    }

    /// Draws one row of tiles and stitches their `image`, with `each` values per pixel.
    fn band<T: Copy + Default>(
        &mut self,
        band: &Span,
        image: impl Fn(&Frame) -> &Image,
        texels: impl Fn(Pixels) -> Vec<T>,
        each: usize,
    ) -> Result<Vec<T>> {
        let width = self.plan.full.x as usize * each;
        let mut whole = vec![T::default(); width * band.count as usize];
        for column in self.plan.columns.clone() {
            self.frame.set_tile(self.plan.window(&column, band));
            for index in 0..self.job.settings.samples {
                self.draw_sample(index)?;
            }
            let drawn = texels(self.read(&image)?);
            let drawn_width = self.plan.tile.x as usize * each;
            let skip = (column.first - column.origin) as usize * each;
            let count = column.count as usize * each;
            for row in 0..band.count as usize {
                let from = (row + (band.first - band.origin) as usize) * drawn_width + skip;
                let to = row * width + column.first as usize * each;
                whole[to..to + count].copy_from_slice(&drawn[from..from + count]);
            }
            self.progress.inc(1);
        }
        Ok(whole)
    }

    /// Writes a PNG; the summary has size and exposure.
    ///
    /// # Errors
    /// Any error up to writing the file; an existing file is then left unchanged.
    pub fn save_png(mut self, path: &Path) -> Result<Saved> {
        let settings = &self.job.settings;
        if settings.false_colour.is_some() {
            let what = "--false-colour draws its legend on whole pictures; choose a smaller --size, or a larger --tile";
            return Err(Error::usage(what));
        }
        let ev100 = self.ev100();
        let mut metadata = self.job.metadata();
        metadata.extend(ev100.map(|ev| ("ev100 used".into(), format!("{ev:.3}"))));
        let encoding = settings.gamma.map_or(Encoding::Srgb, Encoding::Gamma);
        let mut rows = PngRows::new(path, self.plan.full.to_array(), encoding, &metadata)?;
        for band in self.plan.bands.clone() {
            rows.push(&self.band(&band, Frame::display, |p| p.bytes, 4)?)?;
        }
        rows.finish()?;
        let exposure = ev100.map_or(String::new(), |ev| format!(", EV100 {ev:.2}"));
        Ok(Saved {
            summary: self.summary(&exposure),
            metadata,
        })
    }

    /// EV100 used; `None` for quantities that are not exposed.
    fn ev100(&self) -> Option<f64> {
        let settings = &self.job.settings;
        if settings.scale.is_some() || settings.show.file_unit() == 1.0 {
            return None;
        }
        settings.ev100.or_else(|| self.average.map(automatic))
    }

    /// Writes an EXR of these quantities, the image first; the summary has size and layers.
    ///
    /// # Errors
    /// Any error up to writing the file; an existing file is then left unchanged.
    pub fn save_exr(mut self, path: &Path, shows: &[Show], kinds: &[LayerKind]) -> Result<Saved> {
        let metadata = self.job.metadata();
        let mut bands = self.plan.bands.clone().into_iter();
        let size = self.plan.full.to_array();
        write_exr_rows(path, size, kinds, &metadata, || {
            let Some(band) = bands.next() else {
                return Ok(Vec::new());
            };
            let layers = shows
                .iter()
                .map(|show| self.layer(*show, &band, shows.len() > 1));
            layers.collect()
        })?;
        Ok(Saved {
            summary: self.summary(&format!(", {} layer(s)", kinds.len())),
            metadata,
        })
    }

    /// One quantity in a row of tiles, in the file's unit.
    fn layer(&mut self, show: Show, band: &Span, switches: bool) -> Result<Vec<[f32; 4]>> {
        if switches {
            self.frame.show(show)?;
        }
        let unit = show.file_unit();
        let texels = |pixels: Pixels| pixels.rgba();
        let mut texels = self.band(band, Frame::radiance, texels, 1)?;
        for texel in &mut texels {
            *texel = texel.map(|v| v * unit);
        }
        Ok(texels)
    }

    fn summary(&self, more: &str) -> String {
        self.progress.finish_and_clear();
        let [width, height] = self.plan.full.to_array();
        let tiles = self.plan.bands.len() * self.plan.columns.len();
        format!("{width}x{height} in {tiles} tiles{more}")
    }
}

/// Largest number of samples whose occlusion is kept; later samples reuse them cyclically.
const MAX_OCCLUSION_IMAGES: usize = 16;
