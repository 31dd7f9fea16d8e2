//! What of a scene is worth seeing: the default view frames it.
//!
//! A ground that is far wider than what stands on it, and parts that lie far off, would make a house a dot. A model of a room is
//! entered: from outside it is a box.

mod room;
#[cfg(test)]
mod tests;

use glam::Vec3;

use crate::scene::{Bounds, Bvh, Scene};

pub use room::Inside;

/// Height of a triangle over its length below which it lies instead of standing.
const FLAT: f32 = 0.02;
/// The whole scene is the subject unless it is longer than what stands by this factor.
const STRETCH: f32 = 1.5;
/// Largest share of the area of a part that may be left out for being far off.
const STRAY: f32 = 0.05;
/// Bins of an axis in which gaps are looked for.
const BINS: usize = 256;
/// Most parts that are left out one after another.
const MOST_STRAYS: usize = 32;

/// What the default view shows.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Subject {
    /// A box around what is worth seeing, relative to the scene's origin, metres.
    pub bounds: Bounds,
    /// A view from within, for a model of a room.
    pub inside: Option<Inside>,
}

impl From<Bounds> for Subject {
    fn from(bounds: Bounds) -> Self {
        Self {
            bounds,
            inside: None,
        }
    }
}

impl Subject {
    /// Finds the subject of a scene, looked at from outside.
    pub fn of(scene: &Scene) -> Self {
        let standing: Vec<Standing> = triangles(scene).filter_map(Standing::of).collect();
        let bounds = without_strays(&standing);
        let is_stretched = scene.bounds.diagonal() > STRETCH * bounds.diagonal();
        let bounds = if bounds.diagonal() > 0.0 && is_stretched {
            bounds
        } else {
            scene.bounds
        };
        bounds.into()
    }

    /// The same subject of `scene`, looked at from within if it is a room. Keeps the hierarchy that it needs for that in the scene.
    #[must_use]
    pub fn entered(self, scene: &mut Scene) -> Self {
        let mut bvh = None;
        if room::is_as_high_as_a_room(&self.bounds) {
            bvh = scene.bvh.take().or_else(|| Some(Bvh::of(scene, |_| true)));
        }
        let inside = bvh
            .as_ref()
            .and_then(|bvh| Inside::of(scene, bvh, &self.bounds));
        scene.bvh = bvh.or(scene.bvh.take());
        Self { inside, ..self }
    }
}

/// A triangle that stands: no part of a ground.
struct Standing {
    bounds: Bounds,
    /// Square metres.
    area: f32,
}

impl Standing {
    fn of(corners: [Vec3; 3]) -> Option<Self> {
        let bounds = Bounds::of(corners);
        let extent = bounds.extent();
        let [a, b, c] = corners;
        let area = 0.5 * (b - a).cross(c - a).length();
        (extent.y > FLAT * extent.x.hypot(extent.z)).then_some(Self { bounds, area })
    }
}

fn triangles(scene: &Scene) -> impl Iterator<Item = [Vec3; 3]> {
    let corner = |vertex: u32| Vec3::from(scene.positions[vertex as usize]);
    scene
        .indices
        .chunks_exact(3)
        .map(move |t| [0, 1, 2].map(|i| corner(t[i])))
}

/// The bounds of the triangles without parts that are small and farther off than the rest is long.
fn without_strays(triangles: &[Standing]) -> Bounds {
    let mut kept = total(triangles, &everywhere()).bounds;
    for _ in 0..MOST_STRAYS {
        let cuts = [0, 1, 2].map(|axis| widest_gap(triangles, &kept, axis));
        let Some(rest) = cuts
            .iter()
            .flatten()
            .find_map(|gap| gap.larger_side(triangles, &kept))
        else {
            break;
        };
        kept = rest;
    }
    kept
}

/// A stretch of an axis that no triangle reaches into.
struct Gap {
    axis: usize,
    from: f32,
    to: f32,
}

/// Triangles within a box.
struct Total {
    bounds: Bounds,
    area: f32,
}

fn everywhere() -> Bounds {
    Bounds {
        min: Vec3::NEG_INFINITY,
        max: Vec3::INFINITY,
    }
}

fn total(triangles: &[Standing], within: &Bounds) -> Total {
    let none = Total {
        bounds: Bounds::EMPTY,
        area: 0.0,
    };
    let inside = triangles
        .iter()
        .filter(|t| t.bounds.min.cmpge(within.min).all() && t.bounds.max.cmple(within.max).all());
    inside.fold(none, |sum, t| Total {
        bounds: sum.bounds.union(t.bounds),
        area: sum.area + t.area,
    })
}

impl Gap {
    /// The bounds of the larger side, if the other one is a stray.
    fn larger_side(&self, triangles: &[Standing], kept: &Bounds) -> Option<Bounds> {
        let (mut below, mut above) = (*kept, *kept);
        below.max[self.axis] = 0.5 * (self.from + self.to);
        above.min[self.axis] = below.max[self.axis];
        let [a, b] = [below, above].map(|side| total(triangles, &side));
        let (larger, smaller) = if a.area >= b.area { (a, b) } else { (b, a) };
        let is_stray =
            smaller.area < STRAY * larger.area && self.to - self.from > larger.bounds.diagonal();
        is_stray.then_some(larger.bounds)
    }
}

/// The widest gap between the triangles within `kept`, in whole bins.
fn widest_gap(triangles: &[Standing], kept: &Bounds, axis: usize) -> Option<Gap> {
    let (first, length) = (kept.min[axis], kept.extent()[axis]);
    if length <= 0.0 || !length.is_finite() {
        return None;
    }
    let bin = |at: f32| (((at - first) / length * BINS as f32) as usize).min(BINS - 1);
    // How many triangles begin in each bin, less those that ended in the one before.
    let mut changes = [0i64; BINS + 1];
    for t in triangles {
        let [low, high] = [t.bounds.min[axis], t.bounds.max[axis]];
        if low >= first && high <= kept.max[axis] {
            changes[bin(low)] += 1;
            changes[bin(high) + 1] -= 1;
        }
    }
    let (mut open, mut run, mut widest) = (0, 0, (0, 0));
    for (at, change) in changes[..BINS].iter().enumerate() {
        open += change;
        run = if open == 0 { run + 1 } else { 0 };
        widest = widest.max((run, at + 1));
    }
    let (bins, end) = widest;
    let border = |bin: usize| first + length * bin as f32 / BINS as f32;
    (bins > 0).then(|| Gap {
        axis,
        from: border(end - bins),
        to: border(end),
    })
}
