//! A camera with its picture: its matrices, and the uniform block of the screen-space shaders.

use glam::{Mat3, Mat4, UVec2, Vec2, Vec3};

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
