//! The moon: its disc in the background, and its light when the sun gives none.

use crate::common::Worst;
use crate::gpu::{Device, Model, camera, matt, on_ground, pixel_ray, settings, showing};
use crate::lighting::{out_of_view, solid_angle, toward};
use glam::DVec3;
use skylight::daylight::moon::Moon;
use skylight::daylight::sky::{Conditions, Daylight};
use skylight::daylight::sun_position::direction;
use skylight::passes::light::lighting::Show;

/// A night with the moon in the south-east at 40°, lit from the right.
fn night(phase_angle_deg: f64) -> Daylight {
    let toward = direction(130.0, 40.0);
    let (sine, cosine) = phase_angle_deg.to_radians().sin_cos();
    let moon = Moon {
        azimuth_deg: 130.0,
        elevation_deg: 40.0,
        apparent_elevation_deg: 40.0,
        distance_km: 384_400.0,
        phase_angle_deg,
        sunward: direction(220.0, 0.0) * sine - toward * cosine,
    };
    Daylight::new(&Conditions {
        sun_elevation_deg: -30.0,
        moon: Some(moon),
        ..Conditions::default()
    })
}

#[test]
fn the_moons_disc_is_the_cpus_and_integrates_to_its_illuminance() {
    let mut device = Device::new();
    let mut pixels = Worst::new("pixels of the disc against the CPU, of the full disc", 0.01);
    let mut sum = Worst::new("L_moon x solid angle of the disc against E_moon", 0.01);
    for phase in [0.0, 60.0, 120.0] {
        let day = night(phase);
        let moon = day.moon.expect("a moon");
        let camera = toward(moon.direction);
        let set = showing(Show::Background, settings(320, 320));
        let picture = device.picture(&out_of_view(), set, &day, &camera);
        let mut total = DVec3::ZERO;
        for (pixel, found) in picture.pixels() {
            let ray = pixel_ray(&camera, picture.size, pixel).normalize();
            let disc = found * 1e3 - day.sky_radiance(ray);
            total += disc * solid_angle(&camera, picture.size, pixel);
            // At the limb and the terminator rounding decides on which side a pixel is.
            let around = [DVec3::X, DVec3::Y, DVec3::Z].map(|axis| (ray + axis * 2e-6).normalize());
            let expected = moon.disc(ray);
            let is_smooth = around.iter().all(|near| {
                (moon.disc(*near) - expected).length() < 0.02 * moon.luminance.length()
            });
            if is_smooth {
                let error = (disc - expected).abs() / moon.luminance;
                pixels.see(error.max_element(), format!("phase {phase}, {pixel:?}"));
            }
        }
        let error = (total / moon.illuminance - 1.0).abs().max_element();
        sum.see(error, format!("phase {phase}"));
    }
    pixels.finish();
    sum.finish();
}

#[test]
fn the_moon_lights_the_ground_and_throws_shadows() {
    let mut device = Device::new();
    let day = night(10.0);
    let direct = day.direct_light();
    assert_eq!(direct.illuminance, day.moon.expect("a moon").illuminance);
    // A cube whose shadow falls away from the moon: 4 m behind its top edge at 40°, 1.19 m a metre.
    let scene = Model::default()
        .ground(30.0, &matt(0.5))
        .cube([0.0, 1.0, 0.0], 1.0, &matt(0.5))
        .build();
    let camera = camera([0.0, 12.0, 0.1], [0.0, 0.0, 0.0]);
    let set = showing(Show::Sun, settings(160, 160));
    let picture = device.picture(&scene, set, &day, &camera);
    let mut lit = Worst::new("moonlight on the ground against the CPU's", 0.01);
    let (mut dark, mut bright) = (0, 0);
    let away = -DVec3::new(direct.direction.x, 0.0, direct.direction.z).normalize();
    for (pixel, found) in picture.pixels() {
        let Some(point) = on_ground(&camera, picture.size, pixel) else {
            continue;
        };
        let (along, aside) = (point.dot(away), point.dot(away.cross(DVec3::Y)));
        if aside.abs() < 0.8 && (1.7..2.8).contains(&along) {
            assert_eq!(found, DVec3::ZERO, "{point} is in the shadow");
            dark += 1;
        } else if point.length() > 5.0 {
            let expected = direct.illuminance * direct.direction.y * 0.5 / std::f64::consts::PI;
            lit.see(
                (found * 1e3 / expected - 1.0).abs().max_element(),
                format!("{point}"),
            );
            bright += 1;
        }
    }
    assert!(dark > 20 && bright > 500, "{dark} {bright}");
    lit.finish();
}
