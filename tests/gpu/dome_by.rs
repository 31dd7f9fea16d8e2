//! The sky's visibility by maps and by rays: both ways make the same picture, and rays leak no light.

use std::f64::consts::PI;

use glam::DVec3;
use skylight::daylight::colour::luminance;
use skylight::daylight::quadrature::SphereQuadrature;
use skylight::frame::FrameSettings;
use skylight::passes::dome::route::DomeBy;
use skylight::passes::light::lighting::Show;
use skylight::scene::{Encoding, Material, Scene, Texture, Wrap};

use crate::dome::dome;
use crate::gpu::{Device, Model, camera, clear_day, constant_sky, glass, matt, on_ground, showing};
use crate::room::{ROOM, configuration_factor, room, under_the_roof};

fn by(by: DomeBy, mut set: FrameSettings) -> FrameSettings {
    set.sampling.dome.by = by;
    showing(Show::Irradiance, set)
}

/// A body on the ground, a leaf with a hole of half its width and a pane of glass over it.
fn garden() -> Scene {
    let leaf = Material {
        alpha_cutoff: Some(0.5),
        diffuse_texture: Some(0),
        ..matt(0.5)
    };
    let mut scene = Model::default()
        .ground(8.0, &matt(0.5))
        .cube([0.0, 1.0, 0.0], 1.0, &matt(0.7))
        .square([-2.5, 1.5, 1.0], 1.2, &leaf)
        .square([2.5, 1.5, 1.0], 1.2, &glass([0.3; 3]))
        .build();
    let alpha = |i: usize| if (i % 4) / 2 == (i / 8) % 2 { 255 } else { 0 };
    scene.textures = vec![Texture {
        name: String::from("leaf"),
        width: 4,
        height: 4,
        rgba8: (0..16).flat_map(|i| [255, 255, 255, alpha(i)]).collect(),
        encoding: Encoding::Srgb,
        wrap: [Wrap::Clamp; 2],
    }];
    scene
}

#[test]
fn maps_and_rays_make_the_same_picture_with_cut_outs_and_panes() {
    let mut device = Device::new();
    let (scene, day) = (garden(), clear_day(150.0, 50.0));
    let view = camera([0.5, 5.0, 7.0], [0.0, 0.5, 0.0]);
    let [maps, rays] = [DomeBy::Maps, DomeBy::Rays]
        .map(|way| device.picture(&scene, by(way, dome(96, 16)), &day, &view));
    let pairs: Vec<(f64, f64)> = maps
        .pixels()
        .zip(rays.pixels())
        .map(|((_, a), (_, b))| (luminance(a), luminance(b)))
        .collect();
    let count = pairs.len() as f64;
    let mean = pairs.iter().map(|(a, _)| a).sum::<f64>() / count;
    let ratio = pairs.iter().map(|(_, b)| b).sum::<f64>() / count / mean;
    let square = |(a, b): &(f64, f64)| (a - b).powi(2);
    let rmse = (pairs.iter().map(square).sum::<f64>() / count).sqrt() / mean;
    println!("rays: {ratio:.4} of the light of maps, RMSE/mean {rmse:.4}");
    // Texels of the maps blur edges; directions and points of the sun are the same.
    assert!((ratio - 1.0).abs() < 5e-3 && rmse < 0.03, "{ratio} {rmse}");
}

#[test]
fn rays_leave_a_closed_room_black() {
    let mut device = Device::new();
    let (scene, view) = (room(0.0, &matt(0.8)), under_the_roof());
    let set = by(DomeBy::Rays, dome(96, 16));
    for day in [constant_sky(5000.0), clear_day(150.0, 50.0)] {
        let picture = device.picture(&scene, set, &day, &view);
        let brightest = picture
            .pixels()
            .map(|(_, e)| luminance(e))
            .fold(0.0, f64::max);
        assert!(brightest == 0.0, "{brightest} klx");
    }
}

#[test]
fn rays_find_the_light_of_an_opening() {
    const L: f64 = 5000.0;
    let mut device = Device::new();
    let (view, day) = (under_the_roof(), constant_sky(L));
    let set = by(DomeBy::Rays, dome(64, 128));
    let picture = device.picture(&room(ROOM[2], &matt(0.8)), set, &day, &view);
    let (mut found, mut exact) = (0.0, 0.0);
    for (pixel, e) in picture.pixels() {
        let ground = on_ground(&view, picture.size, pixel);
        // Without the foot of the wall, which is a pixel or two wide here.
        let is_inside = |p: &DVec3| p.x.abs().max(p.z.abs()) < f64::from(ROOM[0]) - 0.1;
        if let Some(p) = ground.filter(is_inside) {
            found += 1000.0 * luminance(e);
            exact += PI * L * configuration_factor(p);
        }
    }
    println!("floor: {:.4} of the light by the factor", found / exact);
    assert!((found / exact - 1.0).abs() < 0.01, "{}", found / exact);
}

/// A wide ground shadows nothing from above, so maps leave it out; light from below must not pass it.
#[test]
fn the_light_of_the_far_ground_does_not_pass_the_ground_of_the_model() {
    let mut device = Device::new();
    let scene = Model::default()
        .ground(40.0, &matt(0.1))
        .cube([0.0, 1.0, 0.0], 1.0, &matt(0.7))
        .build();
    let day = clear_day(150.0, 50.0);
    let view = camera([0.0, 1.0, 3.0], [0.0, 1.0, 0.0]);
    for way in [DomeBy::Maps, DomeBy::Rays] {
        let set = showing(Show::Sky, by(way, dome(16, 64)));
        let picture = device.picture(&scene, set, &day, &view);
        let wall = luminance(picture.at(8, 8));
        // Half of the sky is before a wall: its light on the wall without any from below.
        let of_sky =
            SphereQuadrature::upper(128, 256).irradiance(DVec3::Z, |d| day.sky_radiance(d));
        let of_sky = luminance(of_sky) * 0.7 / PI * 1e-3;
        assert!(
            (wall / of_sky - 1.0).abs() < 0.02,
            "{way:?}: {wall} {of_sky}"
        );
    }
}

/// A canopy of leaves much smaller than the texels of a map, which cover a quarter of it.
#[test]
fn leaves_finer_than_a_map_dim_the_sky_by_what_they_cover() {
    const L: f64 = 5000.0;
    const EDGE: u32 = 1024;
    let mut device = Device::new();
    let leaves = Material {
        alpha_cutoff: Some(0.5),
        diffuse_texture: Some(0),
        ..matt(0.5)
    };
    let mut scene = Model::default()
        .ground(8.0, &matt(0.5))
        .square([0.0, 1.0, 0.0], 8.0, &leaves)
        .build();
    // By chance, four texels wide: the linear filter rounds their corners off.
    let is_leaf = |i: u32| {
        let leaf = i % EDGE / 4 + i / EDGE / 4 * EDGE;
        (leaf ^ leaf >> 9).wrapping_mul(0x9e37_79b1) >> 30 == 0
    };
    scene.textures = vec![Texture {
        name: String::from("leaves"),
        width: EDGE,
        height: EDGE,
        rgba8: (0..EDGE * EDGE)
            .flat_map(|i| [255, 255, 255, if is_leaf(i) { 255 } else { 0 }])
            .collect(),
        encoding: Encoding::Srgb,
        wrap: [Wrap::Clamp; 2],
    }];
    let (day, view) = (constant_sky(L), camera([0.0, 0.6, 0.6], [0.0; 3]));
    // A square from below its middle, eight times its height away from the edges.
    let corner = 8.0 / 65f64.sqrt() * (8.0 / 65f64.sqrt()).atan() / PI;
    let expected = 1.0 - 0.25 * 4.0 * corner;
    for way in [DomeBy::Maps, DomeBy::Rays] {
        let mut set = by(way, dome(16, 64));
        set.sampling.dome.map_edge = 64;
        let picture = device.picture(&scene, set, &day, &view);
        let [sum, count] = picture.pixels().fold([0.0; 2], |[sum, count], (_, e)| {
            [sum + 1000.0 * luminance(e) / (PI * L), count + 1.0]
        });
        let share = sum / count;
        println!("{way:?}: {share:.4} of the open sky, by the factor {expected:.4}");
        assert!((share - expected).abs() < 0.03, "{way:?}: {share}");
    }
}
