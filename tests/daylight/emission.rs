//! Sensors lit by surfaces that emit, against closed forms: a box that glows, squares over a plane.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use skylight::daylight::Daylight;
use skylight::scene::{Encoding, Material, Scene, Texture};
use skylight::sensors::{Reading, Sensor};

use crate::bounces::{facing, mean, readings, spread};
use crate::model::{Model, closed_box, constant_sky, glowing, matt, polygon_irradiance};

fn night() -> Daylight {
    constant_sky(0.0)
}

/// Half the edge of the box, metres.
const HALF: f32 = 2.0;

/// Every surface has the radiance L_e/(1 - ρ).
#[test]
fn a_glowing_box_has_the_light_of_all_bounces() {
    let floor = [
        Vec3::new(-HALF, -HALF, -HALF),
        2.0 * HALF * Vec3::X,
        2.0 * HALF * Vec3::Z,
    ];
    let sensors = facing(Vec3::Y, spread(floor, 6));
    for reflectance in [0.0, 0.5, 0.9f32] {
        let scene = closed_box(HALF, &glowing(reflectance, 100.0));
        let (lux, error) = mean(&readings(&scene, &night(), &sensors, 0.0, 1 << 13));
        let expected = PI * 100.0 / (1.0 - f64::from(reflectance));
        let (difference, error) = (lux / expected - 1.0, error / expected);
        println!(
            "reflectance {reflectance}: {lux:.2} lux, expected {expected:.2}: {difference:+.5}, standard error {error:.5}"
        );
        assert!(
            difference.abs() < 0.005 && error < 0.002,
            "{reflectance}: {difference}"
        );
    }
}

/// Squares above a black plane: what they emit, their half edge and height, metres.
fn over_a_plane(lamp: &Material, half: f32, height: f32) -> Scene {
    Model::default()
        .ground(20.0, &matt(0.0))
        .square([0.0, height, 0.0], half, lamp)
        .build()
}

fn corners(half: f64, height: f64) -> [DVec3; 4] {
    [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
        .map(|(x, z)| DVec3::new(x * half, height, z * half))
}

/// Points on the plane: below the square, and ever farther away.
const POINTS: [[f32; 2]; 4] = [[0.0, 0.0], [0.7, -0.2], [2.5, 1.0], [6.0, -4.0]];

fn at_points(scene: &Scene, paths: u32) -> Vec<Reading> {
    let sensors = POINTS.map(|[x, z]| Sensor {
        position: Vec3::new(x, 0.0, z),
        normal: Vec3::Y,
    });
    readings(scene, &night(), &sensors, 0.0, paths)
}

#[test]
fn a_square_lights_a_plane_as_lambert_says() {
    // A luminous ceiling, a lamp, a bright point.
    for (half, height, emission) in [(1.5, 1.0, 50.0), (0.05, 2.0, 1e5), (0.002, 2.5, 6e7f32)] {
        let scene = over_a_plane(&glowing(0.0, emission), half, height);
        for (reading, [x, z]) in at_points(&scene, 1 << 16).iter().zip(POINTS) {
            let polygon = corners(half.into(), height.into());
            let point = DVec3::new(x.into(), 0.0, z.into());
            let expected = f64::from(emission) * polygon_irradiance(&polygon, point, DVec3::Y);
            let (lux, error) = (reading.total(), reading.standard_error / expected);
            let difference = lux / expected - 1.0;
            println!(
                "half edge {half} m, ({x}, {z}): {lux:.3} lux, expected {expected:.3}: {difference:+.5}, standard error {error:.5}"
            );
            assert!(
                difference.abs() < 0.005 && error < 0.002,
                "{half}, {x}, {z}: {difference}"
            );
            assert_eq!(reading.reflected, reading.total());
        }
    }
}

/// A texture whose left half is bright: the light is that of half the square.
#[test]
fn an_emissive_texture_lights_where_it_is_bright() {
    let lamp = Material {
        emissive_texture: Some(0),
        ..glowing(0.0, 1000.0)
    };
    let mut scene = over_a_plane(&lamp, 0.5, 1.0);
    let columns = 1024u32;
    let texels = (0..columns).map(|x| if 2 * x < columns { 255 } else { 0 });
    scene.textures = vec![Texture {
        name: "half".into(),
        width: columns,
        height: 1,
        rgba8: texels.flat_map(|v: u8| [v, v, v, 255]).collect(),
        encoding: Encoding::Srgb,
        wrap: Default::default(),
    }];
    let whole = at_points(&scene, 1 << 16);
    // Texture coordinates of the square run along x.
    let bright = corners(0.5, 1.0).map(|c| DVec3::new(c.x.min(0.0), c.y, c.z));
    for (reading, point) in whole.iter().zip(POINTS) {
        let [x, z] = point.map(f64::from);
        let expected = 1000.0 * polygon_irradiance(&bright, DVec3::new(x, 0.0, z), DVec3::Y);
        let difference = reading.total() / expected - 1.0;
        println!(
            "{point:?}: {:.3} lux, expected {expected:.3}: {difference:+.5}",
            reading.total()
        );
        assert!(difference.abs() < 0.005, "{point:?}: {difference}");
    }
}

/// The lamp of a room: how many paths 1 % takes.
#[test]
fn a_small_lamp_in_a_room_converges() {
    let white = matt(0.7);
    let scene = Model::default()
        .cube([0.0; 3], HALF, &white)
        .square([0.0, 1.0, 0.0], 0.05, &glowing(0.0, 1e5))
        .build();
    let sensor = Sensor {
        position: Vec3::new(1.0, -HALF, 0.5),
        normal: Vec3::Y,
    };
    let reading = readings(&scene, &night(), &[sensor], 0.01, 1 << 20)[0];
    println!("{reading:?}");
    assert!(reading.paths <= 1 << 12, "{}", reading.paths);
    assert!(reading.standard_error < 0.01 * reading.total());
}
