//! Ground of any number of triangles, and how much of it a view sees: what the growth of cost with triangles is measured on.

use std::borrow::Cow;

use glam::{UVec2, Vec2, Vec3};

use crate::commands::job::Job;
use crate::passes::view::View;
use crate::scene::{Bounds, Camera, Material, Part, Scene};

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
            Self::Finer(pieces) => Cow::Owned(job.scene.subdivided(pieces)),
            Self::Hills(triangles) => Cow::Owned(hills(triangles)),
        }
    }
}

/// Edge of the ground, metres: shadows of scenes of this size have cascades.
const EDGE: f32 = 400.0;

/// A hilly square of about so many triangles, seen from both sides: nothing is left out but what lies beside the view.
pub fn hills(triangles: usize) -> Scene {
    let quads = ((triangles as f64 / 2.0).sqrt().round() as u32).max(1);
    let step = EDGE / quads as f32;
    let mut scene = Scene {
        materials: vec![Material::default()],
        ..Scene::default()
    };
    for row in 0..=quads {
        for column in 0..=quads {
            let at = Vec2::new(column as f32, row as f32) * step - 0.5 * EDGE;
            let (height, slope) = height(at);
            scene.positions.push([at.x, height, at.y]);
            let normal = Vec3::new(-slope.x, 1.0, -slope.y).normalize();
            scene.normals.push(normal.into());
            scene.texcoords.push((at / EDGE).into());
        }
    }
    for row in 0..quads {
        for column in 0..quads {
            let a = row * (quads + 1) + column;
            let (b, c, d) = (a + 1, a + quads + 1, a + quads + 2);
            scene.indices.extend([a, c, b, b, c, d]);
        }
    }
    scene.bounds = Bounds::of(scene.positions.iter().copied().map(Vec3::from));
    scene.parts = vec![Part {
        first_index: 0,
        index_count: scene.indices.len() as u32,
        material: 0,
        has_colours: false,
        bounds: scene.bounds,
    }];
    scene
}

/// Height of the ground and its slopes toward +x and +z, metres.
fn height(at: Vec2) -> (f32, Vec2) {
    let (u, v) = (0.05 * at.x, 0.043 * at.y);
    let (p, q) = (0.31 * at.x, 0.27 * at.y);
    let height = 8.0 * u.sin() * v.cos() + 0.6 * p.sin() * q.sin();
    let along_x = 0.4 * u.cos() * v.cos() + 0.186 * p.cos() * q.sin();
    let along_z = -0.344 * u.sin() * v.sin() + 0.162 * p.sin() * q.cos();
    (height, Vec2::new(along_x, along_z))
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
    fn hills_have_the_triangles_asked_for_and_normals_across_them() {
        let scene = hills(10_000);
        assert!((9_500..10_500).contains(&scene.triangles()));
        for t in scene.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|i| Vec3::from(scene.positions[t[i] as usize]));
            let face = (b - a).cross(c - a).normalize();
            let normal = Vec3::from(scene.normals[t[0] as usize]);
            assert!(face.dot(normal) > 0.8, "{face} {normal}");
        }
    }

    #[test]
    fn a_long_lens_sees_the_share_asked_for() {
        let (scene, size) = (hills(20_000), UVec2::new(640, 360));
        let camera = Camera::framing(&scene.bounds, 45.0, 16.0 / 9.0);
        assert!(seen(&camera, &scene, size) > 0.999, "all of it");
        let share = seen(&narrowed(&camera, &scene, size, 0.05), &scene, size);
        assert!(share <= 0.05 && share > 0.04, "{share}");
    }
}
