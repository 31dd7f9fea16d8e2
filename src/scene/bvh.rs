//! A bounding volume hierarchy over the triangles of a scene, and rays through it.
//!
//! Built by a binned surface area heuristic (Wald 2007, "On fast construction of SAH-based bounding volume hierarchies"). Nodes are stored
//! depth-first with skip links, so that occlusion rays need no stack (Smits 1998, "Efficiency issues for ray tracing"). Triangle
//! intersection: Möller and Trumbore 1997. All in `f32`.

mod bundle;
mod stored;

use std::thread;

use bytemuck::{Pod, Zeroable};
use glam::{Vec3, Vec3A};

use crate::scene::{Bounds, Scene};

pub use bundle::{Blocker, Bundle, LANES};
pub use stored::FlatBvh;

/// Most triangles of a leaf.
pub const LEAF_TRIANGLES: usize = 3;

/// Bins of centroids along each axis; a node is split at one of their borders.
const BINS: usize = 16;

/// Cost of visiting a node, in triangle tests.
const NODE_COST: f32 = 1.0;

/// Subtrees with more triangles are built on a thread of their own.
const PARALLEL_TRIANGLES: usize = 1 << 14;

/// Largest depth of the tree: where the heuristic would exceed it, nodes are halved instead.
const MAX_DEPTH: usize = 40;

/// Covers the rounding errors of the slab test, so that triangles in a side of a box are not missed (Ize 2013, "Robust BVH ray
/// traversal").
const ROUNDING: f32 = 1.0 + 4.0 * f32::EPSILON;

/// A node.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Node {
    /// Lower corner of its box, metres.
    pub min: Vec3,
    /// Upper corner of its box, metres.
    pub max: Vec3,
    /// Position of the first triangle of a leaf in [`Bvh::triangles`].
    pub first_triangle: u32,
    /// Number of triangles of a leaf; 0 for an inner node.
    pub triangle_count: u32,
    /// The node after the whole subtree. The first child of an inner node is the next node; its `skip` is the second child.
    pub skip: u32,
}

/// A triangle, prepared for intersection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Triangle {
    /// Its first corner, metres.
    pub corner: Vec3,
    /// From the first corner to the second, metres.
    pub edge1: Vec3,
    /// From the first corner to the third, metres.
    pub edge2: Vec3,
    /// Its number in the scene.
    pub number: u32,
}

/// A ray from `origin` along `direction`, which need not be of unit length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// World space, metres.
    pub origin: Vec3,
    /// Not zero.
    pub direction: Vec3,
}

/// Intersection of a ray with a triangle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance from the origin, in lengths of the direction.
    pub distance: f32,
    /// Index of the triangle: its corners start at three times this index in [`Scene::indices`].
    pub triangle: u32,
    /// Barycentric weights of the second and third corner.
    pub barycentrics: [f32; 2],
}

/// A bounding volume hierarchy over triangles.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    triangles: Vec<Triangle>,
}

impl Bvh {
    /// Builds the hierarchy over the triangles of all parts for which `keep` returns true.
    pub fn of(scene: &Scene, keep: impl Fn(&crate::scene::Part) -> bool) -> Self {
        let mut triangles = Vec::with_capacity(scene.triangles());
        for part in scene.parts.iter().filter(|part| keep(part)) {
            let first = part.first_index / 3;
            triangles.extend((first..first + part.index_count / 3).map(|n| triangle(scene, n)));
        }
        Self::new(triangles)
    }

    fn new(mut triangles: Vec<Triangle>) -> Self {
        if triangles.is_empty() {
            return Self::default();
        }
        let mut nodes = build(&mut triangles, 0, 0);
        number_skips(&mut nodes);
        Self { nodes, triangles }
    }

    /// Its nodes, depth-first.
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Its triangles, in the order of the leaves.
    pub fn triangles(&self) -> &[Triangle] {
        &self.triangles
    }

    /// The nearest hit between the distances `near` and `far`. Triangles are two-sided. `accept` can reject hits, for example those
    /// in holes of cut-outs.
    pub fn closest(
        &self,
        ray: &Ray,
        near: f32,
        far: f32,
        accept: impl Fn(&Hit) -> bool,
    ) -> Option<Hit> {
        let inverse = ray.inverse();
        // Nodes that wait, and where the ray enters them.
        let mut stack = [(0u32, 0.0f32); MAX_DEPTH + 2];
        let mut depth = 0;
        let mut best: Option<Hit> = None;
        let mut limit = far;
        let root = self.nodes.first();
        if let Some(entry) = root.and_then(|node| node.entry(ray, inverse, near, far)) {
            (stack[0], depth) = ((0, entry), 1);
        }
        while depth > 0 {
            depth -= 1;
            let (at, entry) = stack[depth];
            // By now a hit may lie before the box.
            if entry > limit * ROUNDING {
                continue;
            }
            let node = &self.nodes[at as usize];
            if node.triangle_count > 0 {
                for triangle in self.of_leaf(node) {
                    if let Some(hit) = triangle.meet(ray, near, limit)
                        && accept(&hit)
                    {
                        limit = hit.distance;
                        best = Some(hit);
                    }
                }
                continue;
            }
            let children = [at + 1, self.nodes[at as usize + 1].skip];
            let entry = children.map(|c| self.nodes[c as usize].entry(ray, inverse, near, limit));
            // The farther child is pushed first.
            let order = match entry {
                [Some(a), Some(b)] if b < a => [0, 1],
                _ => [1, 0],
            };
            for child in order {
                if let Some(entry) = entry[child] {
                    stack[depth] = (children[child], entry);
                    depth += 1;
                }
            }
        }
        best
    }

    /// Whether anything is hit between the distances `near` and `far`.
    pub fn any(&self, ray: &Ray, near: f32, far: f32, accept: impl Fn(&Hit) -> bool) -> bool {
        let inverse = ray.inverse();
        let mut at = 0;
        while let Some(node) = self.nodes.get(at) {
            if node.entry(ray, inverse, near, far).is_none() {
                at = node.skip as usize;
                continue;
            }
            let mut triangles = self.of_leaf(node).iter();
            if triangles.any(|t| t.meet(ray, near, far).is_some_and(|hit| accept(&hit))) {
                return true;
            }
            at += 1;
        }
        false
    }

    fn of_leaf(&self, node: &Node) -> &[Triangle] {
        let first = node.first_triangle as usize;
        &self.triangles[first..first + node.triangle_count as usize]
    }
}

impl Node {
    /// Where a ray enters the box, if it does between `near` and `far`.
    fn entry(&self, ray: &Ray, inverse: Vec3A, near: f32, far: f32) -> Option<f32> {
        // Vectors of four, for the processor's instructions on four numbers at once.
        let origin = Vec3A::from(ray.origin);
        let a = (Vec3A::from(self.min) - origin) * inverse;
        let b = (Vec3A::from(self.max) - origin) * inverse;
        let enter = a.min(b).max_element().max(near);
        let leave = a.max(b).min_element().min(far);
        (enter <= leave * ROUNDING).then_some(enter)
    }
}

impl Ray {
    /// Reciprocals of the direction, finite, so that a ray in the plane of a side gives 0 and not 0 x infinity.
    fn inverse(&self) -> Vec3A {
        let most = Vec3A::splat(f32::MAX);
        Vec3A::from(self.direction).recip().clamp(-most, most)
    }
}

impl Triangle {
    /// Where a ray meets it between `near` and `far`: Möller and Trumbore 1997, "Fast, minimum storage ray/triangle intersection", both sides.
    pub fn meet(&self, ray: &Ray, near: f32, far: f32) -> Option<Hit> {
        let p = ray.direction.cross(self.edge2);
        let inverse = self.edge1.dot(p).recip();
        let s = ray.origin - self.corner;
        let u = s.dot(p) * inverse;
        let q = s.cross(self.edge1);
        let v = ray.direction.dot(q) * inverse;
        let distance = self.edge2.dot(q) * inverse;
        // The comparisons are false for NaN, which a ray in the plane of the triangle gives.
        let is_met = u >= 0.0 && v >= 0.0 && u + v <= 1.0 && distance > near && distance < far;
        is_met.then_some(Hit {
            distance,
            triangle: self.number,
            barycentrics: [u, v],
        })
    }

    fn bounds(&self) -> Bounds {
        let corners = [
            self.corner,
            self.corner + self.edge1,
            self.corner + self.edge2,
        ];
        Bounds::of(corners)
    }

    fn centroid(&self) -> Vec3 {
        self.corner + (self.edge1 + self.edge2) / 3.0
    }
}

fn triangle(scene: &Scene, number: u32) -> Triangle {
    let [a, b, c] = [0, 1, 2].map(|i| {
        let vertex = scene.indices[3 * number as usize + i];
        Vec3::from(scene.positions[vertex as usize])
    });
    Triangle {
        corner: a,
        edge1: b - a,
        edge2: c - a,
        number,
    }
}

/// The nodes of a subtree over `triangles`, which are brought into the order of its leaves. `first` is the number of the
/// first of them; `skip` of each node is the size of its subtree yet.
fn build(triangles: &mut [Triangle], first: u32, depth: usize) -> Vec<Node> {
    let bounds = triangles
        .iter()
        .fold(Bounds::EMPTY, |all, t| all.union(t.bounds()));
    let halvings = triangles.len().div_ceil(LEAF_TRIANGLES).next_power_of_two();
    let split = if depth + halvings.ilog2() as usize >= MAX_DEPTH {
        (triangles.len() > LEAF_TRIANGLES).then_some(triangles.len() / 2)
    } else {
        split(triangles, &bounds)
    };
    let mut node = Node {
        min: bounds.min,
        max: bounds.max,
        first_triangle: first,
        triangle_count: triangles.len() as u32,
        skip: 1,
    };
    let Some(middle) = split else {
        return vec![node];
    };
    let is_large = triangles.len() > PARALLEL_TRIANGLES;
    let (left, right) = triangles.split_at_mut(middle);
    let second = first + middle as u32;
    let (left, right) = if is_large {
        thread::scope(|scope| {
            let left = scope.spawn(|| build(left, first, depth + 1));
            let right = build(right, second, depth + 1);
            // A fault of this program is one on this thread too.
            let left = left.join();
            (
                left.unwrap_or_else(|fault| std::panic::resume_unwind(fault)),
                right,
            )
        })
    } else {
        (
            build(left, first, depth + 1),
            build(right, second, depth + 1),
        )
    };
    (node.first_triangle, node.triangle_count) = (0, 0);
    node.skip = (1 + left.len() + right.len()) as u32;
    let mut nodes = Vec::with_capacity(node.skip as usize);
    nodes.push(node);
    nodes.extend(left);
    nodes.extend(right);
    nodes
}

/// Sizes of subtrees to numbers of nodes.
fn number_skips(nodes: &mut [Node]) {
    for (at, node) in nodes.iter_mut().enumerate() {
        node.skip += at as u32;
    }
}

/// A bin of the heuristic.
#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds,
    count: usize,
}

/// Partitions the triangles at the cheapest split and returns the size of the first half; `None` if a leaf is cheaper.
fn split(triangles: &mut [Triangle], bounds: &Bounds) -> Option<usize> {
    if triangles.len() <= 1 {
        return None;
    }
    let centroids = Bounds::of(triangles.iter().map(Triangle::centroid));
    let mut best: Option<(f32, usize, f32)> = None;
    for axis in 0..3 {
        let (low, extent) = (centroids.min[axis], centroids.extent()[axis]);
        if extent <= 0.0 || !extent.is_finite() {
            continue;
        }
        let scale = BINS as f32 / extent;
        let bins = binned(triangles, axis, low, scale);
        for (cost, boundary) in costs(&bins) {
            if best.is_none_or(|(least, ..)| cost < least) {
                best = Some((cost, axis, low + boundary as f32 / scale));
            }
        }
    }
    let leaf = triangles.len() as f32;
    let area = half_area(bounds).max(f32::MIN_POSITIVE);
    let (cost, axis, plane) = match best {
        Some(best) => best,
        // All centroids coincide: split by count, because leaves are bounded.
        None if triangles.len() > LEAF_TRIANGLES => return Some(triangles.len() / 2),
        None => return None,
    };
    if triangles.len() <= LEAF_TRIANGLES && NODE_COST + cost / area >= leaf {
        return None;
    }
    let middle = partition(triangles, |t| t.centroid()[axis] < plane);
    let is_proper = middle > 0 && middle < triangles.len();
    Some(if is_proper {
        middle
    } else {
        triangles.len() / 2
    })
}

fn binned(triangles: &[Triangle], axis: usize, low: f32, scale: f32) -> [Bin; BINS] {
    let empty = Bin {
        bounds: Bounds::EMPTY,
        count: 0,
    };
    let mut bins = [empty; BINS];
    for triangle in triangles {
        let at = ((triangle.centroid()[axis] - low) * scale) as usize;
        let bin = &mut bins[at.min(BINS - 1)];
        bin.bounds = bin.bounds.union(triangle.bounds());
        bin.count += 1;
    }
    bins
}

/// Of every boundary between bins: areas times numbers of both sides, and the number of bins before it.
fn costs(bins: &[Bin; BINS]) -> impl Iterator<Item = (f32, usize)> {
    let mut right = [0.0; BINS];
    let (mut bounds, mut count) = (Bounds::EMPTY, 0);
    for at in (1..BINS).rev() {
        bounds = bounds.union(bins[at].bounds);
        count += bins[at].count;
        right[at] = half_area(&bounds) * count as f32;
    }
    let (mut bounds, mut count) = (Bounds::EMPTY, 0);
    let mut list = [(f32::INFINITY, 0); BINS - 1];
    for at in 1..BINS {
        bounds = bounds.union(bins[at - 1].bounds);
        count += bins[at - 1].count;
        list[at - 1] = (half_area(&bounds) * count as f32 + right[at], at);
    }
    list.into_iter()
}

/// Half of the surface of a box, m².
fn half_area(bounds: &Bounds) -> f32 {
    let e = bounds.extent();
    e.x * e.y + e.y * e.z + e.z * e.x
}

/// Moves the triangles that satisfy `first` to the front and returns their number.
fn partition(triangles: &mut [Triangle], first: impl Fn(&Triangle) -> bool) -> usize {
    let mut count = 0;
    for at in 0..triangles.len() {
        if first(&triangles[at]) {
            triangles.swap(at, count);
            count += 1;
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Fractions of multiples of the powers of the plastic number's reciprocal: spread over the unit square.
    fn r2(i: u32) -> glam::Vec2 {
        let at = f64::from(i) * glam::DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_3);
        at.fract().as_vec2()
    }

    /// Small triangles at pseudo-random places of the unit cube.
    pub(super) fn cloud(count: u32) -> Vec<Triangle> {
        let point = |i: u32| {
            let xy = r2(i);
            Vec3::new(xy.x, xy.y, (i as f32 * 0.618_034).fract())
        };
        let triangle = |number| {
            let offset = |k| 0.2 * (point(7 * number + k) - 0.5);
            Triangle {
                corner: point(number),
                edge1: offset(1),
                edge2: offset(2),
                number,
            }
        };
        (0..count).map(triangle).collect()
    }

    pub(super) fn rays(count: u32) -> impl Iterator<Item = Ray> {
        (0..count).map(|i| {
            let (a, b) = (r2(2 * i + 1), r2(5 * i + 3));
            let direction = Vec3::new(b.x - 0.5, b.y - 0.5, a.x - a.y);
            Ray {
                origin: 2.0 * Vec3::new(a.x, a.y, b.x) - 0.5,
                direction: direction.normalize_or(Vec3::X),
            }
        })
    }

    #[test]
    fn rays_meet_what_a_loop_over_all_triangles_meets() {
        let all = cloud(3000);
        let bvh = Bvh::new(all.clone());
        let mut hits = 0;
        for ray in rays(2000) {
            let nearest = all
                .iter()
                .filter_map(|t| t.meet(&ray, 0.0, f32::INFINITY))
                .min_by(|a, b| a.distance.total_cmp(&b.distance));
            let met = bvh.closest(&ray, 0.0, f32::INFINITY, |_| true);
            assert_eq!(met.map(|h| h.distance), nearest.map(|h| h.distance));
            assert_eq!(
                bvh.any(&ray, 0.0, f32::INFINITY, |_| true),
                nearest.is_some()
            );
            hits += u32::from(met.is_some());
        }
        assert!((400..2000).contains(&hits), "{hits}");
    }

    #[test]
    fn distances_bound_what_is_met_and_hits_can_be_refused() {
        let square = |z: f32, number| Triangle {
            corner: Vec3::new(-1.0, -1.0, z),
            edge1: 4.0 * Vec3::X,
            edge2: 4.0 * Vec3::Y,
            number,
        };
        let bvh = Bvh::new(vec![square(1.0, 0), square(2.0, 1), square(3.0, 2)]);
        let ray = Ray {
            origin: Vec3::ZERO,
            direction: 0.5 * Vec3::Z,
        };
        let met = |near, far| bvh.closest(&ray, near, far, |_| true).map(|h| h.triangle);
        assert_eq!(met(0.0, 100.0), Some(0));
        assert_eq!(
            met(2.5, 100.0),
            Some(1),
            "two lengths of the direction to a metre"
        );
        assert_eq!(met(0.0, 1.5), None);
        let refused = bvh.closest(&ray, 0.0, 100.0, |hit| hit.triangle == 2);
        assert_eq!(refused.map(|h| (h.triangle, h.distance)), Some((2, 6.0)));
        assert!(!bvh.any(&ray, 0.0, 100.0, |_| false));
    }

    #[test]
    fn rays_along_the_axes_meet_triangles_in_the_sides_of_their_boxes() {
        // A square in each plane x, y, z = 0, over the unit square: its box has no thickness.
        let axes = [Vec3::X, Vec3::Y, Vec3::Z];
        let half = |number: u32| Triangle {
            corner: Vec3::ZERO,
            edge1: 2.0 * axes[(number as usize + 1) % 3],
            edge2: 2.0 * axes[(number as usize + 2) % 3],
            number,
        };
        let bvh = Bvh::new((0..3).map(half).collect());
        for (number, axis) in (0..3).zip(axes) {
            for side in [-1.0, 1.0] {
                let ray = Ray {
                    origin: side * axis + 0.5 * (Vec3::ONE - axis),
                    direction: -side * axis,
                };
                let hit = bvh.closest(&ray, 0.0, 2.0, |_| true);
                assert_eq!(hit.map(|h| (h.triangle, h.distance)), Some((number, 1.0)));
                assert!(bvh.any(&ray, 0.0, 2.0, |_| true));
                // In the planes of the other two it begins on their sides.
                let edge = Ray {
                    origin: side * axis,
                    ..ray
                };
                assert!(bvh.any(&edge, 0.0, 2.0, |_| true), "{axis} {side}");
            }
        }
    }

    #[test]
    fn triangles_in_one_place_and_empty_scenes_end() {
        let one = cloud(1)[0];
        let many = vec![one; 1000];
        let bvh = Bvh::new(many);
        assert!(bvh.nodes().len() < 2000);
        let towards = Ray {
            origin: one.centroid() - Vec3::Z,
            direction: Vec3::Z,
        };
        assert!(bvh.any(&towards, 0.0, 2.0, |_| true));
        let none = Bvh::new(Vec::new());
        assert!(!none.any(&towards, 0.0, 2.0, |_| true));
        assert_eq!(none.closest(&towards, 0.0, 2.0, |_| true), None);
    }

    #[test]
    fn leaves_are_small_and_hold_each_triangle_once() {
        let bvh = Bvh::new(cloud(20_000));
        let leaves = bvh.nodes.iter().filter(|n| n.triangle_count > 0);
        let mut count = 0;
        for leaf in leaves {
            assert!(leaf.triangle_count as usize <= LEAF_TRIANGLES);
            count += leaf.triangle_count;
        }
        assert_eq!(count, 20_000);
        let mut numbers: Vec<u32> = bvh.triangles.iter().map(|t| t.number).collect();
        numbers.sort_unstable();
        assert!(numbers.iter().copied().eq(0..20_000));
    }
}
