//! Light of the sky and of the bounces in single frames: from the cells, interpolated.

use std::sync::Arc;

use crate::daylight::sky::Daylight;
use crate::gpu::{Context, Depth, Image, ImageDesc, Load, Pipeline, Recorder, Result, shaders};
use crate::passes::bounces::cells::Cells;
use crate::passes::bounces::gather::{HALF_SIZE, half_size};
use crate::passes::surfaces::gbuffer::Surfaces;
use crate::passes::view::View;
use crate::passes::{Screen, screen};

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
    pub fn new(context: &Arc<Context>, size: [u32; 2]) -> Result<Self> {
        let desc = ImageDesc::flat("irradiance from cells", HALF_SIZE, half_size(size));
        let shaders = Screen {
            fragment: &shaders::CELLS_AMBIENT_FRAG,
            compute: &shaders::CELLS_AMBIENT_COMP,
        };
        Ok(Self {
            pipeline: screen(
                context,
                "cells: ambient",
                shaders,
                &[HALF_SIZE],
                Depth::Off,
                &[],
            )?,
            ambient: Image::new(context, &desc.target_by(context.route()))?,
        })
    }

    /// Looks up the light of the surfaces in view, klx, see `include/half_size.glsl`.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        cells: &Cells,
        surfaces: &Surfaces,
        daylight: &Daylight,
        view: &View,
    ) -> &Image {
        let pass = recorder.pass("cells: ambient", &self.pipeline);
        surfaces
            .shapes_sampled_by(cells.bound_to(pass))
            .uniform("view", &view.block())
            .uniform("scene", &cells.block(view, daylight))
            .output("ambient", &self.ambient, Load::Discard)
            .fill();
        &self.ambient
    }
}
