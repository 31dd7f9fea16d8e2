//! Height map: scene depth as seen from the zenith. With it, ambient occlusion accounts for roofs that are not on screen.

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

/// Edge of the map, texels.
const EDGE: u32 = 512;
/// Rays per slice that search for roofs.
const RAYS: i32 = 4;
/// Minimum number of texels per occlusion radius: a coarser map does not resolve roofs.
const TEXELS_OF_RADIUS: f32 = 8.0;
/// How far below the map a point must lie to count as under a roof, texels: a slope rises within a texel.
const SLACK_TEXELS: f32 = 2.0;
/// Normal offset of points, texels.
const LIFT_TEXELS: f32 = 1.5;

/// The height map pass and its map, which is drawn once.
pub struct HeightMap {
    casters: Casters,
    depth: Image,
    view: ShadowView,
    is_drawn: bool,
}

impl HeightMap {
    /// Creates the pass for a scene.
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

    /// Whether the map is fine enough for occlusion within `radius` metres.
    fn serves(&self, radius: f32) -> bool {
        radius > 0.0 && self.view.texel * TEXELS_OF_RADIUS <= radius
    }

    /// Draws the map of the whole scene once, when occlusion within `radius` metres first needs it.
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

    /// The map; reversed depth: 1 is highest.
    pub fn image(&self) -> &Image {
        &self.depth
    }

    /// The shader's uniform block, for occlusion within `radius` metres.
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
