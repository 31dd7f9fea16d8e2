//! Full-screen passes: every pixel of a picture is written, by fragments of a triangle or by a compute shader. Passes name their targets
//! once; the pipeline decides the route.

use crate::gpu::memory::image::{Image, Sampler};
use crate::gpu::record::pass::{Load, Pass};

/// How the pixels of full-screen passes are computed. Both routes run the same function; they give the same pictures but for the rounding
/// to the format of the picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum Route {
    /// Fragments of one triangle that covers the picture.
    #[default]
    Fragment,
    /// Compute shaders with one invocation per pixel: cards with few raster units do these many times faster.
    Compute,
}

/// Name of the depth image in compute shaders that write only some pixels.
const DEPTH: &str = "depth";

impl<'r> Pass<'r> {
    /// Adds a picture that the pass writes: `name` is that of the storage image of the compute shader; outputs of the fragment shader are in
    /// the order of the calls. A compute shader itself writes what `load` clears.
    pub fn output(self, name: &str, image: &'r Image, load: Load) -> Self {
        if self.pipeline.made.local_size.is_some() {
            self.store(name, image)
        } else {
            self.color(image, load)
        }
    }

    /// Sets the depth image that selects the pixels: by the depth test of the pipeline; a compute shader reads it as `depth`.
    pub fn selected_by(self, depth: &'r Image) -> Self {
        if self.pipeline.made.local_size.is_some() {
            self.sample(DEPTH, depth, Sampler::Nearest)
        } else {
            self.depth_test(depth)
        }
    }

    /// Ends the pass: computes all selected pixels of the targets.
    pub fn fill(self) {
        if self.pipeline.made.local_size.is_some() {
            self.dispatch();
        } else {
            self.draw();
        }
    }
}
