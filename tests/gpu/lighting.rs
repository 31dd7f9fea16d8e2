//! Lighting: terms that add up to the picture, the sun's disc, mirrors, depth and normals, the mean of many frames, and the
//! file written by `render --layers`.

use std::process::Command;

use crate::common::Worst;
use crate::gpu::{
    Device, Model, Picture, camera, clear_day, constant_sky, glowing, matt, on_ground, pixel_ray,
    settings, showing,
};
use crate::truth::Exr;
use glam::DVec3;
use skylight::daylight::irradiance::IrradianceMethod;
use skylight::daylight::sky::{Conditions, Daylight, SkyModel};
use skylight::frame::FrameSettings;
use skylight::options::name as option_name;
use skylight::passes::light::lighting::Show;
use skylight::passes::occlusion::ssao::SsaoSettings;
use skylight::passes::picture::accumulate::Accumulate;
use skylight::scene::{Camera, Encoding, Material, Scene, Texture};

/// A mirror without diffuse reflection.
fn mirror() -> Material {
    Material {
        specular: [1.0; 3],
        shininess: 50.0,
        ..matt(0.0)
    }
}

/// A glossy checkered ground with a white sphere that glows in squares and a mirror-like cube on it.
pub fn glossy_scene() -> Scene {
    let chequered = Material {
        specular: [0.2, 0.3, 0.4],
        shininess: 30.0,
        diffuse_texture: Some(0),
        specular_texture: Some(1),
        ..matt(0.8)
    };
    let lantern = Material {
        emissive_texture: Some(1),
        ..glowing(0.9, 700.0)
    };
    let mut scene = Model::default()
        .ground(6.0, &chequered)
        .sphere([0.9, 0.7, 0.0], 0.7, 24, &lantern)
        .cube([-1.0, 0.6, 0.2], 0.6, &mirror())
        .build();
    let texture = |name: &str, shade: fn(u8) -> [u8; 4]| Texture {
        name: name.into(),
        width: 16,
        height: 16,
        rgba8: (0..=255)
            .flat_map(|i: u8| shade((i ^ (i >> 4)) & 1))
            .collect(),
        encoding: Encoding::Srgb,
        wrap: Default::default(),
    };
    scene.textures = vec![
        texture("chequers", |odd| [200 * odd + 40, 150, 90 + 100 * odd, 255]),
        texture("gloss", |odd| [255 * odd, 255 * odd, 255 * odd, 255]),
    ];
    scene
}

/// Settings with ambient occlusion at half resolution, so that every term varies from pixel to pixel.
fn occluded(width: u32, height: u32) -> FrameSettings {
    settings(width, height).with_occlusion(SsaoSettings::default())
}

/// Checks that the terms add up to the picture. Each of them is seen somewhere, but those of `black` nowhere.
pub fn check_sum(beauty: &[DVec3], addends: &[Vec<DVec3>], black: &[Show], worst: Worst) {
    let mut worst = worst;
    for (i, whole) in beauty.iter().enumerate() {
        let sum: DVec3 = addends.iter().map(|addend| addend[i]).sum();
        let error = (sum - *whole).abs().max_element() / whole.max_element().max(1e-6);
        worst.see(error, format!("pixel {i}: {sum} is not {whole}"));
    }
    worst.finish();
    for (addend, show) in addends.iter().zip(Show::ADDENDS) {
        let lit = addend.iter().filter(|v| v.max_element() > 0.0).count();
        println!("{}: {lit} pixels", option_name(show));
        let is_right = if black.contains(&show) {
            lit == 0
        } else {
            lit > 20
        };
        assert!(is_right, "{}: {lit} pixels", option_name(show));
    }
}

/// The largest error of a sum of addends in a single frame: five float32 additions in two orders, a few roundings of 2^-24
/// relative to the picture's value.
pub fn roundings(what: &'static str) -> Worst {
    Worst::new(what, 4.0 / 16_777_216.0)
}

#[test]
fn the_addends_sum_to_the_picture() {
    let mut device = Device::new();
    let (scene, day) = (glossy_scene(), clear_day(150.0, 35.0));
    let camera = camera([1.0, 1.6, 4.5], [0.0, 0.6, 0.0]);
    let mut frame = device.frame(&scene, occluded(160, 90), &day, &camera);
    let mut shown = |show| {
        frame.show(show).expect("shown");
        device.draw(&mut frame, &day, &camera);
        let picture = device.picture_of(&frame);
        picture.pixels().map(|p| p.1).collect::<Vec<_>>()
    };
    let addends = Show::ADDENDS.map(&mut shown);
    let beauty = shown(Show::Beauty);
    let worst = roundings("sum of the addends, textured scene");
    check_sum(&beauty, &addends, &[Show::Bounces, Show::Air], worst);
}

/// The three channels of a layer of a file, in cd/m².
fn layer(file: &Exr, name: &str) -> Vec<DVec3> {
    let prefix = if name.is_empty() {
        String::new()
    } else {
        format!("{name}.")
    };
    let [r, g, b] = ["R", "G", "B"].map(|c| file.channel(&format!("{prefix}{c}")));
    let pixel = |i: usize| DVec3::new(f64::from(r[i]), f64::from(g[i]), f64::from(b[i]));
    (0..r.len()).map(pixel).collect()
}

/// Runs `skylight render` under validation and reads the picture.
fn render(arguments: &[&str]) -> Exr {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("picture.exr");
    let mut command = Command::new(env!("CARGO_BIN_EXE_skylight"));
    command.arg("render").arg("-o").arg(&path);
    command.args(["--size", "160x90", "--quiet", "--validate"]);
    if let Ok(device) = std::env::var("SKYLIGHT_TEST_DEVICE") {
        command.args(["--device", &device]);
    }
    let output = command.args(arguments).output().expect("skylight runs");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    Exr::read(&path)
}

#[test]
fn the_layers_of_a_file_sum_to_its_picture() {
    let file = render(&["--layers", "--visibility", "dome", "--samples", "2"]);
    assert_eq!(file.size, [160, 90]);
    let addends = Show::ADDENDS.map(|show| layer(&file, option_name(show)));
    // The means of the frames round, too.
    let worst = Worst::new("sum of the layers of a file", 1e-5);
    check_sum(&layer(&file, ""), &addends, &[Show::Emission], worst);
    let names = Show::INPUTS.map(option_name);
    for name in names {
        let prefix = format!("{name}.");
        let channels = file.channels.keys().filter(|c| c.starts_with(&prefix));
        assert!(channels.count() > 0, "no layer {name}");
    }
}

#[test]
fn files_are_in_candelas_and_carry_their_parameters() {
    // The sky high up and away from the sun: the values of the file, in cd/m², equal those of the CPU.
    let file = render(&[
        "--sun",
        "150,35",
        "--sky",
        "preetham",
        "--turbidity",
        "4",
        "--eye=0,500,0",
        "--target=0,600,-100",
        "--fov",
        "20",
    ]);
    let day = Daylight::new(&Conditions {
        model: SkyModel::Preetham,
        turbidity: 4.0,
        sun_azimuth_deg: 150.0,
        sun_elevation_deg: 35.0,
        ..Conditions::default()
    });
    let view = Camera {
        fov_deg: 20.0,
        ..camera([0.0, 500.0, 0.0], [0.0, 600.0, -100.0])
    };
    // Errors of the sky cube's 16-bit texels (5e-4) and of bilinear filtering.
    let mut worst = Worst::new("L of the sky in a file against the CPU's", 5e-3);
    for (i, found) in layer(&file, "").into_iter().enumerate() {
        let expected = day.radiance(pixel_ray(&view, file.size, [i % 160, i / 160]));
        worst.see((found / expected - 1.0).abs().max_element(), i);
    }
    worst.finish();
    let text = |key: &str| {
        let attribute = file.attributes.get(&format!("skylight:{key}"));
        attribute.cloned().unwrap_or_default()
    };
    println!("{:?}", file.attributes);
    assert_eq!(text("turbidity"), "4");
    assert!(text("sun elevation").starts_with("35"));
    assert!(text("sun illuminance").ends_with("lux (RGB)"));
}

/// A scene outside the view.
pub fn out_of_view() -> Scene {
    Model::default()
        .square([0.0, -50.0, 0.0], 1.0, &matt(0.5))
        .build()
}

/// A close view of the sun.
pub fn toward(direction: DVec3) -> Camera {
    Camera {
        fov_deg: 2.0,
        ..camera([0.0; 3], direction.as_vec3().to_array())
    }
}

/// Solid angle of a pixel, sr: its area on the plane at distance 1 times the cube of the cosine.
pub fn solid_angle(camera: &Camera, size: [usize; 2], pixel: [usize; 2]) -> f64 {
    let tan = (0.5 * f64::from(camera.fov_deg)).to_radians().tan();
    let edge = 2.0 * tan / size[1] as f64;
    let forward = (camera.target - camera.eye).as_dvec3().normalize();
    edge * edge * pixel_ray(camera, size, pixel).dot(forward).powi(3)
}

fn disc(device: &mut Device, day: &Daylight, limb: f32) -> DVec3 {
    let mut set = showing(Show::Background, settings(320, 320));
    set.lighting.limb_darkening = limb;
    let mut dark = day.clone();
    dark.sun_luminance = DVec3::ZERO;
    let (scene, camera) = (out_of_view(), toward(day.sun_direction));
    let with = device.picture(&scene, set, day, &camera);
    let without = device.picture(&scene, set, &dark, &camera);
    with.pixels()
        .zip(without.pixels())
        .map(|((pixel, a), (_, b))| (a - b) * solid_angle(&camera, with.size, pixel))
        .sum()
}

#[test]
fn the_suns_disc_integrates_to_its_illuminance() {
    let mut device = Device::new();
    let mut worst = Worst::new("L_sun x solid angle of the disc against E_sun", 0.01);
    for (azimuth, elevation) in [(180.0, 45.0), (80.0, 10.0), (300.0, 70.0)] {
        for limb in [0.0, 0.6] {
            let day = clear_day(azimuth, elevation);
            let found = disc(&mut device, &day, limb) * 1e3;
            let error = (found / day.sun_illuminance - 1.0).abs().max_element();
            worst.see(error, format!("sun {azimuth} {elevation}, limb {limb}"));
        }
    }
    worst.finish();
}

#[test]
fn the_disc_is_in_the_background_only() {
    let mut device = Device::new();
    let day = clear_day(180.0, 45.0);
    // The eye sees the sun's mirror image in the ground.
    let scene = Model::default().ground(50.0, &mirror()).build();
    let camera = Camera {
        fov_deg: 2.0,
        ..camera([0.0, 3.0, -3.0], [0.0, 0.0, 0.0])
    };
    let set = showing(Show::SkySpecular, settings(160, 120));
    let picture = device.picture(&scene, set, &day, &camera);
    let brightest = picture
        .pixels()
        .map(|p| p.1.max_element())
        .fold(0.0, f64::max);
    let glow = day.sky_radiance(day.sun_direction).max_element() * 1e-3;
    let disc = day.sun_luminance.max_element() * 1e-3;
    println!("mirrored sky {brightest:.1} kcd/m2, glow {glow:.1}, disc {disc:.0}");
    assert!(brightest > 0.9 * glow && brightest < 1.1 * glow);
    assert!(disc > 1000.0 * glow);
}

#[test]
fn a_mirror_shows_the_sky_in_the_mirrored_direction() {
    let mut device = Device::new();
    let day = clear_day(180.0, 40.0);
    let scene = Model::default().ground(200.0, &mirror()).build();
    let mut worst = Worst::new("L_sky(r) in a mirror against the CPU's", 5e-3);
    for (eye, target) in [
        ([0.0, 2.0, 0.0], [0.0, 0.0, -3.0]),
        ([1.0, 5.0, 2.0], [4.0, 0.0, 4.0]),
    ] {
        let camera = camera(eye, target);
        let set = showing(Show::SkySpecular, settings(160, 120));
        let picture = device.picture(&scene, set, &day, &camera);
        for (pixel, found) in picture.pixels() {
            let ray = pixel_ray(&camera, picture.size, pixel);
            // Bilinear filtering blurs the horizon (1 / cos of the zenith angle) and the glow.
            let r = DVec3::new(ray.x, -ray.y, ray.z);
            if r.y < 0.1 || r.dot(day.sun_direction) > 0.99 {
                continue;
            }
            let expected = day.radiance(r) * 1e-3;
            let error = (found / expected - 1.0).abs().max_element();
            worst.see(error, format!("{pixel:?} from {eye:?}, r {r}"));
        }
    }
    worst.finish();
}

#[test]
fn depth_and_normal_of_a_plane_are_known() {
    let mut device = Device::new();
    let scene = Model::default().ground(20.0, &matt(0.5)).build();
    // Corners are rounded to a grid of 1/256 of a pixel, which turns the plane.
    let mut depths = Worst::new("depth of a plane, relative", 1.5e-4);
    // 16 bits per axis: half a step of 2^-15 on the octahedron, stretched by up to sqrt(3) on the sphere.
    let mut normals = Worst::new("normal of a plane against +Y", 1e-4);
    for (eye, target) in [
        ([0.0, 2.0, 5.0], [0.0, 0.0, 0.0]),
        ([3.0, 8.0, -4.0], [0.0, 0.0, 1.0]),
    ] {
        let (camera, day) = (camera(eye, target), clear_day(180.0, 45.0));
        let show = |device: &mut Device, show| {
            device.picture(&scene, showing(show, settings(160, 120)), &day, &camera)
        };
        let (depth, normal) = (
            show(&mut device, Show::Depth),
            show(&mut device, Show::Normal),
        );
        for (pixel, seen) in depth.pixels() {
            let Some(p) = on_ground(&camera, depth.size, pixel) else {
                assert_eq!(seen.x, 0.0, "background");
                continue;
            };
            if p.x.abs() > 19.5 || p.z.abs() > 19.5 {
                continue;
            }
            let along = (p - camera.eye.as_dvec3()).dot(camera.forward().as_dvec3());
            depths.see(seen.x / along - 1.0, format!("{p}"));
            let n = normal.at(pixel[0], pixel[1]);
            normals.see((n - DVec3::Y).length(), format!("{p}"));
        }
    }
    depths.finish();
    normals.finish();
}

#[test]
fn the_sun_term_of_a_plane_is_lamberts() {
    let mut device = Device::new();
    let scene = Model::default().ground(20.0, &matt(0.5)).build();
    let camera = camera([0.0, 2.0, 5.0], [0.0, 0.0, 0.0]);
    // Integration without noise, so that only the illumination model is tested; 16-bit storage costs up to 2^-10.
    let mut set = settings(80, 60);
    set.irradiance.method = IrradianceMethod::Exact;
    let mut worst = Worst::new("rho/pi n.l E_sun and rho/pi E_sky of a plane", 3e-3);
    for elevation in [10.0, 35.0, 80.0] {
        let day = clear_day(140.0, elevation);
        let rho = 0.5 * 1e-3 / std::f64::consts::PI;
        let sun = day.sun_illuminance * (rho * day.sun_direction.y);
        for (show, expected) in [(Show::Sun, sun), (Show::Sky, day.sky_irradiance_up * rho)] {
            let picture = device.picture(&scene, showing(show, set), &day, &camera);
            for (pixel, found) in picture.pixels() {
                if on_ground(&camera, picture.size, pixel).is_some_and(|p| p.z > -10.0) {
                    let error = (found / expected - 1.0).abs().max_element();
                    worst.see(error, format!("{show:?} {pixel:?}, sun at {elevation}"));
                }
            }
        }
    }
    worst.finish();
}

/// Mean of frames 0..count, alternating between two pictures.
fn mean_of(device: &mut Device, frames: [&skylight::gpu::Image; 2], count: u32) -> Picture {
    let size = frames[0].size();
    let mut mean = Accumulate::new(&device.context, size).expect("a mean");
    for index in 0..count {
        device.run(|rec| {
            mean.record(rec, frames[index as usize % 2], index);
        });
    }
    Picture {
        size: size.map(|edge| edge as usize),
        texels: device.read(mean.image()),
    }
}

#[test]
fn the_mean_of_frames_is_their_mean() {
    let mut device = Device::new();
    let (scene, camera) = (glossy_scene(), camera([1.0, 1.6, 4.5], [0.0, 0.6, 0.0]));
    let [one, two] = [30.0, 60.0].map(|elevation| {
        device.frame(
            &scene,
            occluded(96, 54),
            &clear_day(150.0, elevation),
            &camera,
        )
    });
    let (a, b) = (device.picture_of(&one), device.picture_of(&two));
    let same = mean_of(&mut device, [one.radiance(), one.radiance()], 16);
    assert_eq!(same.texels, a.texels, "16 times the same is the same");
    let mixed = mean_of(&mut device, [one.radiance(), two.radiance()], 64);
    // Each step rounds once, and later steps reduce that error: a few roundings of 2^-24.
    let mut worst = Worst::new("mean of 64 frames, two in turn", 8.0 / 16_777_216.0);
    for (pixel, found) in mixed.pixels() {
        let (a, b) = (a.at(pixel[0], pixel[1]), b.at(pixel[0], pixel[1]));
        let error = (found - 0.5 * (a + b)).abs().max_element();
        worst.see(
            error / a.max_element().max(b.max_element()),
            format!("{pixel:?}"),
        );
    }
    worst.finish();
}

#[test]
fn samples_change_nothing_where_nothing_varies() {
    let mut device = Device::new();
    let scene = Model::default().cube([0.0; 3], 0.8, &matt(1.0)).build();
    let mut set = settings(96, 54);
    set.samples = 16;
    let picture = device.picture(
        &scene,
        set,
        &constant_sky(1000.0),
        &camera([2.0, 1.5, 2.5], [0.0; 3]),
    );
    let mut worst = Worst::new("16 jittered samples in the furnace against 1", 5e-3);
    for (pixel, value) in picture.pixels() {
        worst.see((value - 1.0).abs().max_element(), format!("{pixel:?}"));
    }
    worst.finish();
}
