//! Shadow caster culling by receiver masks (Bittner, Mattausch, Silvennoinen & Wimmer 2011, "Shadow caster culling for efficient
//! shadow mapping"): a caster is drawn only if, as seen from the light, a receiver in view lies behind it.

use std::ops::RangeInclusive;

use glam::{Mat4, Vec2, Vec3, Vec4};

use crate::scene::{Bounds, Cluster};

use crate::passes::sun_shadow::fit::ShadowView;

/// Mask cells along an edge of a map.
const CELLS: usize = 128;
/// Edge of a block, cells; the farthest depth is stored per block.
const BLOCK: usize = 4;
/// Blocks along an edge of a map.
const BLOCKS: usize = CELLS / BLOCK;
/// How far the eye may move while a map is reused, as a fraction of the distance to the far end of the scene.
const REUSE_SHARE: f32 = 1.0 / 24.0;

/// How far the eye may move, metres, before a map drawn for the receivers in view must be redrawn.
pub fn reuse_distance(bounds: &Bounds, eye: Vec3) -> f32 {
    let corners = bounds.corners().map(|corner| corner.distance(eye));
    REUSE_SHARE * corners.into_iter().fold(0.0, f32::max)
}

/// The cells of a map that contain receivers in view, and the depth of the farthest ones.
#[derive(Debug, Clone, PartialEq)]
pub struct ReceiverMask {
    /// From world space to mask space: x and y in cells from the map's corner, z in metres toward the light; the fourth row is zero.
    cells_from_world: Mat4,
    /// One metre along each axis of mask space.
    metre: Vec4,
    /// Rows of cells, one bit per cell.
    rows: [u128; CELLS],
    /// Lowest receiver coordinate toward the light in each block, metres; infinity without a receiver.
    farthest: [[f32; BLOCKS]; BLOCKS],
}

/// The cells that a box covers, as seen from the light.
struct Footprint {
    rows: RangeInclusive<usize>,
    /// Its columns, one bit per column.
    columns: u128,
    /// Columns of blocks.
    blocks: RangeInclusive<usize>,
    /// Lowest and highest coordinate toward the light, metres.
    toward: [f32; 2],
}

impl Footprint {
    fn rows_of_blocks(&self) -> RangeInclusive<usize> {
        self.rows.start() / BLOCK..=self.rows.end() / BLOCK
    }
}

impl Default for ReceiverMask {
    /// An empty mask without a map.
    fn default() -> Self {
        Self {
            cells_from_world: Mat4::ZERO,
            metre: Vec4::ZERO,
            rows: [0; CELLS],
            farthest: [[f32::INFINITY; BLOCKS]; BLOCKS],
        }
    }
}

impl ReceiverMask {
    /// An empty mask of an orthographic map.
    pub fn new(map: &ShadowView) -> Self {
        let mut mask = Self::default();
        mask.reset(map);
        mask
    }

    /// Removes all receivers and sets another map.
    pub fn reset(&mut self, map: &ShadowView) {
        let half = 0.5 * CELLS as f32;
        let axes = [0, 1].map(|i| map.shadow_from_world.row(i).truncate());
        let scale = half * axes[0].length();
        let origin = half * (map.shadow_from_world.w_axis.truncate().truncate() + 1.0);
        let rows = [
            (half * axes[0]).extend(origin.x),
            (half * axes[1]).extend(origin.y),
            map.toward.extend(0.0),
            Vec4::ZERO,
        ];
        self.cells_from_world = Mat4::from_cols_array_2d(&rows.map(Vec4::into)).transpose();
        self.metre = Vec4::new(scale, scale, 1.0, 0.0);
        self.rows = [0; CELLS];
        self.farthest = [[f32::INFINITY; BLOCKS]; BLOCKS];
    }

    /// Whether the mask has no receiver.
    pub fn is_empty(&self) -> bool {
        self.rows.iter().all(|row| *row == 0)
    }

    /// The footprint of a box enlarged by `margin` metres on all sides; `None` outside the map.
    fn footprint(&self, bounds: &Bounds, margin: f32) -> Option<Footprint> {
        let half = 0.5 * bounds.extent();
        let at = self.cells_from_world * bounds.centre().extend(1.0);
        let size = self.cells_from_world.abs() * half.extend(0.0) + self.metre * margin;
        let (low, high) = (at - size, at + size);
        let [first, last] = [low, high].map(|corner| corner.truncate().truncate());
        if last.cmplt(Vec2::ZERO).any() || first.cmpge(Vec2::splat(CELLS as f32)).any() {
            return None;
        }
        let most = Vec2::splat((CELLS - 1) as f32);
        let [first, last] = [first, last].map(|c| c.clamp(Vec2::ZERO, most).as_uvec2());
        let blocks = first.x as usize / BLOCK..=last.x as usize / BLOCK;
        Some(Footprint {
            rows: first.y as usize..=last.y as usize,
            columns: (u128::MAX >> (CELLS as u32 - 1 - (last.x - first.x))) << first.x,
            blocks,
            toward: [low.z, high.z],
        })
    }

    /// Adds the receivers in a box. `radius` is the lookup radius around them, metres.
    pub fn add(&mut self, receivers: &Bounds, radius: f32) {
        let Some(footprint) = self.footprint(receivers, radius) else {
            return;
        };
        let blocks = footprint.rows_of_blocks();
        for row in &mut self.rows[footprint.rows] {
            *row |= footprint.columns;
        }
        for row in &mut self.farthest[blocks] {
            for farthest in &mut row[footprint.blocks.clone()] {
                *farthest = farthest.min(footprint.toward[0]);
            }
        }
    }

    /// Whether a part of a cluster may lie between a receiver and the light.
    pub fn is_shadowed_by(&self, caster: &Cluster) -> bool {
        let Some(footprint) = self.footprint(&caster.bounds, 0.0) else {
            return false;
        };
        let block = u128::MAX >> (CELLS - BLOCK);
        // The caster's distance to the light does not matter: it shadows everything behind it.
        let is_before = |y: usize, x: usize| self.farthest[y / BLOCK][x] <= footprint.toward[1];
        footprint.rows.clone().any(|y| {
            let covered = self.rows[y] & footprint.columns;
            let mut blocks = footprint.blocks.clone();
            covered != 0 && blocks.any(|x| covered & block << (BLOCK * x) != 0 && is_before(y, x))
        })
    }

    /// Lower and upper corner of the receivers' bounding rectangle, 0..1 over the map; the whole map if there are no receivers.
    pub fn rectangle(&self) -> [Vec2; 2] {
        let columns = self.rows.iter().fold(0, |all, row| all | row);
        let first = self.rows.iter().position(|row| *row != 0);
        let last = self.rows.iter().rposition(|row| *row != 0);
        let Some((first, last)) = first.zip(last) else {
            return [Vec2::ZERO, Vec2::ONE];
        };
        let of = |column: u32, row: usize| Vec2::new(column as f32, row as f32) / CELLS as f32;
        [
            of(columns.trailing_zeros(), first),
            of(u128::BITS - columns.leading_zeros(), last + 1),
        ]
    }

    /// Whether the mask already contains the receivers in a box, so that adding them would change nothing. `radius` is the lookup
    /// radius around them, metres.
    pub fn covers(&self, receivers: &Bounds, radius: f32) -> bool {
        self.footprint(receivers, radius).is_none_or(|footprint| {
            let mut rows = self.rows[footprint.rows.clone()].iter();
            let blocks = self.farthest[footprint.rows_of_blocks()].iter();
            let mut depths = blocks.flat_map(|row| &row[footprint.blocks.clone()]);
            rows.all(|row| footprint.columns & !row == 0)
                && depths.all(|z| *z <= footprint.toward[0])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::passes::sun_shadow::fit::{self, axes};

    const TOWARD: Vec3 = Vec3::new(0.6, 0.8, 0.0);

    fn around(centre: Vec3) -> Bounds {
        Bounds {
            min: centre - 0.5,
            max: centre + 0.5,
        }
    }

    fn at(centre: Vec3) -> Cluster {
        Cluster {
            first: 0,
            count: 3,
            bounds: around(centre),
            solid: None,
            normals_match_winding: false,
        }
    }

    /// A map of about 50 m.
    fn map() -> ShadowView {
        let casters = Bounds {
            min: Vec3::splat(-16.0),
            max: Vec3::splat(16.0),
        };
        let map = fit::fit_all(TOWARD, &casters, 1024);
        assert!((30.0..90.0).contains(&(map.texel * 1024.0)), "{map:?}");
        map
    }

    fn empty() -> ReceiverMask {
        ReceiverMask::new(&map())
    }

    #[test]
    fn what_stands_toward_the_light_casts_and_what_stands_beside_or_behind_does_not() {
        let [right, up, _] = axes(TOWARD);
        let mut mask = empty();
        assert!(!mask.is_shadowed_by(&at(Vec3::ZERO)), "no receiver");
        assert!(mask.is_empty());
        assert_eq!(mask.rectangle(), [Vec2::ZERO, Vec2::ONE]);
        mask.add(&around(Vec3::ZERO), 0.0);
        assert!(!mask.is_empty());
        let [low, high] = mask.rectangle();
        assert!(low.cmplt(Vec2::splat(0.5)).all() && high.cmpgt(Vec2::splat(0.5)).all());
        assert!((high - low).max_element() < 0.2, "{low} {high}");
        for distance in [0.0, 5.0, 1e4] {
            assert!(mask.is_shadowed_by(&at(TOWARD * distance)), "{distance}");
        }
        assert!(!mask.is_shadowed_by(&at(-TOWARD * 3.0)));
        for beside in [right, -right, up, -up] {
            assert!(!mask.is_shadowed_by(&at(TOWARD * 20.0 + beside * 6.0)));
            assert!(!mask.is_shadowed_by(&at(beside * 1e3)), "beside the map");
        }
    }

    #[test]
    fn between_receivers_nothing_is_shadowed() {
        let [right, ..] = axes(TOWARD);
        let mut mask = empty();
        for side in [-10.0, 10.0] {
            mask.add(&around(right * side), 0.0);
        }
        assert!(!mask.is_shadowed_by(&at(TOWARD)));
        assert!(mask.is_shadowed_by(&at(TOWARD + right * 10.0)));
        // Receivers outside the map are not looked up in it.
        let before = mask.clone();
        mask.add(&around(right * 500.0), 0.0);
        assert_eq!(mask, before);
        // Setting another map clears the mask.
        mask.reset(&map());
        assert_eq!(mask, empty());
    }

    #[test]
    fn lookups_reach_beyond_their_receivers() {
        let [right, ..] = axes(TOWARD);
        let mut mask = empty();
        mask.add(&around(Vec3::ZERO), 6.0);
        assert!(mask.is_shadowed_by(&at(TOWARD + right * 5.0)));
        assert!(mask.is_shadowed_by(&at(-TOWARD * 5.0)));
    }

    #[test]
    fn a_mask_covers_its_receivers_and_no_others() {
        let mut drawn = empty();
        let boxes = [Vec3::ZERO, Vec3::X * 3.0].map(around);
        boxes.iter().for_each(|seen| drawn.add(seen, 0.5));
        for seen in &boxes {
            assert!(drawn.covers(seen, 0.5) && drawn.covers(seen, 0.0));
            assert!(!empty().covers(seen, 0.0), "nothing");
            assert!(!drawn.covers(seen, 3.0), "lookups reach farther");
        }
        assert!(!drawn.covers(&around(Vec3::X * 6.0), 0.0), "beside");
        assert!(
            !drawn.covers(&around(-TOWARD * 2.0), 0.0),
            "farther from the light"
        );
        assert!(drawn.covers(&around(Vec3::X * 1e3), 0.0), "beside the map");
    }
}
