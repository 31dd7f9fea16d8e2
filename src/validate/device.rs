//! A device with what it gives back: images, cubes, small exact pictures.

use std::sync::Arc;

use glam::{DVec3, UVec2};

use crate::daylight::cube;
use crate::daylight::sky::Daylight;
use crate::daylight::tone_curve::ToneCurve;
use crate::frame::{Frame, FrameSettings};
use crate::gpu::{Context, Image, Recorder, Result, Timing, read_back};
use crate::passes::bounces::cells::Bounces;
use crate::passes::light::lighting::{Ambient, Precision};
use crate::passes::occlusion::ssao::SsaoSettings;
use crate::passes::picture::tone_map::Scale;
use crate::scene::{Camera, Scene};

/// Changes the texels of an image of this name after it is read back, as a faulty device would.
pub type Tamper = Box<dyn FnMut(&str, &mut [[f32; 4]])>;

/// A device and a recorder of its commands.
pub struct Device {
    /// The device.
    pub context: Arc<Context>,
    /// The recorder; not recording.
    pub recorder: Recorder,
    /// For tests of the checks: what goes wrong on the way back. None of the program's options sets it.
    #[doc(hidden)]
    pub tamper: Option<Tamper>,
}

impl Device {
    /// A device that is open.
    ///
    /// # Errors
    /// The device has no memory left.
    pub fn new(context: &Arc<Context>) -> Result<Self> {
        Ok(Self {
            context: context.clone(),
            recorder: Recorder::new(context, Timing::Off)?,
            tamper: None,
        })
    }

    /// Records commands, submits them and waits.
    ///
    /// # Errors
    /// The device fails.
    pub fn run<T>(&mut self, record: impl FnOnce(&mut Recorder) -> T) -> Result<T> {
        self.recorder.begin()?;
        let result = record(&mut self.recorder);
        self.recorder.finish()?;
        Ok(result)
    }

    /// All texels of an image, layer by layer.
    ///
    /// # Errors
    /// The device fails.
    pub fn read(&mut self, image: &Image) -> Result<Vec<[f32; 4]>> {
        let mut texels = read_back(&mut self.recorder, image)?.rgba();
        if let Some(tamper) = &mut self.tamper {
            tamper(image.name(), &mut texels);
        }
        Ok(texels)
    }

    /// The six faces of a cube map, RGB.
    ///
    /// # Errors
    /// The device fails.
    pub fn read_cube(&mut self, image: &Image) -> Result<Cube> {
        let texels = self.read(image)?.into_iter();
        Ok(Cube {
            edge: image.size()[0] as usize,
            texels: texels.map(rgb).collect(),
        })
    }

    /// Draws a scene until its irradiance is refined and all samples are accumulated.
    ///
    /// # Errors
    /// The device fails.
    pub fn frame(
        &mut self,
        scene: &Scene,
        settings: FrameSettings,
        daylight: &Daylight,
        camera: &Camera,
    ) -> Result<Frame> {
        let mut frame = self.run(|rec| Frame::new(rec, scene, settings))??;
        self.draw(&mut frame, daylight, camera)?;
        Ok(frame)
    }

    /// Draws a view with an existing frame.
    ///
    /// # Errors
    /// The device fails.
    pub fn draw(&mut self, frame: &mut Frame, daylight: &Daylight, camera: &Camera) -> Result<()> {
        self.run(|rec| frame.record_light(rec, daylight))?;
        while !frame.is_refined() {
            self.run(|rec| frame.record_light(rec, daylight))?;
        }
        for index in 0..frame.settings().samples {
            self.run(|rec| frame.record(rec, daylight, camera, index))?;
        }
        Ok(())
    }

    /// Draws a scene and reads back the shown quantity, in the device's units.
    ///
    /// # Errors
    /// The device fails.
    pub fn picture(
        &mut self,
        scene: &Scene,
        settings: FrameSettings,
        daylight: &Daylight,
        camera: &Camera,
    ) -> Result<Picture> {
        let frame = self.frame(scene, settings, daylight, camera)?;
        self.picture_of(&frame)
    }

    /// Reads back the shown quantity of a drawn frame.
    ///
    /// # Errors
    /// The device fails.
    pub fn picture_of(&mut self, frame: &Frame) -> Result<Picture> {
        let size = frame.settings().size.to_array().map(|edge| edge as usize);
        let texels = self.read(frame.radiance())?;
        Ok(Picture { size, texels })
    }
}

/// The first three channels.
pub fn rgb(texel: [f32; 4]) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|i| f64::from(texel[i])))
}

/// Texels of a flat image, rows from the top.
pub struct Picture {
    /// Columns and rows.
    pub size: [usize; 2],
    /// The texels.
    pub texels: Vec<[f32; 4]>,
}

impl Picture {
    /// RGB of a pixel.
    pub fn at(&self, x: usize, y: usize) -> DVec3 {
        rgb(self.texels[y * self.size[0] + x])
    }

    /// Column, row and RGB of every pixel.
    pub fn pixels(&self) -> impl Iterator<Item = ([usize; 2], DVec3)> + '_ {
        let width = self.size[0];
        let texels = self.texels.iter().enumerate();
        texels.map(move |(i, t)| ([i % width, i / width], rgb(*t)))
    }
}

/// A cube map read back.
pub struct Cube {
    /// Texels along an edge of a face.
    pub edge: usize,
    /// The texels, face by face.
    pub texels: Vec<DVec3>,
}

impl Cube {
    /// Every texel: its unit direction, its value, and its face, column and row.
    pub fn texels(&self) -> impl Iterator<Item = (DVec3, DVec3, [usize; 3])> + '_ {
        cube::texels(self.edge)
            .zip(&self.texels)
            .map(|((face, i, j), value)| {
                let direction = cube::texel_direction(face, i, j, self.edge);
                (direction, *value, [face, i, j])
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

/// Settings of a single frame that has all its light but the sun's from the cells.
pub fn from_cells(width: u32, height: u32) -> FrameSettings {
    let mut set = settings(width, height);
    set.bounces = Bounces::All;
    // All cells in every frame.
    set.refine = 1 << 16;
    set.lighting.ambient = Ambient::Cells;
    set
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
