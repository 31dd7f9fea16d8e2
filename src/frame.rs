//! The frame: owns the passes; [`Frame::record`] is the whole pipeline in reading order.

use std::sync::Arc;

use glam::{DVec2, UVec2, Vec2, Vec3};

use crate::daylight::sampling;
use crate::daylight::sky::Daylight;
use crate::daylight::sunlight::SUN_ANGULAR_RADIUS;
use crate::gpu::{Context, Image, Recorder, Result};
use crate::passes::accumulate::Accumulate;
use crate::passes::background::Background;
use crate::passes::exposure::Exposure;
use crate::passes::gbuffer::Gbuffer;
use crate::passes::geometry::Geometry;
use crate::passes::irradiance::{Irradiance, IrradianceSettings};
use crate::passes::lighting::{Light, Lighting, LightingSettings, Show};
use crate::passes::shadow::Shadow;
use crate::passes::shadow_fit;
use crate::passes::sky_cube::SkyCube;
use crate::passes::ssao::{Ssao, SsaoSettings};
use crate::passes::tone_map::{ToneMap, ToneSettings};
use crate::passes::view::View;
use crate::scene::{Camera, Scene};

/// Everything that is fixed while frames are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameSettings {
    /// Width and height, pixels.
    pub size: UVec2,
    /// Frames that are averaged into a picture; 1 samples pixel centres and the sun's centre.
    pub samples: u32,
    /// Edge of a face of the sky cube, texels.
    pub sky_edge: u32,
    /// The irradiance cube.
    pub irradiance: IrradianceSettings,
    /// Edge of the shadow map, texels.
    pub shadow_resolution: u32,
    /// Ambient occlusion.
    pub ssao: SsaoSettings,
    /// Lighting.
    pub lighting: LightingSettings,
    /// Display.
    pub tone: ToneSettings,
}

/// Where a frame samples the pixel and the sun's disc.
#[derive(Debug, Clone, Copy)]
struct Sample {
    jitter: Vec2,
    sun_direction: Vec3,
    phase: f32,
}

/// The passes, wired.
pub struct Frame {
    context: Arc<Context>,
    settings: FrameSettings,
    geometry: Geometry,
    sky_cube: SkyCube,
    irradiance: Irradiance,
    shadow: Shadow,
    gbuffer: Gbuffer,
    ssao: Ssao,
    lighting: Lighting,
    background: Background,
    accumulate: Option<Accumulate>,
    exposure: Exposure,
    tone_map: ToneMap,
}

impl Frame {
    /// Uploads the scene and makes the passes; `recorder` must be recording.
    ///
    /// # Errors
    /// When the device refuses or has no memory left.
    pub fn new(
        recorder: &mut Recorder,
        scene: &Scene,
        mut settings: FrameSettings,
    ) -> Result<Self> {
        let context = recorder.context().clone();
        let size = settings.size.to_array();
        let averaged = settings.samples > 1;
        let geometry = Geometry::new(recorder, scene)?;
        if !geometry.is_specular() {
            settings.lighting.specular_scale = 0.0;
        }
        Ok(Self {
            geometry,
            sky_cube: SkyCube::new(&context, settings.sky_edge)?,
            irradiance: Irradiance::new(recorder, settings.irradiance)?,
            shadow: Shadow::new(&context, settings.shadow_resolution)?,
            gbuffer: Gbuffer::new(&context, size)?,
            ssao: Ssao::new(&context, size, settings.ssao)?,
            lighting: Lighting::new(&context, size, settings.lighting)?,
            background: Background::new(&context, settings.lighting)?,
            accumulate: averaged
                .then(|| Accumulate::new(&context, size))
                .transpose()?,
            exposure: Exposure::new(&context)?,
            tone_map: ToneMap::new(&context, size, settings.tone)?,
            settings,
            context,
        })
    }

    /// Records frame number `index` of the picture (0 starts a new average).
    ///
    /// Sky, irradiance and shadow map are drawn only when their inputs changed.
    pub fn record(&mut self, rec: &mut Recorder, daylight: &Daylight, camera: &Camera, index: u32) {
        let sample = self.sample(daylight, index);
        let view = View {
            camera: *camera,
            size: self.settings.size,
            jitter: sample.jitter,
        };

        let sky = self.sky_cube.record(rec, daylight);
        let sky_irradiance = self.irradiance.record(rec, &sky, daylight);

        let (bounds, resolution) = (self.geometry.bounds(), self.shadow.resolution());
        let shadow_view = shadow_fit::fit(sample.sun_direction, bounds, &view, resolution);
        let shadow_map = self.shadow.record(rec, &self.geometry, &shadow_view);

        let surfaces = self.gbuffer.record(rec, &self.geometry, &view);
        let occlusion = self.ssao.record(rec, surfaces, &view, sample.phase);

        let light = Light {
            daylight,
            sun_direction: sample.sun_direction,
            shadow_view: &shadow_view,
            shadow_map,
            sky_irradiance,
            sky_radiance: sky.radiance,
        };
        let materials = self.geometry.materials();
        let frame = self
            .lighting
            .record(rec, surfaces, materials, occlusion, &light, &view);
        self.background
            .record(rec, &surfaces.depth, &light, &view, frame);
        let radiance = match &mut self.accumulate {
            Some(accumulate) => accumulate.record(rec, frame, index),
            None => frame,
        };

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
        Ok(())
    }

    /// The picture in kcd/m² (or the quantity shown), averaged over the samples.
    pub fn radiance(&self) -> &Image {
        match &self.accumulate {
            Some(accumulate) => accumulate.image(),
            None => self.lighting.image(),
        }
    }

    /// The picture in display values.
    pub fn display(&self) -> &Image {
        self.tone_map.image()
    }

    /// Refines the sky's irradiance without drawing a picture; `recorder` must be recording.
    pub fn record_light(&mut self, rec: &mut Recorder, daylight: &Daylight) {
        let sky = self.sky_cube.record(rec, daylight);
        self.irradiance.record(rec, &sky, daylight);
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

    fn sample(&self, daylight: &Daylight, index: u32) -> Sample {
        let centre = daylight.sun_direction.as_vec3();
        if self.settings.samples <= 1 {
            return Sample {
                jitter: Vec2::ZERO,
                sun_direction: centre,
                phase: 0.0,
            };
        }
        // Two stretches of one sequence, far apart, so that pixel and disc are not sampled in step.
        let pixel = sampling::r2(index) - 0.5;
        let disc = sampling::r2(index.wrapping_add(1 << 20));
        Sample {
            jitter: pixel.as_vec2(),
            sun_direction: on_disc(centre, disc),
            phase: sampling::radical_inverse(index) as f32,
        }
    }
}

/// A uniform point of the sun's disc for `xi` in the unit square.
fn on_disc(centre: Vec3, xi: DVec2) -> Vec3 {
    let radius = (xi.x.sqrt() * SUN_ANGULAR_RADIUS) as f32;
    let angle = (xi.y * std::f64::consts::TAU) as f32;
    let (tangent, bitangent) = centre.any_orthonormal_pair();
    (centre + radius * (angle.cos() * tangent + angle.sin() * bitangent)).normalize()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_disc_is_covered_and_not_left() {
        let centre = Vec3::new(0.3, 0.5, -0.8).normalize();
        let angles: Vec<f64> = (0..1000)
            .map(|i| f64::from(on_disc(centre, sampling::r2(i)).cross(centre).length()).asin())
            .collect();
        let largest = angles.iter().copied().fold(0.0, f64::max);
        assert!(largest <= SUN_ANGULAR_RADIUS * 1.001 && largest > SUN_ANGULAR_RADIUS * 0.97);
        // Uniform over the disc: half of the points lie within 1/sqrt(2) of the radius.
        let inner = angles
            .iter()
            .filter(|a| **a < SUN_ANGULAR_RADIUS / 2f64.sqrt())
            .count();
        assert!((450..550).contains(&inner), "{inner}");
    }
}
