//! Runs of indices that are drawn at once: what a view sees of a part's clusters.

use crate::gpu::{Draws, Faces};
use crate::scene::Cluster;

use crate::passes::surfaces::culling::Cull;

/// A run of indices that is drawn at once.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::passes) struct Run {
    first: u32,
    count: u32,
    faces: Faces,
}

impl Run {
    /// Draws it.
    pub fn draw(&self, draws: &mut Draws<'_, '_>) {
        draws.faces(self.faces);
        draws.indexed(self.first, self.count);
    }
}

impl Run {
    /// Whether both are better drawn as one, with what lies between them.
    fn is_followed_by(&self, next: &Self) -> bool {
        self.faces == next.faces && next.first - (self.first + self.count) <= BRIDGED
    }
}

/// Indices that are drawn in vain rather than in two draws: a draw costs a CPU 10 to 30 µs, which is what 200 triangles cost.
const BRIDGED: u32 = 3 * 200;

/// Runs of the clusters that are seen: those that nearly follow each other are drawn at once.
pub(in crate::passes) struct Runs<'c, I> {
    clusters: I,
    cull: &'c Cull,
    open: Option<Run>,
}

impl<'c, I: Iterator<Item = &'c Cluster>> Runs<'c, I> {
    /// Of the clusters of a part, in the order of their indices.
    pub fn new(
        clusters: impl IntoIterator<Item = &'c Cluster, IntoIter = I>,
        cull: &'c Cull,
    ) -> Self {
        Self {
            clusters: clusters.into_iter(),
            cull,
            open: None,
        }
    }
}

impl<'c, I: Iterator<Item = &'c Cluster>> Iterator for Runs<'c, I> {
    type Item = Run;

    fn next(&mut self) -> Option<Run> {
        for cluster in self.clusters.by_ref().filter(|c| self.cull.sees(c)) {
            let next = Run {
                first: cluster.first,
                count: cluster.count,
                faces: self.cull.faces(cluster),
            };
            match &mut self.open {
                Some(run) if run.is_followed_by(&next) => {
                    run.count = next.first + next.count - run.first;
                }
                open => {
                    let done = open.replace(next);
                    if done.is_some() {
                        return done;
                    }
                }
            }
        }
        self.open.take()
    }
}
