//! Read-out of one pixel: its radiance, and the surface with its illuminance.

use std::sync::Arc;

use glam::Vec3;

use crate::gpu::{Buffer, BufferKind, Context, Image, Recorder, Result, Texel, copy_texel};

use crate::passes::light::lighting::Show;
use crate::passes::surfaces::gbuffer::{Surfaces, unpack_normal};

/// Read-out of one pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reading {
    /// Column and row.
    pub pixel: [u32; 2],
    /// Radiance, linear RGB, cd/m²; if another quantity is shown, that quantity in its unit.
    pub radiance: [f32; 3],
    /// The surface, if any.
    pub surface: Option<SurfaceReading>,
}

/// The surface at a pixel; in an average, the one hit by the newest sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceReading {
    /// Illuminance, lux; the mean over the pixel.
    pub illuminance: f32,
    /// World normal on the viewer's side.
    pub normal: [f32; 3],
    /// ρ_d, linear RGB.
    pub albedo: [f32; 3],
    /// L_e, linear RGB, cd/m².
    pub emission: [f32; 3],
    /// Distance along the view axis, metres.
    pub distance: f32,
    /// Number of the material in the scene.
    pub material: u32,
}

/// Maximum number of texels copied: picture, normal and material, depth, ρ_d, factor on L_e.
const TEXELS: usize = 5;

/// Read-back buffer for the texels of one pixel.
pub struct Probe {
    buffer: Buffer,
    picked: Option<Picked>,
}

/// Layout of the texels in the buffer.
#[derive(Clone, Copy)]
struct Picked {
    pixel: [u32; 2],
    picture: Texel,
    words: Texel,
    depth: Texel,
    /// Only for scenes with maps.
    albedo: Option<Texel>,
    /// Only for scenes with emissive textures.
    emission: Option<Texel>,
    near: f32,
    shown: Show,
}

impl Probe {
    /// # Errors
    /// Fails when the device is out of memory.
    pub fn new(context: &Arc<Context>) -> Result<Self> {
        let bytes = (TEXELS * Texel::SLOT_BYTES) as u64;
        Ok(Self {
            buffer: Buffer::new(context, "probe", BufferKind::ReadBack, bytes)?,
            picked: None,
        })
    }

    /// Copies one pixel of a picture, whose fourth channel is the illuminance, and of its G-buffer. `near` is the distance of the
    /// near plane, metres.
    pub fn pick(
        &mut self,
        recorder: &mut Recorder,
        pixel: [u32; 2],
        (picture, shown): (&Image, Show),
        surfaces: &Surfaces,
        near: f32,
    ) {
        let mut slots = 0..;
        let mut copied = |image| {
            let slot = slots.next().unwrap_or_default();
            copy_texel(recorder, image, pixel, &self.buffer, slot)
        };
        self.picked = Some(Picked {
            pixel,
            picture: copied(picture),
            words: copied(&surfaces.normal_material),
            depth: copied(&surfaces.depth),
            albedo: surfaces.albedo.as_ref().map(&mut copied),
            emission: surfaces.emission.as_ref().map(copied),
            near,
            shown,
        });
    }

    /// Returns the picked pixel, once; the GPU must have finished. `of_material` returns ρ_d and L_e (cd/m²) of a material.
    pub fn reading(&mut self, of_material: impl FnOnce(u32) -> [Vec3; 2]) -> Option<Reading> {
        let picked = self.picked.take()?;
        let read = |texel: Texel| texel.read(&self.buffer);
        let [r, g, b, illuminance] = read(picked.picture);
        let (words, depth) = (read(picked.words), read(picked.depth)[0]);
        // `words` holds the halves of the 32-bit words; the number of the material has 24 bits.
        let material = words[2] as u32 | (words[3] as u32 & 0xff) << 16;
        let [diffuse, emission] = of_material(material);
        let texel = |texel: Texel| Vec3::from_slice(&read(texel));
        let albedo = picked.albedo.map_or(diffuse, texel);
        let emission = emission * picked.emission.map_or(Vec3::ONE, texel);
        let surface = (depth > 0.0).then(|| SurfaceReading {
            illuminance: illuminance * Show::Irradiance.file_unit(),
            normal: unpack_normal([words[0] as u16, words[1] as u16]),
            albedo: albedo.to_array(),
            emission: emission.to_array(),
            distance: picked.near / depth,
            material,
        });
        let unit = picked.shown.file_unit();
        Some(Reading {
            pixel: picked.pixel,
            radiance: [r, g, b].map(|value| value * unit),
            surface,
        })
    }
}
