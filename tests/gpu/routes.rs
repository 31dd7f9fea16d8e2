//! Both routes of full-screen passes, fragments and compute shaders, give the same pictures.

use skylight::frame::{Frame, FrameSettings, Visibility};
use skylight::gpu::{ContextOptions, Optional, Route};
use skylight::passes::bounces::cells::Bounces;
use skylight::passes::dome::route::DomeBy;
use skylight::passes::dome::specular::Reflections;
use skylight::passes::light::lighting::{Ambient, Precision, Show};
use skylight::passes::occlusion::ssao::SsaoSettings;
use skylight::passes::route::measured;
use skylight::scene::{Camera, Encoding, Material, Microfacet, Scene, Texture};

use crate::gpu::{Device, Model, camera, clear_day, glass, glowing, matt, settings};

/// Not multiples of a workgroup.
const SIZE: [u32; 2] = [75, 43];

/// A floor and a wall with a mirroring, a rough and a glowing body, part of them behind a pane, before the sky.
fn parts() -> Model {
    let shiny = Material {
        specular: [0.2; 3],
        shininess: 40.0,
        ..matt(0.3)
    };
    let rough = Material {
        microfacet: Some(Microfacet {
            base: [0.8, 0.6, 0.3],
            f0: [0.04; 3],
            f90: 1.0,
            metallic: 1.0,
            roughness: 0.3,
            texture: None,
        }),
        ..matt(0.0)
    };
    Model::default()
        .ground(4.0, &matt(0.5))
        .quad(
            [-4.0, 0.0, -2.0],
            [5.0, 0.0, 0.0],
            [0.0, 2.0, 0.0],
            &matt(0.6),
        )
        .sphere([-0.7, 0.4, -0.5], 0.4, 12, &shiny)
        .sphere([0.4, 0.4, -0.5], 0.4, 12, &rough)
        .cube([1.4, 0.2, -0.4], 0.2, &glowing(0.4, 3000.0))
        .quad(
            [0.2, 0.1, 0.6],
            [1.0, 0.0, 0.0],
            [0.0, 1.3, 0.0],
            &glass([0.6, 0.8, 0.7]),
        )
}

/// The scene with a board that has a texture, one that glows by a texture and one with holes.
fn scene_with_maps() -> Scene {
    let board = |texture: fn(&mut Material)| {
        let mut material = matt(0.7);
        texture(&mut material);
        material
    };
    let boards = [
        board(|m| m.diffuse_texture = Some(0)),
        board(|m| {
            m.emission = [500.0; 3];
            m.emissive_texture = Some(0);
        }),
        board(|m| {
            m.diffuse_texture = Some(0);
            m.alpha_cutoff = Some(0.5);
        }),
    ];
    let mut model = parts();
    for (x, material) in [-1.8, -0.1, 1.0].into_iter().zip(&boards) {
        model = model.quad([x, 0.9, -0.9], [0.9, 0.0, 0.1], [0.0, 0.8, 0.0], material);
    }
    let mut scene = model.build();
    scene.textures.push(Texture {
        name: "spots".into(),
        width: 4,
        height: 1,
        rgba8: [
            [255, 0, 0, 255],
            [0, 90, 188, 0],
            [30, 200, 40, 255],
            [9, 9, 9, 0],
        ]
        .concat(),
        encoding: Encoding::Srgb,
        wrap: Default::default(),
    });
    scene
}

fn eye() -> Camera {
    camera([0.3, 1.1, 3.2], [0.1, 0.7, 0.0])
}

/// Means with occlusion in screen space, single frames with cells, and converging pictures.
fn modes() -> [(&'static str, FrameSettings, &'static [Show]); 5] {
    let mut screen = settings(SIZE[0], SIZE[1]).with_occlusion(SsaoSettings::default());
    screen.samples = 2;
    screen.irradiance.samples = 64;
    let mut cells = screen;
    cells.samples = 1;
    cells.lighting.ambient = Ambient::Cells;
    cells.lighting.precision = Precision::Half;
    cells.bounces = Bounces::All;
    let mut dome = screen;
    dome.sampling.visibility = Visibility::Progressive;
    dome.sampling.dome.directions = 4;
    dome.sampling.dome.map_edge = 128;
    dome.sampling.dome.by = DomeBy::Maps;
    dome.lighting.mirrors.reflections = Reflections::Hidden;
    dome.bounces = Bounces::All;
    let mut lux = dome;
    lux.sampling.visibility = Visibility::Dome;
    lux.sampling.dome.illuminance = true;
    lux.lighting.mirrors.reflections = Reflections::Open;
    lux.bounces = Bounces::UpTo(0);
    let mut rays = lux;
    rays.sampling.dome.by = DomeBy::Rays;
    [
        ("screen space", screen, &ALL),
        ("cells", cells, &[Show::Beauty]),
        ("dome", dome, &[Show::Beauty]),
        ("dome with illuminance", lux, &[Show::Irradiance]),
        ("dome by rays", rays, &[Show::Irradiance]),
    ]
}

const ALL: [Show; 16] = [
    Show::Beauty,
    Show::Sun,
    Show::Sky,
    Show::Bounces,
    Show::Emission,
    Show::SunSpecular,
    Show::SkySpecular,
    Show::Air,
    Show::Background,
    Show::Visibility,
    Show::Occlusion,
    Show::Irradiance,
    Show::Albedo,
    Show::Normal,
    Show::Depth,
    Show::Luminance,
];

fn device(route: Route) -> Device {
    Device::with(&ContextOptions {
        route: Some(route),
        ..ContextOptions::default()
    })
}

/// Radiance of each quantity, and display values of the last.
fn pictures(
    device: &mut Device,
    scene: &Scene,
    set: FrameSettings,
    shown: &[Show],
) -> Vec<Vec<[f32; 4]>> {
    let day = clear_day(150.0, 40.0);
    let mut frame = device.run(|rec| Frame::new(rec, scene, set).expect("a frame"));
    let mut found = Vec::new();
    for show in shown {
        frame.show(*show).expect("shown");
        device.draw(&mut frame, &day, &eye());
        found.push(device.read(frame.radiance()));
    }
    found.push(device.read(frame.display()));
    found
}

/// Differences of the values of two pictures relative to the larger one, where there are any.
fn differences(a: &[[f32; 4]], b: &[[f32; 4]]) -> Vec<f32> {
    let values = a.iter().flatten().zip(b.iter().flatten());
    let unequal = values.filter(|(a, b)| a.to_bits() != b.to_bits());
    let relative = |(a, b): (&f32, &f32)| (a - b).abs() / a.abs().max(b.abs()).max(1e-6);
    unequal.map(relative).collect()
}

/// Fails where the pictures of a scene by both routes differ.
fn expect_same(scene: &Scene, (mode, set, shown): (&str, FrameSettings, &[Show])) {
    let [mut fragments, mut compute] = [Route::Fragment, Route::Compute].map(device);
    assert_eq!(compute.context.route(), Route::Compute);
    let drawn = pictures(&mut fragments, scene, set, shown);
    let computed = pictures(&mut compute, scene, set, shown);
    let names = shown.iter().map(|show| format!("{show:?}"));
    let names = names.chain(["display".to_owned()]);
    for ((name, drawn), computed) in names.zip(&drawn).zip(&computed) {
        let different = differences(drawn, computed);
        println!(
            "{mode}, {name}: {} of {} values differ, by {:.1e} at most",
            different.len(),
            4 * drawn.len(),
            different.iter().copied().fold(0.0, f32::max)
        );
        let lit = drawn.iter().filter(|t| t[..3] != [0.0; 3]).count();
        assert!(
            lit > 0 || *name == *"Air" || *name == *"Bounces",
            "{mode}, {name} is black"
        );
        // Normals of 16 bits may be rounded up by one route and down by the other: few are, and they change little.
        let mean = different.iter().sum::<f32>() / (4 * drawn.len()) as f32;
        assert!(
            different.len() <= drawn.len() / 20 && mean <= 5e-5,
            "{mode}, {name}: {mean}"
        );
    }
}

#[test]
fn both_routes_give_the_same_pictures() {
    for mode in modes() {
        expect_same(&parts().build(), mode);
    }
}

#[test]
fn both_routes_give_the_same_surfaces_with_maps_and_without() {
    let mut set = settings(SIZE[0], SIZE[1]).with_occlusion(SsaoSettings::default());
    set.samples = 2;
    let shown = [
        Show::Beauty,
        Show::Albedo,
        Show::Normal,
        Show::Emission,
        Show::Depth,
    ];
    expect_same(&scene_with_maps(), ("maps", set, &shown));
}

#[test]
fn a_device_that_cannot_store_pictures_takes_fragments() {
    let without = Device::with(&ContextOptions {
        route: Some(Route::Compute),
        without: vec![Optional::StoredPictures],
        ..ContextOptions::default()
    });
    assert_eq!(without.context.route(), Route::Fragment);
}

/// What `--route auto` goes by.
#[test]
fn both_routes_are_timed() {
    let device = Device::new();
    let times = measured(&device.context).expect("measured");
    println!(
        "fragment {:.2} ms, compute {:.2} ms",
        times.fragment, times.compute
    );
    assert!(times.fragment > 0.0 && times.compute > 0.0 && times.fragment.max(times.compute) < 1e5);
}
