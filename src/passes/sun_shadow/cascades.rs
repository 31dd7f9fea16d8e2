//! Cascaded shadow maps of the sun. Small scenes use one map; large ones several, each a few times as wide as the one before.
//!
//! Each cascade covers the receivers in view within a cube around the eye. It follows the view in the steps of [`fit::fit`], so
//! that shadows do not swim. A point uses the finest cascade whose cube contains it; near the cube's side it blends into the next.

use arrayvec::ArrayVec;
use glam::Vec3;

use crate::daylight::sunlight::SUN_ANGULAR_RADIUS;
use crate::gpu_struct;
use crate::scene::Bounds;

use crate::passes::sun_shadow::fit::{self, ShadowView};
use crate::passes::view::View;

/// Settings of the sun's shadow lookup.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Shadows {
    /// Number of cascades, 1 to 4; 0: [`crate::frame::Frame`] chooses it by the extent of the scene.
    pub cascades: u32,
    /// Whether a single frame has penumbrae of physical width, from the sun's angular radius.
    pub penumbrae: bool,
}

impl Shadows {
    /// Radius of the lookups around a receiver, texels, including filter and offset.
    pub(in crate::passes) fn filter_radius(&self) -> f32 {
        if self.penumbrae {
            MAX_RADIUS + 4.0
        } else {
            6.0
        }
    }
}

/// Largest number of cascades.
pub const MAX_CASCADES: usize = 4;
/// Largest texel of a single map, metres; a scene that would need larger ones gets cascades.
const MAX_SINGLE_MAP_TEXEL: f32 = 0.08;
/// Extent of a scene above which there are four cascades instead of three, metres.
const FOUR_CASCADES_EXTENT: f32 = 1000.0;
/// Distance from the eye to the side of the nearest cascade's cube, metres.
const NEAREST_REACH: f32 = 20.0;
/// Largest ratio of a cascade's texel to the next one's for which the cascade is worth drawing.
const MAX_TEXEL_RATIO: f32 = 0.75;
/// Fraction of a cube's half-width beyond which its cascade is blended into the next.
pub(in crate::passes) const BLEND: f32 = 0.85;
/// Largest penumbra radius, texels: with taps farther apart, thin casters would be missed.
pub(in crate::passes) const MAX_RADIUS: f32 = 48.0;
/// Nothing within this distance from a wall that stands upright on a receiver shadows it, texels: such a wall may be lit itself.
pub(in crate::passes) const PLANE_OFFSET_TEXELS: f32 = 1.0;

gpu_struct! {
    /// The cascades, for `include/sun_shadow.glsl`.
    pub struct CascadesBlock: cascades of LIGHTING_FRAG {
        from_world: [[[f32; 4]; 4]; 4],
        sizes: [[f32; 4]; 4],
        tan_radius: f32,
    }
}

/// Number of cascades, `resolution` texels on a side, for a scene within `bounds`. An image may be `most_texels` wide.
pub fn count(bounds: &Bounds, resolution: u32, most_texels: u32) -> u32 {
    let extent = bounds.extent().max_element();
    let wanted = match extent {
        _ if extent.is_nan() || extent <= MAX_SINGLE_MAP_TEXEL * resolution as f32 => 1,
        _ if extent <= FOUR_CASCADES_EXTENT => 3,
        _ => MAX_CASCADES as u32,
    };
    // The cascades lie side by side in one image.
    if wanted * resolution <= most_texels {
        wanted
    } else {
        1
    }
}

/// Fitted cascades, the finest first.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SunViews {
    views: [ShadowView; MAX_CASCADES],
    /// Distance from the eye to the sides of the cube that each covers, metres.
    reach: [f32; MAX_CASCADES],
    count: usize,
}

impl SunViews {
    /// A single map.
    pub fn one(view: ShadowView) -> Self {
        Self {
            views: [view; MAX_CASCADES],
            reach: [f32::INFINITY; MAX_CASCADES],
            count: 1,
        }
    }

    /// Fits up to `count` cascades of `resolution` texels on a side; see [`fit::fit`]. A cascade that would hardly be finer than the
    /// next is omitted: in a narrow or distant view, one map resolves as much as several.
    pub fn fit(
        sun_direction: Vec3,
        bounds: &Bounds,
        casters: &Bounds,
        view: &View,
        resolution: u32,
        count: u32,
    ) -> Self {
        let of = |part: &Bounds| fit::fit(sun_direction, part, casters, view, resolution);
        let whole = of(bounds);
        let mut fitted = Self::one(whole);
        fitted.count = (count as usize).clamp(1, MAX_CASCADES);
        let reaches = reaches(bounds, view.camera.eye, fitted.count);
        let (mut coarser, mut maps) = (whole, ArrayVec::<_, MAX_CASCADES>::new());
        for reach in reaches.into_iter().take(fitted.count - 1).rev() {
            let around = Bounds {
                min: bounds.min.max(view.camera.eye - reach),
                max: bounds.max.min(view.camera.eye + reach),
            };
            // Empty if no part of the scene is that near.
            let map = (!around.is_empty()).then(|| of(&around));
            if let Some(map) = map.filter(|map| map.texel <= MAX_TEXEL_RATIO * coarser.texel) {
                coarser = map;
                maps.push((map, reach));
            }
        }
        // The remaining cascades stay copies of the whole map; no point uses them.
        for (k, (map, reach)) in maps.into_iter().rev().enumerate() {
            fitted.views[k] = map;
            fitted.reach[k] = reach;
        }
        fitted
    }

    /// Indices of the cascades in which receivers in a box are looked up while the eye is within `slack` metres of `eye`.
    pub(in crate::passes) fn looked_up(
        &self,
        receivers: &Bounds,
        eye: Vec3,
        slack: f32,
    ) -> impl Iterator<Item = usize> + use<> {
        let &Bounds { min, max } = receivers;
        let farthest = (max - eye).abs().max((eye - min).abs()).max_element() + slack;
        let nearest = (min - eye).max(eye - max).max_element() - slack;
        // A cascade begins where the previous one blends into it. The whole map has infinite reach, so none begins after it.
        let reach = self.reach;
        let mut finer = 0.0;
        (0..MAX_CASCADES).filter(move |&k| {
            let is_in = farthest >= finer && nearest <= reach[k];
            finer = BLEND * reach[k];
            is_in
        })
    }

    /// The cascades, the finest first.
    pub fn iter(&self) -> impl Iterator<Item = &ShadowView> {
        self.views.iter().take(self.count)
    }

    /// The only map, or the finest cascade.
    pub fn first(&self) -> &ShadowView {
        &self.views[0]
    }

    /// Whether both have the same maps.
    pub(in crate::passes) fn are_those_of(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }

    /// Edge of a texel of cascade `k`, metres.
    pub(in crate::passes) fn texel(&self, k: usize) -> f32 {
        self.views[k].texel
    }

    /// The uniform block for the shader.
    pub fn block(&self) -> CascadesBlock {
        let size = |view: &ShadowView, reach: f32| {
            let metres_of_depth = view.texel / view.texel_depth;
            [reach, view.texel, metres_of_depth, 0.0]
        };
        CascadesBlock {
            from_world: self.views.map(|v| v.shadow_from_world.to_cols_array_2d()),
            sizes: std::array::from_fn(|k| size(&self.views[k], self.reach[k])),
            tan_radius: SUN_ANGULAR_RADIUS.tan() as f32,
        }
    }
}

/// Distances from the eye to the sides of the cubes, metres, in equal ratios up to the cube that contains the scene.
fn reaches(bounds: &Bounds, eye: Vec3, count: usize) -> [f32; MAX_CASCADES] {
    let beside = (bounds.min - eye).max(eye - bounds.max).max(Vec3::ZERO);
    let nearest = beside.max_element() + NEAREST_REACH;
    let farthest = (bounds.max - eye).abs().max((eye - bounds.min).abs());
    // Rounded up to a power of two, so that it seldom changes as the camera moves.
    let farthest = farthest.max_element().max(nearest).log2().ceil().exp2();
    let steps = (count - 1).max(1) as f32;
    std::array::from_fn(|k| nearest * (farthest / nearest).powf(k as f32 / steps))
}

#[cfg(test)]
mod tests {
    use glam::{UVec2, Vec2};

    use super::*;
    use crate::scene::Camera;

    fn square(half: f32) -> Bounds {
        Bounds {
            min: Vec3::new(-half, 0.0, -half),
            max: Vec3::new(half, 10.0, half),
        }
    }

    fn view(eye: Vec3) -> View {
        View {
            camera: Camera {
                eye,
                target: eye + Vec3::new(1.0, -0.1, -2.0),
                fov_deg: 45.0,
                near: 0.05,
            },
            size: UVec2::new(1280, 720),
            jitter: Vec2::ZERO,
            sharpen: 0.0,
            window: None,
        }
    }

    #[test]
    fn large_scenes_have_more_cascades() {
        let of = |half, most| count(&square(half), 2048, most);
        assert_eq!([of(20.0, 16_384), of(80.0, 16_384)], [1, 1]);
        assert_eq!([of(200.0, 16_384), of(2000.0, 16_384)], [3, 4]);
        assert_eq!(of(2000.0, 4096), 1, "no image is wide enough");
    }

    #[test]
    fn near_cascades_are_finer_and_the_last_is_the_whole() {
        let (sun, bounds) = (Vec3::new(0.5, 0.7, 0.2).normalize(), square(1000.0));
        let view = view(Vec3::new(10.0, 1.7, 0.0));
        let views = SunViews::fit(sun, &bounds, &bounds, &view, 2048, 4);
        let texels: Vec<f32> = views.iter().map(|v| v.texel).collect();
        assert!(texels.is_sorted() && texels[0] < 0.05, "{texels:?}");
        assert!(texels.windows(2).all(|t| t[1] / t[0] < 8.0), "{texels:?}");
        let whole = fit::fit(sun, &bounds, &bounds, &view, 2048);
        assert_eq!(views.iter().last(), Some(&whole));
        assert!(views.reach.is_sorted());
    }

    #[test]
    fn cascades_that_are_hardly_finer_than_the_next_are_left_out() {
        let (sun, bounds) = (Vec3::new(0.5, 0.7, 0.2).normalize(), square(200.0));
        // Seen from far away, everything in view is at about the same distance.
        let mut view = view(Vec3::new(300.0, 300.0, 400.0));
        view.camera.target = Vec3::ZERO;
        view.camera.fov_deg = 5.0;
        let views = SunViews::fit(sun, &bounds, &bounds, &view, 2048, 3);
        let mut used = views.reach.iter().take(3).filter(|r| r.is_finite());
        assert!(used.all(|r| *r > 0.0) && views.reach.is_sorted());
        let kept: Vec<f32> = views.iter().map(|v| v.texel).collect();
        assert!(kept.windows(2).all(|t| t[0] < 0.8 * t[1] || t[0] == t[1]));
        let finer = kept
            .windows(2)
            .filter(|t| t[0] <= MAX_TEXEL_RATIO * t[1])
            .count();
        assert_eq!(finer, views.reach.iter().filter(|r| r.is_finite()).count());
        // Cascades after the whole map are never looked up.
        let used = views.looked_up(&bounds, view.camera.eye, 0.0).count();
        assert_eq!(used, finer + 1, "{kept:?}");
    }

    #[test]
    fn every_point_in_a_cube_that_is_seen_lies_in_its_map() {
        let (sun, bounds) = (Vec3::new(0.5, 0.4, 0.2).normalize(), square(1000.0));
        let view = view(Vec3::new(10.0, 1.7, 0.0));
        let views = SunViews::fit(sun, &bounds, &bounds, &view, 2048, 4);
        for (k, map) in views.iter().enumerate() {
            let reach = views.reach[k].min(900.0);
            for pixel in [[2.0, 700.0], [640.0, 500.0], [1270.0, 380.0]] {
                for share in [0.1, 0.5, 0.99] {
                    let ray = view.point(pixel.into(), 1.0) - view.camera.eye;
                    let p = view.camera.eye + ray / ray.abs().max_element() * (reach * share);
                    let at = map.shadow_from_world.project_point3(p);
                    let seen = p.y >= bounds.min.y && p.y <= bounds.max.y;
                    let inside = at.truncate().abs().max_element() <= 1.0;
                    assert!(inside || !seen, "cascade {k}: {p} at {at}");
                }
            }
        }
    }

    #[test]
    fn cascades_stay_while_the_camera_takes_a_step() {
        let (sun, bounds) = (Vec3::new(0.5, 0.7, 0.2).normalize(), square(1000.0));
        let fit = |x: f32| {
            let view = view(Vec3::new(x, 1.7, 0.0));
            SunViews::fit(sun, &bounds, &bounds, &view, 2048, 4)
        };
        let mut changes = 0;
        for step in 0..100 {
            let [before, after] = [0.0, 0.02].map(|d| fit(0.02 * step as f32 + d));
            changes += usize::from(before.views[0] != after.views[0]);
            // A map moves by whole texels only, so that shadow edges stay in place.
            let texel = after.views[0].texel;
            if before.views[0].texel == texel {
                let origin = |v: &SunViews| {
                    v.views[0]
                        .shadow_from_world
                        .project_point3(Vec3::ZERO)
                        .truncate()
                        * 1024.0
                };
                let moved = origin(&before) - origin(&after);
                assert!(
                    (moved - moved.round()).abs().max_element() < 0.05,
                    "{moved}"
                );
            }
        }
        assert!(
            changes <= 6,
            "the nearest map changed {changes} times in two metres"
        );
    }
}
