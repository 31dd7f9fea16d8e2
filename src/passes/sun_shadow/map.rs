//! The sun's shadow map: scene depth as seen from the sun, fitted to the camera's view and reused while it stays valid.

use std::sync::Arc;

use glam::{UVec2, Vec2, Vec3};

use crate::gpu::{
    Blend, Context, Depth, Format, Image, ImageDesc, Load, Pipeline, PipelineDesc, Recorder,
    Result, shaders,
};
use crate::gpu_struct;

use crate::passes::sun_shadow::cascades::{MAX_CASCADES, Shadows, SunViews};
use crate::passes::sun_shadow::fit::{ShadowView, fit_all};
use crate::passes::sun_shadow::glass::{self, SunGlass};
use crate::passes::sun_shadow::perspective::{self, Receivers};
use crate::passes::sun_shadow::receiver_mask::{ReceiverMask, reuse_distance};
use crate::passes::surfaces::culling::Cull;
use crate::passes::surfaces::facts::Facts;
use crate::passes::surfaces::geometry::Geometry;
use crate::passes::view::View;

gpu_struct! {
    /// The sun's view.
    pub struct Push: push of SHADOW_VERT {
        shadow_from_world: [[f32; 4]; 4],
    }
}

gpu_struct! {
    /// The sun's view, and the alpha below which a fragment is discarded.
    pub struct CutOutPush: push of SHADOW_CUT_OUT_VERT, SHADOW_CUT_OUT_FRAG {
        shadow_from_world: [[f32; 4]; 4],
        cutoff: f32,
    }
}

/// Draws casters into shadow maps.
pub(in crate::passes) struct Casters {
    solid: Pipeline,
    /// For alpha-tested surfaces, if there are any.
    cut_outs: Option<Pipeline>,
    /// For panes of glass, if they are drawn and there are any.
    panes: Option<Pipeline>,
    draws_solids: bool,
}

/// A shadow map in an atlas.
#[derive(Debug, Clone)]
pub(in crate::passes) struct Tile {
    /// View of the map.
    pub view: ShadowView,
    /// Mask of the receivers looked up in the map; `None`: the whole map is used.
    pub mask: Option<Arc<ReceiverMask>>,
    /// Its first texel.
    pub origin: [u32; 2],
    /// Edge length, texels.
    pub edge: u32,
}

impl Tile {
    /// First texel and size of the rectangle that receivers use.
    pub fn rectangle(&self) -> ([u32; 2], [u32; 2]) {
        let whole = [Vec2::ZERO, Vec2::ONE];
        let corners = self.mask.as_ref().map_or(whole, |mask| mask.rectangle());
        let [low, high] = corners.map(|corner| corner * self.edge as f32);
        let first = low.floor().as_uvec2().min(UVec2::splat(self.edge - 1));
        let end = high.ceil().as_uvec2().max(first + 1);
        let origin = UVec2::from(self.origin);
        ((origin + first).to_array(), (end - first).to_array())
    }

    /// Culling tests of its casters.
    pub fn cull(&self) -> Cull {
        self.view.cull().masked(self.mask.clone())
    }
}

impl Casters {
    /// Creates the pipelines. Panes of glass are not drawn.
    pub fn new(context: &Arc<Context>, facts: &Facts) -> Result<Self> {
        let has_holes = facts.has_cut_outs();
        Ok(Self {
            solid: pipeline(context, "shadow map", false)?,
            cut_outs: has_holes
                .then(|| pipeline(context, "shadow map, cut-outs", true))
                .transpose()?,
            panes: None,
            draws_solids: true,
        })
    }

    /// Draws only what has holes or lets light through: rays find the rest.
    pub fn without_solids(self) -> Self {
        Self {
            draws_solids: false,
            ..self
        }
    }

    /// Whether nothing is drawn.
    pub fn is_empty(&self) -> bool {
        !self.draws_solids && self.cut_outs.is_none() && self.panes.is_none()
    }

    /// Also draws panes of glass by chance, for the mean of many maps.
    pub fn with_panes(mut self, context: &Arc<Context>, facts: &Facts) -> Result<Self> {
        if facts.has_panes {
            self.panes = Some(glass::by_chance(context)?);
        }
        Ok(self)
    }

    /// Draws the maps of an atlas. Texels outside the bounding rectangle of all lookups are not even cleared.
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
                for tile in tiles.iter().filter(|_| self.draws_solids) {
                    draws.window(tile.origin, [tile.edge; 2], tile.rectangle());
                    draws.push(&Push {
                        shadow_from_world: tile.view.shadow_from_world.to_cols_array_2d(),
                    });
                    geometry.draw_positions(draws, &tile.cull(), tile.view.toward.y < 0.0);
                }
            });
        if let Some(pipeline) = &self.cut_outs {
            record_cut_outs(recorder, pipeline, geometry, tiles, maps);
        }
        if let Some(pipeline) = &self.panes {
            let pass = recorder.pass("shadow map, glass", pipeline);
            glass::draw(pass.depth(maps, Load::Keep), geometry, tiles);
        }
    }
}

/// First texel and size of the bounding rectangle of the tiles' rectangles.
pub(super) fn around(tiles: &[Tile]) -> ([u32; 2], [u32; 2]) {
    let rectangles = tiles.iter().map(Tile::rectangle);
    let ends = rectangles
        .map(|(first, size)| (UVec2::from(first), UVec2::from(first) + UVec2::from(size)));
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
                draws.window(tile.origin, [tile.edge; 2], tile.rectangle());
                geometry.draw_cut_outs(draws, &tile.cull(), |draws, bound| {
                    let map = bound.diffuse_map.unwrap_or(bound.white);
                    draws.texture("diffuse_map", map.image, map.sampler);
                    draws.push(&CutOutPush {
                        shadow_from_world: tile.view.shadow_from_world.to_cols_array_2d(),
                        cutoff: bound.cutoff,
                    });
                });
            }
        });
}

fn pipeline(context: &Arc<Context>, name: &str, holes: bool) -> Result<Pipeline> {
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
            depth: Depth::Write(Format::D32_SFLOAT),
            blend: Blend::Off,
            constants: &[],
        },
    )
}

/// Edge of a map in which nothing is looked up, texels.
const UNUSED: u32 = 16;

/// How the map is fitted.
#[derive(Debug, Clone, Copy)]
enum Fit {
    /// Cascades that follow the view in steps ([`SunViews::fit`]), with only the casters that the receivers in view need.
    Cascades(Shadows),
    /// One map warped toward the viewer ([`perspective::fit`]), a new one for each frame of an average.
    Perspective,
}

/// The shadow pass and its map. Cascades lie side by side.
pub struct Shadow {
    fit: Fit,
    casters: Casters,
    depth: Image,
    glass: Option<SunGlass>,
    views: SunViews,
    masks: [Arc<ReceiverMask>; MAX_CASCADES],
    /// Whether the map has been drawn for these views and receivers.
    is_drawn: bool,
}

impl Shadow {
    /// Cascades for single frames, `resolution` texels on a side.
    ///
    /// # Errors
    /// Fails when the device is out of memory.
    pub fn cascades(
        context: &Arc<Context>,
        facts: &Facts,
        resolution: u32,
        shadows: Shadows,
    ) -> Result<Self> {
        let size = [resolution * shadows.cascades.max(1), resolution];
        let fit = Fit::Cascades(shadows);
        Self::new(context, facts, size, fit)
    }

    /// One map for averaged frames, `resolution` texels on a side; `by_rays`: of cut-outs and panes of glass alone, since rays find
    /// the other casters.
    ///
    /// # Errors
    /// Fails when the device is out of memory.
    pub fn perspective(
        context: &Arc<Context>,
        facts: &Facts,
        resolution: u32,
        by_rays: bool,
    ) -> Result<Self> {
        let is_used = !by_rays || facts.has_cut_outs() || facts.has_panes;
        let size = [if is_used { resolution } else { UNUSED }; 2];
        let mut shadow = Self::new(context, facts, size, Fit::Perspective)?;
        if by_rays {
            shadow.casters = shadow.casters.without_solids();
        }
        Ok(shadow)
    }

    fn new(context: &Arc<Context>, facts: &Facts, size: [u32; 2], fit: Fit) -> Result<Self> {
        let desc = ImageDesc::flat("shadow map", Format::D32_SFLOAT, size);
        let all = fit_all(Vec3::Y, &facts.casters, size[1]);
        Ok(Self {
            fit,
            casters: Casters::new(context, facts)?,
            depth: Image::new(context, &desc)?,
            glass: SunGlass::new(context, facts, size)?,
            views: SunViews::one(all),
            masks: std::array::from_fn(|_| Arc::default()),
            is_drawn: false,
        })
    }

    /// Fits the map to a view. `sun` is the unit vector toward the sun; `shift` (0..1) is the sub-texel shift of a map in an average.
    /// Reuses the drawn map if its views are the same and it covers every receiver in view.
    pub fn fit(&mut self, geometry: &Geometry, view: &View, sun: Vec3, shift: Vec2) {
        let (bounds, resolution) = (geometry.bounds(), self.depth.size()[1]);
        let views = match self.fit {
            Fit::Cascades(Shadows { cascades, .. }) => {
                let casters = geometry.casters();
                SunViews::fit(sun, bounds, casters, view, resolution, cascades)
            }
            Fit::Perspective => {
                let receivers = Receivers::new(bounds, view);
                SunViews::one(perspective::fit(sun, bounds, &receivers, resolution, shift))
            }
        };
        let is_same = self.is_drawn && views.are_those_of(&self.views);
        self.views = views;
        self.is_drawn = match self.fit {
            Fit::Cascades(shadows) => {
                let radius = shadows.filter_radius();
                let is_kept = is_same && self.reuse_if_covered(geometry, view, radius);
                if !is_kept {
                    self.mask(geometry, view, radius);
                }
                is_kept
            }
            Fit::Perspective => is_same,
        };
    }

    /// Whether the drawn map contains the casters of every receiver in view. `radius` is the lookup radius, texels.
    fn reuse_if_covered(&self, geometry: &Geometry, view: &View, radius: f32) -> bool {
        geometry.seen(view).all(|cluster| {
            let receivers = &cluster.bounds;
            let mut cascades = self.views.looked_up(receivers, view.camera.eye, 0.0);
            cascades.all(|k| self.masks[k].covers(receivers, radius * self.views.texel(k)))
        })
    }

    /// Builds the cascades' masks from the receivers in view and those that come into view if the eye moves a little.
    fn mask(&mut self, geometry: &Geometry, view: &View, radius: f32) {
        let (eye, slack) = (
            view.camera.eye,
            reuse_distance(geometry.bounds(), view.camera.eye),
        );
        // Nothing else holds a mask between frames, so this does not copy.
        let mut masks = self.masks.each_mut().map(Arc::make_mut);
        for (mask, map) in masks.iter_mut().zip(self.views.iter()) {
            mask.reset(map);
        }
        for cluster in geometry.around(&view.from_behind(slack)) {
            let receivers = &cluster.bounds;
            for k in self.views.looked_up(receivers, eye, slack) {
                masks[k].add(receivers, radius * self.views.texel(k));
            }
        }
    }

    /// The map, if [`Self::record`] is going to draw it.
    pub fn target(&self) -> Option<&Image> {
        (!self.is_drawn).then_some(&self.depth)
    }

    /// Draws the map unless it is up to date with the last fit. Returns the views, the map, and what panes of glass let through in the
    /// same views, if there are any.
    pub fn record(
        &mut self,
        recorder: &mut Recorder,
        geometry: &Geometry,
    ) -> (&SunViews, &Image, Option<&Image>) {
        if !std::mem::replace(&mut self.is_drawn, true) {
            let edge = self.depth.size()[1];
            let is_masked = matches!(self.fit, Fit::Cascades(_));
            let tile = |((view, mask), k): ((&ShadowView, &Arc<ReceiverMask>), u32)| Tile {
                view: *view,
                mask: is_masked.then(|| mask.clone()),
                origin: [k * edge, 0],
                edge,
            };
            let views = self.views.iter().zip(&self.masks);
            let mut tiles: arrayvec::ArrayVec<Tile, MAX_CASCADES> =
                views.zip(0..).map(tile).collect();
            // Cascades without a receiver in view are skipped; if all would be, the first one is drawn.
            let first = tiles.first().cloned();
            tiles.retain(|tile| tile.mask.as_ref().is_none_or(|mask| !mask.is_empty()));
            if tiles.is_empty() {
                tiles.extend(first);
            }
            self.casters
                .record(recorder, "shadow map", geometry, &tiles, &self.depth);
            if let Some(glass) = &self.glass {
                glass.record(recorder, geometry, &tiles);
            }
        }
        let glass = self.glass.as_ref().map(SunGlass::image);
        (&self.views, &self.depth, glass)
    }

    /// Invalidates the map, so that the next frame redraws it.
    pub fn invalidate(&mut self) {
        self.is_drawn = false;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Bounds;

    #[test]
    fn what_is_looked_up_in_a_tile_lies_in_its_rectangle() {
        let toward = Vec3::new(0.4, 0.5, 0.3).normalize();
        let of = |half: f32| Bounds {
            min: Vec3::new(-half, 0.0, -half),
            max: Vec3::new(half, 1.0, half),
        };
        let view = fit_all(toward, &of(50.0), 256);
        let mut mask = ReceiverMask::new(&view);
        let tile = |mask: Option<&ReceiverMask>| Tile {
            view,
            mask: mask.map(|mask| Arc::new(mask.clone())),
            origin: [256, 512],
            edge: 256,
        };
        assert_eq!(tile(None).rectangle(), ([256, 512], [256; 2]), "no mask");
        assert_eq!(tile(Some(&mask)).rectangle().1, [256; 2], "no receiver");
        mask.add(&of(10.0), 0.0);
        let (first, size) = tile(Some(&mask)).rectangle();
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
