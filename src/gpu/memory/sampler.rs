//! The few ways in which images are looked up.

use ash::vk;

use crate::gpu::error::{During, Result};

/// How an image is looked up.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sampler {
    /// Nearest texel, clamped.
    Nearest,
    /// Bilinear (cubes: seamless), clamped, trilinear where there are mip levels.
    Linear,
    /// Trilinear, repeating: surface textures.
    Repeat,
}

const SAMPLERS: [Sampler; 3] = [Sampler::Nearest, Sampler::Linear, Sampler::Repeat];

impl Sampler {
    /// How many there are.
    pub(in crate::gpu) const COUNT: usize = SAMPLERS.len();
}

/// All of them, in the order of [`Sampler`].
pub(in crate::gpu) fn create_all(device: &ash::Device) -> Result<[vk::Sampler; Sampler::COUNT]> {
    let mut samplers = [vk::Sampler::null(); Sampler::COUNT];
    for (slot, kind) in samplers.iter_mut().zip(SAMPLERS) {
        // SAFETY: the info has no pointers.
        *slot = unsafe { device.create_sampler(&sampler_info(kind), None) }
            .during("create a sampler")?;
    }
    Ok(samplers)
}

fn sampler_info(sampler: Sampler) -> vk::SamplerCreateInfo<'static> {
    let (filter, mipmap) = match sampler {
        Sampler::Nearest => (vk::Filter::NEAREST, vk::SamplerMipmapMode::NEAREST),
        Sampler::Linear | Sampler::Repeat => (vk::Filter::LINEAR, vk::SamplerMipmapMode::LINEAR),
    };
    let address = match sampler {
        Sampler::Repeat => vk::SamplerAddressMode::REPEAT,
        Sampler::Nearest | Sampler::Linear => vk::SamplerAddressMode::CLAMP_TO_EDGE,
    };
    vk::SamplerCreateInfo::default()
        .mag_filter(filter)
        .min_filter(filter)
        .mipmap_mode(mipmap)
        .address_mode_u(address)
        .address_mode_v(address)
        .address_mode_w(address)
        .max_lod(vk::LOD_CLAMP_NONE)
}
