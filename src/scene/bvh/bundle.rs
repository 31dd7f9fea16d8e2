//! Rays from one point, eight at a time: each node and triangle is tested against all of them at once.
//!
//! Wald, Slusallek, Benthin & Wagner 2001, "Interactive rendering with coherent ray tracing". With a common origin the numerators of
//! Möller and Trumbore are scalar products of the direction with vectors that all rays share.

use glam::Vec3;
use wide::f32x8;

use super::{Bvh, Node, ROUNDING, Triangle};

/// Rays of a bundle.
pub const LANES: usize = 8;

/// Directions of eight rays. Sets of rays are bit masks: bit n is ray n.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bundle {
    along: [f32x8; 3],
    inverse: [f32x8; 3],
    count: usize,
}

impl Bundle {
    /// Of the first eight directions, none of them zero; there may be fewer.
    pub fn new(directions: &[Vec3]) -> Self {
        let of = |lane: usize| directions.get(lane).copied().unwrap_or(Vec3::Y);
        let lanes: [Vec3; LANES] = std::array::from_fn(of);
        let along = [0, 1, 2].map(|axis| f32x8::new(lanes.map(|direction| direction[axis])));
        Self {
            count: directions.len().min(LANES),
            ..Self::of_lanes(along)
        }
    }

    /// Of eight directions, none of them zero, by their coordinates.
    pub fn of_lanes(along: [f32x8; 3]) -> Self {
        // Finite, so that a ray in the plane of a side of a box gives 0 and not 0 x infinity.
        let most = f32x8::splat(f32::MAX);
        let inverse = along.map(|along| (f32x8::ONE / along).fast_min(most).fast_max(-most));
        Self {
            along,
            inverse,
            count: LANES,
        }
    }

    /// All rays that there are.
    pub fn all(&self) -> u32 {
        (1 << self.count) - 1
    }

    /// The direction of a ray.
    pub fn direction(&self, lane: usize) -> Vec3 {
        Vec3::from(self.along.map(|along| along.to_array()[lane]))
    }

    /// Scalar products of the directions with a vector.
    pub fn dot(&self, v: Vec3) -> [f32; LANES] {
        self.products(v).to_array()
    }

    fn products(&self, v: Vec3) -> f32x8 {
        let [x, y, z] = self.along;
        x * v.x + y * v.y + z * v.z
    }

    /// The rays that meet a box, given by its corners relative to their origin.
    fn meet_box(&self, low: Vec3, high: Vec3) -> u32 {
        let (mut enter, mut leave) = (f32x8::ZERO, f32x8::splat(f32::INFINITY));
        for axis in 0..3 {
            let a = self.inverse[axis] * low[axis];
            let b = self.inverse[axis] * high[axis];
            enter = enter.fast_max(a.fast_min(b));
            leave = leave.fast_min(a.fast_max(b));
        }
        enter.simd_le(leave * ROUNDING).to_bitmask()
    }

    /// The rays that meet a triangle in front of their origin.
    fn meet_triangle(&self, origin: Vec3, triangle: &Triangle) -> u32 {
        let Triangle { edge1, edge2, .. } = *triangle;
        let s = origin - triangle.corner;
        let q = s.cross(edge1);
        let inverse = f32x8::ONE / self.products(edge2.cross(edge1));
        let u = self.products(edge2.cross(s)) * inverse;
        let v = self.products(q) * inverse;
        let distance = inverse * edge2.dot(q);
        // The comparisons are false for NaN, which a ray in the plane of the triangle gives.
        let is_met = u.simd_ge(f32x8::ZERO)
            & v.simd_ge(f32x8::ZERO)
            & (u + v).simd_le(f32x8::ONE)
            & distance.simd_gt(f32x8::ZERO)
            & distance.simd_lt(f32x8::splat(f32::INFINITY));
        is_met.to_bitmask()
    }
}

/// The triangle that stopped rays last: it is likely to stop their neighbours, and tested first.
#[derive(Debug, Clone, Copy, Default)]
pub struct Blocker(Option<usize>);

impl Bvh {
    /// Of the rays `lanes` of a bundle from `origin` those that nothing stops. `stopped` tells of a triangle and rays that meet it which of these it
    /// stops; triangles are two-sided and come in no order of distance, those that stop rays more than once.
    pub fn open(
        &self,
        origin: Vec3,
        (bundle, lanes): (&Bundle, u32),
        blocker: &mut Blocker,
        mut stopped: impl FnMut(&Triangle, u32) -> u32,
    ) -> u32 {
        let (mut open, mut at) = (lanes, 0);
        let mut stop = |number: usize, open: &mut u32| {
            let triangle = &self.triangles[number];
            let met = bundle.meet_triangle(origin, triangle) & *open;
            if met == 0 {
                return false;
            }
            let stopped = stopped(triangle, met);
            *open &= !stopped;
            stopped != 0
        };
        if let Blocker(Some(number)) = *blocker {
            stop(number, &mut open);
        }
        while open != 0
            && let Some(node) = self.nodes.get(at)
        {
            let Node { min, max, .. } = *node;
            if bundle.meet_box(min - origin, max - origin) & open == 0 {
                at = node.skip as usize;
                continue;
            }
            let first = node.first_triangle as usize;
            for number in first..first + node.triangle_count as usize {
                if stop(number, &mut open) {
                    *blocker = Blocker(Some(number));
                }
            }
            at += 1;
        }
        open
    }
}

#[cfg(test)]
mod tests {
    use super::super::Ray;
    use super::super::tests::{cloud, rays};
    use super::*;

    #[test]
    fn a_bundle_is_open_where_single_rays_are() {
        let bvh = Bvh::new(cloud(2000));
        let directions: Vec<Vec3> = rays(1003).map(|ray| ray.direction).collect();
        let (mut open, mut lanes, mut blocker) = (0, 0, Blocker::default());
        for (at, directions) in directions.chunks(LANES).enumerate() {
            let origin = rays(200).nth(at).map_or(Vec3::ZERO, |ray| ray.origin);
            let bundle = Bundle::new(directions);
            assert_eq!(bundle.all().count_ones() as usize, directions.len());
            // Triangles of odd numbers stop nothing.
            let is_stopping = |triangle: u32| triangle.is_multiple_of(2);
            let all = (&bundle, bundle.all());
            let found = bvh.open(origin, all, &mut blocker, |triangle, met| {
                if is_stopping(triangle.number) { met } else { 0 }
            });
            for (lane, direction) in directions.iter().enumerate() {
                let ray = Ray {
                    origin,
                    direction: *direction,
                };
                let hidden = bvh.any(&ray, 0.0, f32::INFINITY, |hit| is_stopping(hit.triangle));
                assert_eq!(found >> lane & 1 == 0, hidden, "{at} {lane}");
            }
            open += found.count_ones();
            lanes += directions.len() as u32;
            // Rays that are not asked for are not open.
            assert_eq!(
                bvh.open(origin, (&bundle, 0b101), &mut Blocker::default(), |_, _| 0),
                0b101
            );
        }
        assert!(
            (lanes / 10..lanes * 9 / 10).contains(&open),
            "{open} of {lanes}"
        );
    }
}
