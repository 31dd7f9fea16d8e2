//! Height map: depth of the scene seen from the zenith. Ambient occlusion finds roofs in it that the picture does not show.

use std::sync::Arc;

use glam::Vec3;

use crate::gpu::{Context, Format, Image, ImageDesc, Recorder, Result};
use crate::gpu_struct;

use crate::passes::sun_shadow::fit::{self, ShadowView};
use crate::passes::sun_shadow::map::{Casters, Tile};
use crate::passes::surfaces::geometry::Geometry;
use crate::passes::view::View;

gpu_struct! {
    /// See `include/height_map.glsl`.
    pub struct HeightBlock: height of SSAO_FRAG {
        from_view: [[f32; 4]; 4],
        lift: f32,
        slack: f32,
        rays: i32,
    }
}

/// Texels of the map's edge.
const EDGE: u32 = 512;
/// Rays of a slice that look for roofs.
const RAYS: i32 = 4;
/// Fewest texels to a radius: a coarser map shows no roofs.
const TEXELS_OF_RADIUS: f32 = 8.0;
/// Depth, in texels, by which a point must lie below the map to be under a roof: slopes rise within a texel.
const SLACK_TEXELS: f32 = 2.0;
/// Texels by which points are lifted off their surface.
const LIFT_TEXELS: f32 = 1.5;

/// The pass and its map, which is drawn once.
pub struct HeightMap {
    casters: Casters,
    depth: Image,
    view: ShadowView,
    is_drawn: bool,
}

impl HeightMap {
    /// For a scene.
    ///
    /// # Errors
    /// Fails when the device cannot create the resources.
    pub fn new(context: &Arc<Context>, geometry: &Geometry) -> Result<Self> {
        let desc = ImageDesc::flat("height map", Format::D32_SFLOAT, [EDGE; 2]);
        Ok(Self {
            casters: Casters::new(context, geometry, 0.0)?,
            depth: Image::new(context, &desc)?,
            view: fit::fit_all(Vec3::Y, geometry.casters(), EDGE),
            is_drawn: false,
        })
    }

    /// Whether it is fine enough for occlusion within `radius` metres.
    fn serves(&self, radius: f32) -> bool {
        radius > 0.0 && self.view.texel * TEXELS_OF_RADIUS <= radius
    }

    /// Draws the map of the whole scene, once, when occlusion within `radius` metres first needs it.
    pub fn record(&mut self, recorder: &mut Recorder, geometry: &Geometry, radius: f32) -> &Self {
        if self.serves(radius) && !std::mem::replace(&mut self.is_drawn, true) {
            let tile = Tile {
                view: self.view,
                mask: None,
                origin: [0; 2],
                edge: EDGE,
            };
            self.casters
                .record(recorder, "height map", geometry, &[tile], &self.depth);
        }
        self
    }

    /// The map: reversed depth, 1 is highest.
    pub fn image(&self) -> &Image {
        &self.depth
    }

    /// The shader's block, for occlusion within `radius` metres.
    pub fn block(&self, view: &View, radius: f32) -> HeightBlock {
        let from_view = self.view.shadow_from_world * view.camera.world_from_view();
        HeightBlock {
            from_view: from_view.to_cols_array_2d(),
            lift: LIFT_TEXELS * self.view.texel,
            slack: SLACK_TEXELS * self.view.texel_depth,
            rays: if self.serves(radius) { RAYS } else { 0 },
        }
    }
}
