//! The shadow map: depth of the scene seen from the sun.

use std::sync::Arc;

use crate::gpu::{
    Context, Depth, Format, Image, ImageDesc, Load, Pipeline, PipelineDesc, Recorder, Result,
    shaders,
};
use crate::gpu_struct;

use super::geometry::Geometry;
use super::shadow_fit::ShadowView;

gpu_struct! {
    /// The sun's view.
    pub struct Push {
        shadow_from_world: [[f32; 4]; 4],
    }
}

/// Slopes of depth, in texels, by which casters are pushed away from the sun.
const SLOPE_BIAS: f32 = 1.5;

/// The pass and its map.
pub struct Shadow {
    pipeline: Pipeline,
    depth: Image,
    drawn: Option<ShadowView>,
}

impl Shadow {
    /// A map of `resolution` texels a side.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn new(context: &Arc<Context>, resolution: u32) -> Result<Self> {
        let format = Format::D32_SFLOAT;
        let pipeline = Pipeline::new(
            context,
            &PipelineDesc {
                name: "shadow map",
                stages: &[&shaders::SHADOW_VERT],
                vertex: &[Format::R32G32B32_SFLOAT],
                colors: &[],
                depth: Depth::Write {
                    format,
                    slope_bias: SLOPE_BIAS,
                },
                constants: &[],
            },
        )?;
        let desc = ImageDesc::flat("shadow map", format, [resolution, resolution]);
        Ok(Self {
            pipeline,
            depth: Image::new(context, &desc)?,
            drawn: None,
        })
    }

    /// Texels a side.
    pub fn resolution(&self) -> u32 {
        self.depth.size()[0]
    }

    /// Draws the map if the sun or the fit changed.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        geometry: &Geometry,
        view: &ShadowView,
    ) -> &Image {
        if self.drawn.as_ref() != Some(view) {
            recorder
                .pass("shadow map", &self.pipeline)
                .push(&Push {
                    shadow_from_world: view.shadow_from_world.to_cols_array_2d(),
                })
                .depth(&self.depth, Load::Clear([0.0; 4]))
                .draws(|draws| geometry.draw_positions(draws));
            self.drawn = Some(*view);
        }
        &self.depth
    }

    /// The map as it was last drawn.
    pub fn image(&self) -> &Image {
        &self.depth
    }

    /// Forgets what was drawn, so that the next frame draws it again.
    pub fn invalidate(&mut self) {
        self.drawn = None;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::{GpuStruct, check_layout};

    #[test]
    fn host_and_shader_agree() {
        let push = shaders::SHADOW_VERT.push.expect("push");
        assert_eq!(check_layout(Push::FIELDS, push), Ok(()));
    }
}
