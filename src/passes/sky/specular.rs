//! The sky prefiltered for rough metals as a cube map, one mip level for each roughness; see [`crate::daylight::ggx`].
//!
//! A level is drawn into a cube of its own and copied: an image is in one state as a whole, and a level could not be written while
//! the others are read.

use std::sync::Arc;

use crate::daylight::ggx;
use crate::gpu::{
    Buffer, BufferKind, Context, Format, Image, ImageDesc, Recorder, Result, Sampler, shaders,
    upload_buffer,
};
use crate::gpu_struct;

use crate::passes::sky::cube::{SMOOTH_EDGE, SkyImages};
use crate::passes::sky::route::{CubePipeline, CubeRoute, CubeShaders};

gpu_struct! {
    /// Number of samples.
    pub struct Push: push of SPECULAR_FRAG, SPECULAR_COMP {
        count: u32,
    }
}

/// Edge of the first level, texels: that of the cube it is filtered from.
pub const EDGE: u32 = SMOOTH_EDGE;

/// Samples of a texel of the sky for lobes.
pub const SAMPLES: u32 = 64;

const FORMAT: Format = Format::R32G32B32A32_SFLOAT;

const SHADERS: CubeShaders = CubeShaders {
    fragment: &shaders::SPECULAR_FRAG,
    compute: &shaders::SPECULAR_COMP,
};

/// The pass and its cube.
pub struct SpecularCube {
    pipeline: CubePipeline,
    levels: Vec<Level>,
    cube: Image,
    is_drawn: bool,
}

/// One roughness: its cube, and the samples of its lobe.
struct Level {
    image: Image,
    samples: Buffer,
    count: u32,
}

impl SpecularCube {
    /// Creates the cubes and uploads the samples, `samples` for each texel. `route` is chosen by what the device supports if `None`.
    /// `recorder` must be recording.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(recorder: &mut Recorder, samples: u32, route: Option<CubeRoute>) -> Result<Self> {
        let context: Arc<Context> = recorder.context().clone();
        let route = route.unwrap_or_else(|| CubeRoute::of(&context));
        let count = ggx::levels(EDGE);
        let levels = (0..count)
            .map(|level| Level::new(recorder, level, ggx::roughness(level, count), samples))
            .collect::<Result<_>>()?;
        let desc = ImageDesc {
            levels: count,
            ..ImageDesc::cube("specular radiance", FORMAT, EDGE)
        };
        Ok(Self {
            pipeline: CubePipeline::new(&context, route, "specular", SHADERS, &[FORMAT], &[])?,
            levels,
            cube: Image::new(&context, &desc)?,
            is_drawn: false,
        })
    }

    /// Filters the sky if it is new. The cube has [`ggx::levels`] levels, kcd/m².
    pub fn record(&mut self, recorder: &mut Recorder, sky: &SkyImages<'_>) -> &Image {
        if sky.is_new || !self.is_drawn {
            for (index, level) in self.levels.iter().enumerate() {
                let pass = self
                    .pipeline
                    .pass(recorder, "specular")
                    .sample("sky_radiance", sky.smooth, Sampler::Linear)
                    .storage("Samples", &level.samples)
                    .push(&Push { count: level.count });
                self.pipeline
                    .fill(pass, &[("specular_radiance", &level.image)]);
                recorder.copy_to_level(&level.image, &self.cube, index as u32);
            }
            self.is_drawn = true;
        }
        &self.cube
    }

    /// The cube as last filtered, with [`ggx::levels`] levels, kcd/m².
    pub fn image(&self) -> &Image {
        &self.cube
    }

    /// The cube of one level, kcd/m².
    pub fn level(&self, level: usize) -> Option<&Image> {
        self.levels.get(level).map(|level| &level.image)
    }
}

impl Level {
    fn new(recorder: &mut Recorder, level: u32, roughness: f64, count: u32) -> Result<Self> {
        let samples = ggx::filtered_samples(roughness, count);
        let of_sample = |s: &crate::daylight::sample_count::FilteredSample| {
            s.direction
                .extend(s.level(SMOOTH_EDGE))
                .as_vec4()
                .to_array()
        };
        let table: Vec<[f32; 4]> = samples.iter().map(of_sample).collect();
        let bytes = bytemuck::cast_slice(&table);
        let desc = ImageDesc::cube("specular radiance of a level", FORMAT, EDGE >> level);
        Ok(Self {
            image: Image::new(recorder.context(), &desc)?,
            samples: upload_buffer(recorder, "specular samples", BufferKind::Storage, bytes)?,
            count: table.len() as u32,
        })
    }
}
