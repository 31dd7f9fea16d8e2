//! Bounced light of converging frames: a ray from each pixel, lit where it ends by the sun and the cells.

use std::sync::Arc;

use glam::IVec2;

use crate::daylight::sky::Daylight;
use crate::gpu::{
    Context, Depth, Format, Image, ImageDesc, Load, Pipeline, Recorder, Result, Sampler, shaders,
};
use crate::gpu_struct;
use crate::passes::bounces::cells::Cells;
use crate::passes::bounces::tree::Tree;
use crate::passes::fullscreen_at;
use crate::passes::surfaces::gbuffer::Surfaces;
use crate::passes::view::View;

gpu_struct! {
    /// Number of the frame and position of the picture.
    pub struct Push: push of BOUNCES_GATHER_FRAG {
        index: u32,
        origin: IVec2,
    }
}

/// Irradiance in klx: half floats, because it is the light of a single ray.
const FORMAT: Format = Format::R16G16B16A16_SFLOAT;

/// The gathering pass and its image.
pub struct Gather {
    pipeline: Pipeline,
    bounced: Image,
}

impl Gather {
    /// Creates the pass for pictures of `size` pixels.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, tree: &Tree, size: [u32; 2]) -> Result<Self> {
        Ok(Self {
            pipeline: fullscreen_at(
                context,
                "bounces: gather",
                &shaders::BOUNCES_GATHER_FRAG,
                &[FORMAT],
                Depth::Surface(Format::D32_SFLOAT),
                &tree.constants(),
            )?,
            bounced: Image::new(
                context,
                &ImageDesc::flat("bounced irradiance", FORMAT, size),
            )?,
        })
    }

    /// Traces a ray per pixel for frame number `index` of an average and returns the irradiance of the light that it brings, klx.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        (tree, cells): (&Tree, &Cells),
        surfaces: &Surfaces,
        daylight: &Daylight,
        view: &View,
        index: u32,
    ) -> &Image {
        let origin = view.window.map_or(IVec2::ZERO, |w| w.origin.as_ivec2());
        let pass = recorder.pass("bounces: gather", &self.pipeline);
        let pass = cells.bound_to(tree.bound_to(pass));
        pass.sample("depth", &surfaces.depth, Sampler::Nearest)
            .sample(
                "normal_material",
                &surfaces.normal_material,
                Sampler::Nearest,
            )
            .uniform("view", &view.block())
            .uniform("scene", &cells.block(view, daylight))
            .push(&Push { index, origin })
            .color(&self.bounced, Load::Clear([0.0; 4]))
            .depth_test(&surfaces.depth)
            .draw();
        &self.bounced
    }
}
