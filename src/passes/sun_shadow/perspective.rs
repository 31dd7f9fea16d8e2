//! Light space perspective shadow maps (Wimmer, Scherzer & Purgathofer 2004): views from a light direction, fitted to the
//! receivers in view and warped by a perspective along the line of sight, so that near receivers get more texels. Light rays
//! stay parallel and planes stay planes.

use glam::{Mat4, Vec2, Vec3, Vec4};

use crate::scene::Bounds;

use crate::passes::sun_shadow::fit::{Hull, ShadowView, depth_range, visible_points};
use crate::passes::view::View;

/// Margin around the receivers, texels: one for the sub-texel shift, one for rounding.
const MARGIN: f32 = 2.0;

/// Lower limit of the nearest receiver's distance, as a fraction of the farthest's: a nearer one would take too many texels from
/// the rest.
const MIN_NEAR_SHARE: f32 = 0.03;

/// The convex hull of the receivers in view, and the camera.
#[derive(Debug, Clone, PartialEq)]
pub struct Receivers {
    points: Hull,
    eye: Vec3,
    forward: Vec3,
}

impl Receivers {
    /// The part of `bounds` in view; all of it if nothing is in view.
    pub fn new(bounds: &Bounds, view: &View) -> Self {
        let mut points = visible_points(bounds, view);
        if points.is_empty() {
            points.extend(bounds.corners());
        }
        Self {
            points,
            eye: view.camera.eye,
            forward: view.camera.forward(),
        }
    }

    /// The mean of the points, which lies within their hull.
    fn centre(&self) -> Vec3 {
        self.points.iter().sum::<Vec3>() / self.points.len() as f32
    }

    /// Distance from the centre of projection to the near end. `sine` is that of the angle between light and line of sight (eq. 5 of
    /// the paper).
    fn near(&self, sine: f32) -> f32 {
        let distance = |p: &Vec3| (*p - self.eye).dot(self.forward);
        let far = self.points.iter().map(distance).fold(1e-3, f32::max);
        let near = self.points.iter().map(distance).fold(far, f32::min);
        let near = near.max(MIN_NEAR_SHARE * far);
        (near + (near * far).sqrt()) / sine.max(1e-3)
    }
}

/// Component-wise minimum and maximum of the points.
fn extent(points: impl Iterator<Item = Vec2> + Clone) -> (Vec2, Vec2) {
    let low = points.clone().fold(Vec2::INFINITY, Vec2::min);
    (low, points.fold(Vec2::NEG_INFINITY, Vec2::max))
}

/// Fits a map, `edge` texels on a side, to the receivers. It contains every caster of `bounds` between light and receivers.
///
/// `shift` (0..1) moves the grid by a fraction of a texel, so that discretization errors average out over many maps.
pub fn fit(
    toward: Vec3,
    bounds: &Bounds,
    receivers: &Receivers,
    edge: u32,
    shift: Vec2,
) -> ShadowView {
    let sight = receivers.forward - toward * receivers.forward.dot(toward);
    // With light along the line of sight there is no direction to warp in.
    let along = if sight.length() > 1e-3 {
        sight.normalize()
    } else {
        toward.any_orthonormal_vector()
    };
    let across = along.cross(toward);
    let to_light = |p: Vec3| Vec3::new(across.dot(p), along.dot(p), toward.dot(p));
    let seen = Bounds::of(receivers.points.iter().copied().map(to_light));
    let near = receivers.near(sight.length());
    // w is 1 at the near end and grows away from the viewer.
    let row_w = (along / near).extend(1.0 - seen.min.y / near);
    let row_x = across.extend(-across.dot(receivers.eye));
    let row_y = along.extend(-seen.min.y);
    let projected = receivers.points.iter().map(|p| {
        let p = p.extend(1.0);
        Vec2::new(row_x.dot(p), row_y.dot(p)) / row_w.dot(p)
    });
    let (low, high) = extent(projected);
    let texels = edge as f32;
    let scale = (texels - 2.0 * MARGIN) / (high - low).max(Vec2::splat(1e-4));
    // First to texels from the map's edge, then from 0..edge to -1..1.
    let offset = Vec2::splat(MARGIN - 0.5) + shift - low * scale;
    let clip = |row: Vec4, scale: f32, offset: f32| {
        (row * scale + row_w * offset) * (2.0 / texels) - row_w
    };
    let casters = Bounds::of(bounds.corners().map(to_light));
    let (far, depth) = depth_range(&casters);
    let rows = Mat4::from_cols(
        clip(row_x, scale.x, offset.x),
        clip(row_y, scale.y, offset.y),
        (toward / depth).extend(-far / depth),
        row_w,
    );
    let texel = scale.min_element().recip();
    ShadowView {
        shadow_from_world: rows.transpose(),
        texel,
        texel_depth: texel / depth,
        toward,
        inside: receivers.centre(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Camera;
    use glam::UVec2;

    fn bounds() -> Bounds {
        Bounds {
            min: Vec3::new(-30.0, 0.0, -40.0),
            max: Vec3::new(24.0, 6.0, 19.0),
        }
    }

    fn receivers() -> Receivers {
        let camera = Camera {
            eye: Vec3::new(6.0, 3.0, 15.0),
            target: Vec3::new(-4.0, 1.0, -6.0),
            fov_deg: 45.0,
            near: 0.01,
        };
        let view = View {
            camera,
            size: UVec2::new(640, 360),
            jitter: Vec2::ZERO,
            sharpen: 0.0,
            window: None,
        };
        Receivers::new(&bounds(), &view)
    }

    fn directions() -> [Vec3; 5] {
        let forward = receivers().forward;
        [
            Vec3::Y,
            Vec3::new(0.3, 0.5, 0.8),
            Vec3::new(-0.9, 0.05, 0.1),
            forward,
            -forward,
        ]
        .map(Vec3::normalize)
    }

    #[test]
    fn receivers_lie_in_the_map_and_casters_over_them_too() {
        let seen = receivers();
        for toward in directions() {
            for shift in [Vec2::ZERO, Vec2::splat(0.999)] {
                let view = fit(toward, &bounds(), &seen, 64, shift).shadow_from_world;
                for p in &seen.points {
                    let at = view.project_point3(*p);
                    assert!(
                        at.truncate().abs().max_element() <= 31.0 / 32.0 + 1e-3,
                        "{at}"
                    );
                    assert!((0.0..=1.0).contains(&at.z), "{at}");
                    // A point moved toward the light stays at its texel, and its depth grows.
                    let over = view.project_point3(*p + toward * 0.5);
                    assert!((over - at).truncate().length() < 1e-3 && over.z > at.z);
                }
            }
        }
    }

    #[test]
    fn near_things_get_more_texels() {
        let seen = receivers();
        let view = fit(Vec3::Y, &bounds(), &seen, 1024, Vec2::ZERO).shadow_from_world;
        let size =
            |p: Vec3| (view.project_point3(p + 0.1 * Vec3::X) - view.project_point3(p)).length();
        let (near, far) = (Vec3::new(4.0, 0.0, 11.0), Vec3::new(-16.0, 0.0, -32.0));
        assert!(size(near) > 3.0 * size(far), "{} {}", size(near), size(far));
    }

    #[test]
    fn planes_are_taken_along() {
        let seen = receivers();
        for toward in directions() {
            let view = fit(toward, &bounds(), &seen, 256, Vec2::splat(0.3));
            let (normal, p) = (
                Vec3::new(0.2, 0.9, 0.3).normalize(),
                Vec3::new(1.0, 0.5, -2.0),
            );
            let plane = view.planes() * normal.extend(-normal.dot(p));
            let (t, u) = normal.any_orthonormal_pair();
            for q in [p, p + t, p - 0.7 * u + 0.2 * t] {
                let at = view.shadow_from_world.project_point3(q).extend(1.0);
                assert!(
                    plane.dot(at).abs() < 1e-3 * plane.length(),
                    "{}",
                    plane.dot(at)
                );
            }
        }
    }
}
