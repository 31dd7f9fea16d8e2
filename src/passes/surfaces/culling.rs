//! Cluster culling: by view frustum, by back-facing clusters of solids and, for a light, of casters that shadow no receiver in
//! view. The remaining clusters are drawn in runs of indices.

use std::sync::Arc;

use glam::{DVec2, Mat4, Vec3};

use crate::gpu::{Draws, Faces, Winding};
use crate::scene::{Bounds, Cluster};

use crate::passes::sun_shadow::fit::ShadowView;
use crate::passes::sun_shadow::receiver_mask::ReceiverMask;
use crate::passes::view::View;

/// The viewpoint of a view.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Viewer {
    /// A point; the near plane clips only geometry within `reach` metres of it.
    At { eye: Vec3, reach: f32 },
    /// Infinitely far away in a direction (unit vector).
    Toward(Vec3),
}

/// The culling tests of a view.
#[derive(Debug, Clone, PartialEq)]
pub struct Cull {
    /// Left, right, bottom and top plane, one per row: a point is inside where the product with (p, 1) is not negative.
    sides: Mat4,
    viewer: Viewer,
    front: Winding,
    /// For a light, the receivers in view; `None`: the whole map.
    mask: Option<Arc<ReceiverMask>>,
}

impl Cull {
    /// Culling tests for a camera.
    pub fn camera(view: &View) -> Self {
        let clip_from_world = view.clip_from_world();
        let eye = view.camera.eye;
        let block = view.block();
        let corner = (block.ray_scale.abs() + block.ray_offset.abs())
            .extend(1.0)
            .length();
        let viewer = Viewer::At {
            eye,
            reach: view.camera.near * corner,
        };
        // The point must be far enough from the eye: with an eye far from the origin, rounding in the matrix would dominate near it.
        let away = 1.0 + 0.01 * eye.length();
        let ahead = eye + view.camera.forward() * away;
        Self::new(clip_from_world, viewer, ahead, 0.1 * away)
    }

    /// Culling tests for a directional light.
    pub fn light(map: &ShadowView) -> Self {
        let viewer = Viewer::Toward(map.toward);
        Self::new(map.shadow_from_world, viewer, map.inside, map.texel)
    }

    /// Also culls casters that shadow none of these receivers.
    pub fn masked(self, mask: Option<Arc<ReceiverMask>>) -> Self {
        Self { mask, ..self }
    }

    fn new(clip_from_world: Mat4, viewer: Viewer, at: Vec3, size: f32) -> Self {
        let toward = match viewer {
            Viewer::At { eye, .. } => (eye - at).normalize(),
            Viewer::Toward(toward) => toward,
        };
        Self {
            sides: sides(&clip_from_world),
            viewer,
            front: front(clip_from_world, toward, at, size),
            mask: None,
        }
    }

    /// Whether a part of a cluster may be visible or, for a light, cast a visible shadow.
    pub fn sees(&self, cluster: &Cluster) -> bool {
        let casts = |mask: &Arc<ReceiverMask>| mask.is_shadowed_by(cluster);
        self.holds(cluster) && !self.is_behind(cluster) && self.mask.as_ref().is_none_or(casts)
    }

    /// Whether a part of the cluster lies within the sides of the frustum.
    pub fn holds(&self, cluster: &Cluster) -> bool {
        reaches(&self.sides, &cluster.bounds)
    }

    /// The faces of a cluster that may be visible.
    pub fn faces(&self, cluster: &Cluster) -> Faces {
        let outside = cluster.solid.is_some_and(|s| !self.is_within(&s.bodies));
        Faces {
            front: self.front,
            fronts_only: outside,
        }
    }

    /// Whether all triangles of a solid are back-facing; for a viewpoint, over the whole cone of directions to the cluster's sphere.
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

/// Frustum planes from the clip-space matrix (Gribb and Hartmann 2001): -w <= x <= w and -w <= y <= w, as products with (p, 1).
fn sides(clip_from_world: &Mat4) -> Mat4 {
    let [x, y, w] = [0, 1, 3].map(|i| clip_from_world.row(i));
    Mat4::from_cols(w + x, w - x, w + y, w - y).transpose()
}

/// Whether a part of a box is inside each of the four planes, within rounding error.
fn reaches(sides: &Mat4, bounds: &Bounds) -> bool {
    let (centre, half) = (bounds.centre(), 0.5 * bounds.extent());
    let sizes = sides.abs();
    let farthest = *sides * centre.extend(1.0) + sizes * half.extend(0.0);
    let slack = 1e-5 * (sizes * (centre.abs() + half).extend(1.0));
    farthest.cmpge(-slack).all()
}

/// Winding in the picture of triangles that are counter-clockwise as seen by the viewer, from a test triangle of `size` metres
/// at a point.
fn front(clip_from_world: Mat4, toward: Vec3, at: Vec3, size: f32) -> Winding {
    let clip_from_world = clip_from_world.as_dmat4();
    let u = toward.any_orthonormal_vector();
    let v = toward.cross(u);
    let [a, b, c] = [Vec3::ZERO, u * size, v * size].map(|offset| {
        let clip = clip_from_world * (at.as_dvec3() + offset.as_dvec3()).extend(1.0);
        DVec2::new(clip.x, clip.y) / clip.w
    });
    // Rows run down, which flips the sign of the area; Vulkan's definition of winding flips it back.
    if (b - a).perp_dot(c - a) > 0.0 {
        Winding::Clockwise
    } else {
        Winding::CounterClockwise
    }
}

/// A run of indices drawn with one draw call.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::passes) struct Run {
    first: u32,
    count: u32,
    faces: Faces,
}

impl Run {
    /// Number of its first triangle in the index buffer.
    pub fn first_triangle(&self) -> u32 {
        self.first / 3
    }

    /// Draws it.
    pub fn draw(&self, draws: &mut Draws<'_, '_>) {
        draws.faces(self.faces);
        draws.indexed(self.first, self.count);
    }

    /// Whether one draw of both runs, including the indices in between, is cheaper than two.
    fn is_followed_by(&self, next: &Self) -> bool {
        self.faces == next.faces && next.first - (self.first + self.count) <= BRIDGED
    }
}

/// Largest number of culled indices drawn anyway to save a draw call, which costs a CPU 10 to 30 µs, as much as 200 triangles.
const BRIDGED: u32 = 3 * 200;

/// Runs of the visible clusters; nearly adjacent runs are merged.
pub(in crate::passes) struct Runs<'c, I> {
    clusters: I,
    cull: &'c Cull,
    open: Option<Run>,
}

impl<'c, I: Iterator<Item = &'c Cluster>> Runs<'c, I> {
    /// Runs of the clusters of a part, in index order.
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

#[cfg(test)]
mod tests {
    use glam::{UVec2, Vec2};

    use super::*;
    use crate::passes::sun_shadow::fit;
    use crate::scene::{Bodies, Camera, Clusters, Scene};

    /// A box of 2 m around a point, as a single cluster of a solid.
    fn solid(centre: Vec3) -> (Scene, Cluster) {
        let corner = |i: u32| Vec3::from_array([0, 1, 2].map(|k| ((i >> k & 1) * 2) as f32 - 1.0));
        let mut scene = Scene {
            positions: (0..8).map(|i| (centre + corner(i)).to_array()).collect(),
            ..Scene::default()
        };
        for quad in [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ] {
            scene
                .indices
                .extend([0, 1, 2, 0, 2, 3].map(|k: usize| quad[k]));
        }
        scene.bounds = Bounds::of(scene.positions.iter().copied().map(Vec3::from));
        let clusters = Clusters::of(&scene, &Bodies::of(&scene), &[(0, 36)]);
        assert_eq!(clusters.list.len(), 1);
        assert!(clusters.list[0].solid.is_some(), "a solid");
        (scene, clusters.list[0])
    }

    fn view(centre: Vec3, from: Vec3, near: f32) -> View {
        View {
            camera: Camera {
                eye: centre + from,
                target: centre,
                fov_deg: 45.0,
                near,
            },
            size: UVec2::new(640, 360),
            jitter: Vec2::ZERO,
            sharpen: 0.0,
            window: None,
        }
    }

    /// Checks the winding of the box's faces against `faces`, for those toward the viewer and those away from it.
    fn drawn(scene: &Scene, clip: Mat4, faces: Faces, is_toward: impl Fn(Vec3, Vec3) -> bool) {
        for triangle in scene.indices.chunks_exact(3) {
            let corners = [0, 1, 2].map(|i| Vec3::from(scene.positions[triangle[i] as usize]));
            let [a, b, c] = corners.map(|p| {
                let p = clip.as_dmat4() * p.as_dvec3().extend(1.0);
                DVec2::new(p.x, p.y) / p.w
            });
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
            let clockwise = (b - a).perp_dot(c - a) > 0.0;
            let is_drawn = clockwise == (faces.front == Winding::Clockwise);
            assert_eq!(
                is_drawn,
                is_toward(normal, corners[0]),
                "{faces:?} {normal}"
            );
        }
    }

    #[test]
    fn the_faces_that_are_drawn_look_at_the_viewer_wherever_the_scene_lies() {
        for centre in [
            Vec3::ZERO,
            Vec3::new(14_678.0, 3.0, 9_605.0),
            Vec3::splat(-2e5),
        ] {
            let (scene, cluster) = solid(centre);
            for from in [
                Vec3::new(5.0, 3.0, 4.0),
                Vec3::new(-3.0, -4.0, 6.0),
                Vec3::Y * 8.0,
            ] {
                let view = view(centre, from, 0.01);
                let cull = Cull::camera(&view);
                assert!(cull.sees(&cluster), "{centre} {from}");
                let eye = view.camera.eye;
                drawn(
                    &scene,
                    view.clip_from_world(),
                    cull.faces(&cluster),
                    |n, p| n.dot(eye - p) > 0.0,
                );
                let toward = from.normalize();
                let map = fit::fit(toward, &scene.bounds, &scene.bounds, &view, 1024);
                let cull = map.cull();
                assert!(cull.sees(&cluster), "{centre} {from}: by the light");
                drawn(
                    &scene,
                    map.shadow_from_world,
                    cull.faces(&cluster),
                    |n, _| n.dot(toward) > 0.0,
                );
            }
        }
    }

    #[test]
    fn inside_of_a_solid_all_faces_are_drawn() {
        let (_, cluster) = solid(Vec3::ZERO);
        let inside = Cull::camera(&view(Vec3::ZERO, Vec3::new(0.5, 0.2, 0.0), 0.01));
        assert!(!inside.faces(&cluster).fronts_only);
        // The near plane clips the box although the eye is in front of it.
        let before = |near| Cull::camera(&view(Vec3::ZERO, Vec3::Z * 1.2, near)).faces(&cluster);
        assert!(!before(0.5).fronts_only);
        assert!(before(0.01).fronts_only);
    }

    #[test]
    fn what_lies_beside_the_view_is_not_seen() {
        let (_, cluster) = solid(Vec3::new(50.0, 0.0, 0.0));
        assert!(!Cull::camera(&view(Vec3::ZERO, Vec3::Z * 10.0, 0.01)).sees(&cluster));
    }
}
