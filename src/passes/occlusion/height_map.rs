//! What stands above: depth of the scene seen from the zenith, which ambient occlusion asks about roofs that the picture does
//! not show.

use std::sync::Arc;

use glam::Vec3;

use crate::gpu::{Context, Format, Image, ImageDesc, Recorder, Result};
use crate::gpu_struct;

use crate::passes::sun_shadow::fit::{self, ShadowView};
use crate::passes::sun_shadow::map::{Casters, Tile};
use crate::passes::surfaces::geometry::Geometry;
use crate::passes::view::View;

gpu_struct! {
    /// `Cover` of `ssao.frag`.
    pub struct CoverBlock: zenith of SSAO_FRAG {
        from_view: [[f32; 4]; 4],
        texel: f32,
        slack: f32,
        rays: i32,
    }
}

/// Texels of the map's edge.
const EDGE: u32 = 512;
/// Rays of a slice that look for cover.
const RAYS: i32 = 4;
/// Fewest texels of a radius: of a coarser map nothing can be told.
const TEXELS_OF_RADIUS: f32 = 8.0;
/// Texels' depth by which a point lies below the map before it is under it: slopes rise within a texel.
const SLACK_TEXELS: f32 = 2.0;

/// The pass and its map, which is drawn once.
pub struct Cover {
    casters: Casters,
    depth: Image,
    view: ShadowView,
    is_drawn: bool,
}

impl Cover {
    /// For a scene.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn new(context: &Arc<Context>, geometry: &Geometry) -> Result<Self> {
        let desc = ImageDesc::flat("cover", Format::D32_SFLOAT, [EDGE; 2]);
        Ok(Self {
            casters: Casters::new(context, geometry, 0.0)?,
            depth: Image::new(context, &desc)?,
            view: fit::fit_all(Vec3::Y, geometry.casters(), EDGE),
            is_drawn: false,
        })
    }

    /// Whether occlusion within `radius` metres can be told from it.
    fn serves(&self, radius: f32) -> bool {
        radius > 0.0 && self.view.texel * TEXELS_OF_RADIUS <= radius
    }

    /// Draws the map, once, when occlusion within `radius` metres first wants it. Whatever the view, it shows the whole scene.
    pub fn record(&mut self, recorder: &mut Recorder, geometry: &Geometry, radius: f32) -> &Self {
        if self.serves(radius) && !std::mem::replace(&mut self.is_drawn, true) {
            let tile = Tile {
                view: self.view,
                mask: None,
                origin: [0; 2],
                edge: EDGE,
            };
            self.casters
                .record(recorder, "cover", geometry, &[tile], &self.depth);
        }
        self
    }

    /// The map: reversed depth, 1 is highest.
    pub fn image(&self) -> &Image {
        &self.depth
    }

    /// What the shader needs to know, for occlusion within `radius` metres.
    pub fn block(&self, view: &View, radius: f32) -> CoverBlock {
        let from_view = self.view.shadow_from_world * view.camera.world_from_view();
        CoverBlock {
            from_view: from_view.to_cols_array_2d(),
            texel: self.view.texel,
            slack: SLACK_TEXELS * self.view.texel_depth,
            rays: if self.serves(radius) { RAYS } else { 0 },
        }
    }
}
