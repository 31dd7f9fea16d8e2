//! What panes of glass let through of the sun's light: an image beside its shadow map.

use std::sync::Arc;

use glam::Vec3;

use crate::gpu::{
    Blend, Context, Depth, Format, Image, ImageDesc, Load, Pass, Pipeline, PipelineDesc, Recorder,
    Result, shaders,
};
use crate::gpu_struct;

use crate::passes::glass_index;
use crate::passes::sun_shadow::map::{Tile, around};
use crate::passes::surfaces::facts::Facts;
use crate::passes::surfaces::geometry::Geometry;

gpu_struct! {
    /// The sun's view, and the glass of a draw.
    pub struct Push: push of SHADOW_GLASS_VERT, SHADOW_GLASS_FRAG, SHADOW_GLASS_BY_CHANCE_FRAG {
        shadow_from_world: [[f32; 4]; 4],
        internal: Vec3,
        toward: Vec3,
    }
}

/// Position and normal.
const VERTEX: [Format; 2] = [Format::R32G32B32_SFLOAT; 2];

/// Half floats can be combined on every device.
const FORMAT: Format = Format::R16G16B16A16_SFLOAT;

/// A pipeline that draws panes into shadow maps by chance, in proportion to the light that they stop.
pub(super) fn by_chance(context: &Arc<Context>) -> Result<Pipeline> {
    Pipeline::new(
        context,
        &PipelineDesc {
            name: "shadow map, glass by chance",
            stages: &[
                &shaders::SHADOW_GLASS_VERT,
                &shaders::SHADOW_GLASS_BY_CHANCE_FRAG,
            ],
            vertex: &VERTEX,
            colors: &[],
            depth: Depth::Write(Format::D32_SFLOAT),
            blend: Blend::Off,
            constants: &[glass_index()],
        },
    )
}

/// Draws the panes into the tiles.
pub(super) fn draw(pass: Pass<'_>, geometry: &Geometry, tiles: &[Tile]) {
    pass.draws(|draws| {
        for tile in tiles {
            draws.window(tile.origin, [tile.edge; 2], tile.rectangle());
            geometry.draw_panes(draws, &tile.cull(), |draws, internal| {
                draws.push(&Push {
                    shadow_from_world: tile.view.shadow_from_world.to_cols_array_2d(),
                    internal,
                    toward: tile.view.toward,
                });
            });
        }
    });
}

/// The pass that draws panes as the sun sees them, and its image.
pub(in crate::passes) struct SunGlass {
    pipeline: Pipeline,
    /// Red, green, blue: products of the transmittances of all panes; alpha: depth of the one nearest the sun, 0 without any.
    through: Image,
}

impl SunGlass {
    /// Creates the pass if the scene has panes; `size` is that of the shadow map.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, facts: &Facts, size: [u32; 2]) -> Result<Option<Self>> {
        if !facts.has_panes {
            return Ok(None);
        }
        let pipeline = Pipeline::new(
            context,
            &PipelineDesc {
                name: "shadow map, glass",
                stages: &[&shaders::SHADOW_GLASS_VERT, &shaders::SHADOW_GLASS_FRAG],
                vertex: &VERTEX,
                colors: &[FORMAT],
                depth: Depth::Off,
                blend: Blend::MultiplyAndMost,
                constants: &[glass_index()],
            },
        )?;
        let desc = ImageDesc::flat("sun through glass", FORMAT, size);
        Ok(Some(Self {
            pipeline,
            through: Image::new(context, &desc)?,
        }))
    }

    /// Draws the tiles of the shadow map.
    pub fn record(&self, recorder: &mut Recorder, geometry: &Geometry, tiles: &[Tile]) {
        let (first, size) = around(tiles);
        let pass = recorder.pass("shadow map, glass", &self.pipeline);
        let pass = pass.color(&self.through, Load::Clear([1.0, 1.0, 1.0, 0.0]));
        draw(pass.within(first, size), geometry, tiles);
    }

    /// The image.
    pub fn image(&self) -> &Image {
        &self.through
    }
}
