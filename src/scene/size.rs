//! Whether the size of a scene is plausible in metres: models in millimetres are the commonest mistake, and penumbrae, occlusion
//! and lux at a distance depend on size.

use glam::Vec3;

use crate::scene::Scene;

/// Height of a wall above which it is no building's, metres.
const WALL: f32 = 1_000.0;
/// Height above which a scene is no terrain, metres.
const RELIEF: f32 = 20_000.0;
/// Length below which a scene is implausible, metres.
const TINY: f32 = 0.05;
/// Largest vertical component of the unit normal of a wall.
const UPRIGHT: f32 = 0.02;

/// What is implausible about a scene in metres, if anything. A terrain may be high, but it has no high walls.
pub fn implausible(scene: &Scene) -> Option<String> {
    let extent = scene.bounds.extent();
    let length = extent.max_element();
    if scene.triangles() > 0 && length < TINY {
        return Some(format!("is {:.1} mm long", 1000.0 * length));
    }
    if extent.y > RELIEF {
        return Some(format!("is {:.0} m high", extent.y));
    }
    let has_wall = extent.y > WALL
        && scene
            .indices
            .chunks_exact(3)
            .any(|t| is_high_wall(scene, t));
    has_wall.then(|| format!("has walls above {WALL} m"))
}

fn is_high_wall(scene: &Scene, triangle: &[u32]) -> bool {
    let [a, b, c] = [0, 1, 2].map(|i| Vec3::from(scene.positions[triangle[i] as usize]));
    let height = a.max(b).max(c).y - a.min(b).min(c).y;
    height > WALL && (b - a).cross(c - a).normalize_or_zero().y.abs() < UPRIGHT
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Bounds;

    fn triangle(corners: [Vec3; 3]) -> Scene {
        Scene {
            positions: corners.map(|p| p.to_array()).to_vec(),
            indices: vec![0, 1, 2],
            bounds: Bounds::of(corners),
            ..Scene::default()
        }
    }

    #[test]
    fn houses_in_millimetres_are_implausible_and_mountains_are_not() {
        let wall = |scale: f32| {
            let corners = [Vec3::ZERO, Vec3::X * 9.0, Vec3::Y * 3.0].map(|p| p * scale);
            implausible(&triangle(corners))
        };
        assert_eq!(wall(1.0), None);
        assert_eq!(wall(100.0), None, "a tower of 300 m");
        assert!(wall(1000.0).is_some_and(|what| what.contains("walls")));
        assert!(wall(0.002).is_some_and(|what| what.contains("18.0 mm")));
        let mountain = [
            Vec3::ZERO,
            Vec3::new(9e3, 0.0, 0.0),
            Vec3::new(3e3, 4e3, 2e3),
        ];
        assert_eq!(implausible(&triangle(mountain)), None);
        assert!(implausible(&triangle(mountain.map(|p| p * 9.0))).is_some());
    }
}
