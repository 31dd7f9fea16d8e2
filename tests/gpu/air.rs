//! The air between eye and surfaces: the device's table against the CPU's, and pictures against light that goes through the air.

use glam::DVec3;

use crate::common::at_share;
use crate::gpu::{
    Device, Model, Picture, camera, finish, glowing, matt, pixel_ray, settings, showing,
};
use skylight::daylight::atmosphere::aerial::AirBefore;
use skylight::daylight::atmosphere::air::Air as Medium;
use skylight::daylight::atmosphere::scattered_sky::ScatteredSky;
use skylight::daylight::colour::{clip_negative, luminance};
use skylight::daylight::sky::{Conditions, Daylight, Sky, SkyModel};
use skylight::frame::{Frame, FrameSettings, Visibility};
use skylight::passes::light::lighting::Show;
use skylight::passes::sky::air::{Air, altitude_of};
use skylight::scene::{Bounds, Camera, Scene};
use skylight::validate::check::Check;
use skylight::validate::sky::{compare_air, full_moon};

fn day(sun_elevation_deg: f64, air: Medium) -> Daylight {
    Daylight::new(&Conditions {
        model: SkyModel::Atmosphere,
        sun_elevation_deg,
        sun_azimuth_deg: 140.0,
        air,
        ..Conditions::default()
    })
}

fn sky_of(daylight: &Daylight) -> &ScatteredSky {
    match &daylight.sky {
        Sky::Atmosphere(sky) => sky,
        other => panic!("{other:?}"),
    }
}

fn hazy() -> Medium {
    let mut air = Medium {
        aod: 0.4,
        altitude_m: 800.0,
        ..Medium::default()
    };
    air.aerosol.asymmetry = 0.6;
    air
}

/// Prints the errors and bounds 95 % of them.
fn judge(what: &str, errors: &mut [f64], bound: f64) {
    let [middle, most, worst] = [0.5, 0.95, 1.0].map(|share| 100.0 * at_share(errors, share));
    let count = errors.len();
    println!("{what}: {count} values, {middle:.4} % {most:.4} %, worst {worst:.3} %");
    assert!(most < 100.0 * bound, "{what}: {most} %");
}

#[test]
fn the_table_is_the_cpus() {
    let mut device = Device::new();
    let mut air = Air::new(&device.context, &Bounds::EMPTY, 16).expect("a table");
    let mut check = Check::relative("table of the air", "CPU", "", 0.005);
    for (sun, medium, eye) in [
        (50.0, Medium::default(), 1500.0),
        (2.0, hazy(), 2.0),
        (-4.0, Medium::default(), 300.0),
        (-12.0, Medium::default(), 9000.0),
    ] {
        let daylight = day(sun, medium);
        device.run(|rec| {
            air.record(rec, &daylight, eye);
        });
        let altitude = altitude_of(medium.altitude_m, eye.into(), 0.0) / 1000.0;
        let twin = AirBefore::new(sky_of(&daylight), altitude);
        let texels = device.read(air.image());
        compare_air(&mut check, &texels, &air, &twin, &format!("sun {sun}"));
    }
    finish(&check);
}

/// Brightness of the surfaces, cd/m².
const GLOW: f32 = 1e4;

/// A plain of 300 km and walls in all directions at many distances, which glow.
fn far_scene() -> Scene {
    let surface = glowing(0.0, GLOW);
    let mut model = Model::default().ground(150_000.0, &surface);
    let towers: [(f32, f32); 9] = [
        (400.0, 10.0),
        (1500.0, 60.0),
        (5000.0, 100.0),
        (12_000.0, 170.0),
        (30_000.0, 215.0),
        (50_000.0, 260.0),
        (80_000.0, 305.0),
        (110_000.0, 340.0),
        (20_000.0, 138.0),
    ];
    for (distance, azimuth) in towers {
        let (east, north) = azimuth.to_radians().sin_cos();
        let half = (0.25 * distance).min(4000.0);
        let centre = [distance * east, half, -distance * north];
        model = model.cube(centre, half, &surface);
    }
    model.build()
}

fn with_air(shown: Show) -> FrameSettings {
    let mut set = showing(shown, settings(96, 54));
    set.lighting.air = true;
    set
}

/// The view from `height` metres toward an azimuth.
fn view(height: f32, azimuth: f32) -> Camera {
    let (east, north) = azimuth.to_radians().sin_cos();
    let down = if height > 1000.0 { 400.0 } else { 0.0 };
    let mut view = camera(
        [0.0, height, 0.0],
        [1000.0 * east, height - down, -1000.0 * north],
    );
    view.fov_deg = 60.0;
    view
}

/// Draws views with one frame.
fn shown(
    device: &mut Device,
    scene: &Scene,
    set: FrameSettings,
    cases: &[(Daylight, Camera)],
) -> Vec<Picture> {
    let mut frame = device.run(|rec| Frame::new(rec, scene, set).expect("a frame"));
    let pictures = cases.iter().map(|(daylight, camera)| {
        device.draw(&mut frame, daylight, camera);
        device.picture_of(&frame)
    });
    pictures.collect()
}

#[test]
fn pictures_have_the_air_before_them() {
    let mut device = Device::new();
    let scene = far_scene();
    let mut cases = Vec::new();
    for sun in [60.0, 10.0, 2.0, -2.0, -4.0] {
        for (height, medium) in [
            (2.0, Medium::default()),
            (1500.0, Medium::default()),
            (300.0, hazy()),
            (9000.0, Medium::default()),
        ] {
            let azimuth = 137.0 * cases.len() as f32;
            cases.push((day(sun, medium), view(height, azimuth)));
        }
    }
    // At night the moon lights the air.
    let moonlit = Daylight::new(&Conditions {
        model: SkyModel::Atmosphere,
        sun_elevation_deg: -30.0,
        moon: Some(full_moon(35.0)),
        ..Conditions::default()
    });
    assert!(sky_of(&moonlit).brighter() != &sky_of(&moonlit).sun);
    cases.push((moonlit, view(300.0, 80.0)));
    let [lit, light, depth] = [Show::Emission, Show::Air, Show::Depth]
        .map(|show| shown(&mut device, &scene, with_air(show), &cases));
    // Against the table's twin, and against a march of its own for each pixel.
    let (mut scattered, mut through) = ([Vec::new(), Vec::new()], [Vec::new(), Vec::new()]);
    for (i, (daylight, camera)) in cases.iter().enumerate() {
        let sky = sky_of(daylight);
        let altitude = altitude_of(sky.atmosphere.air.altitude_m, camera.eye.y.into(), 0.0);
        let before = AirBefore::new(sky, altitude / 1000.0);
        let mut here = sky.atmosphere.clone();
        here.air.altitude_m = altitude;
        for ([x, y], axial) in depth[i].pixels().step_by(7) {
            if axial.x <= 0.0 {
                assert_eq!(light[i].at(x, y), DVec3::ZERO, "no surface, no air");
                continue;
            }
            let dir = pixel_ray(camera, depth[i].size, [x, y]);
            let km = axial.x / dir.dot(camera.forward().as_dvec3()) / 1000.0;
            let twin = daylight.aerial(&before, dir, km);
            let lamp = sky.brighter();
            let own = here.aerial(lamp.direction, dir, km);
            let own_light = clip_negative(own.inscatter) * (daylight.guard.scale * lamp.share)
                + (1.0 - own.transmittance) * daylight.veil();
            let found = light[i].at(x, y) * 1e3;
            let seen = lit[i].at(x, y) * 1e3 / f64::from(GLOW);
            for (k, expected) in [twin.inscatter, own_light].into_iter().enumerate() {
                let error = (found - expected).abs().max_element();
                scattered[k].push(error / luminance(expected));
            }
            for (k, expected) in [twin.transmittance, own.transmittance]
                .into_iter()
                .enumerate()
            {
                through[k].push((seen - expected).abs().max_element());
            }
        }
    }
    let [mut scattered_twin, mut scattered_own] = scattered;
    let [mut through_twin, mut through_own] = through;
    judge("in-scattered light, twin", &mut scattered_twin, 0.003);
    judge("transmittance, twin", &mut through_twin, 0.003);
    judge(
        "in-scattered light, path by path",
        &mut scattered_own,
        0.015,
    );
    judge("transmittance, path by path", &mut through_own, 0.003);
    assert!(scattered_twin.len() > 5000);
}

/// A wall that fills the view at 20 km.
fn wall() -> (Scene, Camera) {
    let scene = Model::default()
        .quad(
            [-50_000.0, -50_000.0, -20_000.0],
            [100_000.0, 0.0, 0.0],
            [0.0, 100_000.0, 0.0],
            &matt(0.5),
        )
        .ground(100.0, &matt(0.3))
        .build();
    (scene, camera([0.0, 800.0, 0.0], [0.0, 800.0, -1.0]))
}

#[test]
fn light_is_dimmed_and_added_in_single_and_in_converging_frames() {
    let mut device = Device::new();
    let (scene, camera) = wall();
    let cases = [(day(40.0, Medium::default()), camera)];
    for visibility in [Visibility::Ssao, Visibility::Dome] {
        let mut picture = |show, air| {
            let mut set = with_air(show);
            set.lighting.air = air;
            set.sampling.visibility = visibility;
            shown(&mut device, &scene, set, &cases).remove(0)
        };
        let (clear, whole) = (picture(Show::Beauty, false), picture(Show::Beauty, true));
        let addends: Vec<Picture> = Show::ADDENDS.map(|show| picture(show, true)).into();
        let lux = [false, true].map(|air| picture(Show::Irradiance, air));
        assert_eq!(
            lux[0].texels, lux[1].texels,
            "illuminance is that of the surface"
        );
        let sky = sky_of(&cases[0].0);
        // The wall reaches far below the sea: the scene is lifted.
        let before = AirBefore::new(sky, altitude_of(0.0, 800.0, -50_000.0) / 1000.0);
        let mut errors = Vec::new();
        for ([x, y], clear) in clear.pixels() {
            let dir = pixel_ray(&camera, whole.size, [x, y]);
            let air = cases[0].0.aerial(&before, dir, -20.0 / dir.z);
            let expected = air.transmittance * clear + air.inscatter * 1e-3;
            errors.push((whole.at(x, y) - expected).abs().max_element() / luminance(expected));
            let sum: DVec3 = addends.iter().map(|addend| addend.at(x, y)).sum();
            let error = (sum - whole.at(x, y)).abs().max_element();
            assert!(error < 1e-6 * luminance(expected), "{visibility:?} {sum}");
        }
        judge(&format!("{visibility:?}"), &mut errors, 0.003);
    }
}

#[test]
fn the_sky_behind_is_that_of_the_altitude_of_the_eye() {
    let mut device = Device::new();
    let scene = far_scene();
    for (sun, height) in [(12.0, 3000.0), (-3.0, 900.0)] {
        let daylight = day(sun, Medium::default());
        let there = Daylight {
            sky: Sky::Atmosphere(sky_of(&daylight).from_altitude(height.into())),
            ..daylight.clone()
        };
        let view = view(height, 100.0);
        let cases = [(daylight.clone(), view)];
        let picture = shown(&mut device, &scene, with_air(Show::Background), &cases).remove(0);
        let errors = |of: &Daylight| -> Vec<f64> {
            let sky = picture.pixels().filter(|(_, seen)| seen.y > 0.0);
            let error = sky.map(|(pixel, seen)| {
                let expected = of.radiance(pixel_ray(&view, picture.size, pixel));
                (seen * 1e3 - expected).abs().max_element() / luminance(expected)
            });
            error.collect()
        };
        judge("sky from there", &mut errors(&there), 0.02);
        let mut others = errors(&daylight);
        assert!(
            at_share(&mut others, 0.5) > 0.02,
            "the sky of the place differs"
        );
    }
}

#[test]
fn small_scenes_have_no_air() {
    let mut device = Device::new();
    let cases = [(
        day(20.0, Medium::default()),
        camera([0.0, 3.0, 20.0], [0.0, 1.0, 0.0]),
    )];
    // A diagonal of 198 m, and one of 283 m.
    for (half, is_seen) in [(70.0, false), (100.0, true)] {
        let scene = Model::default()
            .ground(half, &matt(0.4))
            .cube([0.0, 1.0, 0.0], 1.0, &matt(0.6))
            .build();
        let [on, off] = [true, false].map(|air| {
            let mut set = with_air(Show::Beauty);
            set.lighting.air = air;
            shown(&mut device, &scene, set, &cases).remove(0).texels
        });
        assert_eq!(on != off, is_seen, "{half} m");
    }
}

#[test]
fn without_an_atmosphere_the_air_is_clear() {
    let mut device = Device::new();
    let scene = far_scene();
    let other = Daylight::new(&Conditions {
        model: SkyModel::Preetham,
        ..Conditions::default()
    });
    let cases = [(other, view(300.0, 20.0))];
    let [on, off] = [true, false].map(|air| {
        let mut set = with_air(Show::Beauty);
        set.lighting.air = air;
        shown(&mut device, &scene, set, &cases).remove(0)
    });
    for ([x, y], seen) in on.pixels() {
        assert!((seen - off.at(x, y)).abs().max_element() <= 1e-6 * seen.max_element());
    }
}
