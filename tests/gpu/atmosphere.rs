//! The atmosphere of the device against the one of the CPU: the table of the view, and the cube that is read from it.

use crate::common::at_share;
use crate::gpu::Device;
use skylight::daylight::atmosphere::air::{Aerosol, Air};
use skylight::daylight::colour::luminance;
use skylight::daylight::moon::{MEAN_DISTANCE_KM, Moon};
use skylight::daylight::sky::{Conditions, Daylight, Sky, SkyModel};
use skylight::daylight::sun_position::direction;
use skylight::passes::sky::cube::SkyCube;

fn conditions(sun_elevation_deg: f64, air: Air) -> Conditions {
    Conditions {
        model: SkyModel::Atmosphere,
        sun_elevation_deg,
        air,
        ..Conditions::default()
    }
}

/// A full moon in the west of the south.
pub fn full_moon(elevation_deg: f64) -> Moon {
    Moon {
        azimuth_deg: 250.0,
        elevation_deg,
        apparent_elevation_deg: elevation_deg,
        distance_km: MEAN_DISTANCE_KM,
        phase_angle_deg: 0.0,
        sunward: -direction(250.0, elevation_deg),
    }
}

fn cases() -> Vec<Conditions> {
    let clear = Air::default();
    let high = Air {
        altitude_m: 2000.0,
        ..clear
    };
    let hazy = Air {
        aod: 0.4,
        ozone_du: 450.0,
        aerosol: Aerosol {
            single_scattering_albedo: 0.98,
            asymmetry: 0.6,
            scale_height_km: 2.0,
            angstrom: 0.5,
        },
        ..clear
    };
    let mut cases = Vec::new();
    for elevation in [90.0, 60.0, 10.0, 2.0, 0.0, -2.0, -6.0, -12.0, -17.0, -40.0] {
        cases.push(conditions(elevation, clear));
    }
    for elevation in [30.0, 1.0, -5.0] {
        cases.push(conditions(elevation, high));
        cases.push(conditions(elevation, hazy));
    }
    for (sun, moon) in [(-2.0, 3.0), (-12.0, 45.0), (-17.0, -4.0), (-40.0, 45.0)] {
        for air in [clear, high] {
            cases.push(Conditions {
                moon: Some(full_moon(moon)),
                ..conditions(sun, air)
            });
        }
    }
    cases
}

/// Prints and bounds the errors of texels, each over the luminance of the twin.
fn judge(what: &str, mut errors: Vec<f64>) {
    let [middle, most, worst] = [0.5, 0.95, 1.0].map(|share| at_share(&mut errors, share));
    println!(
        "{what}: {} texels, {:.4} % {:.4} %, worst {:.3} %",
        errors.len(),
        100.0 * middle,
        100.0 * most,
        100.0 * worst
    );
    assert!(most < 0.003 && worst < 0.05, "{what}");
}

#[test]
fn view_and_cube_are_the_cpus() {
    let mut device = Device::new();
    let mut cube = SkyCube::new(&device.context, 64).expect("a cube");
    for given in cases() {
        let daylight = Daylight::new(&given);
        device.run(|rec| {
            cube.record(rec, &daylight);
        });
        let Sky::Atmosphere(sky) = &daylight.sky else {
            panic!("not an atmosphere");
        };
        let what = format!(
            "sun {}, moon {:?}, AOD {}, {} m",
            given.sun_elevation_deg,
            given.moon.map(|moon| moon.elevation_deg),
            given.air.aod,
            given.air.altitude_m
        );
        assert_eq!(sky.moon.is_some(), given.moon.is_some());
        let lights = [Some(&sky.sun), sky.moon.as_ref()];
        for (image, light) in cube.sky_views().iter().zip(lights) {
            let Some(light) = light else { continue };
            let drawn = device.read(image);
            let twin = &light.view(&sky.atmosphere).entries;
            assert_eq!(drawn.len(), twin.len());
            // What is far darker than the night sky is no light.
            let errors = drawn.iter().zip(twin).map(|(found, expected)| {
                let found = glam::Vec3::from_slice(found).as_dvec3() * 1e3;
                (found - expected).abs().max_element() / luminance(*expected).max(1e-6)
            });
            judge(&format!("view, {what}"), errors.collect());
        }

        let drawn = device.read_cube(cube.image());
        let errors = drawn.iter().map(|(direction, found, _)| {
            assert!(found.is_finite() && found.min_element() >= 0.0);
            let expected = daylight.radiance(direction);
            let error = (found * 1e3 - expected).abs().max_element();
            error / luminance(expected).max(1e-6)
        });
        judge(&format!("cube, {what}"), errors.collect());
    }
}

#[test]
fn a_view_is_made_again_only_when_sun_or_air_change() {
    let mut device = Device::new();
    let mut cube = SkyCube::new(&device.context, 16).expect("a cube");
    let clear = Air::default();
    let altitude = Air {
        altitude_m: 500.0,
        ..clear
    };
    let days: Vec<Daylight> = [(20.0, clear), (21.0, clear), (21.0, altitude)]
        .map(|(elevation, air)| Daylight::new(&conditions(elevation, air)))
        .into();
    let drawn: Vec<bool> = [0, 0, 1, 2, 2, 0]
        .iter()
        .map(|&i| device.run(|rec| cube.record(rec, &days[i]).is_new))
        .collect();
    assert_eq!(drawn, [true, false, true, true, false, true]);
}
