//! A camera with its picture: its matrices, and the uniform block of the screen-space shaders.

use glam::{DMat3, DVec2, DVec4, Mat3, Mat4, UVec2, Vec2, Vec3, Vec4};

use crate::gpu_struct;
use crate::scene::Camera;

gpu_struct! {
    /// `VIEW_BLOCK` of `include/view.glsl`.
    pub struct ViewBlock: view of
        SSAO_FRAG, SSAO_COMP, LIGHTING_FRAG, LIGHTING_COMP, LIGHTING_COMP_FLOAT, BACKGROUND_FRAG, BACKGROUND_COMP, BACKGROUND_COMP_FLOAT, DOME_GATHER_FRAG, DOME_SPECULAR_FRAG, CELLS_SEED_COMP, BOUNCES_GATHER_COMP,
        DOME_GATHER_COMP, DOME_SPECULAR_COMP, CELLS_AMBIENT_FRAG, CELLS_AMBIENT_COMP
    {
        world_from_view: Mat3,
        eye: Vec3,
        ray_scale: Vec2,
        ray_offset: Vec2,
        near: f32,
    }
}

/// A camera with the size of its picture and its sub-pixel jitter.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: Camera,
    /// Width and height, pixels.
    pub size: UVec2,
    /// Offset of the sample in the pixel, in pixels, −0.5..0.5; zero is the pixel's centre.
    pub jitter: Vec2,
    /// Mip bias toward finer levels: the mean of many samples filters better than mip maps.
    pub sharpen: f32,
    /// The part of a larger picture that this view covers; `None`: the whole.
    pub window: Option<Window>,
}

/// A part of a larger picture, in pixels of the part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window {
    /// Its upper left corner in the picture.
    pub origin: UVec2,
    /// Width and height of the whole picture; may be fractional if the part is coarser than the picture.
    pub picture: Vec2,
}

/// Where the surfaces of a picture were in the one before it, without the jitter of either.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reprojection {
    /// Product with (pixel, reversed depth, 1): u of the picture before, 0..1, times w.
    pub to_u: Vec4,
    /// The same for v.
    pub to_v: Vec4,
    /// The same for w, the distance from the eye before over that from the eye now.
    pub to_w: Vec4,
    /// Product with reversed depth: that of the picture before, times w.
    pub to_depth: f32,
    /// Largest motion between the pictures of two surfaces whose reversed depth in the picture before differs by 1, pixels.
    pub parallax: f32,
}

impl View {
    /// The view of the whole picture that this view is part of.
    pub fn whole(&self) -> Self {
        let picture = self.window.map(|window| window.picture.ceil().as_uvec2());
        Self {
            size: picture.unwrap_or(self.size),
            window: None,
            ..*self
        }
    }

    /// The same view, moved back along the view axis by `metres`.
    pub fn from_behind(&self, metres: f32) -> Self {
        let mut view = *self;
        view.camera.eye -= view.camera.forward() * metres;
        view
    }

    /// Width over height of the whole picture.
    pub fn aspect(&self) -> f32 {
        let picture = self.window.map_or(self.size.as_vec2(), |w| w.picture);
        picture.x / picture.y
    }

    /// Scale and shift from x and y of the whole picture's clip space to the part's.
    fn part(&self) -> (Vec2, Vec2) {
        let Some(window) = self.window else {
            return (Vec2::ONE, Vec2::ZERO);
        };
        let size = self.size.as_dvec2();
        let scale = window.picture.as_dvec2() / size;
        let shift = scale - 1.0 - 2.0 * window.origin.as_dvec2() / size;
        (scale.as_vec2(), shift.as_vec2())
    }

    /// World to Vulkan clip space, jittered.
    pub fn clip_from_world(&self) -> Mat4 {
        let (scale, shift) = self.part();
        let part = Mat4::from_translation(shift.extend(0.0)) * Mat4::from_scale(scale.extend(1.0));
        self.jitter_matrix()
            * part
            * self.camera.clip_from_view(self.aspect())
            * self.camera.view_from_world()
    }

    /// Shifts the picture by −jitter, which moves the sample to the pixel's centre.
    fn jitter_matrix(&self) -> Mat4 {
        let shift = -2.0 * self.jitter / self.size.as_vec2();
        Mat4::from_translation(shift.extend(0.0))
    }

    /// The world position at `pixel` (pixels from the upper left corner), `distance` metres along the view axis.
    pub fn point(&self, pixel: Vec2, distance: f32) -> Vec3 {
        let block = self.block();
        let ndc = 2.0 * pixel / self.size.as_vec2() - 1.0;
        let ray = (ndc * block.ray_scale + block.ray_offset).extend(-1.0);
        block.eye + block.world_from_view * ray * distance
    }

    /// Half the extent of the picture at distance 1. In Vulkan, rows run down; the camera's y axis points up.
    fn half_extent(&self) -> DVec2 {
        let tan_y = (0.5 * f64::from(self.camera.fov_deg).to_radians()).tan();
        DVec2::new(tan_y * f64::from(self.aspect()), -tan_y)
    }

    /// Where what this view sees was in the picture of the view `before`. Both are views of whole pictures.
    pub fn reprojection(&self, before: &Self) -> Reprojection {
        let (size, half) = (self.size.as_dvec2(), self.half_extent());
        let half_before = before.half_extent();
        let axes = |view: &Self| DMat3::from_mat4(view.camera.world_from_view().as_dmat4());
        let from_world = axes(before).transpose();
        let turn = from_world * axes(self);
        let step = (self.camera.eye - before.camera.eye).as_dvec3();
        // The position seen from the eye before, over the distance now, is linear in pixel and reversed depth.
        let per_pixel = [turn.x_axis * half.x, turn.y_axis * half.y];
        let columns = [
            per_pixel[0] * 2.0 / size.x,
            per_pixel[1] * 2.0 / size.y,
            from_world * step / f64::from(self.camera.near),
            -per_pixel[0] - per_pixel[1] - turn.z_axis,
        ];
        let row = |axis: usize| DVec4::from_array(columns.map(|column| column[axis]));
        let w = -row(2);
        let pixels_per_tan = 0.5 * f64::from(before.size.y) / -half_before.y;
        Reprojection {
            to_u: (0.5 * (row(0) / half_before.x + w)).as_vec4(),
            to_v: (0.5 * (row(1) / half_before.y + w)).as_vec4(),
            to_w: w.as_vec4(),
            to_depth: before.camera.near / self.camera.near,
            parallax: (step.length() * pixels_per_tan / f64::from(before.camera.near)) as f32,
        }
    }

    /// The uniform block from which shaders reconstruct positions and rays.
    pub fn block(&self) -> ViewBlock {
        let tan_y = (0.5 * self.camera.fov_deg.to_radians()).tan();
        // In Vulkan, rows run down; the camera's y axis points up.
        let (scale, shift) = self.part();
        let ray_scale = Vec2::new(tan_y * self.aspect(), -tan_y) / scale;
        ViewBlock {
            world_from_view: Mat3::from_mat4(self.camera.world_from_view()),
            eye: self.camera.eye,
            ray_scale,
            ray_offset: (2.0 * self.jitter / self.size.as_vec2() - shift) * ray_scale,
            near: self.camera.near,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(jitter: Vec2) -> View {
        let camera = Camera {
            eye: Vec3::new(3.0, 2.0, 7.0),
            target: Vec3::new(-1.0, 0.5, 0.0),
            fov_deg: 50.0,
            near: 0.01,
        };
        View {
            camera,
            size: UVec2::new(640, 360),
            jitter,
            sharpen: 0.0,
            window: None,
        }
    }

    #[test]
    fn parts_see_what_the_whole_sees() {
        let whole = view(Vec2::new(0.25, -0.5));
        let part = View {
            size: UVec2::new(96, 40),
            window: Some(Window {
                origin: UVec2::new(288, 200),
                picture: whole.size.as_vec2(),
            }),
            ..whole
        };
        assert_eq!(part.whole(), whole);
        assert_eq!(part.aspect(), whole.aspect());
        for point in [Vec3::new(-2.0, 1.2, -1.5), Vec3::new(0.5, 0.0, 2.0)] {
            let pixel = |view: &View| {
                let clip = view.clip_from_world() * point.extend(1.0);
                let ndc = clip.truncate() / clip.w;
                ((ndc.truncate() + 1.0) * 0.5 * view.size.as_vec2(), ndc.z)
            };
            let ((a, z), (b, part_z)) = (pixel(&whole), pixel(&part));
            assert!((a - Vec2::new(288.0, 200.0) - b).length() < 1e-3, "{a} {b}");
            assert_eq!(z, part_z);
            let back = part.point(b, part.camera.near / z);
            assert!((back - point).length() < 1e-3, "{back}");
        }
    }

    #[test]
    fn surfaces_are_found_where_they_were() {
        let now = view(Vec2::new(0.25, -0.5));
        let mut before = view(Vec2::new(-0.3, 0.1));
        before.camera.eye += Vec3::new(0.3, 0.05, -0.2);
        before.camera.fov_deg = 55.0;
        before.camera.near = 0.02;
        let seen = |view: &View, point: Vec3| {
            let steady = View {
                jitter: Vec2::ZERO,
                ..*view
            };
            let clip = steady.clip_from_world() * point.extend(1.0);
            let ndc = clip.truncate() / clip.w;
            ((ndc.truncate() + 1.0) * 0.5, ndc.z)
        };
        let motion = now.reprojection(&before);
        for point in [
            Vec3::new(-2.0, 1.2, -1.5),
            Vec3::new(0.5, 0.0, 2.0),
            Vec3::new(-40.0, 8.0, -60.0),
        ] {
            let ((uv, depth), (uv_before, depth_before)) =
                (seen(&now, point), seen(&before, point));
            let pixel = uv * now.size.as_vec2();
            let here = Vec4::new(pixel.x, pixel.y, depth, 1.0);
            let w = motion.to_w.dot(here);
            let found = Vec2::new(motion.to_u.dot(here), motion.to_v.dot(here)) / w;
            assert!((found - uv_before).length() < 1e-5, "{found} {uv_before}");
            let error = motion.to_depth * depth / w / depth_before - 1.0;
            assert!(error.abs() < 1e-5, "{error}");
        }
        // The background moves by the turn of the camera alone.
        let far = Vec4::new(100.0, 50.0, 0.0, 1.0);
        let still = now.reprojection(&now);
        let uv = Vec2::new(still.to_u.dot(far), still.to_v.dot(far)) / still.to_w.dot(far);
        assert!(
            (uv * now.size.as_vec2() - far.truncate().truncate()).length() < 1e-3,
            "{uv}"
        );
        assert_eq!((still.parallax, still.to_depth), (0.0, 1.0));
    }

    #[test]
    fn parallax_is_the_most_that_two_surfaces_move_apart() {
        let now = view(Vec2::ZERO);
        let mut before = now;
        // A step aside moves surfaces by exactly as much, one forward by less.
        let aside = now.camera.world_from_view().x_axis.truncate();
        before.camera.eye -= aside * 0.1;
        let motion = now.reprojection(&before);
        let at = |depth: f32| {
            let here = Vec4::new(320.0, 180.0, depth, 1.0);
            motion.to_u.dot(here) / motion.to_w.dot(here) * 640.0
        };
        let (near, far) = (now.camera.near / 4.0, now.camera.near / 9.0);
        let apart = (at(near) - at(far)).abs();
        let expected = motion.parallax * (near - far);
        assert!((apart / expected - 1.0).abs() < 1e-3, "{apart} {expected}");
    }

    #[test]
    fn rays_undo_the_projection() {
        for jitter in [Vec2::ZERO, Vec2::new(0.4, -0.3)] {
            let view = view(jitter);
            let point = Vec3::new(-2.0, 1.2, -1.5);
            let clip = view.clip_from_world() * point.extend(1.0);
            let ndc = clip.truncate() / clip.w;
            let pixel = (ndc.truncate() + 1.0) * 0.5 * view.size.as_vec2();
            let back = view.point(pixel, view.camera.near / ndc.z);
            assert!((back - point).length() < 1e-3, "{jitter}: {back}");
        }
    }
}
