//! A layout as the cache writes it: arrays of plain numbers.

use std::ops::Range;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::scene::{Bounds, Cluster, Layout, Solid};

/// The arrays of a layout.
pub(in crate::scene) struct FlatLayout<'l> {
    pub clusters: Vec<FlatCluster>,
    pub of_part: Vec<[u32; 2]>,
    pub thickness: &'l [f32],
}

impl<'l> FlatLayout<'l> {
    pub fn of(layout: &'l Layout) -> Self {
        let ends = |range: &Range<usize>| [range.start as u32, range.end as u32];
        Self {
            clusters: layout.clusters.iter().map(FlatCluster::of).collect(),
            of_part: layout.of_part.iter().map(ends).collect(),
            thickness: &layout.thickness,
        }
    }
}

#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub(in crate::scene) struct FlatCluster {
    first: u32,
    count: u32,
    bounds: [Vec3; 2],
    is_wound: u32,
    /// 0: what follows means nothing.
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
            is_wound: cluster.is_wound.into(),
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
            is_wound: self.is_wound != 0,
        }
    }
}

fn bounds([min, max]: [Vec3; 2]) -> Bounds {
    Bounds { min, max }
}

/// The clusters as they were.
pub(in crate::scene) fn clusters(flat: &[FlatCluster]) -> Vec<Cluster> {
    flat.iter().map(FlatCluster::cluster).collect()
}

/// The ranges as they were.
pub(in crate::scene) fn ranges(flat: &[[u32; 2]]) -> Vec<Range<usize>> {
    let range = |[start, end]: &[u32; 2]| *start as usize..*end as usize;
    flat.iter().map(range).collect()
}
