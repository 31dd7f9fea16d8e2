//! Materials that reflect by GGX: white furnace, the sun's lobe against the CPU, and a sky hidden by what stands before it.

use glam::DVec3;
use skylight::daylight::colour::luminance;
use skylight::daylight::microfacet::{Albedo, lobe};
use skylight::frame::{Frame, FrameSettings, Visibility};
use skylight::passes::bounces::cells::Bounces;
use skylight::passes::light::lighting::{Ambient, Show};
use skylight::scene::{Camera, Encoding, Material, Microfacet, Texture};

use crate::common::Worst;
use crate::gpu::{
    Device, Model, Picture, camera, clear_day, constant_sky, glowing, matt, pixel_ray, settings,
    showing,
};
use crate::lighting::check_sum;

/// Luminance of the uniform sky, cd/m².
const L: f64 = 5000.0;

fn surface(base: [f32; 3], metallic: f32, roughness: f32) -> Material {
    Material {
        microfacet: Some(Microfacet {
            base,
            f0: [0.04; 3],
            f90: 1.0,
            metallic,
            roughness,
            texture: None,
        }),
        ..matt(0.0)
    }
}

fn white_metal(roughness: f32) -> Material {
    surface([1.0; 3], 1.0, roughness)
}

/// Single frames from screen space and from the cells, and a converging picture.
fn modes(size: u32, samples: u32) -> [(&'static str, FrameSettings); 3] {
    let screen = settings(size, size);
    let mut cells = screen;
    cells.lighting.ambient = Ambient::Cells;
    let mut converging = screen;
    converging.sampling.visibility = Visibility::Dome;
    converging.sampling.dome.directions = 1;
    converging.sampling.dome.map_edge = 64;
    converging.samples = samples;
    [
        ("screen space", screen),
        ("cells", cells),
        ("converging", converging),
    ]
}

/// Distance between the samples of a row of materials, metres.
const APART: f32 = 20.0;

/// A camera that looks at sample number `k` of a row at an angle from its normal, from the side of +X.
fn from_angle(k: usize, degrees: f64) -> Camera {
    let (s, c) = degrees.to_radians().sin_cos();
    let target = DVec3::new(0.0, 0.0, f64::from(APART) * k as f64);
    let eye = target + 3.0 * DVec3::new(s, c, 1e-3);
    Camera {
        fov_deg: 2.0,
        ..camera(eye.as_vec3().to_array(), target.as_vec3().to_array())
    }
}

/// Mean luminance of a picture, in luminances of the sky.
fn mean(picture: &Picture) -> f64 {
    let sum: f64 = picture.pixels().map(|(_, rgb)| luminance(rgb)).sum();
    1e3 * sum / (picture.texels.len() as f64 * L)
}

#[test]
fn white_surfaces_in_a_white_furnace_are_not_seen() {
    let mut device = Device::new();
    let mut worst = Worst::new("white furnace", 0.01);
    let roughnesses = [0.05, 0.3, 0.6, 1.0];
    let samples = [0.0, 1.0].map(|metallic| roughnesses.map(|r| (metallic, r)));
    let mut scene = Model::default();
    for (k, (metallic, roughness)) in samples.iter().flatten().enumerate() {
        let white = surface([1.0; 3], *metallic, *roughness);
        scene = scene.square([0.0, 0.0, APART * k as f32], 1.0, &white);
    }
    let scene = scene.build();
    for (name, set) in modes(8, 48) {
        let mut frame = device.run(|rec| Frame::new(rec, &scene, set).expect("a frame"));
        for (k, sample) in samples.iter().flatten().enumerate() {
            for degrees in [0.0, 60.0, 85.0] {
                device.draw(&mut frame, &constant_sky(L), &from_angle(k, degrees));
                let seen = mean(&device.picture_of(&frame));
                let what = format!("{name}, metal and roughness {sample:?}, {degrees}°: {seen}");
                worst.see((seen - 1.0).abs(), what);
            }
        }
    }
    worst.finish();
}

#[test]
fn the_suns_highlight_is_the_lobe() {
    let mut device = Device::new();
    let day = clear_day(90.0, 50.0);
    let sun = day.direct_light();
    let set = showing(Show::SunSpecular, settings(24, 24));
    // North and south are symmetric; the sun is in the east and the eye in the west.
    let view = camera([-2.0, 2.0, 0.0], [0.0; 3]);
    let mut worst = Worst::new("highlight of the sun", 0.01);
    for roughness in [0.05f32, 0.2, 0.5, 1.0] {
        let scene = Model::default()
            .ground(50.0, &surface([0.2; 3], 0.0, roughness))
            .build();
        let picture = device.picture(&scene, set, &day, &view);
        let alpha = f64::from(roughness).powi(2);
        // Y and Z change places: the lobe is about +Z.
        let local = |d: DVec3| DVec3::new(d.x, -d.z, d.y);
        let mut seen = 0;
        for (pixel, found) in picture.pixels() {
            let v = local(-pixel_ray(&view, picture.size, pixel));
            let l = local(sun.direction);
            let along = v.dot((v + l).normalize());
            let fresnel = 0.04 + 0.96 * (1.0 - along).powi(5);
            let gain = Albedo::of(f64::from(roughness), v.z).gain(0.04);
            let expected = fresnel * gain * lobe(alpha, v, l) * l.z * luminance(sun.illuminance);
            if expected > 1.0 {
                let error = 1e3 * luminance(found) / expected - 1.0;
                worst.see(error.abs(), format!("roughness {roughness}, {pixel:?}"));
                seen += 1;
            }
        }
        assert!(seen > 20, "roughness {roughness}: {seen} pixels");
    }
    worst.finish();
}

#[test]
fn a_closed_metal_box_is_black_inside() {
    let mut device = Device::new();
    let roughnesses = [0.0, 1.0];
    let mut scene = Model::default();
    for (k, roughness) in roughnesses.iter().enumerate() {
        scene = scene.cube([APART * k as f32, 0.0, 0.0], 1.0, &white_metal(*roughness));
    }
    let scene = scene.build();
    for (name, mut set) in modes(12, 4) {
        for bounces in [Bounces::UpTo(0), Bounces::All] {
            set.bounces = bounces;
            let mut frame = device.run(|rec| Frame::new(rec, &scene, set).expect("a frame"));
            for (k, roughness) in roughnesses.iter().enumerate() {
                let x = APART * k as f32;
                let view = camera([x + 0.5, 0.2, 0.6], [x - 1.0, -0.6, -0.8]);
                device.draw(&mut frame, &constant_sky(L), &view);
                let seen = mean(&device.picture_of(&frame));
                assert!(seen < 1e-6, "{name}, {bounces:?}, {roughness}: {seen}");
            }
        }
    }
}

/// The part of a white metal's reflection from directions with x > 0, by nodes over the hemisphere.
fn from_positive_x(roughness: f64, v: DVec3) -> f64 {
    let alpha = roughness * roughness;
    let (rings, turns) = (400, 800);
    let mut sum = 0.0;
    for i in 0..rings {
        let z = (f64::from(i) + 0.5) / f64::from(rings);
        let sine = (1.0 - z * z).sqrt();
        for k in 0..turns {
            let (s, c) =
                (std::f64::consts::PI * ((f64::from(k) + 0.5) / f64::from(turns) - 0.5)).sin_cos();
            sum += lobe(alpha, v, DVec3::new(c * sine, s * sine, z)) * z;
        }
    }
    let gain = Albedo::of(roughness, v.z).gain(1.0);
    gain * sum * std::f64::consts::PI / f64::from(rings * turns)
}

#[test]
fn a_wall_hides_its_half_of_the_sky_from_a_lobe() {
    let mut device = Device::new();
    let mut worst = Worst::new("lobe beside a wall", 0.01);
    let [_, _, (_, set)] = modes(8, 24);
    let roughnesses = [0.0, 0.5f64.sqrt(), 1.0];
    // A wall at x = -4, nearly without end; black, and then as bright as the sky.
    for (wall, bounces) in [
        (matt(0.0), Bounces::UpTo(0)),
        (glowing(0.0, L as f32), Bounces::All),
    ] {
        let far = [[-4.0, 0.0, -2e3], [0.0, 2e3, 0.0], [0.0, 0.0, 4e3]];
        let mut scene = Model::default().quad(far[0], far[1], far[2], &wall);
        for (k, roughness) in roughnesses.iter().enumerate() {
            let at = [0.0, 0.0, APART * k as f32];
            scene = scene.square(at, 0.3, &white_metal(*roughness as f32));
        }
        let set = FrameSettings { bounces, ..set };
        let scene = scene.build();
        let mut frame = device.run(|rec| Frame::new(rec, &scene, set).expect("a frame"));
        for (k, roughness) in roughnesses.iter().enumerate() {
            for degrees in [-50.0, -20.0, 20.0, 50.0f64] {
                let (s, c) = degrees.to_radians().sin_cos();
                let expected = match (wall.is_emissive(), *roughness == 0.0) {
                    (true, _) => 1.0,
                    (false, true) => f64::from(u8::from(s < 0.0)),
                    (false, false) => from_positive_x(*roughness, DVec3::new(s, 0.0, c)),
                };
                device.draw(&mut frame, &constant_sky(L), &from_angle(k, degrees));
                let seen = mean(&device.picture_of(&frame));
                let what = format!("roughness {roughness:.2}, {degrees}°, {bounces:?}: {seen}");
                worst.see((seen - expected).abs(), what);
            }
        }
    }
    worst.finish();
}

#[test]
fn addends_of_rough_surfaces_sum_to_the_picture() {
    let mut device = Device::new();
    let scene = Model::default()
        .ground(6.0, &surface([0.4, 0.3, 0.2], 0.0, 0.5))
        .sphere(
            [0.0, 1.0, 0.0],
            1.0,
            16,
            &surface([0.9, 0.7, 0.3], 1.0, 0.3),
        )
        .build();
    let day = clear_day(150.0, 35.0);
    let view = camera([1.0, 1.6, 4.5], [0.0, 0.6, 0.0]);
    let [_, cells, converging] = modes(32, 3);
    for (name, mut set) in [cells, converging] {
        set.bounces = Bounces::All;
        let mut frame = device.run(|rec| Frame::new(rec, &scene, set).expect("a frame"));
        let mut shown = |show| {
            frame.show(show).expect("shown");
            device.draw(&mut frame, &day, &view);
            let picture = device.picture_of(&frame);
            picture.pixels().map(|p| p.1).collect::<Vec<_>>()
        };
        let addends = Show::ADDENDS.map(&mut shown);
        let worst = Worst::new("sum of the addends, rough surfaces", 2e-6);
        println!("{name}");
        check_sum(
            &shown(Show::Beauty),
            &addends,
            &[Show::Emission, Show::Air],
            worst,
        );
    }
}

#[test]
fn a_texture_scales_roughness_and_metalness() {
    let mut device = Device::new();
    let [_, (_, set), _] = modes(16, 1);
    let (day, view) = (clear_day(90.0, 50.0), camera([-2.0, 2.0, 0.0], [0.0; 3]));
    let plain = surface([0.8, 0.5, 0.2], 0.5, 0.2);
    let mapped = Material {
        microfacet: Some(Microfacet {
            texture: Some(0),
            metallic: 1.0,
            roughness: 0.2 * 255.0 / 102.0,
            ..plain.microfacet.expect("a surface of microfacets")
        }),
        ..plain.clone()
    };
    let texture = Texture {
        name: "roughness".into(),
        width: 1,
        height: 1,
        rgba8: vec![9, 102, 128, 77],
        encoding: Encoding::Linear,
        wrap: Default::default(),
    };
    let [plain, mapped] = [plain, mapped].map(|material| {
        let mut scene = Model::default().ground(5.0, &material).build();
        scene.textures.push(texture.clone());
        device.picture(&scene, set, &day, &view)
    });
    let mut worst = Worst::new("roughness and metalness by a texture", 0.01);
    for (pixel, expected) in plain.pixels() {
        let error = (mapped.at(pixel[0], pixel[1]) / expected - 1.0)
            .abs()
            .max_element();
        worst.see(error, format!("{pixel:?}"));
    }
    worst.finish();
}
