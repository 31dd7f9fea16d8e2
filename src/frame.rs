//! The frame: owns the passes, and draws them in the order of the diagram on the first page of these docs.

mod average;
mod sample;
mod settings;

use std::panic::resume_unwind;
use std::sync::Arc;
use std::thread::{self, ScopedJoinHandle};

pub use self::sample::{Filter, Sampling, Visibility};
pub use self::settings::FrameSettings;

use crate::daylight::sky::Daylight;
use crate::gpu::{Context, Image, Recorder, Result};
use crate::passes::light::background::Background;
use crate::passes::light::lighting::{Light, Show};
use crate::passes::light::probe::{Probe, Reading};
use crate::passes::occlusion::height_map::HeightMap;
use crate::passes::occlusion::ssao::Ssao;
use crate::passes::picture::exposure::Exposure;
use crate::passes::picture::tone_map::{ToneMap, ToneSettings};
use crate::passes::sky::cube::SkyCube;
use crate::passes::sky::irradiance::Irradiance;
use crate::passes::surfaces::gbuffer::Gbuffer;
use crate::passes::surfaces::geometry::Geometry;
use crate::passes::view::{View, Window};
use crate::scene::{Camera, Scene};

use self::average::{Average, Lit};
use self::sample::Sample;

/// A scene and the passes that draw it.
pub struct Frame {
    context: Arc<Context>,
    settings: FrameSettings,
    geometry: Geometry,
    sky_cube: SkyCube,
    irradiance: Irradiance,
    gbuffer: Gbuffer,
    height_map: HeightMap,
    ssao: Ssao,
    /// Of single frames: previews, and those that the dome does not light.
    preview: Lit,
    background: Background,
    average: Average,
    exposure: Exposure,
    tone_map: ToneMap,
    probe: Probe,
    drawn: Option<Drawn>,
    tiling: Tiling,
}

/// The newest frame.
#[derive(Clone, Copy)]
struct Drawn {
    /// Its number in an average; none of a preview.
    index: Option<u32>,
    view: View,
}

/// What a tile has from the picture that it is cut from.
#[derive(Default)]
struct Tiling {
    /// The tile; without one the frame is the whole picture.
    tile: Option<Window>,
    /// Ambient occlusion of the whole picture, by sample: surfaces beyond the tile's edge occlude too.
    occlusion: Vec<Image>,
}

impl Tiling {
    /// Ambient occlusion for sample `index`, if the tiles share it; images repeat where there are more samples.
    fn occlusion(&self, index: Option<u32>) -> Option<&Image> {
        let count = self.occlusion.len().max(1);
        self.occlusion.get(index.unwrap_or(0) as usize % count)
    }
}

impl Frame {
    /// Uploads the scene and makes the passes; `recorder` must be recording.
    ///
    /// # Errors
    /// When the device refuses or has no memory left: what was recorded must not be submitted then.
    pub fn new(recorder: &mut Recorder, scene: &Scene, settings: FrameSettings) -> Result<Self> {
        let context = recorder.context().clone();
        let (device, asked) = (&context, settings);
        // Drivers take their time to make pipelines: other threads do it while the scene is uploaded.
        thread::scope(|scope| {
            let sky_cube = scope.spawn(move || SkyCube::new(device, asked.sky_edge));
            let ssao = scope.spawn(move || asked.ssao(device));
            let tone_map = scope.spawn(move || asked.tone_map(device));
            let exposure = scope.spawn(move || Exposure::new(device));
            let geometry = Geometry::new(recorder, scene)?;
            let settings = asked.for_scene(device, &geometry);
            let lighting = scope.spawn(move || settings.lighting(device));
            let background = scope.spawn(move || settings.background(device));
            Ok(Self {
                height_map: HeightMap::new(device, &geometry)?,
                gbuffer: settings.gbuffer(device, &geometry)?,
                average: Average::new(device, &geometry, &settings)?,
                irradiance: Irradiance::new(recorder, settings.irradiance)?,
                preview: Lit {
                    shadow: settings.shadow(device, &geometry)?,
                    lighting: joined(lighting)?,
                },
                sky_cube: joined(sky_cube)?,
                ssao: joined(ssao)?,
                background: joined(background)?,
                exposure: joined(exposure)?,
                tone_map: joined(tone_map)?,
                probe: Probe::new(device)?,
                drawn: None,
                tiling: Tiling::default(),
                geometry,
                settings,
                context: context.clone(),
            })
        })
    }

    /// Takes over other settings: remakes the passes that depend on what differs, and keeps the others with what they have drawn.
    /// `recorder` must be recording, with no frame in flight.
    ///
    /// # Errors
    /// When the device refuses or has no memory left. The frame is as it was then; what was recorded must not be submitted.
    pub fn apply(&mut self, recorder: &mut Recorder, settings: FrameSettings) -> Result<()> {
        let settings = settings.for_scene(&self.context, &self.geometry);
        let differs = settings.irradiance != self.settings.irradiance;
        let irradiance = remade(differs, || Irradiance::new(recorder, settings.irradiance))?;
        self.remake(settings, irradiance)
    }

    /// Shows something else from the next frame on.
    ///
    /// # Errors
    /// When the device refuses or has no memory left; the frame is as it was then.
    pub fn show(&mut self, show: Show) -> Result<()> {
        let mut settings = self.settings;
        (settings.lighting.show, settings.tone.show) = (show, show);
        self.remake(settings, None)
    }

    /// Makes the passes that other settings need, then swaps all of them in: nothing changes when one fails.
    fn remake(&mut self, new: FrameSettings, irradiance: Option<Irradiance>) -> Result<()> {
        let (old, device, geometry) = (&self.settings, &self.context, &self.geometry);
        let is_resized = new.size != old.size;
        let is_lit = is_resized || new.lighting != old.lighting;
        let is_new_gbuffer = is_resized || new.converges() != old.converges();
        let is_new_shadow = new.shadow_map() != old.shadow_map();
        let is_new_average = Average::is_changed(old, &new);
        let sky_edge = new.sky_edge;
        let sky_cube = remade(sky_edge != old.sky_edge, || SkyCube::new(device, sky_edge))?;
        let gbuffer = remade(is_new_gbuffer, || new.gbuffer(device, geometry))?;
        let ssao = remade(is_resized || new.ssao != old.ssao, || new.ssao(device))?;
        let shadow = remade(is_new_shadow, || new.shadow(device, geometry))?;
        let lighting = remade(is_lit, || new.lighting(device))?;
        let background = remade(new.lighting != old.lighting, || new.background(device))?;
        let average = remade(is_new_average, || Average::new(device, geometry, &new))?;
        let tone_map = remade(is_resized || new.tone != old.tone, || new.tone_map(device))?;

        // From here on nothing fails.
        replace(&mut self.sky_cube, sky_cube);
        replace(&mut self.irradiance, irradiance);
        replace(&mut self.gbuffer, gbuffer);
        replace(&mut self.ssao, ssao);
        replace(&mut self.preview.shadow, shadow);
        replace(&mut self.preview.lighting, lighting);
        replace(&mut self.background, background);
        replace(&mut self.average, average);
        replace(&mut self.tone_map, tone_map);
        self.settings = new;
        self.drawn = None;
        Ok(())
    }

    /// Records frame number `index` of an average; 0 starts a new one.
    pub fn record(&mut self, rec: &mut Recorder, daylight: &Daylight, camera: &Camera, index: u32) {
        self.draw(rec, daylight, camera, Some(index));
    }

    /// Records a frame that is no part of an average: while the view or the light moves.
    pub fn preview(&mut self, rec: &mut Recorder, daylight: &Daylight, camera: &Camera) {
        self.draw(rec, daylight, camera, None);
    }

    /// The frame. Sky, irradiance and shadow map are drawn only when their inputs changed.
    fn draw(
        &mut self,
        rec: &mut Recorder,
        daylight: &Daylight,
        camera: &Camera,
        index: Option<u32>,
    ) {
        let (geometry, settings) = (&self.geometry, &self.settings);
        let sample = Sample::of(settings, daylight, index);
        let view = sample.view(camera, settings.size, self.tiling.tile);
        let (Lit { shadow, lighting }, resolve) = self.average.frame(&mut self.preview, index);
        shadow.fit(geometry, &view, sample.sun_direction, sample.texel);

        // None of these reads another's images: without a barrier in between they may run at the same time.
        rec.prepare(self.gbuffer.surfaces().images().chain(shadow.target()));
        let sky = self.sky_cube.record(rec, daylight);
        let sky_irradiance = self.irradiance.record(rec, &sky, daylight);
        let (sun_views, shadow_map) = shadow.record(rec, geometry);
        let surfaces = self.gbuffer.record(rec, geometry, &view);
        let occlusion = match self.tiling.occlusion(index) {
            Some(of_picture) => of_picture,
            // It is bound, but not read.
            None if resolve.is_dome() => self.ssao.image(),
            None => {
                let above = self.height_map.record(rec, geometry, settings.ssao.radius);
                self.ssao.record(rec, surfaces, &view, above, sample.phase)
            }
        };
        let light = Light {
            daylight,
            sun_direction: sample.sun_direction,
            sun_views,
            shadow_map,
            sky_irradiance,
            sky_radiance: sky.radiance,
        };
        let materials = geometry.materials();
        let frame = lighting.record(rec, surfaces, materials, occlusion, &light, &view);
        self.background
            .record(rec, &surfaces.depth, &light, &view, frame);
        let radiance = resolve.record(rec, geometry, frame, surfaces, &light, &view);
        let average = self.exposure.record(rec, radiance);
        self.tone_map.record(rec, radiance, average);
        self.drawn = Some(Drawn { index, view });
    }

    /// Sets the share of the way, in log luminance, that an automatic exposure moves toward that of each following picture: 1 (the
    /// default) adapts at once, [`crate::daylight::exposure::adaptation`] smoothly.
    pub fn set_adaptation(&mut self, share: f64) {
        self.exposure.set_share(share as f32);
    }

    /// Exposes the newest picture again, which adapts the exposure further. `rec` must be recording.
    pub fn expose(&self, rec: &mut Recorder) {
        let radiance = self.radiance();
        let average = self.exposure.record(rec, radiance);
        self.tone_map.record(rec, radiance, average);
    }

    /// Tone maps the newest picture again, by other settings. `rec` must be recording, with no frame in flight.
    ///
    /// # Errors
    /// When the device refuses or has no memory left; the frame is as it was then.
    pub fn retone(&mut self, rec: &mut Recorder, tone: ToneSettings) -> Result<()> {
        let settings = FrameSettings {
            tone,
            ..self.settings
        };
        let tone_map = settings.tone_map(&self.context)?;
        tone_map.record(rec, self.radiance(), self.exposure.image());
        self.tone_map = tone_map;
        self.settings = settings;
        Ok(())
    }

    /// Draws this tile of a picture from now on.
    pub fn set_tile(&mut self, tile: Window) {
        self.tiling.tile = Some(tile);
    }

    /// Gives away the ambient occlusion of the newest frame. No frame may be in flight.
    ///
    /// # Errors
    /// When the device has no memory left.
    pub fn take_occlusion(&mut self) -> Result<Image> {
        let next = self.settings.ssao(&self.context)?;
        Ok(std::mem::replace(&mut self.ssao, next).into_image())
    }

    /// Lights tiles by the ambient occlusion of the whole picture from now on, an image for each sample.
    pub fn share_occlusion(&mut self, of_samples: Vec<Image>) {
        self.tiling.occlusion = of_samples;
    }

    /// Records the read-out of one pixel of the newest picture; [`Frame::picked`] has it when the work is done. Nothing is
    /// recorded outside of the picture, and before the first. The illuminance of [`Visibility::Dome`] is known with
    /// [`DomeSettings::illuminance`](crate::passes::dome::gather::DomeSettings::illuminance) only.
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

    /// The pixel of the last [`Frame::pick`], once.
    pub fn picked(&mut self) -> Option<Reading> {
        let geometry = &self.geometry;
        self.probe.reading(|material| geometry.diffuse(material))
    }

    /// The newest picture in kcd/m² (or the quantity shown): of an average its mean so far.
    pub fn radiance(&self) -> &Image {
        newest(&self.average, &self.preview, self.drawn)
    }

    /// The picture in display values.
    pub fn display(&self) -> &Image {
        self.tone_map.image()
    }

    /// The log-average luminance of the newest picture: one texel, kcd/m².
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

    /// Samples of the sky's irradiance so far, and in all.
    pub fn irradiance_progress(&self) -> (u32, u32) {
        let settings = self.irradiance.settings();
        let wanted = if settings.method.is_sampled() {
            settings.samples
        } else {
            1
        };
        (self.irradiance.samples_done(), wanted)
    }

    /// Forgets sky, irradiance and shadow map, so that the next frame draws everything: for measurements.
    pub fn invalidate(&mut self) {
        self.sky_cube.invalidate();
        self.preview.shadow.invalidate();
    }

    /// Its settings, as the scene has them.
    pub fn settings(&self) -> &FrameSettings {
        &self.settings
    }

    /// The sky cube.
    pub fn sky_cube(&self) -> &SkyCube {
        &self.sky_cube
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

/// A pass that is made again if something of its settings differs.
fn remade<T>(differs: bool, make: impl FnOnce() -> Result<T>) -> Result<Option<T>> {
    differs.then(make).transpose()
}

/// Swaps a pass for the one that was made again, if any.
fn replace<T>(pass: &mut T, remade: Option<T>) {
    if let Some(remade) = remade {
        *pass = remade;
    }
}

/// The result of a thread.
fn joined<T>(thread: ScopedJoinHandle<'_, Result<T>>) -> Result<T> {
    // A panic there is one here too.
    thread.join().unwrap_or_else(|panic| resume_unwind(panic))
}
