//! A room with an opening in its roof: the irradiance of its floor under a uniform sky has a closed form.
#![allow(dead_code)]

use std::f64::consts::PI;

use glam::DVec3;
use skylight::scene::{Camera, Material, Scene};

use crate::gpu::{Model, camera, matt};

/// Half the edge of the floor, the height of the room, and half the edge of the roof's opening, metres.
pub const ROOM: [f32; 3] = [2.0, 3.0, 0.8];

/// A room with a square opening in the middle of its roof; `open` is half its edge, 0 closes it.
pub fn room(open: f32, floor: &Material) -> Scene {
    let ([half, height, _], white) = (ROOM, matt(0.8));
    let (edge, rim) = (2.0 * half, half - open);
    let long = |z: f32| ([-half, height, z], [edge, 0.0, 0.0], [0.0, 0.0, rim]);
    let short = |x: f32| ([x, height, -open], [rim, 0.0, 0.0], [0.0, 0.0, 2.0 * open]);
    let mut model = Model::default().ground(half, floor);
    for (corner, a, b) in [long(-half), long(open), short(-half), short(open)] {
        if a[0] * b[2] > 0.0 {
            model = model.quad(corner, a, b, &white);
        }
    }
    let up = [0.0, height, 0.0];
    model
        .quad([-half, 0.0, -half], [edge, 0.0, 0.0], up, &white)
        .quad([-half, 0.0, half], [edge, 0.0, 0.0], up, &white)
        .quad([-half, 0.0, -half], [0.0, 0.0, edge], up, &white)
        .quad([half, 0.0, -half], [0.0, 0.0, edge], up, &white)
        .build()
}

/// A camera under the roof that looks down at the floor.
pub fn under_the_roof() -> Camera {
    Camera {
        fov_deg: 70.0,
        ..camera([0.3, 2.9, 0.4], [0.0, 0.0, 0.0])
    }
}

/// Configuration factor of a horizontal element at `p` to the opening above: the sum over its corners of the factor to a
/// rectangle with one corner above the element (Howell, A Catalog of Radiation Heat Transfer Configuration Factors, B-4).
pub fn configuration_factor(p: DVec3) -> f64 {
    let [_, height, open] = ROOM.map(f64::from);
    let corner = |x: f64, y: f64| {
        let (a, b) = (x / height, y / height);
        let (ra, rb) = ((1.0 + a * a).sqrt(), (1.0 + b * b).sqrt());
        (a / ra * (b / ra).atan() + b / rb * (a / rb).atan()) / (2.0 * PI)
    };
    let (x0, x1, y0, y1) = (-open - p.x, open - p.x, -open - p.z, open - p.z);
    corner(x1, y1) - corner(x0, y1) - corner(x1, y0) + corner(x0, y0)
}
