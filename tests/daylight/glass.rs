//! Sensors behind panes of glass, against closed forms and reference values.

use glam::{DVec3, Vec3};
use skylight::daylight::Daylight;
use skylight::daylight::glass::{internal_transmittance, pane};
use skylight::scene::{Material, Scene};

use crate::bounces::{facing, mean, readings};
use crate::model::{Model, clear_day, constant_sky, glass, hemispherical_transmittance, matt};

/// A wide pane 1 m above the sensor.
fn sheets(material: &Material, count: u32) -> Scene {
    let heights = (0..count).map(|i| 1.0 + 0.1 * i as f32);
    heights
        .fold(
            Model::default().ground(4000.0, &matt(0.0)),
            |model, height| model.square([0.0, height, 0.0], 2000.0, material),
        )
        .build()
}

/// Illuminance of the ground below, lux.
fn below(scene: &Scene, day: &Daylight) -> f64 {
    let sensor = facing(Vec3::Y, vec![Vec3::new(0.1, 0.01, 0.2)]);
    mean(&readings(scene, day, &sensor, 0.0, 1 << 13)).0
}

/// Only the sun: its light passes at one angle.
fn sun_alone(elevation: f64) -> Daylight {
    let mut day = constant_sky(0.0);
    let sun = clear_day(180.0, elevation);
    (day.sun_direction, day.sun_illuminance) = (sun.sun_direction, DVec3::splat(1000.0));
    day
}

#[test]
fn the_sun_passes_a_pane_by_its_angle_and_two_sheets_twice() {
    let internal = internal_transmittance(0.88);
    for elevation in [90.0, 60.0, 45.0, 30.0, 20.0, 10.0] {
        let day = sun_alone(elevation);
        let sine = elevation.to_radians().sin();
        let [through, _] = pane(internal, sine);
        for (count, expected) in [(1, through), (2, through * through)] {
            let found = below(&sheets(&glass([0.88; 3]), count), &day) / (1000.0 * sine);
            let error = found / expected - 1.0;
            println!("{elevation} degrees, {count}: {found:.4}, {error:+.5}");
            // The disc is half a degree wide.
            assert!(error.abs() < 0.003, "{elevation}, {count}: {error}");
        }
    }
}

#[test]
fn a_uniform_sky_passes_with_the_hemispherical_transmittance() {
    let day = constant_sky(100.0);
    let open = below(&sheets(&matt(0.0), 0), &day);
    for transmittance in [0.9, 0.6] {
        let scene = sheets(&glass([transmittance; 3]), 1);
        let found = below(&scene, &day) / open;
        let expected = hemispherical_transmittance(transmittance.into());
        println!("{transmittance}: {found:.4} of {expected:.4}");
        assert!(
            (found / expected - 1.0).abs() < 0.005,
            "{transmittance}: {found}"
        );
    }
}

/// A slab of 6 mm is one pane, and a glass house has two: where light enters and where it leaves.
#[test]
fn a_slab_is_one_pane_and_a_house_of_glass_has_walls() {
    let (day, material) = (sun_alone(90.0), glass([0.8; 3]));
    let slab = |height: f32, half: f32| {
        Model::default()
            .ground(2.0, &matt(0.0))
            .slab(
                [-50.0, height - half, -50.0],
                [50.0, height + half, 50.0],
                0.0,
                &material,
            )
            .build()
    };
    for (name, scene, expected) in [
        ("slab", slab(1.0, 0.003), 0.8),
        ("house", slab(5.0, 2.0), 0.64),
    ] {
        let found = below(&scene, &day) / 1000.0;
        println!("{name}: {found:.4}");
        assert!((found / expected - 1.0).abs() < 0.003, "{name}: {found}");
    }
}

#[test]
fn tinted_glass_colours_the_light() {
    let scene = sheets(&glass([0.2, 0.7, 0.4]), 1);
    let sensor = facing(Vec3::Y, vec![Vec3::new(0.1, 0.01, 0.2)]);
    let reading = readings(&scene, &sun_alone(90.0), &sensor, 0.0, 1 << 8)[0];
    let expected = 0.2126 * 0.2 + 0.7152 * 0.7 + 0.0722 * 0.4;
    let found = reading.total() / 1000.0;
    assert!((found / expected - 1.0).abs() < 0.003, "{found} {expected}");
}
