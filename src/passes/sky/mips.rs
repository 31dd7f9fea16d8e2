//! The mip levels of a cube of 32-bit floats: each texel is the mean of four. Drawn, not blitted: not every device filters such floats.

use std::sync::Arc;

use crate::gpu::{Context, Format, Image, ImageDesc, Recorder, Result, Sampler, shaders};
use crate::passes::sky::route::{CubePipeline, CubeRoute, CubeShaders};

const HALVED: CubeShaders = CubeShaders {
    fragment: &shaders::CUBE_HALVED_FRAG,
    compute: &shaders::CUBE_HALVED_COMP,
};

/// The pass that halves, and its images.
pub(in crate::passes::sky) struct Mips {
    pipeline: CubePipeline,
    /// Each half as large as the one before; the first is half as large as the cube.
    levels: Vec<Image>,
}

impl Mips {
    /// Creates the levels of a cube with faces of `edge` texels, a power of two.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, format: Format, edge: u32) -> Result<Self> {
        let route = CubeRoute::of(context);
        let level = |k| Image::new(context, &ImageDesc::cube("sky level", format, edge >> k));
        Ok(Self {
            pipeline: CubePipeline::new(context, route, "sky mips", HALVED, &[format], &[])?,
            levels: (1..=edge.ilog2()).map(level).collect::<Result<_>>()?,
        })
    }

    /// Fills the levels of `cube` from its first one.
    pub fn record(&self, recorder: &mut Recorder, cube: &Image) {
        let mut finer = cube;
        for level in &self.levels {
            let pass = self.pipeline.pass(recorder, "sky mips");
            let pass = pass.sample("finer", finer, Sampler::Nearest);
            self.pipeline.fill(pass, &[("coarser", level)]);
            finer = level;
        }
        for (k, level) in (1..).zip(&self.levels) {
            recorder.copy_to_level(level, cube, k);
        }
    }
}
