//! Which casters a map of the sun needs: those that can shade what the camera sees in it. Where nothing is seen, as the sun sees
//! it, and behind all that is seen there, a caster shades nothing that is in the picture.

use std::ops::RangeInclusive;

use glam::{Mat4, Vec2, Vec3, Vec4};

use crate::scene::{Bounds, Cluster};

use crate::passes::sun_shadow::fit::axes;

/// Cells along an edge of a map.
const CELLS: usize = 128;
/// Cells along an edge of the squares in which the farthest depth is kept.
const SQUARE: usize = 4;
/// Squares along an edge of a map.
const SQUARES: usize = CELLS / SQUARE;
/// Share of the distance to the end of the scene that the eye may go while a map stays.
const ROOM: f32 = 1.0 / 24.0;

/// How far the eye may go before what is seen of a scene within `bounds` needs another map, metres.
pub fn room(bounds: &Bounds, eye: Vec3) -> f32 {
    let corners = bounds.corners().map(|corner| corner.distance(eye));
    ROOM * corners.into_iter().fold(0.0, f32::max)
}

/// What is shaded: the cells of a map in which something is seen, and how far from the light the farthest of it lies (after the
/// receivers' mask of Bittner, Mattausch, Silvennoinen & Wimmer 2011, "Shadow caster culling for efficient shadow mapping").
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Shade {
    /// From the world to cells from the map's corner, to the right and up, and to metres toward the light; the fourth row is
    /// zero. All of it is where all is shaded.
    cells_from_world: Mat4,
    /// What a metre in any direction is there.
    metre: Vec4,
    /// Rows of cells, a bit for each.
    rows: [u128; CELLS],
    /// Lowest coordinate toward the light in each square, metres; infinity where nothing is shaded.
    farthest: [[f32; SQUARES]; SQUARES],
}

/// What lies under a box.
struct Under {
    rows: RangeInclusive<usize>,
    /// Its columns, a bit for each.
    columns: u128,
    /// Columns of squares.
    squares: RangeInclusive<usize>,
    /// Lowest and highest coordinate toward the light, metres.
    toward: [f32; 2],
}

impl Under {
    fn rows_of_squares(&self) -> RangeInclusive<usize> {
        self.rows.start() / SQUARE..=self.rows.end() / SQUARE
    }
}

impl Shade {
    /// Everything.
    pub const ALL: Self = Self {
        cells_from_world: Mat4::ZERO,
        metre: Vec4::ZERO,
        rows: [u128::MAX; CELLS],
        farthest: [[f32::NEG_INFINITY; SQUARES]; SQUARES],
    };

    /// Nothing yet, of a square map along the axes of [`fit`](super::fit), without perspective, of a light in the direction `toward`.
    pub fn none(toward: Vec3, shadow_from_world: &Mat4) -> Self {
        let half = 0.5 * CELLS as f32;
        let scale = half * shadow_from_world.row(0).truncate().length();
        let origin = half * (shadow_from_world.w_axis.truncate().truncate() + 1.0);
        let [right, up, toward] = axes(toward);
        let rows = [
            (scale * right).extend(origin.x),
            (scale * up).extend(origin.y),
            toward.extend(0.0),
            Vec4::ZERO,
        ];
        Self {
            cells_from_world: Mat4::from_cols_array_2d(&rows.map(Vec4::into)).transpose(),
            metre: Vec4::new(scale, scale, 1.0, 0.0),
            rows: [0; CELLS],
            farthest: [[f32::INFINITY; SQUARES]; SQUARES],
        }
    }

    /// Whether it is nothing.
    pub fn is_nothing(&self) -> bool {
        self.rows.iter().all(|row| *row == 0)
    }

    /// What is covered by a box that is so many metres larger on all sides, if it does not lie beside the map.
    fn under(&self, bounds: &Bounds, reach: f32) -> Option<Under> {
        let half = 0.5 * bounds.extent();
        let at = self.cells_from_world * bounds.centre().extend(1.0);
        let size = self.cells_from_world.abs() * half.extend(0.0) + self.metre * reach;
        let (low, high) = (at - size, at + size);
        let [first, last] = [low, high].map(|corner| corner.truncate().truncate());
        if last.cmplt(Vec2::ZERO).any() || first.cmpge(Vec2::splat(CELLS as f32)).any() {
            return None;
        }
        let most = Vec2::splat((CELLS - 1) as f32);
        let [first, last] = [first, last].map(|c| c.clamp(Vec2::ZERO, most).as_uvec2());
        let squares = first.x as usize / SQUARE..=last.x as usize / SQUARE;
        Some(Under {
            rows: first.y as usize..=last.y as usize,
            columns: (u128::MAX >> (CELLS as u32 - 1 - (last.x - first.x))) << first.x,
            squares,
            toward: [low.z, high.z],
        })
    }

    /// Takes in a box; lookups reach so many metres farther.
    pub fn add(&mut self, bounds: &Bounds, reach: f32) {
        let Some(under) = self.under(bounds, reach) else {
            return;
        };
        let squares = under.rows_of_squares();
        for row in &mut self.rows[under.rows] {
            *row |= under.columns;
        }
        for row in &mut self.farthest[squares] {
            for farthest in &mut row[under.squares.clone()] {
                *farthest = farthest.min(under.toward[0]);
            }
        }
    }

    /// Whether something of a cluster may stand between what is shaded and the light.
    pub fn may_be_shaded_by(&self, cluster: &Cluster) -> bool {
        let Some(under) = self.under(&cluster.bounds, 0.0) else {
            return false;
        };
        let square = u128::MAX >> (CELLS - SQUARE);
        // However near the light: it shades what is behind.
        let is_before = |y: usize, x: usize| self.farthest[y / SQUARE][x] <= under.toward[1];
        under.rows.clone().any(|y| {
            let covered = self.rows[y] & under.columns;
            let mut squares = under.squares.clone();
            covered != 0
                && squares.any(|x| covered & square << (SQUARE * x) != 0 && is_before(y, x))
        })
    }

    /// The first and the last corner of what is shaded, each 0 to 1 over the map: all of it where nothing is.
    pub fn part(&self) -> [Vec2; 2] {
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

    /// Whether a box, of which lookups reach so many metres farther, is within it already: taking it in would change nothing.
    pub fn holds(&self, bounds: &Bounds, reach: f32) -> bool {
        self.under(bounds, reach).is_none_or(|under| {
            let mut rows = self.rows[under.rows.clone()].iter();
            let squares = self.farthest[under.rows_of_squares()].iter();
            let mut depths = squares.flat_map(|row| &row[under.squares.clone()]);
            rows.all(|row| under.columns & !row == 0) && depths.all(|z| *z <= under.toward[0])
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::passes::sun_shadow::fit;

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

    /// Of a map of about 50 m.
    fn nothing() -> Shade {
        let casters = Bounds {
            min: Vec3::splat(-16.0),
            max: Vec3::splat(16.0),
        };
        let map = fit::fit_all(TOWARD, &casters, 1024);
        assert!((30.0..90.0).contains(&(map.texel * 1024.0)), "{map:?}");
        Shade::none(TOWARD, &map.shadow_from_world)
    }

    #[test]
    fn what_stands_toward_the_light_shades_and_what_stands_beside_or_behind_does_not() {
        let [right, up, _] = axes(TOWARD);
        let mut shade = nothing();
        assert!(
            !shade.may_be_shaded_by(&at(Vec3::ZERO)),
            "nothing is shaded"
        );
        assert!(shade.is_nothing());
        assert_eq!(shade.part(), [Vec2::ZERO, Vec2::ONE]);
        shade.add(&around(Vec3::ZERO), 0.0);
        assert!(!shade.is_nothing() && !Shade::ALL.is_nothing());
        let [low, high] = shade.part();
        assert!(low.cmplt(Vec2::splat(0.5)).all() && high.cmpgt(Vec2::splat(0.5)).all());
        assert!((high - low).max_element() < 0.2, "{low} {high}");
        for distance in [0.0, 5.0, 1e4] {
            assert!(shade.may_be_shaded_by(&at(TOWARD * distance)), "{distance}");
        }
        assert!(!shade.may_be_shaded_by(&at(-TOWARD * 3.0)));
        for beside in [right, -right, up, -up] {
            assert!(!shade.may_be_shaded_by(&at(TOWARD * 20.0 + beside * 6.0)));
            assert!(!shade.may_be_shaded_by(&at(beside * 1e3)), "beside the map");
        }
        assert!(Shade::ALL.may_be_shaded_by(&at(-TOWARD * 3e3)));
    }

    #[test]
    fn between_what_is_seen_nothing_is_shaded() {
        let [right, ..] = axes(TOWARD);
        let mut shade = nothing();
        for side in [-10.0, 10.0] {
            shade.add(&around(right * side), 0.0);
        }
        assert!(!shade.may_be_shaded_by(&at(TOWARD)));
        assert!(shade.may_be_shaded_by(&at(TOWARD + right * 10.0)));
        // What is beside the map is not looked up in it.
        let before = shade;
        shade.add(&around(right * 500.0), 0.0);
        assert_eq!(shade, before);
    }

    #[test]
    fn lookups_reach_farther_than_what_is_seen() {
        let [right, ..] = axes(TOWARD);
        let mut shade = nothing();
        shade.add(&around(Vec3::ZERO), 6.0);
        assert!(shade.may_be_shaded_by(&at(TOWARD + right * 5.0)));
        assert!(shade.may_be_shaded_by(&at(-TOWARD * 5.0)));
    }

    #[test]
    fn what_is_drawn_with_room_holds_what_is_seen_after_a_step() {
        let mut drawn = nothing();
        let boxes = [Vec3::ZERO, Vec3::X * 3.0].map(around);
        boxes.iter().for_each(|seen| drawn.add(seen, 0.5));
        for seen in &boxes {
            assert!(drawn.holds(seen, 0.5) && drawn.holds(seen, 0.0));
            assert!(!nothing().holds(seen, 0.0), "nothing");
            assert!(!drawn.holds(seen, 3.0), "lookups reach farther");
        }
        assert!(!drawn.holds(&around(Vec3::X * 6.0), 0.0), "beside");
        assert!(
            !drawn.holds(&around(-TOWARD * 2.0), 0.0),
            "farther from the light"
        );
        assert!(drawn.holds(&around(Vec3::X * 1e3), 0.0), "beside the map");
        let everything = Bounds {
            min: Vec3::splat(-1e3),
            max: Vec3::splat(1e3),
        };
        assert!(Shade::ALL.holds(&everything, 0.0) && !drawn.holds(&everything, 0.0));
    }
}
