//! What is compiled for a scene serves the next one: drivers take up to seconds to compile the passes that trace rays.

use skylight::frame::FrameSettings;
use skylight::passes::bounces::cells::Bounces;
use skylight::scene::Scene;

use crate::bounces::{converged, single, with_bounces};
use crate::gpu::{Device, Model, camera, constant_sky, glowing, matt};

/// A ground in the light of as many lamps.
fn lit_by(lamps: u8) -> Scene {
    let ground = Model::default().ground(20.0, &matt(0.5));
    let lamp = |model: Model, i: u8| {
        let emission = 1000.0 * (1.0 + f32::from(i));
        model.cube([f32::from(i) - 1.0, 1.0, 0.0], 0.2, &glowing(0.5, emission))
    };
    (0..lamps).fold(ground, lamp).build()
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
    let with_lamps = || (1..4).map(lit_by);
    let plain = || {
        let cube = |half| Model::default().cube([0.0; 3], half, &matt(0.5)).build();
        [1.0, 2.0, 3.0].into_iter().map(cube)
    };
    let all = |set| with_bounces(Bounces::All, set);
    for set in [all(single(32, 18)), all(converged(32, 18, 2))] {
        for made in [
            made_for(&mut device, with_lamps(), set),
            made_for(&mut device, plain(), set),
        ] {
            println!("{made:?}");
            assert_eq!(made[1..], [0, 0], "{made:?}");
        }
    }
}
