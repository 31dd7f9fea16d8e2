//! Test scenes with a given triangle count, and views of a given share of them, to measure cost against triangle count.

use std::borrow::Cow;

use glam::{UVec2, Vec2, Vec3};

use crate::commands::job::Job;
use crate::passes::view::View;
use crate::scene::{Camera, Scene, hills};

use super::subdivide::subdivided;

/// The scene drawn at one step of a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ground {
    /// The given scene, unchanged.
    #[default]
    Given,
    /// The given scene with every triangle edge split into this many pieces.
    Finer(u32),
    /// Generated hills with about this many triangles.
    Hills(usize),
}

impl Ground {
    /// The scene to draw; borrowed when it is the given one.
    pub fn scene<'j>(&self, job: &'j Job) -> Cow<'j, Scene> {
        match *self {
            Self::Given | Self::Finer(1) => Cow::Borrowed(&*job.scene),
            Self::Finer(pieces) => Cow::Owned(subdivided(&job.scene, pieces)),
            Self::Hills(triangles) => Cow::Owned(hills(triangles)),
        }
    }
}

/// Narrows the field of view until at most `share` of the triangles (by centroid) are in view.
pub fn narrowed(camera: &Camera, scene: &Scene, size: UVec2, share: f64) -> Camera {
    let with = |fov_deg: f32| Camera { fov_deg, ..*camera };
    let (mut narrow, mut wide) = (0.0, camera.fov_deg);
    // Bisection: ten steps resolve a thousandth of the field of view.
    for _ in 0..10 {
        let middle = 0.5 * (narrow + wide);
        if seen(&with(middle), scene, size) <= share {
            narrow = middle;
        } else {
            wide = middle;
        }
    }
    with(if narrow > 0.0 { narrow } else { wide })
}

/// Share of triangles (0..1) whose centroid is within the left, right, top and bottom frustum planes; occlusion is ignored.
pub fn seen(camera: &Camera, scene: &Scene, size: UVec2) -> f64 {
    let view = View {
        camera: *camera,
        size,
        jitter: Vec2::ZERO,
        sharpen: 0.0,
        window: None,
    };
    let clip_from_world = view.clip_from_world();
    let position = |i: &u32| Vec3::from(scene.positions[*i as usize]);
    let is_seen = |corners: &[u32]| {
        let centroid = corners.iter().map(position).sum::<Vec3>() / 3.0;
        let clip = clip_from_world * centroid.extend(1.0);
        clip.x.abs() <= clip.w && clip.y.abs() <= clip.w
    };
    let triangles = scene.indices.chunks_exact(3);
    triangles.filter(|t| is_seen(t)).count() as f64 / scene.triangles().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_lens_sees_the_share_asked_for() {
        let (scene, size) = (hills(20_000), UVec2::new(640, 360));
        let camera = Camera::framing(&scene.bounds, 45.0, 16.0 / 9.0);
        assert!(seen(&camera, &scene, size) > 0.999, "all of it");
        let share = seen(&narrowed(&camera, &scene, size, 0.05), &scene, size);
        assert!(share <= 0.05 && share > 0.04, "{share}");
    }
}
