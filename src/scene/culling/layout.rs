//! How a scene is drawn: its triangles in the order of clusters, and how thick its bodies are. It follows from the mesh
//! alone and takes as long as reading one, so that the cache keeps it.

use std::ops::Range;

use crate::scene::{Bodies, Body, Cluster, Clusters, Scene};

/// What is known of a scene's mesh beside the mesh.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// In the order of their indices.
    pub clusters: Vec<Cluster>,
    /// The clusters of each part.
    pub of_part: Vec<Range<usize>>,
    /// How far matter reaches behind the surface at each vertex, metres.
    pub thickness: Vec<f32>,
}

impl Layout {
    /// That of a scene, and its indices with the triangles of each part in the order of clusters.
    pub fn of(scene: &Scene) -> (Vec<u32>, Self) {
        let bodies = Bodies::of(scene);
        let runs: Vec<(u32, u32)> = scene
            .parts
            .iter()
            .map(|part| (part.first_index, part.index_count))
            .collect();
        let made = Clusters::of(scene, &bodies, &runs);
        let thickness: Vec<f32> = bodies.list.iter().map(Body::thickness).collect();
        let of_vertex = bodies.of_vertex.iter();
        let layout = Self {
            clusters: made.list,
            of_part: made.of_run,
            thickness: of_vertex.map(|body| thickness[*body as usize]).collect(),
        };
        (made.indices, layout)
    }

    /// Whether it can be of this scene: every number in range.
    pub(in crate::scene) fn fits(&self, scene: &Scene) -> bool {
        let within =
            |c: &Cluster| u64::from(c.first) + u64::from(c.count) <= scene.indices.len() as u64;
        let known = |r: &Range<usize>| r.start <= r.end && r.end <= self.clusters.len();
        self.thickness.len() == scene.positions.len()
            && self.of_part.len() == scene.parts.len()
            && self.of_part.iter().all(known)
            && self.clusters.iter().all(within)
    }
}
