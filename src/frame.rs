//! The frame owns the passes and records them in the order of the diagram on the first page of these docs.

mod ambient;
mod average;
mod change;
mod sample;
mod settings;
mod smooth;

use std::panic::resume_unwind;
use std::sync::Arc;
use std::thread::{self, ScopedJoinHandle};

pub use self::change::{Change, Replacement};
pub use self::sample::{Filter, Sampling, Visibility};
pub use self::settings::FrameSettings;
pub use self::smooth::AntiAliasing;

use glam::{UVec2, Vec3};

use crate::daylight::sky::Daylight;
use crate::gpu::{Context, Image, Recorder, Result};
use crate::passes::bounces::cells::{Cells, Surroundings, Work};
use crate::passes::bounces::tree::Tree;
use crate::passes::light::background::Background;
use crate::passes::light::lighting::Light;
use crate::passes::light::lobes::Lobes;
use crate::passes::light::panes::{BeforePicture, Panes};
use crate::passes::light::probe::{Probe, Reading};
use crate::passes::occlusion::ssao::Ssao;
use crate::passes::picture::exposure::Exposure;
use crate::passes::picture::tone_map::{ToneMap, ToneSettings};
use crate::passes::sky::air::Air;
use crate::passes::sky::cube::SkyCube;
use crate::passes::sky::irradiance::Irradiance;
use crate::passes::sky::specular::{SAMPLES, SpecularCube};
use crate::passes::surfaces::gbuffer::Gbuffer;
use crate::passes::surfaces::geometry::Geometry;
use crate::passes::view::{View, Window};
use crate::scene::{Camera, Scene};

use self::ambient::{AmbientInputs, AmbientPasses};
use self::average::{Average, Lit};
use self::smooth::Smooth;

/// Frames of an average after which a round of the cells follows.
const FRAMES_OF_ROUND: u32 = 4;

/// The work for the cells in frame number `index` of an average, after the frame `before`. The same seed gives the same picture, so an
/// average that does not follow a preview starts with new cells.
fn cell_work(index: Option<u32>, before: Option<Drawn>, refine: u32) -> Work {
    let follows_average = before.is_none_or(|drawn| drawn.index.is_some());
    match index {
        Some(0) if follows_average => Work::Anew,
        Some(index) => Work::Rounds(u32::from(index.is_multiple_of(FRAMES_OF_ROUND))),
        None => Work::Paths(refine),
    }
}

/// A scene and the passes that draw it.
pub struct Frame {
    context: Arc<Context>,
    settings: FrameSettings,
    geometry: Geometry,
    tree: Tree,
    /// Light on surfaces that rays meet, if any is shown.
    cells: Option<Cells>,
    sky_cube: SkyCube,
    irradiance: Irradiance,
    /// The air before the eye, if it is drawn.
    air: Option<Air>,
    gbuffer: Gbuffer,
    /// Panes of glass, if the scene has any.
    panes: Option<Panes>,
    /// The sky of materials that reflect by GGX, if the scene has any.
    sky_prefiltered: Option<SpecularCube>,
    /// Light in their lobes, if it is shown.
    lobes: Option<Lobes>,
    ambient: AmbientPasses,
    /// Shadow map and lighting of previews and of frames that the dome does not light.
    preview: Lit,
    background: Background,
    average: Average,
    exposure: Exposure,
    tone_map: ToneMap,
    smooth: Smooth,
    probe: Probe,
    drawn: Option<Drawn>,
    tiling: Tiling,
}

/// The newest frame.
#[derive(Clone, Copy)]
struct Drawn {
    /// Its number in an average; `None` for a preview.
    index: Option<u32>,
    view: View,
}

/// State for rendering a picture in tiles.
#[derive(Default)]
struct Tiling {
    /// The current tile; `None`: the frame is the whole picture.
    tile: Option<Window>,
    /// Ambient occlusion of the whole picture, one image per sample, because surfaces beyond the tile's edge occlude too.
    occlusion: Vec<Image>,
}

impl Tiling {
    /// Upper left corner of the frame in the picture, pixels.
    fn origin(&self) -> UVec2 {
        self.tile.map_or(UVec2::ZERO, |tile| tile.origin)
    }

    /// Shared ambient occlusion for sample `index`, if any. The images repeat if there are more samples than images.
    fn occlusion(&self, index: Option<u32>) -> Option<&Image> {
        let count = self.occlusion.len().max(1);
        self.occlusion.get(index.unwrap_or(0) as usize % count)
    }
}

impl Frame {
    /// Uploads the scene and creates the passes. `recorder` must be recording.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources. The recorded commands must then not be submitted.
    pub fn new(recorder: &mut Recorder, scene: &Scene, settings: FrameSettings) -> Result<Self> {
        let context = recorder.context().clone();
        let (device, asked) = (&context, settings);
        // Pipeline creation is slow, so other threads do it while the scene is uploaded.
        thread::scope(|scope| {
            let sky_cube = scope.spawn(move || SkyCube::new(device, asked.sky_edge));
            let tone_map = scope.spawn(move || asked.tone_map(device));
            let exposure = scope.spawn(move || Exposure::new(device));
            let geometry = Geometry::new(recorder, scene)?;
            let tree = Tree::new(recorder, scene)?;
            let (facts, rays) = (geometry.facts(), tree.facts());
            let settings = asked.for_scene(device, facts);
            let constants = rays.constants();
            let lighting = scope.spawn(move || settings.lighting(device, constants));
            let background = scope.spawn(move || settings.background(device));
            Ok(Self {
                ambient: AmbientPasses::new(device, &settings)?,
                gbuffer: settings.gbuffer(device, facts)?,
                panes: settings.panes(device, rays)?,
                sky_prefiltered: facts
                    .is_rough
                    .then(|| SpecularCube::new(recorder, SAMPLES, None))
                    .transpose()?,
                lobes: settings.lobes(device, rays)?,
                average: Average::new(device, facts, rays, &settings)?,
                cells: settings.cells(device, rays, facts)?,
                irradiance: Irradiance::new(recorder, settings.irradiance)?,
                air: settings.air(device, facts)?,
                preview: Lit {
                    shadow: settings.shadow(device, facts)?,
                    lighting: joined(lighting)?,
                },
                sky_cube: joined(sky_cube)?,
                background: joined(background)?,
                exposure: joined(exposure)?,
                tone_map: joined(tone_map)?,
                smooth: Smooth::new(device, &settings)?,
                probe: Probe::new(device)?,
                drawn: None,
                tiling: Tiling::default(),
                tree,
                geometry,
                settings,
                context: context.clone(),
            })
        })
    }

    /// Records frame number `index` of an average; 0 starts a new one.
    pub fn record(&mut self, rec: &mut Recorder, daylight: &Daylight, camera: &Camera, index: u32) {
        self.draw(rec, daylight, camera, (Some(index), None));
    }

    /// The same, with the shadows of another sun than that of the daylight: a unit vector toward it.
    pub fn record_under(
        &mut self,
        rec: &mut Recorder,
        daylight: &Daylight,
        sun: Vec3,
        camera: &Camera,
        index: u32,
    ) {
        self.draw(rec, daylight, camera, (Some(index), Some(sun)));
    }

    /// Records a frame outside of any average, for a moving view or light.
    pub fn preview(&mut self, rec: &mut Recorder, daylight: &Daylight, camera: &Camera) {
        self.draw(rec, daylight, camera, (None, None));
    }

    /// Records a frame.
    fn draw(
        &mut self,
        rec: &mut Recorder,
        daylight: &Daylight,
        camera: &Camera,
        (index, sun): (Option<u32>, Option<Vec3>),
    ) {
        if index.is_none() {
            self.gbuffer.turn();
            self.smooth.keep(rec, self.tone_map.image());
        }
        let view = self.light_up(rec, daylight, camera, (index, sun));
        self.drawn = Some(Drawn { index, view });
        self.expose(rec);
        let drawn = smooth::Drawn {
            display: self.tone_map.image(),
            gbuffer: &self.gbuffer,
            view: &view,
            daylight,
        };
        let frames = self.settings.samples;
        let average = index.filter(|_| self.settings.averages());
        self.smooth
            .record(rec, &drawn, average.map(|index| (index, frames)));
    }

    /// Records the picture in kcd/m² and returns its view. Sky, irradiance and shadow map are redrawn only when their inputs change.
    fn light_up(
        &mut self,
        rec: &mut Recorder,
        daylight: &Daylight,
        camera: &Camera,
        (index, sun): (Option<u32>, Option<Vec3>),
    ) -> View {
        let (geometry, settings) = (&self.geometry, &self.settings);
        let sample = self.smooth.sample(settings, daylight, index).under(sun);
        let view = sample.view(camera, settings.size, self.tiling.tile);
        let (Lit { shadow, lighting }, resolve) = self.average.frame(&mut self.preview, index);
        shadow.fit(geometry, &view, sample.sun_direction, sample.texel);

        // None of these passes reads another's images, so without a barrier in between they may overlap.
        rec.prepare(self.gbuffer.targets().chain(shadow.target()));
        let sky = self.sky_cube.record(rec, daylight);
        if let Some(cube) = &mut self.sky_prefiltered {
            cube.record(rec, &sky);
        }
        let air = self.air.as_mut();
        let air = air.map(|air| air.record(rec, daylight, view.camera.eye.y));
        let sky_irradiance = self.irradiance.record(rec, &sky, daylight);
        let (sun_views, shadow_map, sun_glass) = shadow.record(rec, geometry);
        let surfaces = self.gbuffer.record(rec, geometry, &view);
        let is_dome = resolve.is_dome();
        let are_seen = resolve.gathers() || !is_dome || self.lobes.is_some();
        if let Some(cells) = self.cells.as_mut().filter(|_| are_seen) {
            let around = Surroundings::new(&self.tree, &view, daylight, sky.radiance);
            let work = cell_work(index, self.drawn, settings.refine);
            cells.record(rec, &around, settings.cell_bounces(is_dome), work);
        }
        let inputs = AmbientInputs {
            surfaces,
            daylight,
            view: &view,
            cells: self.cells.as_ref(),
            of_picture: self.tiling.occlusion(index),
            phase: sample.phase,
        };
        let ambient = self.ambient.record(rec, &inputs, is_dome);
        let mut light = Light {
            daylight,
            sun_direction: sample.sun_direction,
            sun_views,
            shadow_map,
            traces: index.is_some(),
            sky_irradiance,
            sky_radiance: sky.radiance,
            air: air.unwrap_or_default(),
            panes: BeforePicture(self.panes.as_ref()),
            sun_glass,
            sky_prefiltered: self.sky_prefiltered.as_ref().map(SpecularCube::image),
            lobes: None,
        };
        let scene = (geometry, &self.tree, self.cells.as_ref());
        if let Some(lobes) = &mut self.lobes {
            let number = index.filter(|_| is_dome);
            light.lobes = lobes.record(rec, scene, (surfaces, ambient), &light, &view, number);
        }
        let solid = (geometry, &self.tree);
        if let Some(panes) = &self.panes {
            panes.record(rec, solid, &surfaces.depth, &light.surroundings(), &view);
        }
        let frame = lighting.record(rec, solid, surfaces, ambient, &light, &view);
        self.background
            .record(rec, &surfaces.depth, &light, &view, frame);
        resolve.record(rec, scene, frame, surfaces, &light, &view);
        view
    }

    /// Sets the adaptation rate of automatic exposure: the fraction of the difference in log luminance covered with each following
    /// picture. 1 (the default) adapts at once; [`crate::daylight::exposure::adaptation`] adapts smoothly.
    pub fn set_adaptation(&mut self, share: f64) {
        self.exposure.set_share(share as f32);
    }

    /// Exposes and tone maps the newest picture again, so that exposure adapts further, without anti-aliasing. `rec` must be recording.
    pub fn expose(&mut self, rec: &mut Recorder) {
        let radiance = self.radiance();
        let average = self.exposure.record(rec, radiance);
        self.tone_map
            .record(rec, radiance, average, self.tiling.origin());
        self.smooth.show_plain();
    }

    /// Tone maps the newest picture again with new settings, without anti-aliasing. `rec` must be recording, with no frame in flight.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources. The frame is then unchanged.
    pub fn retone(&mut self, rec: &mut Recorder, tone: ToneSettings) -> Result<()> {
        let settings = FrameSettings {
            tone,
            ..self.settings
        };
        let tone_map = settings.tone_map(&self.context)?;
        let smooth = Smooth::new(&self.context, &settings)?;
        let origin = self.tiling.origin();
        tone_map.record(rec, self.radiance(), self.exposure.image(), origin);
        self.tone_map = tone_map;
        self.smooth = smooth;
        self.settings = settings;
        Ok(())
    }

    /// Renders this tile of a larger picture from now on.
    pub fn set_tile(&mut self, tile: Window) {
        self.tiling.tile = Some(tile);
    }

    /// Takes the ambient occlusion image of the newest frame, if there is one. No frame may be in flight.
    ///
    /// # Errors
    /// Fails when the device is out of memory.
    pub fn take_occlusion(&mut self) -> Result<Option<Image>> {
        let AmbientPasses::Screen(ssao) = &mut self.ambient else {
            return Ok(None);
        };
        let size = self.settings.size.to_array();
        let next = Ssao::new(&self.context, size, self.settings.ssao)?;
        Ok(Some(std::mem::replace(&mut **ssao, next).into_image()))
    }

    /// Uses the ambient occlusion of the whole picture for tiles from now on, one image per sample.
    pub fn share_occlusion(&mut self, of_samples: Vec<Image>) {
        self.tiling.occlusion = of_samples;
    }

    /// Records the read-out of one pixel of the newest picture; [`Frame::picked`] returns it when the GPU has finished. Nothing is
    /// recorded for pixels outside the picture or before the first picture. With [`Visibility::Dome`] the illuminance is known only
    /// if [`DomeSettings::illuminance`](crate::passes::dome::gather::DomeSettings::illuminance) is set.
    pub fn pick(&mut self, rec: &mut Recorder, pixel: [u32; 2]) {
        let [width, height] = self.settings.size.to_array();
        let is_inside = pixel[0] < width && pixel[1] < height;
        let Some(drawn) = self.drawn.filter(|_| is_inside) else {
            return;
        };
        let picture = (
            newest(&self.average, &self.preview, self.drawn),
            self.settings.lighting.show,
        );
        self.probe.pick(
            rec,
            pixel,
            picture,
            self.gbuffer.surfaces(),
            drawn.view.camera.near,
        );
    }

    /// Returns the pixel of the last [`Frame::pick`], once.
    pub fn picked(&mut self) -> Option<Reading> {
        let geometry = &self.geometry;
        self.probe
            .reading(|material| [geometry.diffuse(material), geometry.emission(material)])
    }

    /// The newest picture in kcd/m² (or the quantity shown); for an average, the mean so far.
    pub fn radiance(&self) -> &Image {
        newest(&self.average, &self.preview, self.drawn)
    }

    /// The picture in display values, anti-aliased.
    pub fn display(&self) -> &Image {
        self.smooth.image().unwrap_or(self.tone_map.image())
    }

    /// Depth of the surfaces in the newest picture, or in its newest sample: reversed, 0 without a surface.
    pub fn depth(&self) -> &Image {
        &self.gbuffer.surfaces().depth
    }

    /// The log-average luminance of the newest picture, kcd/m², as one texel.
    pub fn average_luminance(&self) -> &Image {
        self.exposure.image()
    }

    /// Adds samples to the sky's irradiance without drawing a picture; `recorder` must be recording.
    pub fn record_light(&mut self, rec: &mut Recorder, daylight: &Daylight) {
        let sky = self.sky_cube.record(rec, daylight);
        self.irradiance.refine(rec, &sky, daylight);
    }

    /// Whether the sky's irradiance has all its samples.
    pub fn is_refined(&self) -> bool {
        self.irradiance.is_complete()
    }

    /// Samples of the sky's irradiance so far, and in total.
    pub fn irradiance_progress(&self) -> (u32, u32) {
        let settings = self.irradiance.settings();
        let wanted = if settings.method.is_sampled() {
            settings.samples
        } else {
            1
        };
        (self.irradiance.samples_done(), wanted)
    }

    /// Invalidates sky, irradiance and shadow map, so that the next frame redraws everything. For benchmarks.
    pub fn invalidate(&mut self) {
        self.sky_cube.invalidate();
        self.air.iter_mut().for_each(Air::invalidate);
        self.preview.shadow.invalidate();
    }

    /// Its settings, adjusted to the scene.
    pub fn settings(&self) -> &FrameSettings {
        &self.settings
    }

    /// The sky cube.
    pub fn sky_cube(&self) -> &SkyCube {
        &self.sky_cube
    }

    /// The cells, if any light is looked up in them.
    pub fn cells(&self) -> Option<&Cells> {
        self.cells.as_ref()
    }

    /// The irradiance cube.
    pub fn irradiance(&self) -> &Irradiance {
        &self.irradiance
    }
}

/// The newest picture.
fn newest<'a>(average: &'a Average, preview: &'a Lit, drawn: Option<Drawn>) -> &'a Image {
    let average = average
        .image()
        .filter(|_| drawn.is_some_and(|drawn| drawn.index.is_some()));
    average.unwrap_or(preview.lighting.image())
}

/// Joins a thread and returns its result.
fn joined<T>(thread: ScopedJoinHandle<'_, Result<T>>) -> Result<T> {
    // Propagates a panic of the thread.
    thread.join().unwrap_or_else(|panic| resume_unwind(panic))
}
