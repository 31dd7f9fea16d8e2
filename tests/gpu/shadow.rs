//! The shadow map against closed forms: a floating square, an open plane, the foot of a wall, a sphere.

use crate::common::Worst;
use crate::gpu::{Device, Model, Picture, camera, clear_day, finish, matt, pixel_ray};
use skylight::daylight::sky::Daylight;
use skylight::scene::{Camera, Scene};
use skylight::validate::check::Check;
use skylight::validate::shadow::{self, ground_point, texel};

/// Width of wrongly lit ground (light leak) allowed at a wall's foot, texels across the light: none, rays decide.
const FOOT_TEXELS: f64 = 0.01;

/// Pictures of V and of the distance along the view axis.
fn draw(device: &mut Device, scene: &Scene, day: &Daylight, camera: &Camera) -> (Picture, Picture) {
    shadow::draw(device, scene, day, camera).expect("drawn")
}

#[test]
fn a_square_casts_its_shadow_where_geometry_says() {
    let mut device = Device::new();
    let mut check = Check::absolute("V of a square's shadow", "geometry", "", 1e-6);
    let mut depths = Check::relative("depths", "geometry", "m", 1e-4);
    let (mut dark, mut skipped) = (0, 0);
    for sun in [[180.0, 80.0], [100.0, 45.0], [250.0, 30.0], [20.0, 55.0]] {
        let counts =
            shadow::compare_square(&mut device, [&mut check, &mut depths], sun).expect("drawn");
        dark += counts[0];
        skipped += counts[1];
    }
    finish(&check);
    finish(&depths);
    println!("{dark} of them dark, {skipped} skipped at edges");
    assert!(dark > 2000 && skipped < dark, "{dark} {skipped}");
}

#[test]
fn an_open_plane_has_no_acne() {
    let mut device = Device::new();
    let scene = Model::default().ground(20.0, &matt(0.5)).build();
    let mut worst = Worst::new("V of an open plane against 1", 1e-6);
    for elevation in [5.0, 8.0, 15.0, 30.0, 60.0, 85.0, 90.0] {
        for (azimuth, eye) in [
            (180.0, [0.0, 2.0, 18.0]),
            (75.0, [5.0, 9.0, 9.0]),
            (311.0, [-3.0, 0.5, -8.0]),
        ] {
            let day = clear_day(azimuth, elevation);
            let camera = camera(eye, [0.0, 0.0, 0.0]);
            let (visibility, depth) = draw(&mut device, &scene, &day, &camera);
            for (pixel, v) in visibility.pixels() {
                if depth.at(pixel[0], pixel[1]).x > 0.0 {
                    let at = format!("{pixel:?}, sun {azimuth} {elevation}, eye {eye:?}");
                    worst.see(v.x - 1.0, at);
                }
            }
        }
    }
    worst.finish();
}

#[test]
fn light_does_not_leak_under_a_wall() {
    let mut device = Device::new();
    let grey = matt(0.5);
    // The wall stands at z = 0 and faces south; the sun is in the north, so the ground south of it is in shadow.
    let scene = Model::default()
        .ground(12.0, &grey)
        .quad([-6.0, 0.0, 0.0], [12.0, 0.0, 0.0], [0.0, 4.0, 0.0], &grey)
        .build();
    let camera = camera([1.0, 3.0, 6.0], [0.0, 0.0, 0.5]);
    let mut worst = Worst::new("V beyond the leak at a wall's foot", 1e-6);
    for (azimuth, elevation) in [(0.0, 15.0), (0.0, 45.0), (20.0, 30.0), (340.0, 60.0)] {
        let day = clear_day(azimuth, elevation);
        let sun = day.sun_direction;
        let texel = texel(&scene, &day, &camera);
        let (visibility, depth) = draw(&mut device, &scene, &day, &camera);
        let mut leak: f64 = 0.0;
        for (pixel, v) in visibility.pixels() {
            let Some(p) = ground_point(&camera, &depth, pixel) else {
                continue;
            };
            // Where the ray to the sun meets the wall; well inside the wall's other edges.
            let at = p - sun * (p.z / sun.z);
            if p.z <= 0.0 || at.x.abs() > 5.0 || at.y > 3.0 {
                continue;
            }
            // Distance from the foot across the light, in texels.
            let across = at.y * (sun.x * sun.x + sun.z * sun.z).sqrt() / texel;
            if v.x > 1e-6 {
                leak = leak.max(across);
            }
            if across > FOOT_TEXELS {
                worst.see(v.x, format!("{p}, sun {azimuth} {elevation}"));
            }
        }
        println!(
            "sun {azimuth} {elevation}: light leaks {leak:.2} texels (of {texel:.4} m) under the wall"
        );
    }
    worst.finish();
}

#[test]
fn the_sunny_side_of_a_sphere_is_lit_and_the_other_dark() {
    let mut device = Device::new();
    let scene = Model::default()
        .sphere([0.0; 3], 1.0, 96, &matt(0.5))
        .build();
    let mut worst = Worst::new("V of a sphere where n.l > 0.2 (1) and n.l < 0 (0)", 1e-6);
    for (azimuth, elevation, eye) in [
        (180.0, 45.0, [0.0, 1.0, 3.5]),
        (90.0, 20.0, [1.0, 2.0, 2.5]),
        (0.0, 70.0, [2.5, -1.0, 2.0]),
    ] {
        let day = clear_day(azimuth, elevation);
        let camera = camera(eye, [0.0; 3]);
        let (visibility, depth) = draw(&mut device, &scene, &day, &camera);
        for (pixel, v) in visibility.pixels() {
            let seen = depth.at(pixel[0], pixel[1]).x;
            if seen <= 0.0 {
                continue;
            }
            let ray = pixel_ray(&camera, depth.size, pixel);
            let distance = seen / ray.dot(camera.forward().as_dvec3());
            let normal = (camera.eye.as_dvec3() + ray * distance).normalize();
            let n_dot_l = normal.dot(day.sun_direction);
            // A facet's normal is within 1 degree of the sphere's: 0.02 around the terminator.
            let expected = match n_dot_l {
                x if x > 0.2 => 1.0,
                x if x < -0.02 => 0.0,
                _ => continue,
            };
            worst.see(
                v.x - expected,
                format!("n.l {n_dot_l:.3}, sun {azimuth} {elevation}"),
            );
        }
    }
    worst.finish();
}
