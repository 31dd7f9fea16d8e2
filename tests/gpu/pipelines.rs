//! What is compiled for a scene serves the next one: drivers take up to seconds to compile the passes that trace rays.

use skylight::frame::FrameSettings;
use skylight::passes::bounces::cells::Bounces;
use skylight::scene::{Material, Scene};

use crate::bounces::{converged, single, with_bounces};
use crate::gpu::{Device, Model, camera, constant_sky, glowing, matt};

/// A ground and a row of cubes; `material` is that of cube `i`.
fn row(cubes: u8, material: impl Fn(u8) -> Material) -> Scene {
    let ground = Model::default().ground(20.0, &matt(0.5));
    let cube = |model: Model, i: u8| model.cube([f32::from(i) - 1.0, 1.0, 0.0], 0.2, &material(i));
    (0..cubes).fold(ground, cube).build()
}

/// Pipelines that a device makes to draw scenes one after the other.
fn made_for(
    device: &mut Device,
    scenes: impl Iterator<Item = Scene>,
    set: FrameSettings,
) -> Vec<usize> {
    let (day, view) = (constant_sky(1000.0), camera([0.0, 2.0, 5.0], [0.0; 3]));
    let count = |scene| {
        let before = device.context.pipelines().len();
        device.picture(&scene, set, &day, &view);
        device.context.pipelines().len() - before
    };
    scenes.map(count).collect()
}

/// Neither the number of triangles nor that of lamps nor their power is compiled into a shader.
#[test]
fn scenes_share_them() {
    let mut device = Device::new();
    let plain = || (1..4).map(|cubes| row(cubes, |_| matt(0.5)));
    let lamp = |i| glowing(0.5, 1000.0 * (1.0 + f32::from(i)));
    let lit = || (1..4).map(|cubes| row(cubes, lamp));
    let all = |set| with_bounces(Bounces::All, set);
    for set in [all(single(32, 18)), all(converged(32, 18, 2))] {
        for made in [
            made_for(&mut device, lit(), set),
            made_for(&mut device, plain(), set),
        ] {
            println!("{made:?}");
            assert_eq!(made[1..], [0, 0], "{made:?}");
        }
    }
}
