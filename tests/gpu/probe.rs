//! Read-outs of single pixels match the picture on the screen.

use glam::DVec3;
use skylight::daylight::colour::luminance;
use skylight::daylight::sky::Daylight;
use skylight::frame::{Frame, FrameSettings, Visibility};
use skylight::passes::light::lighting::{Precision, Show};
use skylight::passes::light::probe::Reading;
use skylight::scene::{Camera, Scene};

use crate::gpu::{Device, Model, Picture, camera, clear_day, matt, on_ground, settings, showing};

const EDGE: u32 = 96;
const SAMPLES: u32 = 32;

/// A roof of 4 m at a height of 2 m on the left, a cube on the right; a camera and a daylight.
fn scene() -> (Scene, Camera, Daylight) {
    let scene = Model::default()
        .ground(12.0, &matt(0.5))
        .square([-3.0, 2.0, 0.0], 2.0, &matt(0.6))
        .cube([3.0, 1.0, 0.0], 1.0, &matt(0.7))
        .build();
    let view = camera([0.0, 5.0, 11.0], [0.0, 0.5, 0.0]);
    // Shadows fall to the left.
    (scene, view, clear_day(92.0, 45.0))
}

/// Ground points in the sun, in the cube's shadow, and under the roof.
const POINTS: [(&str, DVec3); 3] = [
    ("in the sun", DVec3::new(0.0, 0.0, 4.0)),
    ("in the shade", DVec3::new(1.2, 0.0, 0.0)),
    ("under the roof", DVec3::new(-3.8, 0.0, 0.5)),
];

/// The pixel that shows a ground point.
fn pixel_of(view: &Camera, point: DVec3) -> [u32; 2] {
    let edge = EDGE as usize;
    let pixels = (0..edge * edge).map(|i| [i % edge, i / edge]);
    let distances = pixels.filter_map(|pixel| {
        let at = on_ground(view, [edge; 2], pixel)?;
        Some((at.distance(point), pixel))
    });
    let nearest = distances.min_by(|a, b| a.0.total_cmp(&b.0));
    nearest.expect("a pixel of the ground").1.map(|i| i as u32)
}

/// Settings of the window: half floats, ambient occlusion while the view moves.
fn as_in_the_window(visibility: Visibility) -> FrameSettings {
    let mut set = settings(EDGE, EDGE);
    set.samples = SAMPLES;
    set.sampling.visibility = visibility;
    set.sampling.dome.directions = 4;
    set.sampling.dome.map_edge = 512;
    set.sampling.dome.illuminance = true;
    set.ssao.radius = 5.0;
    set.lighting.occlusion_downscale = set.ssao.pixels_per_texel();
    set.lighting.precision = Precision::Half;
    set
}

fn read(device: &mut Device, frame: &mut Frame, pixel: [u32; 2]) -> Reading {
    device.run(|rec| frame.pick(rec, pixel));
    frame.picked().expect("a reading")
}

/// Reads the three points from a drawn frame and compares them with a picture of irradiance (klx).
fn compare(
    device: &mut Device,
    frame: &mut Frame,
    view: &Camera,
    irradiance: &Picture,
    what: &str,
) {
    let shown = device.picture_of(frame);
    let mut read_outs = Vec::new();
    for (place, point) in POINTS {
        let pixel = pixel_of(view, point);
        let reading = read(device, frame, pixel);
        assert_eq!(reading.pixel, pixel);
        let [x, y] = pixel.map(|i| i as usize);
        // The shown quantity, in its unit.
        let unit = f64::from(frame.settings().lighting.show.file_unit());
        let texel = shown.at(x, y) * unit;
        let radiance = glam::Vec3::from(reading.radiance).as_dvec3();
        assert!((radiance - texel).length() <= 1e-6 * texel.length());
        let surface = reading.surface.expect("the ground");
        let (found, expected) = (
            f64::from(surface.illuminance),
            luminance(irradiance.at(x, y)) * 1e3,
        );
        println!("{what}, {place}: {found:.0} lux, the picture {expected:.0}");
        assert!(
            (found / expected - 1.0).abs() < 0.01,
            "{what}, {place}: {found} {expected}"
        );
        read_outs.push(found);
    }
    // The points are lit as their names say.
    let [sun, shade, roof] = read_outs[..] else {
        panic!("three places")
    };
    assert!(sun > 50e3 && shade < 0.3 * sun && roof < 0.3 * sun);
}

/// The picture of irradiance that `render` would write with these settings.
fn irradiance(device: &mut Device, mut set: FrameSettings) -> Picture {
    let (scene, view, day) = scene();
    set.lighting.precision = Precision::Float;
    device.picture(&scene, showing(Show::Irradiance, set), &day, &view)
}

/// Draws a preview, then accumulates all frames, and compares the read-outs of both.
fn check(visibility: Visibility, file: Visibility, show: Show) {
    let mut device = Device::new();
    let (scene, view, day) = scene();
    let set = as_in_the_window(visibility);
    let mut at_rest = set;
    at_rest.sampling.visibility = file;
    let rested = irradiance(&mut device, at_rest);
    let mut preview = set;
    preview.samples = 1;
    preview.sampling.visibility = Visibility::Ssao;
    let moving = irradiance(&mut device, preview);

    let mut frame = device.run(|rec| Frame::new(rec, &scene, showing(show, set)).expect("made"));
    while !frame.is_refined() {
        device.run(|rec| frame.record_light(rec, &day));
    }
    device.run(|rec| frame.preview(rec, &day, &view));
    compare(&mut device, &mut frame, &view, &moving, "moving");
    for index in 0..SAMPLES {
        device.run(|rec| frame.record(rec, &day, &view, index));
    }
    compare(&mut device, &mut frame, &view, &rested, "at rest");
}

#[test]
fn under_the_dome_the_illuminance_is_that_of_the_picture() {
    check(Visibility::Progressive, Visibility::Dome, Show::Beauty);
}

#[test]
fn of_a_mean_the_illuminance_is_that_of_the_picture() {
    check(Visibility::Ssao, Visibility::Ssao, Show::Beauty);
}

#[test]
fn the_illuminance_is_known_whatever_is_shown() {
    check(Visibility::Progressive, Visibility::Dome, Show::Normal);
}
