//! Shared by the GPU tests: a validated device, frames, read-back, and the small scenes of `model`.
#![allow(dead_code)]

use std::sync::Arc;

use glam::{DVec3, UVec2};
use skylight::daylight::cube;
use skylight::daylight::sky::Daylight;
use skylight::daylight::tone_curve::ToneCurve;
use skylight::frame::{Frame, FrameSettings};
use skylight::gpu::{Context, ContextOptions, Image, Recorder, Timing, read_back};
use skylight::passes::bounces::cells::Bounces;
use skylight::passes::light::lighting::{Ambient, Precision, Show};
use skylight::passes::occlusion::ssao::SsaoSettings;
use skylight::passes::picture::tone_map::Scale;
use skylight::scene::{Camera, Scene};

#[path = "model.rs"]
mod model;

pub use model::{
    Model, clear_day, closed_box, constant_sky, glass, glowing, hemispherical_transmittance, matt,
    polygon_irradiance,
};

/// Relative step of 16-bit floats. Vulkan lets a device round to either neighbour (lavapipe truncates), so the error of a
/// stored value is a whole step, not half of one.
pub const HALF_ROUNDOFF: f64 = 1.0 / 1024.0;

/// A device under the validation layer with synchronization validation.
///
/// A missing device or layer is a failure. Dropping it panics if the layer has reported anything.
pub struct Device {
    pub context: Arc<Context>,
    pub recorder: Recorder,
}

impl Device {
    /// The best device, or the one named by SKYLIGHT_TEST_DEVICE.
    pub fn new() -> Self {
        Self::with(&ContextOptions::default())
    }

    /// A device with these options; validation is always on.
    pub fn with(options: &ContextOptions) -> Self {
        let context = Context::new(&ContextOptions {
            device: std::env::var("SKYLIGHT_TEST_DEVICE").ok(),
            validate: true,
            ..options.clone()
        })
        .unwrap_or_else(|e| panic!("{e}"));
        let recorder = Recorder::new(&context, Timing::Off).expect("a recorder");
        Self { context, recorder }
    }

    /// Records commands, submits them and waits.
    pub fn run<T>(&mut self, record: impl FnOnce(&mut Recorder) -> T) -> T {
        self.recorder.begin().expect("begun");
        let result = record(&mut self.recorder);
        self.recorder.finish().expect("finished");
        result
    }

    /// All texels of an image, layer by layer.
    pub fn read(&mut self, image: &Image) -> Vec<[f32; 4]> {
        read_back(&mut self.recorder, image)
            .expect("read back")
            .rgba()
    }

    /// Reads back the six faces of a cube map, RGB.
    pub fn read_cube(&mut self, image: &Image) -> Cube {
        let texels = self.read(image).into_iter();
        Cube {
            edge: image.size()[0] as usize,
            texels: texels.map(|t| DVec3::from_array(rgb(t))).collect(),
        }
    }

    /// Draws a scene until its irradiance is refined and all samples are accumulated.
    pub fn frame(
        &mut self,
        scene: &Scene,
        settings: FrameSettings,
        daylight: &Daylight,
        camera: &Camera,
    ) -> Frame {
        let mut frame = self.run(|rec| Frame::new(rec, scene, settings).expect("a frame"));
        self.draw(&mut frame, daylight, camera);
        frame
    }

    /// Draws a view with an existing frame.
    pub fn draw(&mut self, frame: &mut Frame, daylight: &Daylight, camera: &Camera) {
        let refined = (0..1000).any(|_| {
            self.run(|rec| frame.record_light(rec, daylight));
            frame.is_refined()
        });
        assert!(refined, "the light is not refined after 1000 passes");
        for index in 0..frame.settings().samples {
            self.run(|rec| frame.record(rec, daylight, camera, index));
        }
    }

    /// Draws a scene and reads back the shown quantity, in the device's units.
    pub fn picture(
        &mut self,
        scene: &Scene,
        settings: FrameSettings,
        daylight: &Daylight,
        camera: &Camera,
    ) -> Picture {
        let frame = self.frame(scene, settings, daylight, camera);
        self.picture_of(&frame)
    }

    /// Reads back the shown quantity of a drawn frame.
    pub fn picture_of(&mut self, frame: &Frame) -> Picture {
        let size = frame.settings().size.to_array().map(|edge| edge as usize);
        let texels = self.read(frame.radiance());
        Picture { size, texels }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        if std::thread::panicking() {
            return;
        }
        self.context
            .check_validation()
            .unwrap_or_else(|e| panic!("{e}"));
    }
}

/// The first three channels, in f64.
pub fn rgb(texel: [f32; 4]) -> [f64; 3] {
    [0, 1, 2].map(|i| f64::from(texel[i]))
}

/// Texels of a flat image, rows from the top.
pub struct Picture {
    pub size: [usize; 2],
    pub texels: Vec<[f32; 4]>,
}

impl Picture {
    /// RGB of a pixel.
    pub fn at(&self, x: usize, y: usize) -> DVec3 {
        DVec3::from_array(rgb(self.texels[y * self.size[0] + x]))
    }

    /// Column, row and RGB of every pixel.
    pub fn pixels(&self) -> impl Iterator<Item = ([usize; 2], DVec3)> + '_ {
        let width = self.size[0];
        self.texels
            .iter()
            .enumerate()
            .map(move |(i, t)| ([i % width, i / width], DVec3::from_array(rgb(*t))))
    }
}

/// A cube map read back.
pub struct Cube {
    pub edge: usize,
    pub texels: Vec<DVec3>,
}

impl Cube {
    /// Every texel: its unit direction, its value, and a name for messages.
    pub fn iter(&self) -> impl Iterator<Item = (DVec3, DVec3, String)> + '_ {
        cube::texels(self.edge)
            .zip(&self.texels)
            .map(|((face, i, j), value)| {
                let direction = cube::texel_direction(face, i, j, self.edge);
                (direction, *value, format!("face {face} texel {i} {j}"))
            })
    }

    fn nearest(&self, direction: DVec3) -> DVec3 {
        let (face, s, t) = cube::face_of(direction);
        let index = |x: f64| ((x * self.edge as f64) as usize).min(self.edge - 1);
        self.texels[(face * self.edge + index(t)) * self.edge + index(s)]
    }

    /// Bilinear and seamless: a tap beyond the edge of a face takes the nearest texel of the neighbouring face; at a corner the
    /// missing fourth tap is left out.
    pub fn sample(&self, direction: DVec3) -> DVec3 {
        let n = self.edge as f64;
        let (face, s, t) = cube::face_of(direction);
        let (x, y) = (s * n - 0.5, t * n - 0.5);
        let (mut sum, mut weights) = (DVec3::ZERO, 0.0);
        for (dx, dy) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)] {
            let (i, j) = (x.floor() + dx, y.floor() + dy);
            let outside = |k: f64| k < 0.0 || k >= n;
            if outside(i) && outside(j) {
                continue;
            }
            let weight = (1.0 - (x - i).abs()) * (1.0 - (y - j).abs());
            let at = cube::face_vector(face, (i + 0.5) / n, (j + 0.5) / n);
            sum += self.nearest(at) * weight;
            weights += weight;
        }
        sum / weights
    }
}

/// Settings of a small exact picture: 32-bit floats, one sample, no ambient occlusion.
pub fn settings(width: u32, height: u32) -> FrameSettings {
    let mut set = FrameSettings {
        size: UVec2::new(width, height),
        shadow_resolution: 1024,
        bounces: Bounces::UpTo(0),
        ..FrameSettings::default()
    };
    set.lighting.precision = Precision::Float;
    set.lighting.ambient = Ambient::Ssao;
    set.tone.curve = ToneCurve::Linear;
    set.tone.scale = Scale::Fixed(1e-4);
    set.tone.depth_scale = 10.0;
    set.with_occlusion(SsaoSettings {
        radius: 0.0,
        downscale: 1,
        ..SsaoSettings::default()
    })
}

/// The same settings showing another quantity.
pub fn showing(show: Show, settings: FrameSettings) -> FrameSettings {
    settings.showing(show)
}

/// A camera with a vertical field of view of 45°.
pub fn camera(eye: [f32; 3], target: [f32; 3]) -> Camera {
    Camera {
        eye: eye.into(),
        target: target.into(),
        fov_deg: 45.0,
        near: 0.05,
    }
}

/// Unit ray through the centre of a pixel, in world space.
pub fn pixel_ray(camera: &Camera, size: [usize; 2], pixel: [usize; 2]) -> DVec3 {
    let (width, height) = (size[0] as f64, size[1] as f64);
    let tan = (0.5 * f64::from(camera.fov_deg)).to_radians().tan();
    let forward = (camera.target.as_dvec3() - camera.eye.as_dvec3()).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let x = (2.0 * (pixel[0] as f64 + 0.5) / width - 1.0) * tan * width / height;
    let y = (1.0 - 2.0 * (pixel[1] as f64 + 0.5) / height) * tan;
    (forward + right * x + up * y).normalize()
}

/// Intersection of a pixel's ray with the plane y = 0; `None` if the ray does not point down.
pub fn on_ground(camera: &Camera, size: [usize; 2], pixel: [usize; 2]) -> Option<DVec3> {
    let (eye, ray) = (camera.eye.as_dvec3(), pixel_ray(camera, size, pixel));
    (ray.y < 0.0).then(|| eye + ray * (-eye.y / ray.y))
}
