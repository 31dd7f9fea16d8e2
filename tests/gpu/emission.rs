//! Surfaces that emit light: what they show, and their light on other surfaces, from rays in converged pictures and from the cells in
//! single frames, against closed forms.

use glam::DVec3;
use skylight::daylight::colour::luminance;
use skylight::frame::FrameSettings;
use skylight::passes::bounces::cells::Bounces;
use skylight::passes::light::lighting::Show;
use skylight::scene::{Camera, Encoding, Material, Scene, Texture, Wrap};
use skylight::validate::surfaces::{self, within_the_box};

use crate::bounces::{converged, mean, single, with_bounces};
use crate::common::Worst;
use crate::gpu::{
    Device, Model, Picture, camera, closed_box, constant_sky, glowing, matt, on_ground,
    polygon_irradiance, settings, showing,
};

/// A picture after `previews` frames that each add paths to the cells.
fn previewed(
    device: &mut Device,
    scene: &Scene,
    set: FrameSettings,
    view: &Camera,
    previews: u32,
) -> Picture {
    surfaces::previewed(device, scene, set, view, previews).expect("drawn")
}

/// Settings of a converged picture under a black sky, whose maps need not be fine.
fn by_lamps(width: u32, height: u32, samples: u32) -> FrameSettings {
    let mut set = converged(width, height, samples);
    set.sampling.dome.directions = 1;
    set.sampling.dome.map_edge = 64;
    set
}

/// Every view is (1 - ρ^(N+1))/(1 - ρ) times as bright as what the walls emit.
#[test]
fn a_glowing_box_has_the_light_of_all_bounces_and_of_few() {
    let mut device = Device::new();
    let (day, view) = (constant_sky(0.0), within_the_box());
    for (reflectance, bounces) in [
        (0.5, Bounces::UpTo(0)),
        (0.5, Bounces::UpTo(3)),
        (0.5, Bounces::All),
        (0.9, Bounces::UpTo(2)),
        (0.9, Bounces::All),
    ] {
        let scene = closed_box(2.0, &glowing(reflectance, 1000.0));
        let rho = f64::from(reflectance);
        let expected = match bounces {
            Bounces::All => 1.0 / (1.0 - rho),
            Bounces::UpTo(n) => (1.0 - rho.powi(n as i32 + 1)) / (1.0 - rho),
        };
        let set = with_bounces(bounces, by_lamps(24, 16, 32));
        let rays = mean(&device.picture(&scene, set, &day, &view)) / expected;
        let set = with_bounces(bounces, single(24, 16));
        let cells = mean(&previewed(&mut device, &scene, set, &view, 64)) / expected;
        println!(
            "reflectance {reflectance}, {bounces:?}: {expected:.4} kcd/m2; rays {rays:.5}, cells {cells:.5} of it"
        );
        // A mean of few pictures holds the first ones, whose cells have had time for some twenty of the white room's bounces.
        let limit = if reflectance > 0.8 && bounces == Bounces::All {
            0.03
        } else {
            0.005
        };
        assert!((rays - 1.0).abs() < limit, "{bounces:?}: {rays}");
        assert!((cells - 1.0).abs() < 0.005, "{bounces:?}: {cells}");
    }
}

/// A lamp over a plane: half its edge, its height above the plane, metres, and its luminance, cd/m².
const LAMPS: [(f32, f32, f32); 2] = [(0.6, 1.5, 2000.0), (0.05, 2.0, 1e5)];

#[test]
fn a_square_lights_a_plane_as_lambert_says() {
    let mut device = Device::new();
    let (day, view) = (constant_sky(0.0), camera([0.0, 1.2, 5.0], [0.0, 0.0, 0.0]));
    for (half, height, emission) in LAMPS {
        let scene = Model::default()
            .ground(4.0, &matt(0.5))
            .square([0.0, height, 0.0], half, &glowing(0.0, emission))
            .build();
        let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, z)| {
            let half = f64::from(half);
            DVec3::new(x * half, height.into(), z * half)
        });
        let expected =
            |p: DVec3| 1e-3 * f64::from(emission) * polygon_irradiance(&corners, p, DVec3::Y);
        // One bounce: the light is that of the rays alone, without a share of the cells.
        let set = with_bounces(Bounces::UpTo(1), by_lamps(96, 64, 128));
        let set = showing(Show::Irradiance, set);
        let rays = device.picture(&scene, set, &day, &view);
        let set = showing(Show::Irradiance, single(96, 64));
        let cells = previewed(&mut device, &scene, set, &view, 64);
        // A cell looks from two of its points, not from all.
        for (what, picture, limit) in [("rays", rays, 0.02), ("cells", cells, 0.06)] {
            let mut worst = Worst::new(
                "blocks of pixels on the plane against Lambert's formula",
                limit,
            );
            for at in [[8, 40], [24, 48], [40, 36], [44, 52], [64, 44], [80, 56]] {
                let (mut lit, mut due) = (0.0, 0.0);
                for [x, y] in (0..64).map(|i| [at[0] + i % 8, at[1] + i / 8]) {
                    let point = on_ground(&view, picture.size, [x, y]).expect("the plane");
                    lit += luminance(picture.at(x, y));
                    due += expected(point);
                }
                println!("{what}, half edge {half}, {at:?}: {:.4}", lit / due);
                worst.see((lit / due - 1.0).abs(), format!("{what} {half} {at:?}"));
            }
            worst.finish();
        }
    }
}

/// A panel that fills the view, with an emissive texture or without.
fn panel(lamp: &Material) -> Scene {
    let mut scene = Model::default()
        .quad([-1.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], lamp)
        .build();
    scene.textures = vec![Texture {
        name: "red and blue".into(),
        width: 64,
        height: 1,
        rgba8: [[255, 0, 0, 255], [0, 0, 188, 255]]
            .concat()
            .chunks(4)
            .flat_map(|texel| texel.repeat(32))
            .collect(),
        encoding: Encoding::Srgb,
        wrap: Default::default(),
    }];
    scene
}

#[test]
fn a_panel_shows_what_it_emits_and_nothing_more_at_night() {
    let mut device = Device::new();
    let (day, view) = (constant_sky(0.0), camera([0.0, 1.0, 1.9], [0.0, 1.0, 0.0]));
    let plain = glowing(0.8, 3000.0);
    let mapped = Material {
        emissive_texture: Some(0),
        ..plain.clone()
    };
    for (what, set) in [
        ("single", settings(32, 32)),
        ("converged", converged(32, 32, 4)),
    ] {
        let set = with_bounces(Bounces::UpTo(0), set);
        for show in [Show::Beauty, Show::Emission] {
            let whole = device.picture(&panel(&plain), showing(show, set), &day, &view);
            let halves = device.picture(&panel(&mapped), showing(show, set), &day, &view);
            let (left, right) = (halves.at(8, 16), halves.at(24, 16));
            println!(
                "{what} {show:?}: {}, left {left}, right {right}",
                whole.at(16, 16)
            );
            assert!((whole.at(16, 16) - 3.0).abs().max_element() < 1e-4);
            assert!(
                (left - DVec3::new(3.0, 0.0, 0.0)).abs().max_element() < 0.01,
                "{left}"
            );
            // sRGB 188 is 0.503 in linear light.
            assert!(
                (right - DVec3::new(0.0, 0.0, 1.508)).abs().max_element() < 0.01,
                "{right}"
            );
        }
        let dark = device.picture(&panel(&plain), showing(Show::Bounces, set), &day, &view);
        assert_eq!(mean(&dark), 0.0, "{what}");
    }
}

#[test]
fn a_texture_is_repeated_mirrored_or_clamped_outside_of_its_picture() {
    let mut device = Device::new();
    let (day, view) = (constant_sky(0.0), camera([0.0, 1.0, 1.9], [0.0, 1.0, 0.0]));
    let lamp = Material {
        emissive_texture: Some(0),
        ..glowing(0.0, 3000.0)
    };
    let set = showing(
        Show::Emission,
        with_bounces(Bounces::UpTo(0), settings(32, 32)),
    );
    for (wrap, reds) in [
        (Wrap::Repeat, [true, false]),
        (Wrap::Mirror, [false, true]),
        (Wrap::Clamp, [false, false]),
    ] {
        let mut scene = panel(&lamp);
        scene.textures[0].wrap = [wrap, Wrap::Repeat];
        scene.texcoords.iter_mut().for_each(|uv| uv[0] *= 2.0);
        let picture = device.picture(&scene, set, &day, &view);
        // u = 1.25 and 1.7: the left and the right half of the picture's second copy.
        let found = [21, 30].map(|x| picture.at(x, 16)).map(|l| l.x > l.z);
        assert_eq!(found, reds, "{wrap:?}");
        assert!(picture.at(4, 16).x > 2.9, "within the picture: {wrap:?}");
    }
}

#[test]
fn without_bounces_lamps_glow_but_light_nothing() {
    let mut device = Device::new();
    let scene = Model::default()
        .ground(4.0, &matt(0.5))
        .square([0.0, 1.0, 0.0], 0.3, &glowing(0.0, 1e5))
        .build();
    let (day, view) = (constant_sky(0.0), camera([0.0, 1.8, 5.0], [0.0, 0.3, 0.0]));
    for (what, set) in [
        ("single", single(48, 32)),
        ("converged", converged(48, 32, 4)),
    ] {
        let set = with_bounces(Bounces::UpTo(0), set);
        let lamp = device.picture(&scene, showing(Show::Emission, set), &day, &view);
        let whole = device.picture(&scene, set, &day, &view);
        assert!(mean(&lamp) > 0.0, "{what}");
        assert_eq!(lamp.texels.len(), whole.texels.len());
        let differ = lamp.pixels().filter(|([x, y], l)| whole.at(*x, *y) != *l);
        assert_eq!(differ.count(), 0, "{what}");
    }
}
