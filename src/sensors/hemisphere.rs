//! Rays over the hemisphere of a point, one in each of many cells of equal share, eight neighbours at a time; what they find of the sky.

use std::f32::consts::TAU;

use glam::Vec3;
use wide::f32x8;

use super::surface::{TracedScene, lanes_of};
use crate::daylight::sampling::rnd;
use crate::daylight::tangent_frame::duff_f32;
use crate::scene::{Blocker, Bundle};

/// Cells of a bundle from the pole to the rim and around it.
const TILE: [u32; 2] = [4, 2];

/// One of how many rays that meet a pane tells what it mirrors.
const MIRRORED: f64 = 4.0;

/// The hemisphere of a point in cells of equal share of cos θ/π.
pub(super) struct Hemisphere {
    normal: Vec3,
    across: [Vec3; 2],
    side: u32,
}

impl Hemisphere {
    /// Around a unit vector, with `side` cells from the pole to the rim and as many around it, or up to three more.
    pub fn new(normal: Vec3, side: u32) -> Self {
        Self {
            normal,
            across: duff_f32(normal).into(),
            side: side.max(1).next_multiple_of(TILE[0]),
        }
    }

    /// Turns it to another unit vector.
    pub fn turn(&mut self, normal: Vec3) {
        if normal != self.normal {
            (self.normal, self.across) = (normal, duff_f32(normal).into());
        }
    }

    /// Cells from the pole to the rim.
    pub fn side(&self) -> u32 {
        self.side
    }

    /// The first cells of bundles, each by its number from the pole and around it.
    pub fn tiles(&self) -> impl Iterator<Item = [u32; 2]> + use<> {
        let [rows, columns] = TILE.map(|step| (0..self.side).step_by(step as usize));
        rows.flat_map(move |row| columns.clone().map(move |column| [row, column]))
    }

    /// The cell of a ray of the bundle that begins at a cell.
    pub fn cell([row, column]: [u32; 2], lane: usize) -> [u32; 2] {
        let lane = lane as u32;
        [row + lane / TILE[1], column + lane % TILE[1]]
    }

    /// A ray in each cell of a bundle, by random numbers of `state`.
    pub fn bundle(&self, first: [u32; 2], state: &mut u32) -> Bundle {
        let mut jitter = || f32x8::new(std::array::from_fn(|_| rnd(state) as f32));
        let [rows, columns] = [0, 1].map(|axis| {
            let of = |lane| Self::cell(first, lane)[axis] as f32;
            f32x8::new(std::array::from_fn(of))
        });
        let edge = 1.0 / self.side as f32;
        let square = (rows + jitter()) * edge;
        let (sin, cos) = ((columns + jitter()) * (TAU * edge)).sin_cos();
        let radius = square.sqrt();
        let height = (1.0 - square).max(f32x8::ZERO).sqrt();
        let [x, y] = self.across;
        let along =
            |axis: usize| radius * (cos * x[axis] + sin * y[axis]) + height * self.normal[axis];
        Bundle::of_lanes([0, 1, 2].map(along))
    }
}

/// Tells `found` of the directions in which rays of a bundle leave the scene, and what panes leave of the light from there: straight on, and mirrored
/// by panes.
pub(super) fn outside(
    scene: &TracedScene,
    from: Vec3,
    bundle: &Bundle,
    (state, blocker): (&mut u32, &mut Blocker),
    mut found: impl FnMut(Vec3, Vec3),
) {
    let (open, through) = scene.passing_each(from, (bundle, bundle.all()), blocker);
    lanes_of(open).for_each(|lane| found(bundle.direction(lane), through[lane]));
    for lane in lanes_of(scene.meet_panes(from, bundle, bundle.all())) {
        if MIRRORED * rnd(state) >= 1.0 {
            continue;
        }
        let met = scene.first(from, bundle.direction(lane), || rnd(state));
        if met.is_mirrored && met.point.is_none() {
            found(met.direction, (MIRRORED * met.through).as_vec3());
        }
    }
}
