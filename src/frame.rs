//! The frame: owns the passes; [`Frame::record`] is the whole pipeline in reading order.

mod ask;
mod converging;
mod develop;
mod parts;
mod sample;
mod settings;

use std::panic::resume_unwind;
use std::sync::Arc;
use std::thread::{self, ScopedJoinHandle};

use glam::Vec3;

pub use self::sample::{Filter, Sampling, Visibility};
pub use self::settings::FrameSettings;

use crate::daylight::sky::Daylight;
use crate::gpu::{Context, Image, Recorder, Result};
use crate::passes::dome::fit::{self, Receivers};
use crate::passes::dome::gather::Gathered;
use crate::passes::light::background::Background;
use crate::passes::light::lighting::{Light, Lighting, Show};
use crate::passes::light::probe::Probe;
use crate::passes::occlusion::height_map::HeightMap;
use crate::passes::occlusion::ssao::Ssao;
use crate::passes::picture::accumulate::Accumulate;
use crate::passes::picture::exposure::Exposure;
use crate::passes::picture::tone_map::ToneMap;
use crate::passes::sky::cube::SkyCube;
use crate::passes::sky::irradiance::Irradiance;
use crate::passes::sun_shadow::cascades::SunViews;
use crate::passes::sun_shadow::map::Shadow;
use crate::passes::sun_shadow::receiver_mask;
use crate::passes::surfaces::gbuffer::Gbuffer;
use crate::passes::surfaces::geometry::Geometry;
use crate::passes::view::View;
use crate::scene::{Camera, Scene};

use self::converging::Converging;
use self::parts::Parts;
use self::sample::Sample;

/// What the newest frame was drawn with, for passes that look at it afterwards.
#[derive(Clone, Copy)]
struct Drawn {
    view: View,
    sun_direction: Vec3,
    sun_views: SunViews,
    /// Whether it is part of an average.
    is_averaged: bool,
}

/// Mip levels by which textures are sharpened where samples converge: each sees an eighth of the pixel's width.
const SHARPEN: f32 = 3.0;

/// The passes, wired.
pub struct Frame {
    context: Arc<Context>,
    settings: FrameSettings,
    geometry: Geometry,
    sky_cube: SkyCube,
    irradiance: Irradiance,
    shadow: Shadow,
    gbuffer: Gbuffer,
    cover: HeightMap,
    ssao: Ssao,
    lighting: Lighting,
    background: Background,
    accumulate: Option<Accumulate>,
    converging: Option<Converging>,
    exposure: Exposure,
    tone_map: ToneMap,
    probe: Option<Probe>,
    drawn: Option<Drawn>,
    parts: Parts,
}

impl Frame {
    /// Uploads the scene and makes the passes; `recorder` must be recording.
    ///
    /// # Errors
    /// When the device refuses or has no memory left.
    pub fn new(recorder: &mut Recorder, scene: &Scene, settings: FrameSettings) -> Result<Self> {
        let context = recorder.context().clone();
        let (device, asked, size) = (&context, settings, settings.size.to_array());
        // Drivers take their time to make pipelines: passes are made at the same time, while the scene is uploaded.
        thread::scope(|scope| {
            let sky_cube = scope.spawn(move || SkyCube::new(device, asked.sky_edge));
            let ssao = scope.spawn(move || Ssao::new(device, size, asked.ssao));
            let tone_map = scope.spawn(move || ToneMap::new(device, size, asked.tone));
            let exposure = scope.spawn(move || Exposure::new(device));
            let geometry = Geometry::new(recorder, scene)?;
            let settings = asked.for_scene(device, &geometry);
            let lighting = scope.spawn(move || Lighting::new(device, size, settings.lighting));
            let background = scope.spawn(move || Background::new(device, settings.lighting));
            Ok(Self {
                cover: HeightMap::new(device, &geometry)?,
                shadow: settings.shadow(device, &geometry)?,
                gbuffer: Gbuffer::new(device, &geometry, size, asked.converges())?,
                converging: Converging::new(device, &geometry, &settings)?,
                geometry,
                irradiance: Irradiance::new(recorder, settings.irradiance)?,
                accumulate: accumulate(device, &settings)?,
                sky_cube: made(sky_cube)?,
                ssao: made(ssao)?,
                lighting: made(lighting)?,
                background: made(background)?,
                exposure: made(exposure)?,
                tone_map: made(tone_map)?,
                probe: None,
                drawn: None,
                parts: Parts::default(),
                settings,
                context: context.clone(),
            })
        })
    }

    /// Takes over other settings: makes anew what they change, and keeps the rest (the scene, a sky that is drawn).
    /// `recorder` must be recording, with no frame in flight.
    ///
    /// # Errors
    /// When the device refuses or has no memory left; the frame is as it was, or partly new, and can be drawn.
    pub fn apply(&mut self, recorder: &mut Recorder, settings: FrameSettings) -> Result<()> {
        let (old, new) = (
            self.settings,
            settings.for_scene(&self.context, &self.geometry),
        );
        let context = self.context.clone();
        let size = new.size.to_array();
        let resized = new.size != old.size;
        if new.sky_edge != old.sky_edge {
            self.sky_cube = SkyCube::new(&context, new.sky_edge)?;
        }
        if new.irradiance != old.irradiance {
            self.irradiance = Irradiance::new(recorder, new.irradiance)?;
        }
        if new.shadow_maps() != old.shadow_maps() {
            self.shadow = new.shadow(&context, &self.geometry)?;
        }
        if resized || new.converges() != old.converges() {
            self.gbuffer = Gbuffer::new(&context, &self.geometry, size, new.converges())?;
        }
        if resized || new.ssao != old.ssao {
            self.ssao = Ssao::new(&context, size, new.ssao)?;
        }
        if resized || new.lighting != old.lighting {
            self.lighting = Lighting::new(&context, size, new.lighting)?;
            self.background = Background::new(&context, new.lighting)?;
            self.probe = None;
        }
        if resized || new.averages() != old.averages() {
            self.accumulate = accumulate(&context, &new)?;
        }
        if Converging::is_changed(&old, &new) {
            self.converging = Converging::new(&context, &self.geometry, &new)?;
        }
        if resized || new.tone != old.tone {
            self.tone_map = ToneMap::new(&context, size, new.tone)?;
        }
        self.drawn = None;
        self.settings = new;
        Ok(())
    }

    /// Records frame number `index` of the picture (0 starts a new average).
    ///
    /// Sky, irradiance and shadow map are drawn only when their inputs changed.
    pub fn record(&mut self, rec: &mut Recorder, daylight: &Daylight, camera: &Camera, index: u32) {
        self.draw(rec, daylight, camera, Some(index));
    }

    /// Records a frame that is no part of an average: while the view or the light moves.
    pub fn preview(&mut self, rec: &mut Recorder, daylight: &Daylight, camera: &Camera) {
        self.draw(rec, daylight, camera, None);
    }

    fn draw(
        &mut self,
        rec: &mut Recorder,
        daylight: &Daylight,
        camera: &Camera,
        index: Option<u32>,
    ) {
        let converging = self.converging.as_mut().filter(|_| index.is_some());
        let sun = daylight.sun_direction.as_vec3();
        let mut sample = match index {
            Some(index) if converging.is_some() || self.settings.averages() => {
                Sample::new(sun, index, &self.settings.sampling)
            }
            _ => Sample::central(sun),
        };
        let count = self.settings.lighting.shadows.cascades;
        if self.settings.lighting.shadows.penumbrae && converging.is_none() {
            // The map's lookup sees the whole disc: its points would be another disc.
            sample.sun_direction = sun;
        }
        let view = View {
            camera: *camera,
            size: self.settings.size,
            jitter: sample.jitter,
            sharpen: if converging.is_some() { SHARPEN } else { 0.0 },
            window: self.parts.window,
        };

        let (shadow, lighting, dome, fade) = match converging {
            Some(c) => {
                let fade = c.fade.as_mut().map(|fade| (fade, self.lighting.image()));
                (&mut c.shadow, &mut c.lighting, Some(&mut c.dome), fade)
            }
            None => (&mut self.shadow, &mut self.lighting, None, None),
        };
        let (bounds, casters) = (self.geometry.bounds(), self.geometry.casters());
        let resolution = shadow.resolution();
        let sun_views = match dome {
            Some(_) => {
                let receivers = Receivers::new(bounds, &view);
                let (sun, shift) = (sample.sun_direction, sample.texel);
                SunViews::one(fit::fit(sun, bounds, &receivers, resolution, shift))
            }
            None => {
                let sun = sample.sun_direction;
                let mut views = SunViews::fit(sun, bounds, casters, &view, resolution, count);
                let (eye, shadows) = (camera.eye, &self.settings.lighting.shadows);
                let seen = self.geometry.seen(&view);
                let drawn = shadow.drawn();
                if !drawn.is_some_and(|drawn| views.stay(drawn, seen, eye, shadows)) {
                    let room = receiver_mask::room(bounds, eye);
                    let behind = view.from_behind(room);
                    views.shade(self.geometry.around(&behind), eye, room, shadows);
                }
                views
            }
        };

        // Nothing of these reads another's images: with no barrier in between they may run at the same time.
        let shadow_target = shadow.is_stale(&sun_views).then(|| shadow.image());
        rec.prepare(self.gbuffer.surfaces().images().chain(shadow_target));
        let sky = self.sky_cube.record(rec, daylight);
        let sky_irradiance = self.irradiance.record(rec, &sky, daylight);
        let shadow_map = shadow.record(rec, &self.geometry, &sun_views);
        let surfaces = self.gbuffer.record(rec, &self.geometry, &view);
        let occlusion = match &dome {
            Some(_) => self.ssao.image(),
            None => match self.parts.occlusion(index) {
                Some(of_whole) => of_whole,
                None => {
                    let cover = self
                        .cover
                        .record(rec, &self.geometry, self.settings.ssao.radius);
                    self.ssao.record(rec, surfaces, &view, cover, sample.phase)
                }
            },
        };

        let light = Light {
            daylight,
            sun_direction: sample.sun_direction,
            sun_views: &sun_views,
            shadow_map,
            sky_irradiance,
            sky_radiance: sky.radiance,
        };
        let materials = self.geometry.materials();
        let frame = lighting.record(rec, surfaces, materials, occlusion, &light, &view);
        self.background
            .record(rec, &surfaces.depth, &light, &view, frame);
        let radiance = match (dome, &mut self.accumulate, index) {
            (Some(dome), _, Some(index)) => {
                let gathered = Gathered {
                    surfaces,
                    materials,
                    frame,
                    sky_irradiance,
                    sky_radiance: sky.radiance,
                };
                let picture = dome.record(rec, &self.geometry, &gathered, daylight, &view, index);
                let is_previewed = self.drawn.is_some_and(|drawn| !drawn.is_averaged);
                match fade {
                    Some((fade, preview)) => {
                        fade.record(rec, preview, picture, index, is_previewed)
                    }
                    None => picture,
                }
            }
            (None, Some(accumulate), Some(index)) => accumulate.record(rec, frame, index),
            _ => frame,
        };
        self.drawn = Some(Drawn {
            view,
            sun_direction: sample.sun_direction,
            sun_views,
            is_averaged: index.is_some(),
        });

        let average = self.exposure.record(rec, radiance);
        self.tone_map.record(rec, radiance, average);
    }

    /// Shows something else from the next frame on.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn show(&mut self, show: Show) -> Result<()> {
        let context = self.context.clone();
        let size = self.settings.size.to_array();
        self.settings.lighting.show = show;
        self.settings.tone.show = show;
        self.lighting = Lighting::new(&context, size, self.settings.lighting)?;
        self.background = Background::new(&context, self.settings.lighting)?;
        self.tone_map = ToneMap::new(&context, size, self.settings.tone)?;
        self.converging = Converging::new(&context, &self.geometry, &self.settings)?;
        Ok(())
    }

    /// The picture in kcd/m² (or the quantity shown), averaged over the samples.
    pub fn radiance(&self) -> &Image {
        let is_averaged = self.drawn.is_some_and(|drawn| drawn.is_averaged);
        match (&self.converging, &self.accumulate) {
            (Some(converging), _) if is_averaged => converging.image(),
            (None, Some(accumulate)) if is_averaged => accumulate.image(),
            _ => self.lighting.image(),
        }
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

    /// The picture in display values.
    pub fn display(&self) -> &Image {
        self.tone_map.image()
    }

    /// Refines the sky's irradiance without drawing a picture; `recorder` must be recording.
    pub fn record_light(&mut self, rec: &mut Recorder, daylight: &Daylight) {
        let sky = self.sky_cube.record(rec, daylight);
        self.irradiance.refine(rec, &sky, daylight);
    }

    /// Whether the sky's irradiance has all its samples.
    pub fn is_refined(&self) -> bool {
        self.irradiance.is_complete()
    }

    /// Forgets sky, irradiance and shadow map, so that the next frame draws everything: for measurements.
    pub fn invalidate(&mut self) {
        self.sky_cube.invalidate();
        self.shadow.invalidate();
    }

    /// How it was set.
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

    /// The log-average luminance of the last picture: one texel, kcd/m².
    pub fn average_luminance(&self) -> &Image {
        self.exposure.image()
    }
}

/// What a thread made.
fn made<T>(thread: ScopedJoinHandle<'_, Result<T>>) -> Result<T> {
    // A fault of this program is one on this thread too.
    thread.join().unwrap_or_else(|fault| resume_unwind(fault))
}

/// The mean over frames, where more than one is asked for.
fn accumulate(context: &Arc<Context>, settings: &FrameSettings) -> Result<Option<Accumulate>> {
    settings
        .averages()
        .then(|| Accumulate::new(context, settings.size.to_array()))
        .transpose()
}
