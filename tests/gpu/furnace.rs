//! White furnace: a white body under a uniform sky is invisible, so every pixel reads L = 1.

use crate::gpu::{Device, finish};
use skylight::daylight::irradiance::IrradianceMethod;
use skylight::validate::check::Check;
use skylight::validate::light::{compare_furnace, white_bodies};

fn check(method: IrradianceMethod) {
    let mut device = Device::new();
    // E is stored in 16 bits: 2^-11 = 0.05 %; the rest of the chain is 32-bit. Measured: 3.08e-4.
    let mut check = Check::relative("L of a white body and of the sky", "1", "kcd/m²", 3.4e-4);
    for (name, scene) in &white_bodies() {
        for eye in [[2.0, 1.5, 2.5], [-2.5, -1.0, -1.5], [0.1, 3.0, 0.1]] {
            let body = compare_furnace(&mut device, &mut check, (name, scene), eye, method);
            let body = body.expect("drawn");
            assert!(
                body > 2000 && body < 160 * 120,
                "{name} from {eye:?}: {body} pixels of body"
            );
        }
    }
    finish(&check);
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
