//! Skies of the device against those of the CPU, texel by texel: cubes, tables of the atmosphere.

use glam::{Vec3, Vec4};

use super::check::Check;
use super::device::{Cube, Device};
use crate::daylight::atmosphere::aerial::{AZIMUTHS, AirBefore, SOURCE_ROWS, STEPS};
use crate::daylight::atmosphere::air::Air as Medium;
use crate::daylight::atmosphere::scattered_sky::ScatteredSky;
use crate::daylight::colour::luminance;
use crate::daylight::moon::{MEAN_DISTANCE_KM, Moon};
use crate::daylight::perez::Measured;
use crate::daylight::sky::{Conditions, Daylight, Sky, SkyModel};
use crate::daylight::sun_position::direction;
use crate::gpu::Result;
use crate::passes::sky::air::{Air, altitude_of};
use crate::passes::sky::cube::SkyCube;
use crate::scene::Bounds;

/// Relative error of a texel's brightest channel: the shader evaluates in float32 (2^-24), and the chain of exp, pow and XYZ to RGB (differences of
/// terms with factors up to 3.2) amplifies that.
pub const EVALUATION: f64 = 1e-4;

/// The models whose sky is a formula.
const FORMULAS: [SkyModel; 21] = [
    SkyModel::Preetham,
    SkyModel::Hosek,
    SkyModel::Perez,
    SkyModel::Overcast,
    SkyModel::CieClear,
    SkyModel::Cie1,
    SkyModel::Cie2,
    SkyModel::Cie3,
    SkyModel::Cie4,
    SkyModel::Cie5,
    SkyModel::Cie6,
    SkyModel::Cie7,
    SkyModel::Cie8,
    SkyModel::Cie9,
    SkyModel::Cie10,
    SkyModel::Cie11,
    SkyModel::Cie12,
    SkyModel::Cie13,
    SkyModel::Cie14,
    SkyModel::Cie15,
    SkyModel::Cie16,
];

/// Compares every texel of a sky cube with [`Daylight::radiance`]; what is black there must be black.
pub fn compare_cube(check: &mut Check, cube: &Cube, daylight: &Daylight, what: &str) {
    for (direction, found, [face, i, j]) in cube.texels() {
        let expected = daylight.radiance(direction);
        let scale = expected.max_element() + f64::MIN_POSITIVE;
        let at = || format!("{what}, face {face} texel {i} {j}");
        check.see_colour(found * 1e3, expected, scale, at);
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

/// All skies that are formulas, by a high and a low sun, clear and with clouds.
fn days() -> Vec<Conditions> {
    let mut days = Vec::new();
    for (sun_elevation_deg, sun_azimuth_deg) in [(50.0, 200.0), (3.0, 75.0)] {
        let at = Conditions {
            sun_elevation_deg,
            sun_azimuth_deg,
            measured: Measured {
                direct_normal_w: 350.0,
                diffuse_horizontal_w: 160.0,
                ..Measured::default()
            },
            ..Conditions::default()
        };
        days.extend(FORMULAS.map(|model| Conditions { model, ..at }));
        days.extend(FORMULAS[..2].iter().map(|&model| Conditions {
            model,
            cloud_cover: 0.6,
            ..at
        }));
    }
    days
}

/// Cubes of all skies that are formulas.
///
/// # Errors
/// The device fails.
pub fn formulas(device: &mut Device) -> Result<Vec<Check>> {
    let mut check = Check::relative("sky cubes, 21 models", "CPU, f64", "cd/m²", EVALUATION);
    let mut cube = SkyCube::new(&device.context, 16)?;
    for given in days() {
        let daylight = Daylight::new(&given);
        device.run(|rec| {
            cube.record(rec, &daylight);
        })?;
        let drawn = device.read_cube(cube.image())?;
        let what = format!("{:?}, sun {}°", given.model, given.sun_elevation_deg);
        compare_cube(&mut check, &drawn, &daylight, &what);
    }
    Ok(vec![check])
}

/// Compares the tables of the view under sun and moon, and the cube that is read from them, relative to the luminance of each entry: what is
/// far darker than the night sky is no light. `cube` has just drawn `daylight`.
///
/// # Errors
/// The device fails.
pub fn compare_atmosphere(
    device: &mut Device,
    cube: &SkyCube,
    (daylight, sky): (&Daylight, &ScatteredSky),
    [view, texels]: [&mut Check; 2],
    what: &str,
) -> Result<()> {
    let lights = [Some(&sky.sun), sky.moon.as_ref()];
    for (image, light) in cube.sky_views().iter().zip(lights) {
        let Some(light) = light else { continue };
        let drawn = device.read(image)?;
        let twin = &light.view(&sky.atmosphere).entries;
        view.see(drawn.len() as f64, twin.len() as f64, 1.0, || {
            format!("{what}, number of entries")
        });
        for (i, (found, expected)) in drawn.iter().zip(twin).enumerate() {
            let found = Vec3::from_slice(found).as_dvec3() * 1e3;
            let scale = luminance(*expected).max(1e-6);
            view.see_colour(found, *expected, scale, || format!("{what}, entry {i}"));
        }
    }
    for (direction, found, [face, i, j]) in device.read_cube(cube.image())?.texels() {
        let expected = daylight.radiance(direction);
        let scale = luminance(expected).max(1e-6);
        let at = || format!("{what}, face {face} texel {i} {j}");
        texels.see_colour(found * 1e3, expected, scale, at);
    }
    Ok(())
}

/// The sky of the atmosphere: noon, dusk, moonlight.
///
/// # Errors
/// The device fails.
pub fn atmosphere(device: &mut Device) -> Result<Vec<Check>> {
    let twin = "CPU, f64";
    let mut view = Check::relative("atmosphere, tables of the view", twin, "cd/m²", 0.005);
    let mut texels = Check::relative("atmosphere, cubes", twin, "cd/m²", 0.005);
    let mut air = Check::relative("atmosphere, table of the air", twin, "", 0.005);
    let mut cube = SkyCube::new(&device.context, 32)?;
    let mut table = Air::new(&device.context, &Bounds::EMPTY, 16)?;
    for (sun_elevation_deg, moon) in [(50.0, None), (-4.0, None), (-12.0, Some(full_moon(45.0)))] {
        let daylight = Daylight::new(&Conditions {
            model: SkyModel::Atmosphere,
            sun_elevation_deg,
            moon,
            ..Conditions::default()
        });
        let Sky::Atmosphere(sky) = &daylight.sky else {
            continue;
        };
        let what = format!("sun {sun_elevation_deg}°");
        device.run(|rec| {
            cube.record(rec, &daylight);
        })?;
        let both = [&mut view, &mut texels];
        compare_atmosphere(device, &cube, (&daylight, sky), both, &what)?;
        let eye = 300.0;
        device.run(|rec| {
            table.record(rec, &daylight, eye);
        })?;
        let altitude = altitude_of(Medium::default().altitude_m, eye.into(), 0.0) / 1000.0;
        let twin = AirBefore::new(sky, altitude);
        compare_air(&mut air, &device.read(table.image())?, &table, &twin, &what);
    }
    Ok(vec![view, texels, air])
}

/// Compares densities and sources of the table of the air.
pub fn compare_air(
    check: &mut Check,
    texels: &[[f32; 4]],
    table: &Air,
    twin: &AirBefore,
    what: &str,
) {
    let width = table.image().size()[0] as usize;
    let at = |x: usize, y: usize| Vec4::from_array(texels[y * width + x]).as_dvec4();
    for (i, density) in twin.densities.iter().enumerate() {
        let found = at(i / STEPS, 4 * SOURCE_ROWS + i % STEPS).truncate();
        let scale = density.max_element();
        check.see_colour(found, *density, scale, || format!("{what}, density {i}"));
    }
    for (i, source) in twin.sources.iter().enumerate() {
        let (x, row) = (i % (STEPS * AZIMUTHS), i / (STEPS * AZIMUTHS));
        for (y, expected) in [(row, source.rest), (row + 2 * SOURCE_ROWS, source.aerosol)] {
            // No light at all is a value too.
            let scale = expected.max_element().max(1e-13);
            let found = at(x, y);
            for channel in 0..4 {
                let at = || format!("{what}, source {i}, channel {channel}");
                check.see(found[channel], expected[channel], scale, at);
            }
        }
    }
}
