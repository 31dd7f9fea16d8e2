//! The draw layout of a scene: triangles in cluster order. It depends only on the mesh and takes about as long to compute as the
//! mesh takes to read, so the cache stores it too.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::scene::{Bodies, Bounds, Cluster, Clusters, Scene, Solid};

/// Data derived from the mesh of a scene for drawing.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// All clusters, in index order.
    pub clusters: Vec<Cluster>,
    /// For each part, its range in `clusters`.
    pub of_part: Vec<Range<usize>>,
}

impl Layout {
    /// Computes the layout of a scene, and the indices with the triangles of each part in cluster order.
    pub fn of(scene: &Scene) -> (Vec<u32>, Self) {
        let bodies = Bodies::of(scene);
        let runs: Vec<(u32, u32)> = scene
            .parts
            .iter()
            .map(|part| (part.first_index, part.index_count))
            .collect();
        let built = Clusters::of(scene, &bodies, &runs);
        let layout = Self {
            clusters: built.list,
            of_part: built.of_run,
        };
        (built.indices, layout)
    }

    /// Whether all its indices are in range for this scene.
    pub(in crate::scene) fn fits(&self, scene: &Scene) -> bool {
        let within =
            |c: &Cluster| u64::from(c.first) + u64::from(c.count) <= scene.indices.len() as u64;
        let known = |r: &Range<usize>| r.start <= r.end && r.end <= self.clusters.len();
        self.of_part.len() == scene.parts.len()
            && self.of_part.iter().all(known)
            && self.clusters.iter().all(within)
    }
}

/// A layout as stored in the cache: arrays of plain numbers.
pub struct FlatLayout {
    pub clusters: Vec<FlatCluster>,
    pub of_part: Vec<[u32; 2]>,
}

impl FlatLayout {
    pub fn of(layout: &Layout) -> Self {
        let ends = |range: &Range<usize>| [range.start as u32, range.end as u32];
        Self {
            clusters: layout.clusters.iter().map(FlatCluster::of).collect(),
            of_part: layout.of_part.iter().map(ends).collect(),
        }
    }
}

/// A [`Cluster`] as plain numbers.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct FlatCluster {
    first: u32,
    count: u32,
    bounds: [Vec3; 2],
    normals_match_winding: u32,
    /// If 0, the following fields are unused.
    is_solid: u32,
    bodies: [Vec3; 2],
    axis: Vec3,
    sine: f32,
}

impl FlatCluster {
    fn of(cluster: &Cluster) -> Self {
        let plain = Self {
            first: cluster.first,
            count: cluster.count,
            bounds: [cluster.bounds.min, cluster.bounds.max],
            normals_match_winding: cluster.normals_match_winding.into(),
            ..Self::zeroed()
        };
        cluster.solid.map_or(plain, |solid| Self {
            is_solid: 1,
            bodies: [solid.bodies.min, solid.bodies.max],
            axis: solid.axis,
            sine: solid.sine,
            ..plain
        })
    }

    fn cluster(&self) -> Cluster {
        Cluster {
            first: self.first,
            count: self.count,
            bounds: bounds(self.bounds),
            solid: (self.is_solid != 0).then(|| Solid {
                bodies: bounds(self.bodies),
                axis: self.axis,
                sine: self.sine,
            }),
            normals_match_winding: self.normals_match_winding != 0,
        }
    }
}

fn bounds([min, max]: [Vec3; 2]) -> Bounds {
    Bounds { min, max }
}

/// The inverse of [`FlatLayout::clusters`].
pub fn clusters(flat: &[FlatCluster]) -> Vec<Cluster> {
    flat.iter().map(FlatCluster::cluster).collect()
}

/// The inverse of [`FlatLayout::of_part`].
pub fn ranges(flat: &[[u32; 2]]) -> Vec<Range<usize>> {
    let range = |[start, end]: &[u32; 2]| *start as usize..*end as usize;
    flat.iter().map(range).collect()
}
