//! The sun's shadow against geometry: a square that floats above a plane.

use glam::{DVec3, UVec2, Vec2};

use super::check::Check;
use super::device::{Device, Picture, camera, on_ground, pixel_ray, settings};
use super::model::{Model, clear_day, matt};
use crate::daylight::sky::Daylight;
use crate::frame::FrameSettings;
use crate::gpu::Result;
use crate::passes::light::lighting::Show;
use crate::passes::sun_shadow::fit;
use crate::passes::view::View;
use crate::scene::{Camera, Scene};

/// Width of the untested band around a shadow's edge, texels: 2 for the map, 1.5 for the half width of the 3x3 tent filter
/// (four bilinear taps).
const EDGE_TEXELS: f64 = 3.5;

/// Columns and rows of the pictures.
pub const SIZE: (u32, u32) = (240, 180);

/// Settings of a picture of the sun's visibility.
pub fn visibility_settings() -> FrameSettings {
    settings(SIZE.0, SIZE.1).showing(Show::Visibility)
}

/// Pictures of V and of the distance along the view axis.
///
/// # Errors
/// The device fails.
pub fn draw(
    device: &mut Device,
    scene: &Scene,
    day: &Daylight,
    camera: &Camera,
) -> Result<(Picture, Picture)> {
    let mut frame = device.frame(scene, visibility_settings(), day, camera)?;
    let visibility = device.picture_of(&frame)?;
    frame.show(Show::Depth)?;
    device.draw(&mut frame, day, camera)?;
    Ok((visibility, device.picture_of(&frame)?))
}

/// Edge of a texel of the frame's shadow map, metres.
pub fn texel(scene: &Scene, day: &Daylight, camera: &Camera) -> f64 {
    let view = View {
        camera: *camera,
        size: UVec2::new(SIZE.0, SIZE.1),
        jitter: Vec2::ZERO,
        sharpen: 0.0,
        window: None,
    };
    let (sun, casters) = (day.sun_direction.as_vec3(), scene.casters());
    let resolution = visibility_settings().shadow_resolution;
    fit::fit(sun, &scene.bounds, &casters, &view, resolution)
        .texel
        .into()
}

/// Points around p, moved across the light by `radius`; p first.
fn around(p: DVec3, sun: DVec3, radius: f64) -> impl Iterator<Item = DVec3> {
    let (right, up) = sun.any_orthonormal_pair();
    let ring = (0..16).map(move |i| {
        let (sin, cos) = (f64::from(i) * std::f64::consts::TAU / 16.0).sin_cos();
        p + radius * (right * cos + up * sin)
    });
    std::iter::once(p).chain(ring)
}

/// Whether the square of half width 2 at height 3 is between p and the sun.
fn under_square(p: DVec3, sun: DVec3) -> bool {
    let at = p + sun * ((3.0 - p.y) / sun.y);
    at.x.abs() <= 2.0 && at.z.abs() <= 2.0
}

/// The ground point of a pixel; `None` if the pixel does not show the ground.
pub fn ground_point(camera: &Camera, depth: &Picture, pixel: [usize; 2]) -> Option<DVec3> {
    let p = on_ground(camera, depth.size, pixel)?;
    let along = (p - camera.eye.as_dvec3()).dot(camera.forward().as_dvec3());
    let seen = depth.at(pixel[0], pixel[1]).x;
    (seen > 0.0 && (seen / along - 1.0).abs() < 1e-3).then_some(p)
}

/// Compares the depth of every pixel with the nearer of the square and the plane, but for pixels at edges.
fn compare_depth(check: &mut Check, depth: &Picture, camera: &Camera) {
    let eye = camera.eye.as_dvec3();
    for (pixel, seen) in depth.pixels() {
        let ray = pixel_ray(camera, depth.size, pixel);
        // Where the ray meets the horizontal square of this height: how deep within its edge, metres, and how far along the axis.
        let hit = |height: f64, half: f64| {
            let distance = (height - eye.y) / ray.y;
            let at = eye + ray * distance;
            let inside = half - at.x.abs().max(at.z.abs());
            let along = distance * ray.dot(camera.forward().as_dvec3());
            (if distance > 0.0 { inside } else { f64::MIN }, along)
        };
        let (square, ground) = (hit(3.0, 2.0), hit(0.0, 12.0));
        if square.0.abs() < 0.1 || ground.0.abs() < 0.5 {
            continue;
        }
        let expected = match (square.0 > 0.0, ground.0 > 0.0) {
            (true, _) => square.1,
            (false, true) => ground.1,
            (false, false) => 0.0,
        };
        let at = || format!("pixel {pixel:?}");
        check.see(seen.x, expected, expected.max(1.0), at);
    }
}

/// Compares V with the analytic shadow of a square under the sun at `azimuth` and `elevation`, degrees, and the depths; returns the number of dark pixels, and of
/// those at edges, which are not compared.
///
/// # Errors
/// The device fails.
pub fn compare_square(
    device: &mut Device,
    [check, depths]: [&mut Check; 2],
    [azimuth, elevation]: [f64; 2],
) -> Result<[usize; 2]> {
    let grey = matt(0.5);
    let scene = Model::default()
        .square([0.0, 3.0, 0.0], 2.0, &grey)
        // Behind what is drawn before it: the depth test hides it.
        .ground(12.0, &grey)
        .build();
    let camera = camera([7.0, 8.0, 14.0], [0.0, 0.0, 0.0]);
    let day = clear_day(azimuth, elevation);
    let sun = day.sun_direction;
    let margin = EDGE_TEXELS * texel(&scene, &day, &camera);
    let (visibility, depth) = draw(device, &scene, &day, &camera)?;
    compare_depth(depths, &depth, &camera);
    let (mut dark, mut skipped) = (0, 0);
    for (pixel, v) in visibility.pixels() {
        let Some(p) = ground_point(&camera, &depth, pixel) else {
            continue;
        };
        let shadow = under_square(p, sun);
        if around(p, sun, margin).any(|q| under_square(q, sun) != shadow) {
            skipped += 1;
            continue;
        }
        dark += usize::from(shadow);
        let expected = if shadow { 0.0 } else { 1.0 };
        check.see(v.x, expected, 1.0, || {
            format!("{p:.2}, sun {azimuth}° {elevation}°")
        });
    }
    Ok([dark, skipped])
}

/// The shadow of a square under three suns.
///
/// # Errors
/// The device fails.
pub fn square(device: &mut Device) -> Result<Vec<Check>> {
    let mut check = Check::absolute("shadow of a floating square, V", "geometry", "", 1e-6);
    let mut depths = Check::relative("depth of square and plane", "geometry", "m", 1e-4);
    let mut seen = Check::absolute("pixels in that shadow", "at least 500", "", 0.0);
    for sun in [[180.0, 80.0], [100.0, 45.0], [250.0, 30.0]] {
        let [dark, _] = compare_square(device, [&mut check, &mut depths], sun)?;
        let dark = dark as f64;
        seen.see(dark, dark.max(500.0), 1.0, || {
            format!("sun {}° {}°", sun[0], sun[1])
        });
    }
    Ok(vec![check, seen, depths])
}
