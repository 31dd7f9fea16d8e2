//! Shared by the GPU tests: a validated device, frames, read-back, and the small scenes of `validate::model`.
#![allow(dead_code)]

use std::ops::{Deref, DerefMut};

use glam::DVec3;
use skylight::daylight::sky::Daylight;
use skylight::frame::{Frame, FrameSettings};
use skylight::gpu::{Context, ContextOptions, Image, Recorder, Route};
use skylight::passes::light::lighting::Show;
use skylight::scene::{Camera, Scene};
use skylight::validate::check::Check;
use skylight::validate::device;

pub use skylight::validate::device::{Cube, Picture, camera, on_ground, pixel_ray, settings};
pub use skylight::validate::model::{
    Model, clear_day, closed_box, constant_sky, glass, glowing, hemispherical_transmittance, matt,
    polygon_irradiance,
};

/// Relative step of 16-bit floats. Vulkan lets a device round to either neighbour (lavapipe truncates), so the error of a
/// stored value is a whole step, not half of one.
pub const HALF_ROUNDOFF: f64 = 1.0 / 1024.0;

/// A device under the validation layer with synchronization validation.
///
/// A missing device or layer is a failure. Dropping it panics if the layer has reported anything.
pub struct Device(device::Device);

impl Deref for Device {
    type Target = device::Device;

    fn deref(&self) -> &device::Device {
        &self.0
    }
}

impl DerefMut for Device {
    fn deref_mut(&mut self) -> &mut device::Device {
        &mut self.0
    }
}

/// The route that SKYLIGHT_TEST_ROUTE names; without it that of the device.
fn test_route() -> Option<Route> {
    let name = std::env::var("SKYLIGHT_TEST_ROUTE").ok()?;
    Some(match name.as_str() {
        "fragment" => Route::Fragment,
        "compute" => Route::Compute,
        other => panic!("SKYLIGHT_TEST_ROUTE={other} is no route: it is fragment or compute"),
    })
}

impl Device {
    /// The best device, or the one named by SKYLIGHT_TEST_DEVICE.
    pub fn new() -> Self {
        Self::with(&ContextOptions::default())
    }

    /// A device with these options, by default by the route of SKYLIGHT_TEST_ROUTE; validation is always on.
    pub fn with(options: &ContextOptions) -> Self {
        let context = Context::new(&ContextOptions {
            device: std::env::var("SKYLIGHT_TEST_DEVICE").ok(),
            route: options.route.or_else(test_route),
            validate: true,
            ..options.clone()
        })
        .unwrap_or_else(|e| panic!("{e}"));
        Self(device::Device::new(&context).expect("a recorder"))
    }

    /// Records commands, submits them and waits.
    pub fn run<T>(&mut self, record: impl FnOnce(&mut Recorder) -> T) -> T {
        self.0.run(record).expect("run")
    }

    /// All texels of an image, layer by layer.
    pub fn read(&mut self, image: &Image) -> Vec<[f32; 4]> {
        self.0.read(image).expect("read back")
    }

    /// Reads back the six faces of a cube map, RGB.
    pub fn read_cube(&mut self, image: &Image) -> Cube {
        self.0.read_cube(image).expect("read back")
    }

    /// Draws a scene until its irradiance is refined and all samples are accumulated.
    pub fn frame(
        &mut self,
        scene: &Scene,
        settings: FrameSettings,
        daylight: &Daylight,
        camera: &Camera,
    ) -> Frame {
        let frame = self.0.frame(scene, settings, daylight, camera);
        frame.expect("a frame")
    }

    /// Draws a view with an existing frame.
    pub fn draw(&mut self, frame: &mut Frame, daylight: &Daylight, camera: &Camera) {
        self.0.draw(frame, daylight, camera).expect("drawn");
    }

    /// Draws a scene and reads back the shown quantity, in the device's units.
    pub fn picture(
        &mut self,
        scene: &Scene,
        settings: FrameSettings,
        daylight: &Daylight,
        camera: &Camera,
    ) -> Picture {
        let picture = self.0.picture(scene, settings, daylight, camera);
        picture.expect("a picture")
    }

    /// Reads back the shown quantity of a drawn frame.
    pub fn picture_of(&mut self, frame: &Frame) -> Picture {
        self.0.picture_of(frame).expect("read back")
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

/// Prints a check; fails if it has not passed.
pub fn finish(check: &Check) {
    println!(
        "{}: {} compared, largest error {:.2e} (allowed {:.1e}) at {}",
        check.name,
        check.count(),
        check.error(),
        check.tolerance,
        check.at()
    );
    assert!(
        check.passed(),
        "{}: {:e} exceeds {:e} at {}: {:?}",
        check.name,
        check.error(),
        check.tolerance,
        check.at(),
        check.values()
    );
}

/// The first three channels, in f64.
pub fn rgb(texel: [f32; 4]) -> [f64; 3] {
    device::rgb(texel).to_array()
}

/// Every texel of a cube: its unit direction, its value, and a name for messages.
pub fn named(cube: &Cube) -> impl Iterator<Item = (DVec3, DVec3, String)> + '_ {
    let texels = cube.texels();
    texels.map(|(direction, value, [face, i, j])| {
        (direction, value, format!("face {face} texel {i} {j}"))
    })
}

/// The same settings showing another quantity.
pub fn showing(show: Show, settings: FrameSettings) -> FrameSettings {
    settings.showing(show)
}
