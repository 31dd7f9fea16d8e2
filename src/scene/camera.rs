//! The camera: its position, field of view and matrices.
//!
//! View space is right-handed with +Y up and −Z forward. Clip space is Vulkan's (y down, depth 0..1) with reversed Z and
//! an infinite far plane: depth 1 at `near`, 0 at infinity.

use glam::camera::rh::{proj::vulkan, view};
use glam::{Mat4, Vec3};

use crate::scene::bounds::Bounds;
use crate::scene::subject::Subject;

/// Default vertical field of view, degrees.
pub const DEFAULT_FOV_DEG: f32 = 45.0;

/// Azimuth of the eye of the default view as seen from the model, degrees clockwise from north: south-south-east.
const FRAMING_AZIMUTH_DEG: f32 = 152.0;
/// Elevation of the eye of the default view above the centre of the model, degrees.
const FRAMING_ELEVATION_DEG: f32 = 14.0;
/// Distance of the default view, as a factor on the distance at which the model just fits.
const FRAMING_MARGIN: f32 = 1.05;

/// Vertical field of view of a plan, degrees: so narrow that verticals at its upper and lower edge lean by 1/57 of their height.
const PLAN_FOV_DEG: f32 = 2.0;
/// What a plan keeps free around its subject, so that shadows have room: as a factor on the subject's height.
const PLAN_ROOM: f32 = 1.5;

/// A perspective camera without roll (+Y up).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Camera {
    /// Eye position, metres.
    pub eye: Vec3,
    /// Point the eye looks at, metres; never equal to `eye`.
    pub target: Vec3,
    /// Vertical field of view, degrees, in (0, 180).
    pub fov_deg: f32,
    /// Near plane distance, metres, positive.
    pub near: f32,
}

impl Camera {
    /// A camera with the given parts. Missing parts are chosen so that the subject is in view.
    ///
    /// Without a target, it looks at the centre of the subject. Without an eye, it views the target from the direction and
    /// distance of the default view. With neither, it is within a subject that is a room. `aspect` is width / height.
    pub fn from_parts(
        eye: Option<Vec3>,
        target: Option<Vec3>,
        fov_deg: Option<f32>,
        subject: &Subject,
        aspect: f32,
    ) -> Self {
        let framed = Self::framing(&subject.bounds, fov_deg.unwrap_or(DEFAULT_FOV_DEG), aspect);
        let (eye, target) = match (eye, target) {
            (Some(eye), Some(target)) => (eye, target),
            (Some(eye), None) => (eye, framed.target),
            (None, Some(target)) => (target + framed.eye - framed.target, target),
            (None, None) => match subject.inside {
                Some(inside) => (inside.eye, inside.target),
                None => (framed.eye, framed.target),
            },
        };
        // With no view direction given, look north.
        let target = if eye == target {
            eye + Vec3::NEG_Z
        } else {
            target
        };
        Self {
            eye,
            target,
            ..framed
        }
    }

    /// A view of all of `bounds` from the south-south-east, slightly above the centre.
    ///
    /// `fov_deg` is the vertical field of view in degrees, in (0, 180); `aspect` is width / height.
    pub fn framing(bounds: &Bounds, fov_deg: f32, aspect: f32) -> Self {
        let toward_eye = direction(FRAMING_AZIMUTH_DEG, FRAMING_ELEVATION_DEG);
        Self::framing_from(bounds, toward_eye, fov_deg, aspect)
    }

    /// A view of all of `bounds`. `toward_eye` is the unit vector from the centre to the eye and must not be vertical. For the
    /// other arguments see [`Camera::framing`].
    pub fn framing_from(bounds: &Bounds, toward_eye: Vec3, fov_deg: f32, aspect: f32) -> Self {
        let target = bounds.centre();
        let right = Vec3::Y.cross(toward_eye).normalize();
        let up = toward_eye.cross(right);
        let tan_y = (0.5 * fov_deg).to_radians().tan();
        let tan_x = tan_y * aspect;
        // A corner q is in view if |x| <= (distance − depth) tan, so each corner gives a minimum distance.
        let distance = bounds.corners().map(|corner| {
            let q = if bounds.is_empty() {
                Vec3::ZERO
            } else {
                corner - target
            };
            let lateral = (q.dot(right).abs() / tan_x).max(q.dot(up).abs() / tan_y);
            q.dot(toward_eye) + lateral
        });
        let distance = distance.into_iter().fold(0.0, f32::max) * FRAMING_MARGIN;
        let near = near_plane(bounds);
        Self {
            eye: target + toward_eye * distance.max(10.0 * near),
            target,
            fov_deg,
            near,
        }
    }

    /// A view from high above, north at the top: nearly a parallel projection. `aspect` is width / height. It shows all of `bounds`, or `width`
    /// metres around their middle.
    pub fn plan(bounds: &Bounds, width: Option<f32>, aspect: f32) -> Self {
        let (centre, extent) = (bounds.centre(), bounds.extent());
        let whole = 0.5 * extent.z.max(extent.x / aspect) * FRAMING_MARGIN + PLAN_ROOM * extent.y;
        let half = width.map_or(whole, |width| 0.5 * width / aspect);
        let near = near_plane(bounds);
        let height = (half / (0.5 * PLAN_FOV_DEG).to_radians().tan()).max(10.0 * near);
        Self {
            eye: centre + (0.5 * extent.y + height) * Vec3::Y,
            target: centre,
            fov_deg: PLAN_FOV_DEG,
            near,
        }
    }

    /// World space to view space: rotation and translation.
    pub fn view_from_world(&self) -> Mat4 {
        view::look_at_mat4(self.eye, self.target, self.up())
    }

    /// View space to world space. The last column is the eye position.
    pub fn world_from_view(&self) -> Mat4 {
        self.view_from_world().inverse()
    }

    /// View space to Vulkan clip space with reversed Z and an infinite far plane. `aspect` is width / height.
    pub fn clip_from_view(&self, aspect: f32) -> Mat4 {
        vulkan::perspective_infinite_reverse(self.fov_deg.to_radians(), aspect, self.near)
    }

    /// View direction, unit length.
    pub fn forward(&self) -> Vec3 {
        (self.target - self.eye).normalize_or(Vec3::NEG_Z)
    }

    /// +Y, or north if the camera looks straight up or down.
    fn up(&self) -> Vec3 {
        if self.forward().y.abs() > 0.999_999 {
            Vec3::NEG_Z
        } else {
            Vec3::Y
        }
    }
}

/// Unit vector from an azimuth (degrees clockwise from north) and an elevation (degrees).
fn direction(azimuth_deg: f32, elevation_deg: f32) -> Vec3 {
    let (sin_az, cos_az) = azimuth_deg.to_radians().sin_cos();
    let (sin_el, cos_el) = elevation_deg.to_radians().sin_cos();
    Vec3::new(sin_az * cos_el, sin_el, -cos_az * cos_el)
}

/// Near plane distance, metres. Reversed floating-point depth keeps its relative precision at any distance, so the near plane
/// can be very close; it only has to shrink for small models.
fn near_plane(bounds: &Bounds) -> f32 {
    (1e-3 * bounds.diagonal()).clamp(1e-5, 0.05)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn boxes() -> [Bounds; 5] {
        let around = |min: [f32; 3], max: [f32; 3]| Bounds {
            min: min.into(),
            max: max.into(),
        };
        [
            around([-5.0, 0.0, -5.0], [5.0, 8.0, 5.0]),
            around([-50.0, -0.1, -20.0], [50.0, 0.0, 20.0]),
            around([100.0, 100.0, 100.0], [100.1, 140.0, 100.1]),
            around([-0.01, 0.0, -0.01], [0.01, 0.02, 0.01]),
            around([1.0, 2.0, 3.0], [1.0, 2.0, 3.0]),
        ]
    }

    #[test]
    fn framing_shows_every_corner() {
        for bounds in boxes() {
            for (fov, aspect) in [(45.0, 16.0 / 9.0), (20.0, 1.0), (100.0, 0.4), (60.0, 4.0)] {
                let camera = Camera::framing(&bounds, fov, aspect);
                let clip_from_world = camera.clip_from_view(aspect) * camera.view_from_world();
                for corner in bounds.corners() {
                    let clip = clip_from_world * corner.extend(1.0);
                    assert!(
                        clip.w > camera.near,
                        "{bounds:?}: {corner} is behind the eye"
                    );
                    let inside = clip.x.abs() <= clip.w && clip.y.abs() <= clip.w;
                    assert!(
                        inside,
                        "{bounds:?} fov {fov} aspect {aspect}: {corner} is outside"
                    );
                }
            }
        }
    }

    #[test]
    fn framing_views_from_south_east_and_above() {
        let camera = Camera::framing(&boxes()[0], 45.0, 1.5);
        let offset = camera.eye - camera.target;
        assert!(
            offset.x > 0.0 && offset.y > 0.0 && offset.z > 0.0,
            "{offset}"
        );
    }

    #[test]
    fn clip_space_is_vulkans_with_reversed_depth() {
        let camera = Camera {
            eye: Vec3::ZERO,
            target: Vec3::NEG_Z,
            fov_deg: 90.0,
            near: 0.1,
        };
        let clip_from_world = camera.clip_from_view(2.0) * camera.view_from_world();
        let project = |p: Vec3| clip_from_world.project_point3(p);
        assert!(
            (project(Vec3::new(0.0, 0.0, -0.1)).z - 1.0).abs() < 1e-6,
            "near is 1"
        );
        assert!(
            project(Vec3::new(0.0, 0.0, -1e6)).z.abs() < 1e-6,
            "far is 0"
        );
        assert!(
            project(Vec3::new(0.0, 1.0, -2.0)).y < 0.0,
            "up is toward the first row"
        );
        assert!(
            project(Vec3::new(1.0, 0.0, -2.0)).x > 0.0,
            "east is to the right when looking north"
        );
        let edge = project(Vec3::new(2.0, 1.0, -1.0));
        assert!(
            (edge.x - 1.0).abs() < 1e-6 && (edge.y + 1.0).abs() < 1e-6,
            "{edge}"
        );
    }

    #[test]
    fn world_from_view_ends_at_the_eye() {
        let camera = Camera {
            eye: Vec3::new(1.0, 2.0, 3.0),
            target: Vec3::ZERO,
            fov_deg: 50.0,
            near: 0.1,
        };
        let eye = camera.world_from_view().w_axis.truncate();
        assert!((eye - camera.eye).length() < 1e-5);
        let ahead = camera.world_from_view().transform_vector3(Vec3::NEG_Z);
        assert!((ahead - camera.forward()).length() < 1e-5);
    }

    #[test]
    fn straight_down_has_north_at_the_top() {
        let camera = Camera {
            eye: Vec3::Y * 10.0,
            target: Vec3::ZERO,
            fov_deg: 50.0,
            near: 0.1,
        };
        let clip_from_world = camera.clip_from_view(1.0) * camera.view_from_world();
        let north = clip_from_world.project_point3(Vec3::NEG_Z);
        assert!(north.is_finite() && north.y < -0.1, "{north}");
    }

    #[test]
    fn a_plan_shows_every_corner_with_north_at_the_top() {
        for bounds in boxes() {
            for aspect in [16.0 / 9.0, 1.0, 0.4] {
                let camera = Camera::plan(&bounds, None, aspect);
                let clip_from_world = camera.clip_from_view(aspect) * camera.view_from_world();
                let seen = bounds.corners().map(|corner| {
                    let at = clip_from_world.project_point3(corner);
                    let is_inside = at.x.abs() <= 1.0 && at.y.abs() <= 1.0;
                    assert!(is_inside, "{bounds:?} aspect {aspect}: {corner} at {at}");
                    (corner, at)
                });
                for (corner, at) in seen {
                    let from_centre = corner - bounds.centre();
                    assert!(from_centre.z * at.y >= 0.0, "south is down: {corner} {at}");
                    assert!(from_centre.x * at.x >= 0.0, "east is right: {corner} {at}");
                }
                // A given width is that at the height of the top.
                let camera = Camera::plan(&bounds, Some(8.0), aspect);
                let clip_from_world = camera.clip_from_view(aspect) * camera.view_from_world();
                let edge = bounds.centre() + Vec3::new(4.0, 0.5 * bounds.extent().y, 0.0);
                let at = clip_from_world.project_point3(edge);
                assert!((at.x - 1.0).abs() < 1e-3, "{bounds:?}: {at}");
            }
        }
    }

    #[test]
    fn missing_parts_are_filled_in() {
        let bounds = boxes()[0];
        let eye = Vec3::new(9.0, 2.0, 9.0);
        let looks = Camera::from_parts(Some(eye), None, Some(30.0), &bounds.into(), 1.0);
        assert_eq!(
            (looks.eye, looks.target, looks.fov_deg),
            (eye, bounds.centre(), 30.0)
        );
        let itself = Camera::from_parts(Some(eye), Some(eye), None, &bounds.into(), 1.0);
        assert!(itself.view_from_world().is_finite());
        let nothing = Camera::from_parts(None, None, None, &Bounds::EMPTY.into(), 1.0);
        assert!(nothing.view_from_world().is_finite());
    }
}
