//! Light of the sky and of the bounces in single frames: from the cells, interpolated.

use std::sync::Arc;

use crate::daylight::sky::Daylight;
use crate::gpu::{
    Context, Depth, Image, ImageDesc, Pipeline, PipelineDesc, Recorder, Result, Sampler, shaders,
};
use crate::passes::bounces::cells::Cells;
use crate::passes::bounces::gather::{HALF_SIZE, half_size};
use crate::passes::bounces::tree::Tree;
use crate::passes::surfaces::gbuffer::Surfaces;
use crate::passes::view::View;

/// The pass and its image.
pub struct CellLight {
    pipeline: Pipeline,
    ambient: Image,
}

impl CellLight {
    /// Creates the pass for pictures of `size` pixels.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, tree: &Tree, size: [u32; 2]) -> Result<Self> {
        let desc = ImageDesc::flat("irradiance from cells", HALF_SIZE, half_size(size));
        Ok(Self {
            pipeline: Pipeline::new(
                context,
                &PipelineDesc {
                    name: "cells: ambient",
                    stages: &[&shaders::CELLS_AMBIENT_COMP],
                    vertex: &[],
                    colors: &[],
                    depth: Depth::Off,
                    constants: &tree.constants(),
                },
            )?,
            ambient: Image::new(context, &desc.stored())?,
        })
    }

    /// Looks up the light of the surfaces in view, klx, see `include/half_size.glsl`.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        (tree, cells): (&Tree, &Cells),
        surfaces: &Surfaces,
        daylight: &Daylight,
        view: &View,
    ) -> &Image {
        let pass = recorder.pass("cells: ambient", &self.pipeline);
        let pass = cells.bound_to(tree.bound_to(pass));
        pass.sample("depth", &surfaces.depth, Sampler::Nearest)
            .sample(
                "normal_material",
                &surfaces.normal_material,
                Sampler::Nearest,
            )
            .uniform("view", &view.block())
            .uniform("scene", &cells.block(view, daylight))
            .store("ambient", &self.ambient)
            .dispatch();
        &self.ambient
    }
}
