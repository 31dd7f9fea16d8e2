//! Morphological anti-aliasing of display values, after SMAA 1x (Jimenez et al. 2012): it works on one picture alone.
//!
//! The stairs along an edge are replaced by the straight line that they stand for. Areas are computed, not looked up; diagonals have no shapes of their own. What one
//! sample a pixel has missed, as thin rails, it cannot bring back.

use std::sync::Arc;

use crate::gpu::{
    Context, Format, Image, ImageDesc, Load, Pipeline, Recorder, Result, Sampler, shaders,
};

use crate::passes::fullscreen;

/// Both passes, and the image of the edges.
pub struct Morphological {
    edges: Pipeline,
    blend: Pipeline,
    image: Image,
}

impl Morphological {
    /// Creates the passes for pictures of `size` pixels of this format; `is_linear`: display values are linear, else encoded.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        size: [u32; 2],
        format: Format,
        is_linear: bool,
    ) -> Result<Self> {
        let of_edges = Format::R8G8_UNORM;
        let (find, blend) = (&shaders::EDGES_FRAG, &shaders::MORPHOLOGICAL_FRAG);
        let constants = [("LINEAR", is_linear.into())];
        Ok(Self {
            edges: fullscreen(context, "edges", find, of_edges, &[])?,
            blend: fullscreen(context, "morphological", blend, format, &constants)?,
            image: Image::new(context, &ImageDesc::flat("edges", of_edges, size))?,
        })
    }

    /// Smooths a picture.
    pub fn record(&self, recorder: &mut Recorder, display: &Image, target: &Image) {
        recorder
            .pass("edges", &self.edges)
            .sample("display", display, Sampler::Nearest)
            .color(&self.image, Load::Discard)
            .draw();
        recorder
            .pass("morphological anti-aliasing", &self.blend)
            .sample("display", display, Sampler::Nearest)
            .sample("edges", &self.image, Sampler::Nearest)
            .color(target, Load::Discard)
            .draw();
    }
}
