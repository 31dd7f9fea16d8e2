//! Scenes of any number of triangles and views of a share of them, for measuring how the cost grows with triangles.

use std::borrow::Cow;

use glam::{UVec2, Vec2, Vec3};

use crate::commands::job::Job;
use crate::passes::view::View;
use crate::scene::{Camera, Scene, hills};

use super::subdivide::subdivided;

/// What is drawn at a step of a sweep.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ground {
    /// The scene as it is.
    #[default]
    Given,
    /// The scene with every edge of a triangle cut into so many pieces.
    Finer(u32),
    /// Hills of about so many triangles.
    Hills(usize),
}

impl Ground {
    /// Makes it, where it is not the scene itself.
    pub fn scene<'j>(&self, job: &'j Job) -> Cow<'j, Scene> {
        match *self {
            Self::Given | Self::Finer(1) => Cow::Borrowed(&job.scene),
            Self::Finer(pieces) => Cow::Owned(subdivided(&job.scene, pieces)),
            Self::Hills(triangles) => Cow::Owned(hills(triangles)),
        }
    }
}

/// The same camera with so long a lens that it sees no more than this share of a scene's triangles, by their centroids.
pub fn narrowed(camera: &Camera, scene: &Scene, size: UVec2, share: f64) -> Camera {
    let with = |fov_deg: f32| Camera { fov_deg, ..*camera };
    let (mut narrow, mut wide) = (0.0, camera.fov_deg);
    // Halved to a thousandth of the field of view.
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

/// Share of a scene's triangles whose centroids lie in the picture, in front of others or behind them.
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
