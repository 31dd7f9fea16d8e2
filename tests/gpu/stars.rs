//! The stars: their flux in the picture, where they stand, and what hides them.

use chrono::DateTime;
use glam::{DVec2, DVec3};

use crate::common::Worst;
use crate::gpu::{Device, Model, camera, matt, pixel_ray, settings, showing};
use crate::lighting::{out_of_view, solid_angle, toward};
use skylight::daylight::colour::luminance;
use skylight::daylight::sky::{Conditions, Daylight, SkyModel};
use skylight::daylight::stars::{PointLight, StarrySky};
use skylight::frame::FrameSettings;
use skylight::passes::light::lighting::{Precision, Show};

/// A night in Copenhagen, with Orion in the south-west.
fn night() -> Daylight {
    let when = DateTime::parse_from_rfc3339("2026-02-28T21:00:00+01:00").expect("a moment");
    Daylight::new(&Conditions {
        model: SkyModel::Atmosphere,
        sun_elevation_deg: -28.0,
        stars: StarrySky::at(when, 55.68, 12.57).ok(),
        ..Conditions::default()
    })
}

fn dark(width: u32, height: u32) -> FrameSettings {
    let mut set = showing(Show::Background, settings(width, height));
    set.lighting.precision = Precision::Float;
    set
}

/// The brightest star (Sirius).
fn brightest(day: &Daylight) -> PointLight {
    let stars = day.stars();
    let lux = |star: &PointLight| luminance(star.illuminance);
    *stars
        .iter()
        .max_by(|a, b| lux(a).total_cmp(&lux(b)))
        .expect("stars")
}

/// A night with stars, and the same without.
fn nights() -> [Daylight; 2] {
    let black = Daylight {
        stars: None,
        ..night()
    };
    [night(), black]
}

#[test]
fn a_star_keeps_its_place_and_its_flux_at_every_size_and_angle() {
    let mut device = Device::new();
    let [day, black] = nights();
    let sirius = brightest(&day);
    let mut flux = Worst::new("flux of Sirius in the picture", 0.01);
    let mut place = Worst::new("centre of its light, pixels", 0.05);
    let aside = sirius.direction.any_orthonormal_vector();
    for (width, height, fov_deg, off_deg) in [
        (320, 200, 20.0, 0.0),
        (320, 200, 20.0, 7.3),
        (640, 400, 20.0, 0.013),
        (320, 200, 70.0, 30.0),
    ] {
        let look = sirius.direction + aside * f64::to_radians(off_deg).tan();
        let mut view = toward(look.normalize());
        view.fov_deg = fov_deg;
        let [with, without] = [&day, &black]
            .map(|day| device.picture(&out_of_view(), dark(width, height), day, &view));
        let (mut sum, mut centre) = (DVec3::ZERO, DVec2::ZERO);
        for ((pixel, found), (_, sky)) in with.pixels().zip(without.pixels()) {
            let ray = pixel_ray(&view, with.size, pixel).normalize();
            // Other stars are further away.
            let pixels = ray.angle_between(sirius.direction).to_degrees() / f64::from(fov_deg)
                * f64::from(height);
            if pixels < 4.0 {
                let light = (found - sky) * 1e3 * solid_angle(&view, with.size, pixel);
                sum += light;
                centre += DVec2::new(pixel[0] as f64, pixel[1] as f64) * luminance(light);
            }
        }
        let what = format!("{width}x{height}, {fov_deg} degrees, {off_deg} aside");
        let error = (sum / sirius.illuminance - 1.0).abs().max_element();
        flux.see(error, &what);
        let centre = centre / luminance(sum);
        let at = [centre.x.round() as usize, centre.y.round() as usize];
        let step = |pixel| pixel_ray(&view, with.size, pixel).normalize();
        let (own, right, below) = (step(at), step([at[0] + 1, at[1]]), step([at[0], at[1] + 1]));
        let off = sirius.direction - own;
        let found = DVec2::new(
            off.dot(right - own) / (right - own).length_squared(),
            off.dot(below - own) / (below - own).length_squared(),
        );
        let expected = centre - DVec2::new(at[0] as f64, at[1] as f64);
        place.see((found - expected).length(), &what);
    }
    flux.finish();
    place.finish();
}

#[test]
fn all_stars_in_view_are_drawn_once_and_none_before_a_surface() {
    let mut device = Device::new();
    let [day, black] = nights();
    let mut view = toward(brightest(&day).direction + DVec3::Y * 0.2);
    view.fov_deg = 45.0;
    let set = dark(320, 200);
    let [with, without] = [&day, &black].map(|day| device.picture(&out_of_view(), set, day, &view));
    let mut sum = 0.0;
    for ((pixel, found), (_, sky)) in with.pixels().zip(without.pixels()) {
        assert!((found - sky).min_element() >= -1e-12);
        sum += luminance(found - sky) * 1e3 * solid_angle(&view, with.size, pixel);
    }
    let corner = |pixel| pixel_ray(&view, with.size, pixel).normalize();
    let (first, last) = (corner([0, 0]), corner([319, 199]));
    let ahead = corner([160, 100]);
    let (right, down) = (
        (corner([319, 100]) - corner([0, 100])).normalize(),
        (corner([160, 199]) - corner([160, 0])).normalize(),
    );
    let within = |d: DVec3, axis: DVec3| {
        let at = |v: DVec3| v.dot(axis) / v.dot(ahead);
        d.dot(ahead) > 0.0 && at(d) > at(first) && at(d) < at(last)
    };
    let inside = |star: &&PointLight| within(star.direction, right) && within(star.direction, down);
    let stars = day.stars();
    let expected: f64 = stars
        .iter()
        .filter(inside)
        .map(|s| luminance(s.illuminance))
        .sum();
    let count = stars.iter().filter(inside).count();
    println!("{count} stars, {sum:.3e} lux for {expected:.3e}");
    assert!(count > 20 && (sum / expected - 1.0).abs() < 0.02);

    // A wall before all of the view.
    let wall = Model::default()
        .cube([0.0, 0.0, -3.0], 2.5, &matt(0.5))
        .build();
    let mut set = showing(Show::Beauty, settings(64, 64));
    set.lighting.precision = Precision::Float;
    let view = camera([0.0, 0.0, 0.0], [0.0, 0.0, -1.0]);
    let [with, without] = [&day, &black].map(|day| device.picture(&wall, set, day, &view));
    for ((pixel, found), (_, bare)) in with.pixels().zip(without.pixels()) {
        assert_eq!(found, bare, "{pixel:?}");
    }
}
