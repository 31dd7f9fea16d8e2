//! Connected surfaces (bodies) of a scene: their bounds, and whether they are closed.

use std::collections::HashMap;
use std::hash::{BuildHasherDefault, Hasher};

use glam::{DVec3, Vec3};

use crate::scene::{Bounds, Scene};

/// A connected surface: triangles connected through shared vertex positions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Bounds of its triangles, metres.
    pub bounds: Bounds,
    /// Whether the surface is closed and its triangles wind counter-clockwise seen from outside. No back face is then visible
    /// from outside.
    pub is_solid: bool,
    /// Twice the volume over the area, metres: the thickness of a slab. Only of a closed surface.
    pub thickness: f32,
}

/// Thickness up to which a closed body of glass is one pane, metres: thicker ones have panes as walls.
const THICKEST_PANE: f32 = 0.15;

impl Body {
    /// Whether it is a slab, a pane if it is of glass: light enters it by one face and leaves it by another.
    pub fn is_slab(&self) -> bool {
        self.is_solid && self.thickness <= THICKEST_PANE
    }
}

/// The bodies of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Bodies {
    /// All bodies.
    pub list: Vec<Body>,
    /// For each vertex, the index of its body in `list`.
    pub of_vertex: Vec<u32>,
}

impl Bodies {
    /// Finds the bodies. Vertices with bitwise equal positions are merged.
    pub fn of(scene: &Scene) -> Self {
        let points = weld(&scene.positions);
        let mut sets = Sets::new(points.len());
        let triangles = || {
            let corners = scene.indices.chunks_exact(3);
            corners.map(|c| [0, 1, 2].map(|i| points[c[i] as usize]))
        };
        for [a, b, c] in triangles() {
            sets.join(a, b);
            sets.join(a, c);
        }
        let mut numbers = HashMap::new();
        let of_vertex: Vec<u32> = points
            .iter()
            .map(|p| {
                let next = numbers.len() as u32;
                *numbers.entry(sets.root(*p)).or_insert(next)
            })
            .collect();
        let mut sums = vec![Sums::default(); numbers.len()];
        for corners in scene.indices.chunks_exact(3) {
            let vertices = [0, 1, 2].map(|i| corners[i] as usize);
            let positions = vertices.map(|v| Vec3::from(scene.positions[v]));
            sums[of_vertex[vertices[0]] as usize].add(vertices.map(|v| points[v]), positions);
        }
        Self {
            list: sums.iter().map(Sums::body).collect(),
            of_vertex,
        }
    }
}

/// For each vertex, the first vertex at the same position.
fn weld(positions: &[[f32; 3]]) -> Vec<u32> {
    let mut first: HashMap<[u32; 3], u32, BuildHasherDefault<Mix>> = HashMap::default();
    first.reserve(positions.len());
    let numbered = positions.iter().enumerate();
    numbered
        // Adding zero normalises −0 to 0.
        .map(|(i, p)| {
            *first
                .entry(p.map(|x| (x + 0.0).to_bits()))
                .or_insert(i as u32)
        })
        .collect()
}

/// A fast hash for the many positions. A malicious file could only slow the lookup down.
#[derive(Default)]
struct Mix(u64);

impl Hasher for Mix {
    fn write(&mut self, bytes: &[u8]) {
        for chunk in bytes.chunks(4) {
            let mut word = [0; 4];
            word[..chunk.len()].copy_from_slice(chunk);
            self.0 = mixed(self.0 ^ u64::from(u32::from_le_bytes(word)));
        }
    }

    fn finish(&self) -> u64 {
        self.0
    }
}

/// SplitMix64 (Steele et al. 2014).
fn mixed(mut x: u64) -> u64 {
    x = x.wrapping_add(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

/// Disjoint sets (Galler and Fischer 1964) with path halving.
struct Sets(Vec<u32>);

impl Sets {
    fn new(count: usize) -> Self {
        Self((0..count as u32).collect())
    }

    fn root(&mut self, mut x: u32) -> u32 {
        while self.0[x as usize] != x {
            let up = self.0[self.0[x as usize] as usize];
            self.0[x as usize] = up;
            x = up;
        }
        x
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.0[a.max(b) as usize] = a.min(b);
    }
}

/// Accumulated sums over the triangles of a body.
#[derive(Clone, Copy)]
struct Sums {
    bounds: Bounds,
    /// Apex of the tetrahedra whose volumes are summed, metres. A corner of the body, for precision.
    origin: Option<DVec3>,
    six_volumes: f64,
    double_area: f64,
    /// Sum of the hashes of the directed edges. Opposite edges cancel, so it is zero if all edges are paired.
    unpaired: u64,
}

impl Default for Sums {
    fn default() -> Self {
        Self {
            bounds: Bounds::EMPTY,
            origin: None,
            six_volumes: 0.0,
            double_area: 0.0,
            unpaired: 0,
        }
    }
}

impl Sums {
    fn add(&mut self, points: [u32; 3], positions: [Vec3; 3]) {
        for i in 0..3 {
            let (a, b) = (points[i], points[(i + 1) % 3]);
            let edge = mixed(u64::from(a.min(b)) << 32 | u64::from(a.max(b)));
            let signed = if a < b { edge } else { edge.wrapping_neg() };
            self.unpaired = self.unpaired.wrapping_add(signed);
            self.bounds = self.bounds.with(positions[i]);
        }
        let origin = *self.origin.get_or_insert(positions[0].as_dvec3());
        let [a, b, c] = positions.map(|p| p.as_dvec3() - origin);
        self.six_volumes += a.dot(b.cross(c));
        self.double_area += (b - a).cross(c - a).length();
    }

    fn body(&self) -> Body {
        Body {
            bounds: self.bounds,
            is_solid: self.unpaired == 0 && self.six_volumes > 0.0,
            thickness: (2.0 / 3.0 * self.six_volumes / self.double_area.max(1e-30)) as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A box of twelve triangles. Each face has its own vertices.
    fn cuboid(scene: &mut Scene, corner: Vec3, size: Vec3, faces: usize, inward: bool) {
        let order = if inward {
            [0, 2, 1, 0, 3, 2]
        } else {
            [0, 1, 2, 0, 2, 3]
        };
        for face in 0..faces {
            let (axis, side) = (face / 2, face % 2);
            let [u, v] = if side == 1 {
                [(axis + 1) % 3, (axis + 2) % 3]
            } else {
                [(axis + 2) % 3, (axis + 1) % 3]
            };
            let first = scene.positions.len() as u32;
            for (s, t) in [(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)] {
                let mut unit = [0.0; 3];
                (unit[axis], unit[u], unit[v]) = (side as f32, s, t);
                let p = corner + Vec3::from(unit) * size;
                scene.positions.push(p.into());
            }
            scene.indices.extend(order.map(|i| first + i));
        }
    }

    fn bodies(build: impl FnOnce(&mut Scene)) -> Vec<Body> {
        let mut scene = Scene::default();
        build(&mut scene);
        Bodies::of(&scene).list
    }

    #[test]
    fn boxes_apart_are_two_bodies_and_boxes_that_touch_are_one() {
        let size = Vec3::new(0.1, 2.0, 0.5);
        let apart = bodies(|s| {
            cuboid(s, Vec3::ZERO, size, 6, false);
            cuboid(s, Vec3::new(3.0, 0.0, 0.0), size, 6, false);
        });
        assert_eq!(apart.len(), 2);
        assert!(apart.iter().all(|b| b.is_solid));
        // 2 abc/(2 (ab + bc + ca)).
        assert!((apart[0].thickness - 0.1 / 1.25).abs() < 1e-6, "{apart:?}");
        assert_eq!(apart[0].bounds.max, size);
        let touching = bodies(|s| {
            cuboid(s, Vec3::ZERO, size, 6, false);
            cuboid(s, Vec3::new(0.1, 0.0, 0.0), size, 6, false);
        });
        assert_eq!(touching.len(), 1);
        assert_eq!(touching[0].bounds.max.x, 0.2);
    }

    #[test]
    fn only_a_closed_surface_that_faces_outward_is_solid() {
        let at = Vec3::new(100.0, 50.0, -20.0);
        let solid = |faces, inward| bodies(|s| cuboid(s, at, Vec3::ONE, faces, inward))[0].is_solid;
        assert!(solid(6, false));
        assert!(!solid(6, true), "an interior");
        assert!(!solid(5, false), "a box without a lid");
        let mut scene = Scene::default();
        cuboid(&mut scene, at, Vec3::ONE, 6, false);
        scene.indices.swap(0, 1);
        assert!(!Bodies::of(&scene).list[0].is_solid, "one triangle turned");
    }
}
