//! Draws the picture and the user interface to the window.

use std::sync::Arc;

use glam::Vec2;

use crate::gpu::{
    Context, Format, Image, Load, Overlay, Pipeline, Recorder, Result, Sampler, UiFrame, shaders,
};
use crate::gpu_struct;

use crate::passes::fullscreen;

gpu_struct! {
    /// Size of the window.
    pub struct Push: push of PRESENT_FRAG {
        size: Vec2,
    }
}

/// The presentation pass.
pub struct Present {
    pipeline: Pipeline,
}

impl Present {
    /// Creates the pass for windows of an sRGB `format`.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, format: Format) -> Result<Self> {
        let pipeline = fullscreen(context, "present", &shaders::PRESENT_FRAG, format, &[])?;
        Ok(Self { pipeline })
    }

    /// Draws the display values, with the user interface on top.
    ///
    /// # Errors
    /// Fails when there is no memory left for the user interface.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        display: &Image,
        overlay: &mut Overlay,
        ui: &UiFrame,
        window: &Image,
    ) -> Result<()> {
        let [width, height] = window.size();
        let mut drawn = Ok(());
        recorder
            .pass("present", &self.pipeline)
            .sample("display", display, Sampler::Nearest)
            .push(&Push {
                size: Vec2::new(width as f32, height as f32),
            })
            .color(window, Load::Discard)
            .draws(|draws| {
                draws.triangle();
                drawn = overlay.draw(draws, ui);
            });
        drawn
    }
}
