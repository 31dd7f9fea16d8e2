//! The raster of a plane, and the regions that surfaces part.

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use super::{Level, Planes};
use crate::scene::{Bvh, Ray, Scene};
use crate::sensors::grid::GridError;

/// Samples from one sensor to the next.
const FINER: f32 = 0.5;

/// Most samples of a plane.
const MOST_SAMPLES: f32 = 16e6;

/// Least width and length that a room has somewhere, metres.
const LEAST_WIDTH: f32 = 0.9;

/// Least part of the border of a room that is walls.
const LEAST_CLOSED: f32 = 0.75;

/// Least part of a room where nothing stands on the floor.
const LEAST_FREE: f32 = 0.3;

/// Most walls that turn their back on a room. More do inside of a body.
const MOST_BACKS: f32 = 0.5;

/// Space below the plane that a floor may differ from its level, metres.
const TOLERANCE: f32 = 0.05;

/// The directions to the next samples, and their steps in the raster.
const SIDES: [([i64; 2], Vec3); 4] = [
    ([1, 0], Vec3::X),
    ([-1, 0], Vec3::NEG_X),
    ([0, 1], Vec3::Z),
    ([0, -1], Vec3::NEG_Z),
];

/// A sample.
#[derive(Clone, Copy, PartialEq, Eq, Default)]
enum Sample {
    /// Not above the floor, or below the sky.
    #[default]
    Outside,
    /// Something stands on the floor.
    Covered,
    Free,
}

/// Samples of the plane above a level.
pub(super) struct Raster {
    /// Of the plane, metres.
    pub height: f32,
    corner: Vec2,
    /// From sample to sample, metres.
    step: f32,
    size: [usize; 2],
    samples: Vec<Sample>,
    /// For each sample and side what parts it from the next.
    borders: Vec<[Option<Border>; 4]>,
}

/// A surface beside a sample.
#[derive(Clone, Copy)]
struct Border {
    /// Distance from the sample, metres.
    distance: f32,
    /// Whether its front is turned away.
    is_back: bool,
}

/// Samples that belong together.
pub(super) struct Region {
    /// Its smallest and largest coordinates: east, south, metres.
    pub min: Vec2,
    pub max: Vec2,
    /// Whether it is one for each sample of the raster.
    members: Vec<bool>,
    area: f32,
    free: f32,
    closed: f32,
    backs: f32,
    is_wide: bool,
}

impl Raster {
    /// # Errors
    /// A floor that is too large for the spacing.
    pub fn new(
        (scene, bvh): (&Scene, &Bvh),
        level: &Level,
        planes: &Planes,
    ) -> Result<Self, GridError> {
        let corners = || level.triangles.iter().flatten().copied();
        let corner = corners().reduce(Vec2::min).unwrap_or_default();
        let extent = corners().reduce(Vec2::max).unwrap_or_default() - corner;
        let step = FINER * planes.spacing;
        let size = (extent / step).ceil().max(Vec2::ONE);
        if size.x * size.y > MOST_SAMPLES {
            return Err(GridError::LargeFloor {
                metres: extent.max_element().round() as u32,
            });
        }
        let mut raster = Self {
            height: level.y + planes.height,
            corner,
            step,
            size: size.to_array().map(|n| n as usize),
            samples: vec![Sample::Outside; (size.x * size.y) as usize],
            borders: Vec::new(),
        };
        for triangle in &level.triangles {
            raster.cover(triangle);
        }
        let is_roofed = planes.floors.is_empty();
        let samples = (0..raster.samples.len()).into_par_iter();
        let samples = samples.map(|at| raster.sample(bvh, at, planes.height, is_roofed));
        raster.samples = samples.collect();
        let borders = (0..raster.samples.len()).into_par_iter();
        raster.borders = borders
            .map(|at| raster.borders_of(scene, bvh, at))
            .collect();
        Ok(raster)
    }

    /// Marks the samples above a triangle.
    fn cover(&mut self, triangle: &[Vec2; 3]) {
        let [a, b, c] = triangle.map(|v| (v - self.corner) / self.step - 0.5);
        let least = a.min(b).min(c).ceil().max(Vec2::ZERO);
        let most = a.max(b).max(c).floor();
        let is_left = |p: Vec2, q: Vec2, at: Vec2| (q - p).perp_dot(at - p) >= 0.0;
        for row in least.y as usize..((most.y + 1.0).max(0.0) as usize).min(self.size[1]) {
            for column in least.x as usize..((most.x + 1.0).max(0.0) as usize).min(self.size[0]) {
                let at = Vec2::new(column as f32, row as f32);
                let sides = [is_left(a, b, at), is_left(b, c, at), is_left(c, a, at)];
                if sides == [true; 3] || sides == [false; 3] {
                    self.samples[row * self.size[0] + column] = Sample::Free;
                }
            }
        }
    }

    /// The point of a sample.
    fn point(&self, at: usize) -> Vec3 {
        let [column, row] = [at % self.size[0], at / self.size[0]].map(|n| n as f32 + 0.5);
        let plan = self.corner + self.step * Vec2::new(column, row);
        Vec3::new(plan.x, self.height, plan.y)
    }

    fn sample(&self, bvh: &Bvh, at: usize, height: f32, is_roofed: bool) -> Sample {
        if self.samples[at] == Sample::Outside {
            return Sample::Outside;
        }
        let ray = |direction| Ray {
            origin: self.point(at),
            direction,
        };
        if is_roofed && !bvh.any(&ray(Vec3::Y), 0.0, f32::INFINITY, |_| true) {
            return Sample::Outside;
        }
        if bvh.any(&ray(Vec3::NEG_Y), 0.0, height - TOLERANCE, |_| true) {
            return Sample::Covered;
        }
        Sample::Free
    }

    fn borders_of(&self, scene: &Scene, bvh: &Bvh, at: usize) -> [Option<Border>; 4] {
        if self.samples[at] == Sample::Outside {
            return [None; 4];
        }
        SIDES.map(|(_, direction)| {
            let ray = Ray {
                origin: self.point(at),
                direction,
            };
            let hit = bvh.closest(&ray, 0.0, self.step, |_| true)?;
            let first = 3 * hit.triangle as usize;
            let [a, b, c] =
                [0, 1, 2].map(|k| Vec3::from(scene.positions[scene.indices[first + k] as usize]));
            Some(Border {
                distance: hit.distance,
                is_back: (b - a).cross(c - a).dot(direction) > 0.0,
            })
        })
    }

    /// The next sample on a side, if it is in the raster.
    fn next(&self, at: usize, side: [i64; 2]) -> Option<usize> {
        let [width, height] = self.size.map(|n| n as i64);
        let (column, row) = (at as i64 % width + side[0], at as i64 / width + side[1]);
        let is_inside = (0..width).contains(&column) && (0..height).contains(&row);
        is_inside.then(|| (row * width + column) as usize)
    }

    /// The regions, in the order of their first samples.
    pub fn regions(&self) -> Vec<Region> {
        let mut is_seen = vec![false; self.samples.len()];
        let mut regions = Vec::new();
        for start in 0..self.samples.len() {
            if is_seen[start] || self.samples[start] == Sample::Outside {
                continue;
            }
            let mut members = vec![start];
            is_seen[start] = true;
            let mut done = 0;
            while let Some(at) = members.get(done).copied() {
                done += 1;
                for ((side, _), border) in SIDES.iter().zip(self.borders[at]) {
                    let next = self.next(at, *side).filter(|_| border.is_none());
                    let is_new = |n: &usize| !is_seen[*n] && self.samples[*n] != Sample::Outside;
                    if let Some(next) = next.filter(is_new) {
                        is_seen[next] = true;
                        members.push(next);
                    }
                }
            }
            regions.push(self.region(&members));
        }
        regions
    }

    fn region(&self, list: &[usize]) -> Region {
        let mut members = vec![false; self.samples.len()];
        for at in list {
            members[*at] = true;
        }
        let (mut min, mut max) = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        let (mut free, mut walls, mut open, mut backs) = (0.0, 0.0f32, 0.0f32, 0.0);
        for at in list {
            free += f32::from(self.samples[*at] == Sample::Free);
            let point = self.point(*at);
            for ((side, direction), border) in SIDES.iter().zip(self.borders[*at]) {
                let is_inner =
                    border.is_none() && self.next(*at, *side).is_some_and(|next| members[next]);
                if is_inner {
                    continue;
                }
                let reach = border.map_or(0.5 * self.step, |border| border.distance);
                let end = point + reach * *direction;
                min = min.min(Vec2::new(end.x, end.z));
                max = max.max(Vec2::new(end.x, end.z));
                walls += f32::from(border.is_some());
                open += f32::from(border.is_none());
                backs += f32::from(border.is_some_and(|border| border.is_back));
            }
        }
        let count = list.len() as f32;
        Region {
            min,
            max,
            area: count * self.step * self.step,
            free: free / count,
            closed: walls / (walls + open).max(1.0),
            backs: backs / walls.max(1.0),
            is_wide: list.iter().any(|at| self.is_middle(&members, *at)),
            members,
        }
    }

    /// Whether all samples around are members too, as wide as a room must be.
    fn is_middle(&self, members: &[bool], at: usize) -> bool {
        let reach = (0.5 * (LEAST_WIDTH / self.step - 1.0)).ceil().max(0.0) as i64;
        let is_member = |column, row| self.next(at, [column, row]).is_some_and(|n| members[n]);
        (-reach..=reach).all(|row| (-reach..=reach).all(|column| is_member(column, row)))
    }

    /// Whether a point is in a region: nothing parts it from a sample nearby.
    pub fn belongs(&self, bvh: &Bvh, region: &Region, origin: Vec3) -> bool {
        let plan = (Vec2::new(origin.x, origin.z) - self.corner) / self.step;
        let [width, height] = self.size.map(|n| n as i64);
        let around = |n: f32, count: i64| {
            let n = n.floor() as i64;
            (n - 1).max(0)..=(n + 1).min(count - 1)
        };
        around(plan.y, height).any(|row| {
            around(plan.x, width).any(|column| {
                let at = (row * width + column) as usize;
                let direction = self.point(at) - origin;
                let is_near = direction.length() <= self.step;
                let ray = Ray { origin, direction };
                let is_parted = || direction != Vec3::ZERO && bvh.any(&ray, 0.0, 1.0, |_| true);
                region.members[at] && is_near && !is_parted()
            })
        })
    }
}

impl Region {
    /// Whether it is a room: wide, walled in, with a floor on which things stand, and no inside of a body.
    pub fn is_room(&self) -> bool {
        self.area >= super::LEAST_AREA
            && self.is_wide
            && self.closed >= LEAST_CLOSED
            && self.free >= LEAST_FREE
            && self.backs <= MOST_BACKS
    }
}
