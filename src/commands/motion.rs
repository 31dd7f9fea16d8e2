//! Camera and sun motion during benchmarks.

use std::borrow::Cow;

use glam::Quat;

use super::job::Job;
use super::light::conditions;
use crate::cli::Motion;
use crate::daylight::sky::Daylight;
use crate::scene::Camera;

/// Camera rotation about its target per frame, radians: the speed of a slow walk.
const CAMERA_STEP: f32 = 0.002;
/// Number of frames after which the rotation reverses, so that the camera stays near the requested view.
const CAMERA_SWING: u32 = 64;
/// Change of the sun's azimuth per frame, degrees: about one minute of time.
const SUN_STEP_DEG: f64 = 0.25;

impl Motion {
    /// The camera at frame `index`.
    pub fn camera(self, camera: &Camera, index: u32) -> Camera {
        if self == Self::None {
            return *camera;
        }
        // Back and forth: 0 1 2 .. 63 64 63 .. 1 0.
        let phase = index % (2 * CAMERA_SWING);
        let step = phase.min(2 * CAMERA_SWING - phase);
        let turn = Quat::from_rotation_y(CAMERA_STEP * step as f32);
        Camera {
            eye: camera.target + turn * (camera.eye - camera.target),
            ..*camera
        }
    }

    /// The daylight at frame `index`.
    pub fn daylight(self, job: &Job, index: u32) -> Cow<'_, Daylight> {
        if self != Self::Sun {
            return Cow::Borrowed(&job.daylight);
        }
        let mut sun = job.sun;
        sun.azimuth_deg += SUN_STEP_DEG * f64::from(index);
        Cow::Owned(Daylight::new(&conditions(&job.settings, &sun)))
    }

    /// Row name of the whole frame in reports.
    pub fn frame_name(self) -> &'static str {
        match self {
            Self::None => "whole frame, nothing moves",
            Self::Camera => "whole frame, camera moves",
            Self::Sun => "whole frame, sun and camera",
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn the_camera_moves_every_frame_and_comes_back() {
        let camera = Camera {
            eye: Vec3::new(4.0, 2.0, 9.0),
            target: Vec3::new(0.0, 1.0, 0.0),
            fov_deg: 50.0,
            near: 0.01,
        };
        for i in 0..3 * CAMERA_SWING {
            let [a, b] = [i, i + 1].map(|i| Motion::Camera.camera(&camera, i));
            assert!((a.eye - b.eye).length() > 0.01, "frame {i}");
            assert!((a.eye - camera.eye).length() < 1.5, "frame {i}");
            assert_eq!(Motion::None.camera(&camera, i), camera);
        }
    }
}
