//! The shadow map: depth of the scene seen from the sun.

use std::sync::Arc;

use glam::UVec2;

use crate::gpu::{
    Context, Depth, Format, Image, ImageDesc, Load, Pipeline, PipelineDesc, Recorder, Result,
    Sampler, shaders,
};
use crate::gpu_struct;

use crate::passes::sun_shadow::cascades::{MOST, SunViews};
use crate::passes::sun_shadow::fit::ShadowView;
use crate::passes::surfaces::geometry::Geometry;

gpu_struct! {
    /// The sun's view.
    pub struct Push: push of SHADOW_VERT {
        shadow_from_world: [[f32; 4]; 4],
    }
}

gpu_struct! {
    /// The sun's view, and where a surface has holes.
    pub struct CutOutPush: push of SHADOW_CUT_OUT_VERT, SHADOW_CUT_OUT_FRAG {
        shadow_from_world: [[f32; 4]; 4],
        cutoff: f32,
    }
}

/// Slopes of depth, in texels, by which casters are pushed away from the sun.
const SLOPE_BIAS: f32 = 1.5;

/// Draws what casts shadows into maps.
pub(in crate::passes) struct Casters {
    solid: Pipeline,
    /// For surfaces with holes, if there are any.
    cut_outs: Option<Pipeline>,
}

/// A map in an image of maps.
#[derive(Debug, Clone, Copy)]
pub(in crate::passes) struct Tile {
    /// What it shows.
    pub view: ShadowView,
    /// Its first texel.
    pub origin: [u32; 2],
    /// Texels of its edge.
    pub edge: u32,
}

impl Tile {
    /// First texel and size of what is ever looked up in it.
    fn part(&self) -> ([u32; 2], [u32; 2]) {
        let corners = self.view.shade.part();
        let [low, high] = corners.map(|corner| corner * self.edge as f32);
        let first = low.floor().as_uvec2().min(UVec2::splat(self.edge - 1));
        let end = high.ceil().as_uvec2().max(first + 1);
        let origin = UVec2::from(self.origin);
        ((origin + first).to_array(), (end - first).to_array())
    }
}

impl Casters {
    /// With casters pushed away from the light by so many slopes of depth.
    pub fn new(context: &Arc<Context>, geometry: &Geometry, slope_bias: f32) -> Result<Self> {
        let has_holes = geometry.kinds().any(|kind| kind.cut_out);
        Ok(Self {
            solid: pipeline(context, "shadow map", slope_bias, false)?,
            cut_outs: has_holes
                .then(|| pipeline(context, "shadow map, cut-outs", slope_bias, true))
                .transpose()?,
        })
    }

    /// Draws maps of an image. What lies beside the rectangle around what is looked up in them is not even cleared.
    pub fn record(
        &self,
        recorder: &mut Recorder,
        name: &'static str,
        geometry: &Geometry,
        tiles: &[Tile],
        maps: &Image,
    ) {
        let (first, size) = around(tiles);
        recorder
            .pass(name, &self.solid)
            .depth(maps, Load::Clear([0.0; 4]))
            .within(first, size)
            .draws(|draws| {
                for tile in tiles {
                    draws.window(tile.origin, [tile.edge; 2], tile.part());
                    draws.push(&Push {
                        shadow_from_world: tile.view.shadow_from_world.to_cols_array_2d(),
                    });
                    geometry.draw_positions(draws, &tile.view.cull());
                }
            });
        if let Some(pipeline) = &self.cut_outs {
            record_cut_outs(recorder, pipeline, geometry, tiles, maps);
        }
    }
}

/// First texel and size of the rectangle around the parts of tiles.
fn around(tiles: &[Tile]) -> ([u32; 2], [u32; 2]) {
    let parts = tiles.iter().map(Tile::part);
    let ends =
        parts.map(|(first, size)| (UVec2::from(first), UVec2::from(first) + UVec2::from(size)));
    let both = ends.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1)));
    let (first, end) = both.unwrap_or_default();
    (first.to_array(), (end - first).to_array())
}

fn record_cut_outs(
    recorder: &mut Recorder,
    pipeline: &Pipeline,
    geometry: &Geometry,
    tiles: &[Tile],
    maps: &Image,
) {
    recorder
        .pass("shadow map, cut-outs", pipeline)
        .depth(maps, Load::Keep)
        .draws(|draws| {
            for tile in tiles {
                draws.window(tile.origin, [tile.edge; 2], tile.part());
                geometry.draw_cut_outs(draws, &tile.view.cull(), |draws, bound| {
                    let map = bound.diffuse_map.unwrap_or(bound.white);
                    draws.texture("diffuse_map", map, Sampler::Repeat);
                    draws.push(&CutOutPush {
                        shadow_from_world: tile.view.shadow_from_world.to_cols_array_2d(),
                        cutoff: bound.cutoff,
                    });
                });
            }
        });
}

fn pipeline(context: &Arc<Context>, name: &str, slope_bias: f32, holes: bool) -> Result<Pipeline> {
    let solid: &[_] = &[&shaders::SHADOW_VERT];
    let cut_out: &[_] = &[&shaders::SHADOW_CUT_OUT_VERT, &shaders::SHADOW_CUT_OUT_FRAG];
    let streams = [Format::R32G32B32_SFLOAT, Format::R32G32_SFLOAT];
    Pipeline::new(
        context,
        &PipelineDesc {
            name,
            stages: if holes { cut_out } else { solid },
            vertex: &streams[..if holes { 2 } else { 1 }],
            colors: &[],
            depth: Depth::Write {
                format: Format::D32_SFLOAT,
                slope_bias,
            },
            constants: &[],
        },
    )
}

/// The pass and its map.
pub struct Shadow {
    casters: Casters,
    depth: Image,
    drawn: Option<SunViews>,
}

impl Shadow {
    /// A map of `resolution` texels a side, and what drawing `geometry` takes.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn new(context: &Arc<Context>, geometry: &Geometry, resolution: u32) -> Result<Self> {
        Self::with(context, geometry, resolution, 1, SLOPE_BIAS)
    }

    /// `count` maps side by side.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn cascaded(
        context: &Arc<Context>,
        geometry: &Geometry,
        resolution: u32,
        count: u32,
    ) -> Result<Self> {
        Self::with(context, geometry, resolution, count, SLOPE_BIAS)
    }

    /// The same for comparisons in the plane of the receiver, which need no bias of casters.
    ///
    /// # Errors
    /// When the device refuses.
    pub fn unbiased(context: &Arc<Context>, geometry: &Geometry, resolution: u32) -> Result<Self> {
        Self::with(context, geometry, resolution, 1, 0.0)
    }

    fn with(
        context: &Arc<Context>,
        geometry: &Geometry,
        resolution: u32,
        count: u32,
        slope_bias: f32,
    ) -> Result<Self> {
        let size = [resolution * count.max(1), resolution];
        let desc = ImageDesc::flat("shadow map", Format::D32_SFLOAT, size);
        Ok(Self {
            casters: Casters::new(context, geometry, slope_bias)?,
            depth: Image::new(context, &desc)?,
            drawn: None,
        })
    }

    /// Texels a side.
    pub fn resolution(&self) -> u32 {
        self.depth.size()[1]
    }

    /// What the maps were drawn for.
    pub fn drawn(&self) -> Option<&SunViews> {
        self.drawn.as_ref()
    }

    /// Whether the maps of these views must be drawn anew.
    pub fn is_stale(&self, views: &SunViews) -> bool {
        !self
            .drawn()
            .is_some_and(|drawn| drawn.iter().eq(views.iter()))
    }

    /// Draws the map if the sun or the fit changed.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        geometry: &Geometry,
        views: &SunViews,
    ) -> &Image {
        if self.is_stale(views) {
            let edge = self.resolution();
            let origins = (0..).map(|k| [k * edge, 0]);
            let tile = |(view, origin): (&ShadowView, _)| Tile {
                view: *view,
                origin,
                edge,
            };
            let mut tiles: arrayvec::ArrayVec<Tile, MOST> =
                views.iter().zip(origins).map(tile).collect();
            // Cascades in which nothing is in view cost no more than their place; the first stands in when that is all of them.
            let first = tiles.first().copied();
            tiles.retain(|tile| !tile.view.shade.is_nothing());
            if tiles.is_empty() {
                tiles.extend(first);
            }
            self.casters
                .record(recorder, "shadow map", geometry, &tiles, &self.depth);
            self.drawn = Some(*views);
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
    use glam::{Vec2, Vec3};

    use super::*;
    use crate::passes::sun_shadow::fit;
    use crate::passes::sun_shadow::receiver_mask::Shade;
    use crate::scene::Bounds;

    #[test]
    fn what_is_looked_up_in_a_tile_lies_in_its_part() {
        let toward = Vec3::new(0.4, 0.5, 0.3).normalize();
        let of = |half: f32| Bounds {
            min: Vec3::new(-half, 0.0, -half),
            max: Vec3::new(half, 1.0, half),
        };
        let mut view = fit::fit_all(toward, &of(50.0), 256);
        let tile = |view| Tile {
            view,
            origin: [256, 512],
            edge: 256,
        };
        assert_eq!(tile(view).part(), ([256, 512], [256; 2]), "all of it");
        view.shade = Shade::none(toward, &view.shadow_from_world);
        assert_eq!(tile(view).part().1, [256; 2], "nothing is known");
        view.shade.add(&of(10.0), 0.0);
        let (first, size) = tile(view).part();
        assert!(size.iter().all(|edge| *edge < 80), "{size:?}");
        for corner in of(10.0).corners() {
            let at = view.shadow_from_world.project_point3(corner).truncate();
            let texel = (at * 0.5 + 0.5) * 256.0 + Vec2::new(256.0, 512.0);
            let within = texel - UVec2::from(first).as_vec2();
            let size = UVec2::from(size).as_vec2();
            assert!(
                within.cmpge(Vec2::ZERO).all() && within.cmple(size).all(),
                "{texel}"
            );
        }
    }
}
