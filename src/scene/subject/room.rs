//! Whether a model is one room, and a place in it to look from.

use std::f32::consts::{PI, TAU};

use glam::Vec3;

use crate::scene::{Bounds, Bvh, Hit, Ray, Scene};

/// Height of the eye above the floor, metres.
const EYE_HEIGHT: f32 = 1.6;
/// Least and greatest height of a room, metres.
const HEIGHTS: std::ops::RangeInclusive<f32> = 1.9..=40.0;
/// Places along each side of the footprint that are tried.
const PLACES: usize = 7;
/// Rays in all directions from each place.
const RAYS: usize = 128;
/// Least share of the rays that must end at a wall, and of these at its front.
const ENCLOSED: f32 = 0.75;
/// Least share of the volume of the bounds that is seen from one place: a house of many rooms, or with a roof and a garden, is seen
/// from outside.
const SEEN: f32 = 0.4;
/// Surfaces in the sides of the bounds are within, metres.
const SLACK: f32 = 0.01;
/// Fractional part of the golden ratio.
const GOLDEN: f32 = 0.618_034;
/// Directions in which the view is looked for.
const AZIMUTHS: usize = 64;
/// Rays in all directions by which the openness of a view is judged, and the cosine up to which they lie ahead.
const VIEW_RAYS: usize = 512;
const AHEAD: f32 = 0.8;
/// Distance of the eye from the wall behind it, metres, unless the room is small.
const FROM_WALL: f32 = 0.5;

/// A view from within a room.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inside {
    /// Eye, relative to the scene's origin, metres.
    pub eye: Vec3,
    /// What it looks at: a point as high as the eye.
    pub target: Vec3,
}

impl Inside {
    /// A view from within, if what is in `bounds` is a room: enclosed on all sides, with the fronts of its surfaces inward.
    pub fn of(scene: &Scene, bvh: &Bvh, bounds: &Bounds) -> Option<Self> {
        let probe = Probe {
            glass: scene.glass_triangles(),
            scene,
            bvh,
            bounds: *bounds,
        };
        let rooms = places(bounds)
            .filter_map(|(x, z)| probe.eye_above_floor(bounds, x, z))
            .filter_map(|eye| Some((eye, probe.enclosed_volume(eye)?)));
        let (eye, volume) = rooms.max_by(|a, b| a.1.total_cmp(&b.1))?;
        (volume > SEEN * bounds.extent().element_product()).then(|| probe.view(eye))
    }
}

/// Whether a box has the height of a room.
pub(super) fn is_as_high_as_a_room(bounds: &Bounds) -> bool {
    HEIGHTS.contains(&bounds.extent().y)
}

/// Places of a grid over the footprint, metres.
fn places(bounds: &Bounds) -> impl Iterator<Item = (f32, f32)> {
    let (min, extent) = (bounds.min, bounds.extent());
    let at = |i: usize| (i as f32 + 0.5) / PLACES as f32;
    (0..PLACES * PLACES).map(move |i| {
        let (u, v) = (at(i % PLACES), at(i / PLACES));
        (min.x + u * extent.x, min.z + v * extent.z)
    })
}

/// One of `all` directions that cover the sphere evenly: a spiral by the golden ratio.
fn spiral(i: usize, all: usize) -> Vec3 {
    let y = 1.0 - (2.0 * i as f32 + 1.0) / all as f32;
    let (sin, cos) = (TAU * (i as f32 * GOLDEN).fract()).sin_cos();
    let radius = (1.0 - y * y).sqrt();
    Vec3::new(radius * sin, y, radius * cos)
}

/// Rays through a scene.
struct Probe<'a> {
    scene: &'a Scene,
    bvh: &'a Bvh,
    /// For each triangle, whether it is a pane, which is looked through; empty without any.
    glass: Vec<bool>,
    /// What is not within is outside, metres.
    bounds: Bounds,
}

impl Probe<'_> {
    /// Distance to the first surface that is no pane within the bounds, and whether its front was met.
    fn first(&self, origin: Vec3, direction: Vec3) -> Option<(f32, bool)> {
        let ray = Ray { origin, direction };
        let reach = self.leaves(origin, direction) + SLACK;
        let is_pane = |hit: &Hit| self.glass.get(hit.triangle as usize) == Some(&true);
        let hit = self.bvh.closest(&ray, 0.0, reach, |hit| !is_pane(hit))?;
        let first = 3 * hit.triangle as usize;
        let [a, b, c] = [0, 1, 2].map(|i| {
            let vertex = self.scene.indices[first + i];
            Vec3::from(self.scene.positions[vertex as usize])
        });
        let is_front = (b - a).cross(c - a).dot(direction) < 0.0;
        Some((hit.distance, is_front))
    }

    /// Distance at which a ray from within leaves the bounds.
    fn leaves(&self, origin: Vec3, direction: Vec3) -> f32 {
        // Finite, so that a ray in the plane of a side gives 0 and not 0 x infinity.
        let inverse = direction.recip().clamp(-Vec3::MAX, Vec3::MAX);
        let sides = [self.bounds.min, self.bounds.max].map(|side| (side - origin) * inverse);
        sides[0].max(sides[1]).min_element()
    }

    /// The place at the height of an eye above the floor that is seen from half the height of the bounds.
    fn eye_above_floor(&self, bounds: &Bounds, x: f32, z: f32) -> Option<Vec3> {
        let middle = Vec3::new(x, bounds.centre().y, z);
        let (below, _) = self.first(middle, Vec3::NEG_Y)?;
        let (above, _) = self.first(middle, Vec3::Y)?;
        let height = below + above;
        let eye = EYE_HEIGHT.min(0.6 * height);
        HEIGHTS
            .contains(&height)
            .then(|| middle + Vec3::Y * (eye - below))
    }

    /// The volume that is seen from a place, cubic metres, if it is enclosed.
    fn enclosed_volume(&self, eye: Vec3) -> Option<f32> {
        let met = (0..RAYS).filter_map(|i| self.first(eye, spiral(i, RAYS)));
        let (mut hits, mut fronts, mut volume) = (0, 0, 0.0);
        for (distance, is_front) in met {
            hits += 1;
            fronts += usize::from(is_front);
            volume += 4.0 * PI / RAYS as f32 * distance.powi(3) / 3.0;
        }
        let is_most = |part: usize, all: usize| part as f32 >= ENCLOSED * all as f32;
        (is_most(hits, RAYS) && is_most(fronts, hits)).then_some(volume)
    }

    /// The share of the directions ahead that leave the room.
    fn openness(&self, eye: Vec3, direction: Vec3) -> f32 {
        let is_ahead = |d: &Vec3| d.dot(direction) > AHEAD;
        let ahead = (0..VIEW_RAYS)
            .map(|i| spiral(i, VIEW_RAYS))
            .filter(is_ahead);
        let (mut all, mut open) = (0, 0);
        for d in ahead {
            all += 1;
            open += usize::from(self.first(eye, d).is_none());
        }
        open as f32 / (all as f32).max(1.0)
    }

    /// The longest view through the room around `place`: from one wall, rather toward a side with windows.
    fn view(&self, place: Vec3) -> Inside {
        let directions = (0..AZIMUTHS).map(|i| {
            let (sin, cos) = (TAU * i as f32 / AZIMUTHS as f32).sin_cos();
            Vec3::new(sin, 0.0, -cos)
        });
        let free: Vec<(Vec3, Option<f32>)> = directions
            .map(|d| (d, self.first(place, d).map(|(at, _)| at)))
            .collect();
        // Where the room is open behind, there is no wall to stand at.
        let behind = |i: usize| free[(i + AZIMUTHS / 2) % AZIMUTHS].1.unwrap_or(0.0);
        let ahead = |i: usize| {
            let (direction, at) = free[i];
            at.unwrap_or_else(|| self.leaves(place, direction))
        };
        let length = |i: usize| (ahead(i) + behind(i)) * (1.0 + self.openness(place, free[i].0));
        let worth: Vec<f32> = (0..AZIMUTHS).map(length).collect();
        let longest = (0..AZIMUTHS).max_by(|&a, &b| worth[a].total_cmp(&worth[b]));
        let longest = longest.unwrap_or_default();
        let direction = free[longest].0;
        let back = behind(longest) - FROM_WALL.min(0.25 * behind(longest));
        Inside {
            eye: place - direction * back,
            target: place + direction * (0.5 * ahead(longest)),
        }
    }
}
