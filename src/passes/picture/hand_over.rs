//! From the smoothed picture of a moving view to the converging one of a view at rest: a cross-fade of display values.

use std::sync::Arc;

use crate::gpu::{
    Context, Depth, Format, Image, Load, Pipeline, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;

use crate::passes::picture::temporal;
use crate::passes::{Screen, screen};

gpu_struct! {
    /// Weight of the moving view's picture.
    pub struct Push: push of HAND_OVER_FRAG, HAND_OVER_COMP, HAND_OVER_COMP_HALF {
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
        let shaders = Screen {
            fragment: &shaders::HAND_OVER_FRAG,
            compute: if is_linear {
                &shaders::HAND_OVER_COMP_HALF
            } else {
                &shaders::HAND_OVER_COMP
            },
        };
        Ok(Self {
            pipeline: screen(
                context,
                "hand over",
                shaders,
                &[format],
                Depth::Off,
                &constants,
            )?,
        })
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
            .output("picture", target, Load::Discard)
            .fill();
    }
}
