//! Metering for automatic exposure, and its adaptation over time. [`crate::daylight::exposure`] is the CPU counterpart.

use std::cell::Cell;
use std::sync::Arc;

use crate::daylight::exposure::{BINS_PER_STOP, BLACK, BOUND, FADE};
use crate::gpu::{Context, Format, Image, ImageDesc, Pipeline, Recorder, Result, Sampler, shaders};
use crate::gpu_struct;
use crate::passes::compute;

gpu_struct! {
    /// Metering and adaptation parameters.
    pub struct Push: push of EXPOSURE_COMP {
        black: f32,
        bins_per_stop: f32,
        bound: f32,
        fade: f32,
        share: f32,
    }
}

/// The metering pass and its images.
pub struct Exposure {
    pipeline: Pipeline,
    /// Luminances of the newest and the previous picture.
    luminances: [Image; 2],
    /// Index of the newest, if any.
    newest: Cell<Option<usize>>,
    share: f32,
}

impl Exposure {
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>) -> Result<Self> {
        let image = |name| {
            Image::new(
                context,
                &ImageDesc::flat(name, Format::R32G32B32A32_SFLOAT, [1, 1]).stored(),
            )
        };
        let pipeline = compute(context, "exposure", &shaders::EXPOSURE_COMP, &[])?;
        Ok(Self {
            pipeline,
            luminances: [image("average luminance 0")?, image("average luminance 1")?],
            newest: Cell::new(None),
            share: 1.0,
        })
    }

    /// Sets the adaptation rate: the fraction of the difference in log luminance covered with each following picture. 1 (the
    /// default) adapts at once.
    pub fn set_share(&mut self, share: f32) {
        self.share = share;
    }

    /// Computes the average luminance of a picture, kcd/m², as one texel.
    pub fn record(&self, recorder: &mut Recorder, radiance: &Image) -> &Image {
        let share = self.newest.get().map_or(1.0, |_| self.share);
        let [previous, new] = match self.newest.get() {
            Some(1) => [1, 0],
            _ => [0, 1],
        };
        self.newest.set(Some(new));
        let [previous, new] = [previous, new].map(|i| &self.luminances[i]);
        recorder
            .pass("exposure", &self.pipeline)
            .sample("radiance", radiance, Sampler::Nearest)
            .sample("previous_luminance", previous, Sampler::Nearest)
            .push(&Push {
                black: (BLACK / 1e3).log2() as f32,
                bins_per_stop: BINS_PER_STOP as f32,
                bound: BOUND as f32,
                fade: FADE as f32,
                share,
            })
            .store("average_luminance", new)
            .dispatch();
        new
    }

    /// The newest average luminance, kcd/m², as one texel; its second value is the change since the picture before, a factor.
    pub fn image(&self) -> &Image {
        &self.luminances[self.newest.get().unwrap_or(0)]
    }
}
