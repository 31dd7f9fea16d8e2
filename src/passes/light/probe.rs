//! What is under one pixel: its luminance, and the surface with its illuminance.

use std::sync::Arc;

use glam::Vec3;

use crate::gpu::{Buffer, BufferKind, Context, Image, Recorder, Result, Texel, copy_texel};

use crate::passes::light::lighting::{Lighting, LightingSettings, Precision, Show};
use crate::passes::surfaces::gbuffer::{Surfaces, unpack_normal};

/// What one pixel shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Column and row.
    pub pixel: [u32; 2],
    /// Radiance of the picture, linear RGB, cd/m² (the quantity shown, in its unit, when that is another).
    pub radiance: [f32; 3],
    /// The surface, where there is one.
    pub surface: Option<SurfaceReading>,
}

/// A surface under a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceReading {
    /// Illuminance by sun and sky, linear RGB, lux.
    pub illuminance: [f32; 3],
    /// World normal on the viewer's side.
    pub normal: [f32; 3],
    /// ρ_d, linear RGB.
    pub albedo: [f32; 3],
    /// Distance along the view axis, metres.
    pub distance: f32,
    /// Number of the material in the scene.
    pub material: u32,
}

/// Texels that are copied: radiance, illuminance, words, depth.
const TEXELS: usize = 4;

/// The pass and where its texels arrive.
pub struct Probe {
    illuminance: Lighting,
    buffer: Buffer,
    asked: Option<Asked>,
}

/// What the texels in the buffer are.
#[derive(Clone, Copy)]
struct Asked {
    pixel: [u32; 2],
    texels: [Texel; TEXELS],
    /// Of scenes with maps.
    albedo: Option<Texel>,
    near: f32,
    unit: f32,
}

impl Probe {
    /// For pictures of `size` pixels.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn new(context: &Arc<Context>, size: [u32; 2], settings: LightingSettings) -> Result<Self> {
        let settings = LightingSettings {
            show: Show::Irradiance,
            precision: Precision::Half,
            ..settings
        };
        let bytes = ((TEXELS + 1) * Texel::SLOT_BYTES) as u64;
        Ok(Self {
            illuminance: Lighting::new(context, size, settings)?,
            buffer: Buffer::new(context, "probe", BufferKind::ReadBack, bytes)?,
            asked: None,
        })
    }

    /// Asks for one pixel. `light` draws the illuminance with the pass it is given, at this pixel alone.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        pixel: [u32; 2],
        (radiance, shown): (&Image, Show),
        surfaces: &Surfaces,
        near: f32,
        light: impl FnOnce(&mut Lighting, &mut Recorder),
    ) {
        light(&mut self.illuminance, recorder);
        let images = [
            radiance,
            self.illuminance.image(),
            &surfaces.normal_material,
            &surfaces.depth,
        ];
        let mut slot = 0;
        let mut copied = |image| {
            let texel = copy_texel(recorder, image, pixel, &self.buffer, slot);
            slot += 1;
            texel
        };
        let texels = images.map(&mut copied);
        let albedo = surfaces.albedo.as_ref().map(copied);
        self.asked = Some(Asked {
            pixel,
            texels,
            albedo,
            near,
            unit: shown.file_unit(),
        });
    }

    /// The answer, once the frame that asked is done. `diffuse` is ρ_d of a material.
    pub fn reading(&mut self, diffuse: impl FnOnce(u32) -> Vec3) -> Option<Reading> {
        let asked = self.asked.take()?;
        let [radiance, illuminance, words, depth] = asked.texels.map(|t| t.read(&self.buffer));
        let rgb = |t: [f32; 4], unit: f32| [t[0] * unit, t[1] * unit, t[2] * unit];
        // Halves of the words.
        let number = words[2] as u32;
        let albedo = match asked.albedo {
            Some(texel) => rgb(texel.read(&self.buffer), 1.0),
            None => diffuse(number).to_array(),
        };
        let surface = (depth[0] > 0.0).then(|| SurfaceReading {
            illuminance: rgb(illuminance, Show::Irradiance.file_unit()),
            normal: unpack_normal([words[0] as u16, words[1] as u16]),
            albedo,
            distance: asked.near / depth[0],
            material: number,
        });
        Some(Reading {
            pixel: asked.pixel,
            radiance: rgb(radiance, asked.unit),
            surface,
        })
    }
}
