//! Draws the picture and the user interface to the window, encoded for its format.

use std::sync::Arc;

use glam::Vec2;

use crate::daylight::hdr::{PAPER_WHITE, PQ_PEAK, SCRGB_WHITE};
use crate::gpu::{
    Context, Encoding, Format, Image, ImageDesc, Load, Output, Overlay, Pipeline, Recorder, Result,
    Sampler, UiFrame, shaders,
};
use crate::gpu_struct;

use crate::passes::fullscreen;
use crate::passes::picture::tone_map::is_linear;

gpu_struct! {
    /// Parameters of the presentation.
    pub struct Push: push of PRESENT_FRAG {
        size: Vec2,
        white: f32,
        is_linear: u32,
    }
}

/// The presentation pass.
///
/// Where the window's format encodes, the user interface is blended over the picture in the window itself. Else it is drawn to an image of its
/// own, and the pass blends linear values, as such a format would, and encodes them: so the panel looks the same on all screens.
pub struct Present {
    pipeline: Pipeline,
    output: Output,
    context: Arc<Context>,
    /// The user interface alone, unless the window's format encodes.
    layer: Option<Image>,
}

/// Format of the target that the user interface is drawn to, see [`Overlay::new`]. It is the same for all outputs of a window: that of the
/// output that it has without HDR, `sdr`, if this one encodes.
pub fn interface_format(sdr: Output) -> Format {
    match sdr.encoding {
        Encoding::ByFormat => sdr.format,
        Encoding::Srgb | Encoding::ScRgb | Encoding::Hdr10 => Format::R8G8B8A8_SRGB,
    }
}

fn interface(context: &Arc<Context>, format: Format, size: [u32; 2]) -> Result<Image> {
    Image::new(context, &ImageDesc::flat("user interface", format, size))
}

impl Present {
    /// Creates the pass for windows of this output, with the user interface in `interface_format`.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, output: Output, interface_format: Format) -> Result<Self> {
        let encoding = output.encoding;
        let is_layered = encoding != Encoding::ByFormat;
        let constants = [
            ("LAYER", u32::from(is_layered)),
            ("SRGB", u32::from(encoding == Encoding::Srgb)),
            ("HDR10", u32::from(encoding == Encoding::Hdr10)),
        ];
        let (name, shader) = ("present", &shaders::PRESENT_FRAG);
        let layer = is_layered.then(|| interface(context, interface_format, [1, 1]));
        Ok(Self {
            pipeline: fullscreen(context, name, shader, output.format, &constants)?,
            output,
            context: context.clone(),
            layer: layer.transpose()?,
        })
    }

    /// Draws the display values, encoded or linear ([`is_linear`]), with the user interface on top.
    ///
    /// # Errors
    /// Fails when there is no memory left for the user interface.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        display: &Image,
        overlay: &mut Overlay,
        ui: &UiFrame,
        window: &Image,
    ) -> Result<()> {
        if let Some(layer) = &mut self.layer {
            // The window's images were made anew too, with nothing in flight.
            if layer.size() != window.size() {
                *layer = interface(&self.context, layer.format(), window.size())?;
            }
            overlay.draw_alone(recorder, ui, layer)?;
        }
        let push = self.push(display, window.size());
        let mut drawn = Ok(());
        // Bound but not read where the format encodes.
        let layer = self.layer.as_ref().unwrap_or(display);
        recorder
            .pass("present", &self.pipeline)
            .sample("display", display, Sampler::Nearest)
            .sample("layer", layer, Sampler::Nearest)
            .push(&push)
            .color(window, Load::Discard)
            .draws(|draws| {
                draws.triangle();
                if self.layer.is_none() {
                    drawn = overlay.draw(draws, ui);
                }
            });
        drawn
    }

    fn push(&self, display: &Image, size: [u32; 2]) -> Push {
        let white = match self.output.encoding {
            Encoding::ByFormat | Encoding::Srgb => 1.0,
            Encoding::ScRgb => PAPER_WHITE / SCRGB_WHITE,
            Encoding::Hdr10 => PAPER_WHITE / PQ_PEAK,
        };
        Push {
            size: Vec2::from(size.map(|edge| edge as f32)),
            white: white as f32,
            is_linear: is_linear(display).into(),
        }
    }
}
