//! Temporal accumulation: the running mean of frames in 32-bit floats, for anti-aliasing, soft shadows and less noise.

use std::sync::Arc;

use crate::gpu::{
    Context, Depth, Format, Image, ImageDesc, Load, Pipeline, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;

use crate::passes::{Screen, screen};

gpu_struct! {
    /// Number of frames.
    pub struct Push: push of ACCUMULATE_FRAG, ACCUMULATE_COMP {
        count: u32,
    }
}

/// The accumulation pass; it alternates between two images.
pub struct Accumulate {
    pipeline: Pipeline,
    means: [Image; 2],
}

impl Accumulate {
    /// Creates the pass for pictures of `size` pixels.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, size: [u32; 2]) -> Result<Self> {
        let format = Format::R32G32B32A32_SFLOAT;
        let shaders = Screen {
            fragment: &shaders::ACCUMULATE_FRAG,
            compute: &shaders::ACCUMULATE_COMP,
        };
        let pipeline = screen(context, "accumulate", shaders, &[format], Depth::Off, &[])?;
        let image = |name| {
            let desc = ImageDesc::flat(name, format, size);
            Image::new(context, &desc.target_by(context.route()))
        };
        Ok(Self {
            pipeline,
            means: [image("mean 0")?, image("mean 1")?],
        })
    }

    /// Adds frame number `index` of the picture; 0 starts a new mean.
    pub fn record(&mut self, recorder: &mut Recorder, frame: &Image, index: u32) -> &Image {
        let count = index + 1;
        self.means.swap(0, 1);
        let [new, old] = &self.means;
        recorder
            .pass("accumulate", &self.pipeline)
            .sample("frame", frame, Sampler::Nearest)
            .sample("previous_mean", old, Sampler::Nearest)
            .push(&Push { count })
            .output("mean", new, Load::Discard)
            .fill();
        new
    }

    /// The newest mean, in the unit of the frames.
    pub fn image(&self) -> &Image {
        &self.means[0]
    }
}
