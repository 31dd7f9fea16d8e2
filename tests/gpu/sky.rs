//! The sky cube of the device against `Daylight::radiance` on the CPU, texel by texel.

use crate::gpu::{Cube, Device, finish};
use skylight::daylight::perez::Measured;
use skylight::daylight::sky::{Conditions, Daylight, SkyModel};
use skylight::passes::sky::cube::SkyCube;
use skylight::validate::check::Check;
use skylight::validate::sky::{EVALUATION, compare_cube};

const MODELS: [SkyModel; 4] = [
    SkyModel::Preetham,
    SkyModel::Hosek,
    SkyModel::Overcast,
    SkyModel::CieClear,
];

/// General skies of all kinds: the steepest gradations and the narrowest coronas are among them.
const GENERAL: [SkyModel; 6] = [
    SkyModel::Cie1,
    SkyModel::Cie4,
    SkyModel::Cie8,
    SkyModel::Cie9,
    SkyModel::Cie13,
    SkyModel::Cie15,
];

/// Irradiances by sun and sky, W/m², from overcast to very clear.
const MEASURED: [(f64, f64); 6] = [
    (0.0, 90.0),
    (15.0, 200.0),
    (120.0, 180.0),
    (350.0, 160.0),
    (600.0, 110.0),
    (900.0, 50.0),
];

fn draw(device: &mut Device, cube: &mut SkyCube, daylight: &Daylight) -> Cube {
    device.run(|rec| {
        cube.record(rec, daylight);
    });
    device.read_cube(cube.image())
}

fn conditions() -> Vec<Conditions> {
    let mut all = Vec::new();
    for model in MODELS {
        for turbidity in [2.0, 3.0, 6.0, 10.0] {
            for sun_elevation_deg in [85.0, 30.0, 0.5, -3.0, -10.0] {
                for (ground_albedo, sun_azimuth_deg) in [(0.0, 200.0), (0.2, 75.0)] {
                    all.push(Conditions {
                        model,
                        turbidity,
                        ground_albedo,
                        sun_azimuth_deg,
                        sun_elevation_deg,
                        ..Conditions::default()
                    });
                }
            }
        }
    }
    for sun_elevation_deg in [85.0, 30.0, 2.0] {
        let at = Conditions {
            sun_elevation_deg,
            sun_azimuth_deg: 75.0,
            ..Conditions::default()
        };
        all.extend(GENERAL.map(|model| Conditions { model, ..at }));
        all.extend(MEASURED.map(|measured| measured_day(measured, at)));
        all.extend(MODELS[..2].iter().map(|&model| Conditions {
            model,
            cloud_cover: 0.6,
            ..at
        }));
    }
    all
}

fn measured_day((direct_normal_w, diffuse_horizontal_w): (f64, f64), at: Conditions) -> Conditions {
    Conditions {
        model: SkyModel::Perez,
        measured: Measured {
            direct_normal_w,
            diffuse_horizontal_w,
            ..Measured::default()
        },
        ..at
    }
}

#[test]
fn every_texel_of_every_sky_is_the_cpus() {
    let mut device = Device::new();
    let mut cube = SkyCube::new(&device.context, 32).expect("a cube");
    let mut check = Check::relative("sky cubes", "CPU", "cd/m²", EVALUATION);
    for given in conditions() {
        let daylight = Daylight::new(&given);
        let drawn = draw(&mut device, &mut cube, &daylight);
        compare_cube(&mut check, &drawn, &daylight, &format!("{given:?}"));
    }
    finish(&check);
}

#[test]
fn a_cube_of_the_renderers_size_has_texels_near_horizon_and_sun() {
    let mut device = Device::new();
    let mut cube = SkyCube::new(&device.context, 256).expect("a cube");
    let mut check = Check::relative("sky cubes of 256 x 256 x 6", "CPU", "cd/m²", EVALUATION);
    for model in MODELS {
        let given = Conditions {
            model,
            sun_elevation_deg: 20.0,
            ..Conditions::default()
        };
        let daylight = Daylight::new(&given);
        let drawn = draw(&mut device, &mut cube, &daylight);
        compare_cube(&mut check, &drawn, &daylight, &format!("{model:?}"));
    }
    finish(&check);
}

#[test]
fn a_sky_is_drawn_again_only_when_it_changes() {
    let mut device = Device::new();
    let mut cube = SkyCube::new(&device.context, 16).expect("a cube");
    let days = [
        crate::gpu::clear_day(180.0, 40.0),
        crate::gpu::clear_day(181.0, 40.0),
    ];
    let drawn: Vec<bool> = [0, 0, 1, 1, 0]
        .iter()
        .map(|&i| device.run(|rec| cube.record(rec, &days[i]).is_new))
        .collect();
    assert_eq!(drawn, [true, false, true, false, true]);
}

/// The guard holds on the device as well: no input gives a negative or non-finite texel.
#[test]
fn no_input_gives_a_bad_texel() {
    let mut device = Device::new();
    let mut cube = SkyCube::new(&device.context, 32).expect("a sky cube");
    let mut values = 0u64;
    for model in &MODELS {
        for turbidity in [-5.0, 0.0, 1.0, 1.65, 2.0, 5.0, 10.0, 50.0] {
            for elevation in (-18..=18).map(|step| f64::from(step) * 5.0) {
                let daylight = Daylight::new(&Conditions {
                    model: *model,
                    turbidity,
                    sun_elevation_deg: elevation,
                    // Toward a texel in the row above the horizon, where the glow of a low sun is out of gamut.
                    sun_azimuth_deg: 1.79,
                    ..Conditions::default()
                });
                for texel in draw(&mut device, &mut cube, &daylight).texels {
                    assert!(
                        texel.is_finite() && texel.min_element() >= 0.0,
                        "{model:?} {turbidity} {elevation}: {texel}"
                    );
                    values += 3;
                }
            }
        }
    }
    println!("{values} values are finite and not negative");
    assert!(values > 1_000_000);
}
