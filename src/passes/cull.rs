//! What a view cannot see: clusters outside of its pyramid, and those of solids that turn their backs.

use glam::{Mat4, Vec3, Vec4};

use crate::gpu::Faces;
use crate::scene::{Bounds, Cluster};

use super::view::View;

/// From where a view looks.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Viewer {
    /// From a point; `reach` metres around it lies what the near plane cuts.
    At { eye: Vec3, reach: f32 },
    /// From infinitely far in a direction, unit.
    Toward(Vec3),
}

/// A view as culling sees it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Cull {
    /// Left, right, bottom, top: inside where the product with (p, 1) is not negative.
    planes: [Vec4; 4],
    viewer: Viewer,
    front: Faces,
}

impl Cull {
    /// For a camera.
    pub fn camera(view: &View) -> Self {
        let clip_from_world = view.clip_from_world();
        let eye = view.camera.eye;
        let corner = view.block().ray_scale.extend(1.0).length();
        let viewer = Viewer::At {
            eye,
            reach: view.camera.near * corner,
        };
        let ahead = eye + view.camera.forward() * (2.0 * view.camera.near);
        Self::new(clip_from_world, viewer, ahead)
    }

    /// For a directional light: `at` is a point in its map.
    pub fn light(clip_from_world: Mat4, toward: Vec3, at: Vec3) -> Self {
        Self::new(clip_from_world, Viewer::Toward(toward), at)
    }

    fn new(clip_from_world: Mat4, viewer: Viewer, at: Vec3) -> Self {
        let row = |i| clip_from_world.row(i);
        // Gribb and Hartmann 2001: -w <= x <= w, as products with (p, 1).
        let planes = [
            row(3) + row(0),
            row(3) - row(0),
            row(3) + row(1),
            row(3) - row(1),
        ];
        let toward = match viewer {
            Viewer::At { eye, .. } => (eye - at).normalize(),
            Viewer::Toward(toward) => toward,
        };
        Self {
            planes,
            viewer,
            front: front(clip_from_world, toward, at),
        }
    }

    /// Whether some of a cluster may be seen.
    pub fn sees(&self, cluster: &Cluster) -> bool {
        self.planes
            .iter()
            .all(|plane| reaches(*plane, &cluster.bounds))
            && !self.is_behind(cluster)
    }

    /// The faces of a cluster that may be seen.
    pub fn faces(&self, cluster: &Cluster) -> Faces {
        let outside = cluster.solid.is_some_and(|s| !self.is_within(&s.bodies));
        if outside { self.front } else { Faces::Both }
    }

    /// Whether all triangles of a solid turn their backs. A point sees the back of a plane through any point of the cluster if it
    /// does so from the whole cone of directions to the cluster's sphere.
    fn is_behind(&self, cluster: &Cluster) -> bool {
        let Some(solid) = &cluster.solid else {
            return false;
        };
        if solid.sine >= 1.0 || self.is_within(&solid.bodies) {
            return false;
        }
        match self.viewer {
            Viewer::Toward(toward) => -toward.dot(solid.axis) > solid.sine,
            Viewer::At { eye, .. } => {
                let (away, radius) = (
                    cluster.bounds.centre() - eye,
                    0.5 * cluster.bounds.diagonal(),
                );
                away.dot(solid.axis) > solid.sine * away.length() + radius
            }
        }
    }

    fn is_within(&self, bounds: &Bounds) -> bool {
        match self.viewer {
            Viewer::Toward(_) => false,
            Viewer::At { eye, reach } => {
                (bounds.min - reach).cmple(eye).all() && (bounds.max + reach).cmpge(eye).all()
            }
        }
    }
}

/// Whether some of a box is on the inner side of a plane.
fn reaches(plane: Vec4, bounds: &Bounds) -> bool {
    let normal = plane.truncate();
    let farthest = Vec3::select(normal.cmpge(Vec3::ZERO), bounds.max, bounds.min);
    normal.dot(farthest) + plane.w >= 0.0
}

/// How triangles that are counter-clockwise seen from the viewer wind in the picture.
fn front(clip_from_world: Mat4, toward: Vec3, at: Vec3) -> Faces {
    let u = toward.any_orthonormal_vector();
    let v = toward.cross(u);
    let small = 1e-3 * (1.0 + at.length());
    let [a, b, c] = [at, at + u * small, at + v * small].map(|p| {
        let clip = clip_from_world * p.extend(1.0);
        clip.truncate().truncate() / clip.w
    });
    // Rows run down: what is counter-clockwise with y up is clockwise there, and by Vulkan's own word the other way.
    if (b - a).perp_dot(c - a) > 0.0 {
        Faces::Clockwise
    } else {
        Faces::CounterClockwise
    }
}
