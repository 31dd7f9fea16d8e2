//! A procedurally generated test scene.

use glam::{Vec2, Vec3};

use crate::scene::{Material, Scene};

/// Edge length of the terrain, metres: large enough for several shadow cascades.
const EDGE: f32 = 400.0;

/// A hilly square terrain, 400 m wide, with about `triangles` triangles, normals and texture coordinates.
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
    scene.into_one_part()
}

/// Height of the terrain, metres, and its slopes along +x and +z.
fn height(at: Vec2) -> (f32, Vec2) {
    let (u, v) = (0.05 * at.x, 0.043 * at.y);
    let (p, q) = (0.31 * at.x, 0.27 * at.y);
    let height = 8.0 * u.sin() * v.cos() + 0.6 * p.sin() * q.sin();
    let along_x = 0.4 * u.cos() * v.cos() + 0.186 * p.cos() * q.sin();
    let along_z = -0.344 * u.sin() * v.sin() + 0.162 * p.sin() * q.cos();
    (height, Vec2::new(along_x, along_z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_number_of_triangles_and_the_normals_are_right() {
        let scene = hills(10_000);
        assert!((9_500..10_500).contains(&scene.triangles()));
        for t in scene.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|i| Vec3::from(scene.positions[t[i] as usize]));
            let face = (b - a).cross(c - a).normalize();
            let normal = Vec3::from(scene.normals[t[0] as usize]);
            assert!(face.dot(normal) > 0.8, "{face} {normal}");
        }
    }
}
