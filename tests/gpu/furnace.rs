//! White furnace: a white body under a uniform sky is invisible, so every pixel reads L = 1.

use crate::common::Worst;
use crate::gpu::{Device, Model, camera, constant_sky, matt, settings, showing};
use skylight::daylight::irradiance::IrradianceMethod;
use skylight::passes::light::lighting::Show;
use skylight::passes::sky::irradiance::IrradianceSettings;
use skylight::scene::Scene;

fn bodies() -> [(&'static str, Scene); 2] {
    let white = matt(1.0);
    [
        (
            "sphere",
            Model::default().sphere([0.0; 3], 1.0, 24, &white).build(),
        ),
        ("cube", Model::default().cube([0.0; 3], 0.8, &white).build()),
    ]
}

fn check(method: IrradianceMethod) {
    let mut device = Device::new();
    // E is stored in 16 bits: 2^-11 = 0.05 %; the rest of the chain is 32-bit. Measured: 3.08e-4.
    let mut worst = Worst::new(
        "L of a white body and of the sky around it against 1",
        3.4e-4,
    );
    for (name, scene) in bodies() {
        for eye in [[2.0, 1.5, 2.5], [-2.5, -1.0, -1.5], [0.1, 3.0, 0.1]] {
            let (camera, day) = (camera(eye, [0.0; 3]), constant_sky(1000.0));
            let mut set = settings(160, 120);
            set.irradiance = IrradianceSettings {
                method,
                ..set.irradiance
            };
            let picture = device.picture(&scene, set, &day, &camera);
            for (pixel, value) in picture.pixels() {
                let error = (value - 1.0).abs().max_element();
                worst.see(error, format!("{name} from {eye:?}, {pixel:?}"));
            }
            let depth = device.picture(&scene, showing(Show::Depth, set), &day, &camera);
            let body = depth.pixels().filter(|(_, d)| d.x > 0.0).count();
            assert!(
                body > 2000 && body < 160 * 120,
                "{name} from {eye:?}: {body} pixels of body"
            );
        }
    }
    worst.finish();
}

#[test]
fn quasi() {
    check(IrradianceMethod::Quasi);
}

#[test]
fn monte_carlo() {
    check(IrradianceMethod::MonteCarlo);
}

#[test]
fn exact_sum() {
    check(IrradianceMethod::Exact);
}

#[test]
fn spherical_harmonics() {
    check(IrradianceMethod::Sh);
}
