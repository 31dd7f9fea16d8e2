//! The directions of a frame as the shaders read them.

use glam::Vec3;

use crate::gpu_struct;

use crate::passes::dome::gather::{BIAS_TEXELS, MOST_DIRECTIONS};
use crate::passes::sun_shadow::fit::ShadowView;

gpu_struct! {
    /// The directions of a frame.
    pub struct DomeBlock: dome of DOME_GATHER_FRAG, DOME_MIRROR_FRAG {
        clip_from_world: [[[f32; 4]; 4]; 16],
        planes: [[[f32; 4]; 4]; 16],
        window: [[f32; 4]; 16],
        toward: [[f32; 4]; 16],
        light: [[f32; 4]; 16],
    }
}

/// A direction with its map, a tile of the image of maps.
pub(in crate::passes) struct Direction<'a> {
    /// Unit vector toward the light.
    pub toward: Vec3,
    /// Share of the irradiance at normal incidence, klx.
    pub light: Vec3,
    /// Whether it is of the sky, and not of the ground.
    pub is_sky: bool,
    /// View of its map.
    pub view: &'a ShadowView,
    /// First texel of the map, and its edge.
    pub window: [u32; 3],
}

impl DomeBlock {
    /// Of at most [`MOST_DIRECTIONS`].
    pub(in crate::passes) fn new<'a>(directions: impl Iterator<Item = Direction<'a>>) -> Self {
        let mut block: Self = bytemuck::Zeroable::zeroed();
        for (k, d) in directions.take(MOST_DIRECTIONS as usize).enumerate() {
            let [x, y, edge] = d.window;
            block.clip_from_world[k] = d.view.shadow_from_world.to_cols_array_2d();
            block.planes[k] = d.view.planes().to_cols_array_2d();
            block.window[k] = [x, y, edge, edge].map(|texels| texels as f32);
            block.toward[k] = d.toward.extend(BIAS_TEXELS * d.view.texel_depth).to_array();
            block.light[k] = d.light.extend(f32::from(u8::from(d.is_sky))).to_array();
        }
        block
    }
}
