//! The atmosphere of the device against the one of the CPU: the table of the view, and the cube that is read from it.

use crate::gpu::{Device, finish};
use skylight::daylight::atmosphere::air::{Aerosol, Air};
use skylight::daylight::sky::{Conditions, Daylight, Sky, SkyModel};
use skylight::passes::sky::cube::SkyCube;
use skylight::validate::check::Check;
use skylight::validate::sky::{compare_atmosphere, full_moon};

fn conditions(sun_elevation_deg: f64, air: Air) -> Conditions {
    Conditions {
        model: SkyModel::Atmosphere,
        sun_elevation_deg,
        air,
        ..Conditions::default()
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

#[test]
fn view_and_cube_are_the_cpus() {
    let mut device = Device::new();
    let mut cube = SkyCube::new(&device.context, 64).expect("a cube");
    let mut view = Check::relative("tables of the view", "CPU", "cd/m²", 0.005);
    let mut texels = Check::relative("cubes", "CPU", "cd/m²", 0.005);
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
        let pair = (&daylight, sky);
        compare_atmosphere(&mut device, &cube, pair, [&mut view, &mut texels], &what)
            .expect("read back");
    }
    finish(&view);
    finish(&texels);
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
