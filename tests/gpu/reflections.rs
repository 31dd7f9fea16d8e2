//! Specular reflection: energy balance of the normalised lobe, and occlusion of the sky in reflections.

use std::f64::consts::PI;

use crate::gpu::{
    Device, Model, camera, clear_day, constant_sky, on_ground, pixel_ray, settings, showing,
};
use crate::room::{ROOM, room, under_the_roof};
use glam::DVec3;
use skylight::daylight::colour::luminance;
use skylight::frame::{FrameSettings, Visibility};
use skylight::passes::dome::specular::{Mirrors, Phong, Reflections};
use skylight::passes::light::lighting::Show;
use skylight::scene::Material;

/// A purely specular material.
fn mirror(rho_s: f32, shininess: f32) -> Material {
    Material {
        diffuse: [0.0; 3],
        specular: [rho_s; 3],
        shininess,
        ..Material::default()
    }
}

fn with(phong: Phong, reflections: Reflections, mut set: FrameSettings) -> FrameSettings {
    set.lighting.mirrors = Mirrors { phong, reflections };
    if reflections == Reflections::Hidden {
        set.sampling.visibility = Visibility::Dome;
    }
    set
}

#[test]
fn a_normalised_lobe_reflects_its_share_head_on_and_never_more() {
    const L: f64 = 5000.0;
    let mut device = Device::new();
    for shininess in [1.0, 20.0, 400.0] {
        let scene = Model::default()
            .ground(50.0, &mirror(0.4, shininess))
            .build();
        for reflections in [Reflections::Open, Reflections::Hidden] {
            let mut set = showing(Show::SkySpecular, settings(32, 32));
            set.samples = 16;
            set = with(Phong::Normalized, reflections, set);
            // Straight down, and at a shallow angle over the ground.
            for (target, is_head_on) in [([0.0, 0.0, -0.01], true), ([0.0, 1.0, -3.0], false)] {
                let view = camera([0.0, 2.0, 0.0], target);
                let picture = device.picture(&scene, set, &constant_sky(L), &view);
                let share = 1e3 * luminance(picture.at(16, 16)) / (0.4 * L);
                println!(
                    "p = {shininess}, {reflections:?}, head-on {is_head_on}: {share:.4} of rho_s L"
                );
                if is_head_on {
                    assert!((share - 1.0).abs() < 0.01, "{share}");
                }
                assert!(share < 1.01 && share > 0.15, "{share}");
            }
        }
    }
}

#[test]
fn the_normalised_highlight_of_the_sun_is_the_lobe_times_the_cosine() {
    let mut device = Device::new();
    let (rho_s, p) = (0.3, 30.0f32);
    let scene = Model::default().ground(50.0, &mirror(rho_s, p)).build();
    let day = clear_day(180.0, 50.0);
    // The sun is in the south, the eye north of the centre.
    let view = camera([0.0, 2.0, -2.0], [0.0, 0.0, 0.0]);
    let set = showing(Show::SunSpecular, settings(24, 24));
    let lecture = device.picture(&scene, set, &day, &view);
    let normalised = device.picture(
        &scene,
        with(Phong::Normalized, Reflections::Open, set),
        &day,
        &view,
    );
    let scale = (f64::from(p) + 2.0) / (2.0 * PI) * 50f64.to_radians().sin();
    let mut seen = 0;
    for (pixel, a) in lecture.pixels() {
        let (a, b) = (luminance(a), luminance(normalised.at(pixel[0], pixel[1])));
        if a > 1e-3 {
            assert!((b / a / scale - 1.0).abs() < 2e-3, "{pixel:?} {a} {b}");
            seen += 1;
        }
    }
    assert!(seen > 50, "{seen}");
}

/// Where the reflection vector of a floor pixel meets the roof.
fn on_the_roof(
    view: &skylight::scene::Camera,
    size: [usize; 2],
    pixel: [usize; 2],
) -> Option<DVec3> {
    let (p, ray) = (on_ground(view, size, pixel)?, pixel_ray(view, size, pixel));
    let half = f64::from(ROOM[0]);
    (p.x.abs().max(p.z.abs()) < half - 0.1)
        .then(|| p + ray * DVec3::new(1.0, -1.0, 1.0) * (f64::from(ROOM[1]) / -ray.y))
}

#[test]
fn a_mirror_on_the_floor_shows_the_sky_in_the_opening_and_nowhere_else() {
    const L: f64 = 5000.0;
    let mut device = Device::new();
    let mut set = showing(Show::SkySpecular, settings(96, 96));
    set.samples = 128;
    let (view, scene) = (under_the_roof(), room(ROOM[2], &mirror(0.5, 1000.0)));
    let hidden = device.picture(
        &scene,
        with(Phong::Lecture, Reflections::Hidden, set),
        &constant_sky(L),
        &view,
    );
    let open = device.picture(&scene, set, &constant_sky(L), &view);
    let edge = f64::from(ROOM[2]);
    let (mut sky, mut roof) = (Vec::new(), Vec::new());
    for (pixel, l) in hidden.pixels() {
        let Some(at) = on_the_roof(&view, hidden.size, pixel) else {
            continue;
        };
        let share = 1e3 * luminance(l) / (0.5 * L);
        let whole = 1e3 * luminance(open.at(pixel[0], pixel[1])) / (0.5 * L);
        assert!(
            (whole - 1.0).abs() < 2e-3,
            "the open mirror has all of it: {whole}"
        );
        let from_middle = at.x.abs().max(at.z.abs());
        // The lobe is some degrees wide: half a metre at the roof.
        if from_middle < edge - 0.4 {
            sky.push(share)
        } else if from_middle > edge + 0.6 {
            roof.push(share)
        }
    }
    let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
    println!(
        "sky {:.3} of {} pixels, roof {:.4} of {}",
        mean(&sky),
        sky.len(),
        mean(&roof),
        roof.len()
    );
    assert!(
        sky.len() > 20 && roof.len() > 500,
        "{} {}",
        sky.len(),
        roof.len()
    );
    assert!(
        (mean(&sky) - 1.0).abs() < 0.03 && mean(&roof) < 0.01,
        "{} {}",
        mean(&sky),
        mean(&roof)
    );
}

#[test]
fn addends_under_the_dome_sum_to_the_picture() {
    let mut device = Device::new();
    let paint = Material {
        diffuse: [0.5, 0.4, 0.3],
        ..mirror(0.3, 40.0)
    };
    let scene = Model::default()
        .ground(8.0, &paint)
        .cube([0.0, 1.0, 0.0], 1.0, &paint)
        .build();
    let (day, view) = (
        clear_day(150.0, 30.0),
        camera([4.0, 2.5, 5.0], [0.0, 0.7, 0.0]),
    );
    let mut set = with(Phong::Normalized, Reflections::Hidden, settings(48, 32));
    set.samples = 8;
    let whole = device.picture(&scene, set, &day, &view);
    let parts = Show::ADDENDS.map(|show| device.picture(&scene, showing(show, set), &day, &view));
    for (pixel, l) in whole.pixels() {
        let sum: DVec3 = parts.iter().map(|part| part.at(pixel[0], pixel[1])).sum();
        let error = (sum - l).abs().max_element();
        assert!(error <= 1e-5 * l.max_element(), "{pixel:?} {sum} {l}");
    }
}
