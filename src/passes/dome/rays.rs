//! Light of the dome's directions by rays through the scene.

use std::sync::Arc;

use glam::Vec3;

use crate::gpu::{Context, Format, Image, ImageDesc, Pipeline, Recorder, Result, Sampler, shaders};
use crate::gpu_struct;

use crate::passes::bounces::tree::{Tree, TreeFacts};
use crate::passes::compute;
use crate::passes::dome::gather::DomeBlock;
use crate::passes::surfaces::gbuffer::Surfaces;
use crate::passes::view::View;

gpu_struct! {
    /// Radiance of the ground, kcd/m².
    pub struct Push: push of DOME_RAYS_COMP {
        ground: Vec3,
    }
}

const FORMAT: Format = Format::R32G32B32A32_SFLOAT;

/// The pass and its image.
pub(in crate::passes) struct SkyRays {
    pipeline: Pipeline,
    light: Image,
}

impl SkyRays {
    /// Creates the pass for pictures of `size` pixels; `has_maps`: maps tell cut-outs and panes of glass.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(
        context: &Arc<Context>,
        tree: &TreeFacts,
        size: [u32; 2],
        directions: u32,
        has_maps: bool,
    ) -> Result<Self> {
        let mut constants = tree.constants().to_vec();
        constants.extend([("DIRECTIONS", directions), ("MAPS", has_maps.into())]);
        let desc = ImageDesc::flat("sky light by rays", FORMAT, size);
        Ok(Self {
            pipeline: compute(context, "dome: rays", &shaders::DOME_RAYS_COMP, &constants)?,
            light: Image::new(context, &desc.stored())?,
        })
    }

    /// Traces the rays of a frame. Without maps any image will do in their place.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        (tree, maps): (&Tree, &Image),
        surfaces: &Surfaces,
        view: &View,
        block: &DomeBlock,
        ground: Vec3,
    ) {
        let pass = tree.bound_to(recorder.pass("dome: rays", &self.pipeline));
        surfaces
            .shapes_sampled_by(pass)
            .sample("maps", maps, Sampler::Nearest)
            .uniform("view", &view.block())
            .uniform("dome", block)
            .push(&Push { ground })
            .store("sky_light", &self.light)
            .dispatch();
    }

    /// For each pixel the light of the directions with visibility, klx, and its luminance without, see `include/dome_light.glsl`.
    pub fn light(&self) -> &Image {
        &self.light
    }
}
