//! Clusters (meshlets): small groups of neighbouring triangles, the unit of culling.

use std::ops::Range;
use std::thread;

use glam::Vec3;

use crate::scene::{Bodies, Bounds, Scene};

/// Maximum number of triangles per cluster.
const MAX_TRIANGLES: usize = 128;
/// Minimum number of triangles to split on two threads.
const MIN_PARALLEL: usize = 1 << 15;

/// A group of neighbouring triangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cluster {
    /// Offset of its first index.
    pub first: u32,
    /// Number of indices.
    pub count: u32,
    /// Bounds of its triangles, metres.
    pub bounds: Bounds,
    /// Set if all triangles belong to closed bodies.
    pub solid: Option<Solid>,
    /// Whether the vertex normals of every triangle agree with its winding.
    pub normals_match_winding: bool,
}

/// Bounds and normal cone of triangles of closed bodies, whose back faces are not visible from outside.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Solid {
    /// Bounds of the bodies that the triangles belong to, metres.
    pub bodies: Bounds,
    /// Axis of the normal cone, which contains the normals of all triangles; unit length.
    pub axis: Vec3,
    /// Sine of the cone's half angle; 1 for a right angle or more.
    pub sine: f32,
}

/// Reordered indices and the clusters they form.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Clusters {
    /// The indices of the scene; within each run they are ordered by cluster.
    pub indices: Vec<u32>,
    /// All clusters, in index order.
    pub list: Vec<Cluster>,
    /// For each run, its range in `list`.
    pub of_run: Vec<Range<usize>>,
}

impl Clusters {
    /// Splits runs of a scene's indices (first, count) recursively at the median of the longest axis. Triangles keep their
    /// order within a cluster, which preserves most vertex reuse.
    pub fn of(scene: &Scene, bodies: &Bodies, runs: &[(u32, u32)]) -> Self {
        let mut made = Self {
            indices: scene.indices.clone(),
            ..Self::default()
        };
        let splitter = Splitter {
            scene,
            bodies,
            glass: scene.glass_triangles(),
        };
        for &(first, count) in runs {
            let start = made.list.len();
            let mut of_kind: [Vec<Item>; 4] = Default::default();
            for triangle in first / 3..(first + count) / 3 {
                of_kind[splitter.kind(triangle).rank()].push(splitter.item(triangle));
            }
            let mut first = first;
            for (kind, mut items) in Kind::ALL.into_iter().zip(of_kind) {
                let end = first + 3 * items.len() as u32;
                let run = Run {
                    first,
                    kind,
                    indices: &mut made.indices[first as usize..end as usize],
                };
                made.list.extend(splitter.split(&mut items, run));
                first = end;
            }
            made.of_run.push(start..made.list.len());
        }
        made
    }
}

/// Properties shared by all triangles of a cluster.
#[derive(Clone, Copy)]
struct Kind {
    /// Whether they belong to closed bodies.
    is_solid: bool,
    /// [`Cluster::normals_match_winding`].
    normals_match_winding: bool,
}

impl Kind {
    /// All kinds, in the order in which their clusters are stored.
    const ALL: [Self; 4] = [
        Self::new(true, true),
        Self::new(true, false),
        Self::new(false, true),
        Self::new(false, false),
    ];

    const fn new(is_solid: bool, normals_match_winding: bool) -> Self {
        Self {
            is_solid,
            normals_match_winding,
        }
    }

    /// Index in [`Kind::ALL`].
    fn rank(self) -> usize {
        2 * usize::from(!self.is_solid) + usize::from(!self.normals_match_winding)
    }
}

/// A triangle being sorted.
#[derive(Clone, Copy)]
struct Item {
    /// Three times its centroid, metres.
    centroid: Vec3,
    triangle: u32,
}

/// Destination of the indices of a range of triangles.
struct Run<'i> {
    /// Offset of the first index.
    first: u32,
    kind: Kind,
    indices: &'i mut [u32],
}

impl Run<'_> {
    /// Splits the run after this many triangles.
    fn halves(&mut self, triangles: usize) -> (Run<'_>, Run<'_>) {
        let (low, high) = self.indices.split_at_mut(3 * triangles);
        let of = |first, indices| Run {
            first,
            kind: self.kind,
            indices,
        };
        (
            of(self.first, low),
            of(self.first + 3 * triangles as u32, high),
        )
    }
}

struct Splitter<'s> {
    scene: &'s Scene,
    bodies: &'s Bodies,
    /// For each triangle, whether it is glass; empty without any.
    glass: Vec<bool>,
}

impl Splitter<'_> {
    fn corners(&self, triangle: u32) -> [u32; 3] {
        [0, 1, 2].map(|i| self.scene.indices[3 * triangle as usize + i])
    }

    fn positions(&self, triangle: u32) -> [Vec3; 3] {
        self.corners(triangle)
            .map(|v| self.scene.positions[v as usize].into())
    }

    fn body(&self, triangle: u32) -> &crate::scene::Body {
        let vertex = self.scene.indices[3 * triangle as usize] as usize;
        &self.bodies.list[self.bodies.of_vertex[vertex] as usize]
    }

    fn kind(&self, triangle: u32) -> Kind {
        let [a, b, c] = self.positions(triangle);
        let face = (b - a).cross(c - a);
        let normals = &self.scene.normals;
        let agrees = |v: u32| {
            let normal = normals.get(v as usize);
            normal.is_some_and(|n| face.dot((*n).into()) > 0.0)
        };
        let normals_match_winding = self.corners(triangle).into_iter().all(agrees);
        let body = self.body(triangle);
        // The far walls of a glass house are seen through the near ones.
        let is_open = self.glass.get(triangle as usize) == Some(&true) && !body.is_slab();
        Kind::new(body.is_solid && !is_open, normals_match_winding)
    }

    fn item(&self, triangle: u32) -> Item {
        Item {
            centroid: self.positions(triangle).iter().sum(),
            triangle,
        }
    }

    /// Splits into clusters of at most [`MAX_TRIANGLES`] triangles.
    fn split(&self, items: &mut [Item], mut run: Run<'_>) -> Vec<Cluster> {
        if items.is_empty() {
            return Vec::new();
        }
        if items.len() <= MAX_TRIANGLES {
            return vec![self.cluster(items, run)];
        }
        let middle = items.len() / 2;
        let is_large = items.len() >= MIN_PARALLEL;
        halve(items, middle);
        let (low, high) = items.split_at_mut(middle);
        let (low_run, high_run) = run.halves(middle);
        let (mut clusters, rest) = if is_large {
            thread::scope(|scope| {
                let rest = scope.spawn(|| self.split(high, high_run));
                let clusters = self.split(low, low_run);
                let rest = rest.join();
                // Propagates a panic of the other thread.
                (
                    clusters,
                    rest.unwrap_or_else(|fault| std::panic::resume_unwind(fault)),
                )
            })
        } else {
            (self.split(low, low_run), self.split(high, high_run))
        };
        clusters.extend(rest);
        clusters
    }

    fn cluster(&self, items: &mut [Item], run: Run<'_>) -> Cluster {
        items.sort_unstable_by_key(|item| item.triangle);
        let mut bounds = Bounds::EMPTY;
        for (item, indices) in items.iter().zip(run.indices.chunks_exact_mut(3)) {
            indices.copy_from_slice(&self.corners(item.triangle));
            bounds = self
                .positions(item.triangle)
                .into_iter()
                .fold(bounds, Bounds::with);
        }
        Cluster {
            first: run.first,
            count: run.indices.len() as u32,
            bounds,
            solid: run.kind.is_solid.then(|| self.solid(items)),
            normals_match_winding: run.kind.normals_match_winding,
        }
    }

    fn solid(&self, items: &[Item]) -> Solid {
        let bodies = items.iter().map(|item| self.body(item.triangle).bounds);
        let normals = || {
            items.iter().map(|item| {
                let [a, b, c] = self.positions(item.triangle);
                (b - a).cross(c - a).normalize_or_zero()
            })
        };
        let axis = normals().sum::<Vec3>().normalize_or_zero();
        // A degenerate triangle has no normal and is never visible.
        let cosine = normals()
            .filter(|n| *n != Vec3::ZERO)
            .map(|n| n.dot(axis))
            .fold(1.0, f32::min);
        Solid {
            bodies: bodies.fold(Bounds::EMPTY, Bounds::union),
            axis,
            sine: if cosine > 0.0 {
                (1.0 - cosine * cosine).max(0.0).sqrt()
            } else {
                1.0
            },
        }
    }
}

/// Partitions the triangles around position `middle` along the longest axis.
fn halve(items: &mut [Item], middle: usize) {
    let extent = Bounds::of(items.iter().map(|item| item.centroid)).extent();
    let axis = extent.max_position();
    let order = |a: &Item, b: &Item| {
        let by_centroid = a.centroid[axis].total_cmp(&b.centroid[axis]);
        by_centroid.then(a.triangle.cmp(&b.triangle))
    };
    items.select_nth_unstable_by(middle, order);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A sheet of `n` x `n` quads in the plane y = 0, facing up, in row order.
    fn sheet(n: u32) -> Scene {
        let mut scene = Scene::default();
        for row in 0..=n {
            for column in 0..=n {
                scene.positions.push([column as f32, 0.0, row as f32]);
            }
        }
        for row in 0..n {
            for column in 0..n {
                let a = row * (n + 1) + column;
                let (b, c, d) = (a + 1, a + n + 1, a + n + 2);
                scene.indices.extend([a, c, b, b, c, d]);
            }
        }
        scene
    }

    fn triangles(indices: &[u32]) -> Vec<[u32; 3]> {
        let mut all: Vec<[u32; 3]> = indices
            .chunks_exact(3)
            .map(|t| [t[0], t[1], t[2]])
            .collect();
        all.sort_unstable();
        all
    }

    #[test]
    fn every_triangle_is_in_one_cluster_and_within_its_bounds() {
        let scene = sheet(150);
        let count = scene.indices.len() as u32;
        let runs = [(0, 300), (300, count - 300)];
        let clusters = Clusters::of(&scene, &Bodies::of(&scene), &runs);
        assert_eq!(triangles(&clusters.indices), triangles(&scene.indices));
        assert_eq!(clusters.of_run[0], 0..1);
        assert_eq!(clusters.of_run[1], 1..clusters.list.len());
        let mut next = 0;
        for cluster in &clusters.list {
            assert_eq!(cluster.first, next);
            assert!(cluster.count as usize <= 3 * MAX_TRIANGLES && cluster.count > 0);
            assert!(cluster.solid.is_none(), "a sheet has two sides");
            next += cluster.count;
            let range = cluster.first as usize..next as usize;
            for vertex in &clusters.indices[range] {
                let p = Vec3::from(scene.positions[*vertex as usize]);
                assert!(cluster.bounds.min.cmple(p).all() && cluster.bounds.max.cmpge(p).all());
            }
        }
        assert_eq!(next, count);
    }

    #[test]
    fn clusters_are_compact() {
        let scene = sheet(64);
        let count = scene.indices.len() as u32;
        let clusters = Clusters::of(&scene, &Bodies::of(&scene), &[(0, count)]);
        // 8192 triangles in 64 clusters of 128: patches of 8 x 8 quads, not rows of 64.
        assert_eq!(clusters.list.len(), 64);
        for cluster in &clusters.list {
            assert!(cluster.bounds.extent().max_element() <= 10.0, "{cluster:?}");
        }
    }

    #[test]
    fn the_cone_contains_all_normals() {
        let mut scene = Scene {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
            // A tetrahedron, counter-clockwise seen from outside.
            indices: vec![0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3],
            ..Scene::default()
        };
        let whole = Clusters::of(&scene, &Bodies::of(&scene), &[(0, 12)]);
        let solid = whole.list[0].solid.expect("a solid");
        assert_eq!(solid.sine, 1.0, "faces on all sides");
        assert_eq!(solid.bodies.max, Vec3::ONE);
        let face = Clusters::of(&scene, &Bodies::of(&scene), &[(9, 3)]);
        let solid = face.list[0].solid.expect("a part of a solid");
        assert!(solid.sine < 1e-3 && solid.axis.dot(Vec3::ONE.normalize()) > 0.9999);
        scene.indices.truncate(9);
        let open = Clusters::of(&scene, &Bodies::of(&scene), &[(0, 9)]);
        assert_eq!(open.list[0].solid, None);
    }
}
