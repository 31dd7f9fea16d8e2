//! From the smoothed picture of a moving view to the converging one of a view at rest: a cross-fade of display values.

use std::sync::Arc;

use crate::gpu::{Context, Format, Image, Load, Pipeline, Recorder, Result, Sampler, shaders};
use crate::gpu_struct;

use crate::passes::fullscreen;
use crate::passes::picture::temporal;

gpu_struct! {
    /// Weight of the moving view's picture.
    pub struct Push: push of HAND_OVER_FRAG {
        share: f32,
        shift: f32,
    }
}

/// The pass; its caller owns the pictures.
pub struct HandOver {
    pipeline: Pipeline,
}

impl HandOver {
    /// Creates the pass for pictures of this format; `is_linear`: display values are linear, else encoded.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, format: Format, is_linear: bool) -> Result<Self> {
        let constants = [("LINEAR", is_linear.into())];
        let shader = &shaders::HAND_OVER_FRAG;
        let pipeline = fullscreen(context, "hand over", shader, format, &constants)?;
        Ok(Self { pipeline })
    }

    /// Draws `display` with the given share of `before`, 0..=1. With 0 it is a copy.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        (display, before, target): (&Image, &Image, &Image),
        share: f32,
        number: u32,
    ) {
        recorder
            .pass("hand over", &self.pipeline)
            .sample("display", display, Sampler::Nearest)
            .sample("before", before, Sampler::Nearest)
            .push(&Push {
                share,
                shift: temporal::shift(number),
            })
            .color(target, Load::Discard)
            .draw();
    }
}
