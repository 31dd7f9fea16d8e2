//! Orthographic shadow views, fitted to the receivers in view and deep enough for all casters.

use arrayvec::ArrayVec;
use glam::{Mat4, Vec2, Vec3, Vec4};

use crate::scene::Bounds;

use crate::passes::surfaces::culling::Cull;
use crate::passes::view::View;

/// A map's extent is rounded up to a power of this, so that its scale seldom changes.
const SCALE_STEP: f32 = 1.25;
/// Step in which the centre follows the view, as a fraction of the extent. The map has the same margin, so a moving camera needs
/// no new map between two steps.
const CENTRE_STEP: f32 = 1.0 / 16.0;

/// A fitted shadow view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShadowView {
    /// World to the map's clip space: depth 1 nearest the sun, 0 farthest.
    pub shadow_from_world: Mat4,
    /// Edge of a texel, metres; for a perspective map, at the viewer's end.
    pub texel: f32,
    /// Edge of a texel in units of the map's depth.
    pub texel_depth: f32,
    /// Unit vector toward the light.
    pub toward: Vec3,
    /// A point within the map.
    pub inside: Vec3,
}

impl ShadowView {
    /// Transforms planes from world space to the map's clip space.
    pub fn planes(&self) -> Mat4 {
        self.shadow_from_world.inverse().transpose()
    }

    /// The culling tests for this view.
    pub fn cull(&self) -> Cull {
        Cull::light(self)
    }
}

/// World-space axes of the map: right, up, and toward the light.
pub(in crate::passes) fn axes(sun_direction: Vec3) -> [Vec3; 3] {
    let hint = if sun_direction.y.abs() > 0.99 {
        Vec3::NEG_Z
    } else {
        Vec3::Y
    };
    let right = hint.cross(sun_direction).normalize();
    [right, sun_direction.cross(right), sun_direction]
}

/// Coordinates of a point along the axes.
fn along(axes: [Vec3; 3], p: Vec3) -> Vec3 {
    Vec3::from_array(axes.map(|axis| axis.dot(p)))
}

/// Fits a map, `resolution` texels on a side, to the receivers: the part of `bounds` that is in view and that something within
/// `casters` may shadow.
///
/// The centre is snapped to whole texels and the extent is quantized, so that shadows do not swim when the camera moves and the
/// map seldom changes. A map of the whole scene never moves.
pub fn fit(
    sun_direction: Vec3,
    bounds: &Bounds,
    casters: &Bounds,
    view: &View,
    resolution: u32,
) -> ShadowView {
    let axes = axes(sun_direction);
    let to_light = |p| along(axes, p);
    let casters = Bounds::of(casters.corners().map(to_light));
    let receivers = Bounds::of(visible_points(bounds, view).into_iter().map(to_light));
    // Sunlight is parallel: receivers beside the casters, as seen from the sun, are not in shadow.
    let receivers = Bounds {
        min: receivers
            .min
            .max(casters.min.truncate().extend(receivers.min.z)),
        max: receivers
            .max
            .min(casters.max.truncate().extend(receivers.max.z)),
    };
    let receivers = if receivers.is_empty() {
        casters
    } else {
        receivers
    };
    let extent = (receivers.max - receivers.min)
        .truncate()
        .max_element()
        .max(1e-3);
    let stepped = SCALE_STEP.powf((extent.ln() / SCALE_STEP.ln()).ceil());
    let whole = (casters.max - casters.min)
        .truncate()
        .max_element()
        .max(1e-3);
    let follows = stepped * (1.0 + CENTRE_STEP) < whole;
    let (covered, side) = if follows {
        (receivers, stepped * (1.0 + CENTRE_STEP))
    } else {
        (casters, whole)
    };
    let step = if follows {
        (CENTRE_STEP * resolution as f32).floor().max(1.0)
    } else {
        1.0
    };
    let centre = covered.centre().truncate();
    square(axes, &casters, centre, side, step, resolution)
}

/// Fits a map to all of `casters`, independent of the view.
pub fn fit_all(direction: Vec3, casters: &Bounds, resolution: u32) -> ShadowView {
    let axes = axes(direction);
    let casters = Bounds::of(casters.corners().map(|p| along(axes, p)));
    let side = casters.extent().truncate().max_element().max(1e-3);
    let centre = casters.centre().truncate();
    square(axes, &casters, centre, side, 1.0, resolution)
}

/// A square map deep enough for `casters` (in light space), with its centre snapped to steps of `step` texels.
fn square(
    axes: [Vec3; 3],
    casters: &Bounds,
    centre: Vec2,
    side: f32,
    step: f32,
    resolution: u32,
) -> ShadowView {
    let [right, up, toward] = axes;
    // Two texels of margin on each side, for filter and rounding.
    let side = side * (1.0 + 4.0 / resolution as f32);
    let texel = side / resolution as f32;
    let step = step * texel;
    let centre = (centre / step).round() * step;
    ShadowView {
        shadow_from_world: orthographic(axes, centre, side, casters),
        texel,
        texel_depth: texel / depth_range(casters).1,
        toward,
        inside: right * centre.x + up * centre.y + toward * casters.centre().z,
    }
}

/// Far end and depth range of a map of `casters` (in light space), metres along the axis toward the light.
pub(in crate::passes) fn depth_range(casters: &Bounds) -> (f32, f32) {
    let deep = (casters.max.z - casters.min.z).max(1e-3);
    // A little slack keeps the nearest and farthest casters inside the clip volume.
    (casters.min.z - 0.01 * deep, 1.02 * deep)
}

fn orthographic(axes: [Vec3; 3], centre: Vec2, side: f32, casters: &Bounds) -> Mat4 {
    let [right, up, toward] = axes;
    let scale = 2.0 / side;
    let (far, depth) = depth_range(casters);
    let row = |axis: Vec3, scale: f32, offset: f32| (axis * scale).extend(offset);
    Mat4::from_cols(
        row(right, scale, -centre.x * scale),
        row(up, scale, -centre.y * scale),
        row(toward, 1.0 / depth, -far / depth),
        Vec4::W,
    )
    .transpose()
}

/// A half-space: inside where `normal · p + offset ≥ 0`.
#[derive(Clone, Copy)]
struct Plane {
    normal: Vec3,
    offset: f32,
}

impl Plane {
    fn distance(&self, p: Vec3) -> f32 {
        self.normal.dot(p) + self.offset
    }
}

/// Corners of the receivers' convex hull: the view pyramid intersected with the box.
pub(in crate::passes) fn visible_points(bounds: &Bounds, view: &View) -> Hull {
    let frustum = frustum(view);
    let mut points = Hull::new();
    for face in box_faces(bounds) {
        points.extend(clip(&face, &frustum));
    }
    // Corners of the pyramid inside the box.
    let sides = box_planes(bounds);
    for face in pyramid_faces(bounds, view) {
        points.extend(clip(&face, &sides));
    }
    points
}

/// Corners of a convex polygon. Each clip plane adds at most one: squares are clipped by four planes, triangles by six.
type Polygon = ArrayVec<Vec3, 10>;

/// Corners of the clipped faces: six of a box and four of a pyramid.
pub(in crate::passes) type Hull = ArrayVec<Vec3, 100>;

/// Clips a convex polygon against half-spaces (Sutherland and Hodgman 1974).
fn clip(corners: &[Vec3], planes: &[Plane]) -> Polygon {
    let mut polygon: Polygon = corners.iter().copied().collect();
    for plane in planes {
        let mut kept = Polygon::new();
        for (i, &b) in polygon.iter().enumerate() {
            let a = polygon[(i + polygon.len() - 1) % polygon.len()];
            let (da, db) = (plane.distance(a), plane.distance(b));
            if (da >= 0.0) != (db >= 0.0) {
                kept.push(a + (b - a) * (da / (da - db)));
            }
            if db >= 0.0 {
                kept.push(b);
            }
        }
        polygon = kept;
    }
    polygon
}

/// Directions of the pyramid's four edges, in order around it.
fn edges(view: &View) -> [Vec3; 4] {
    // Tiles share the maps of the whole picture.
    let block = view.whole().block();
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, y)| block.world_from_view * (Vec2::new(x, y) * block.ray_scale).extend(-1.0))
}

fn frustum(view: &View) -> [Plane; 4] {
    let (eye, edges, forward) = (view.camera.eye, edges(view), view.camera.forward());
    std::array::from_fn(|i| {
        let normal = edges[i].cross(edges[(i + 1) % 4]).normalize();
        let normal = if normal.dot(forward) < 0.0 {
            -normal
        } else {
            normal
        };
        Plane {
            normal,
            offset: -normal.dot(eye),
        }
    })
}

fn pyramid_faces(bounds: &Bounds, view: &View) -> [[Vec3; 3]; 4] {
    let eye = view.camera.eye;
    // Long enough to leave the box from any eye position.
    let reach = 4.0 * (bounds.diagonal() + (eye - bounds.centre()).length());
    let ends = edges(view).map(|edge| eye + edge * reach);
    std::array::from_fn(|i| [eye, ends[i], ends[(i + 1) % 4]])
}

fn box_planes(bounds: &Bounds) -> [Plane; 6] {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    std::array::from_fn(|i| {
        let axis = axes[i / 2];
        if i % 2 == 0 {
            Plane {
                normal: axis,
                offset: -bounds.min.dot(axis),
            }
        } else {
            Plane {
                normal: -axis,
                offset: bounds.max.dot(axis),
            }
        }
    })
}

fn box_faces(bounds: &Bounds) -> [[Vec3; 4]; 6] {
    let (a, b) = (bounds.min, bounds.max);
    let v = Vec3::new;
    [
        [
            v(a.x, a.y, a.z),
            v(a.x, b.y, a.z),
            v(a.x, b.y, b.z),
            v(a.x, a.y, b.z),
        ],
        [
            v(b.x, a.y, a.z),
            v(b.x, b.y, a.z),
            v(b.x, b.y, b.z),
            v(b.x, a.y, b.z),
        ],
        [
            v(a.x, a.y, a.z),
            v(b.x, a.y, a.z),
            v(b.x, a.y, b.z),
            v(a.x, a.y, b.z),
        ],
        [
            v(a.x, b.y, a.z),
            v(b.x, b.y, a.z),
            v(b.x, b.y, b.z),
            v(a.x, b.y, b.z),
        ],
        [
            v(a.x, a.y, a.z),
            v(b.x, a.y, a.z),
            v(b.x, b.y, a.z),
            v(a.x, b.y, a.z),
        ],
        [
            v(a.x, a.y, b.z),
            v(b.x, a.y, b.z),
            v(b.x, b.y, b.z),
            v(a.x, b.y, b.z),
        ],
    ]
}

#[cfg(test)]
#[path = "fit_tests.rs"]
mod tests;
