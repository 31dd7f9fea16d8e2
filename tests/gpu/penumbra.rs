//! Sun shadows beyond a single map: penumbrae against the geometry of the sun's disc, cascades against closed forms.

use crate::gpu::{Device, Model, Picture, camera, clear_day, matt, on_ground, settings};
use glam::DVec3;
use skylight::daylight::sunlight::SUN_ANGULAR_RADIUS;
use skylight::frame::FrameSettings;
use skylight::passes::light::lighting::{Shadows, Show};
use skylight::scene::{Camera, Scene};

fn visibility(size: [u32; 2], shadows: Shadows) -> FrameSettings {
    let mut set = crate::gpu::showing(Show::Visibility, settings(size[0], size[1]));
    set.shadow_resolution = 2048;
    set.lighting.shadows = shadows;
    set
}

/// Fraction of a unit disc on one side of a line at `t`, -1..1.
fn share(t: f64) -> f64 {
    0.5 + (t.asin() + t * (1.0 - t * t).sqrt()) / std::f64::consts::PI
}

/// Position of the line for which that fraction is `wanted`, by bisection.
fn line_at(wanted: f64) -> f64 {
    let (mut low, mut high) = (-1.0, 1.0);
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if share(middle) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    low
}

/// Where a profile (sorted by position) crosses `level`, by the mean of nearby points.
fn crossing(profile: &[(f64, f64)], level: f64) -> f64 {
    let bin = 0.002;
    let first = profile[0].0;
    let bins = ((profile[profile.len() - 1].0 - first) / bin) as usize + 1;
    let mut means = vec![(0.0, 0u32); bins];
    for (x, v) in profile {
        let mean = &mut means[((x - first) / bin) as usize];
        *mean = (mean.0 + v, mean.1 + 1);
    }
    let means = means.iter().enumerate().filter(|(_, m)| m.1 > 0);
    let means: Vec<(f64, f64)> = means
        .map(|(i, m)| (first + (i as f64 + 0.5) * bin, m.0 / f64::from(m.1)))
        .collect();
    let pair = means.windows(2).find(|p| p[0].1 < level && p[1].1 >= level);
    let [(xa, a), (xb, b)] = pair.expect("the profile crosses the level") else {
        unreachable!("pairs")
    };
    xa + (level - a) / (b - a) * (xb - xa)
}

#[test]
fn penumbrae_are_as_wide_as_the_suns_disc_makes_them() {
    let mut device = Device::new();
    let grey = matt(0.5);
    let day = clear_day(180.0, 90.0);
    let mut before = 0.0;
    for height in [5.0, 10.0, 20.0] {
        let scene = Model::default()
            .ground(8.0, &grey)
            .square([0.0, height as f32, 0.0], 2.0, &grey)
            .build();
        // From the side, under the square, toward its shadow's edge x = 2.
        let camera = Camera {
            fov_deg: 12.0,
            ..camera([5.5, 2.5, 0.0], [2.0, 0.0, 0.0])
        };
        let shadows = Shadows {
            penumbrae: true,
            ..Shadows::default()
        };
        let picture = device.picture(&scene, visibility([320, 240], shadows), &day, &camera);
        let mut profile: Vec<(f64, f64)> = picture
            .pixels()
            .filter_map(|(pixel, v)| Some((on_ground(&camera, picture.size, pixel)?, v.x)))
            .filter(|(p, _)| (p.x - 2.0).abs() < 0.25 && p.z.abs() < 0.3)
            .map(|(p, v)| (p.x, v))
            .collect();
        profile.sort_by(|a, b| a.0.total_cmp(&b.0));
        assert!(profile.len() > 1000, "{} pixels", profile.len());
        let (low, high) = (crossing(&profile, 0.1), crossing(&profile, 0.9));
        let width = (high - low) / (line_at(0.9) - line_at(0.1)) * 2.0;
        let expected = 2.0 * SUN_ANGULAR_RADIUS.tan() * height;
        let middle = crossing(&profile, 0.5);
        println!(
            "a square's edge {height} m above: penumbra {:.1} mm, expected {:.1} mm ({:+.1} %), its middle at x = {middle:.4}",
            width * 1e3,
            expected * 1e3,
            (width / expected - 1.0) * 100.0
        );
        assert!((width / expected - 1.0).abs() < 0.15, "{width} {expected}");
        assert!((middle - 2.0).abs() < 0.02 && width > before);
        before = width;
    }
}

#[test]
fn an_open_plane_is_lit_under_any_sun() {
    let mut device = Device::new();
    let scene = Model::default().ground(20.0, &matt(0.5)).build();
    let camera = camera([7.0, 8.0, 14.0], [0.0, 0.0, 0.0]);
    let shadows = Shadows {
        penumbrae: true,
        ..Shadows::default()
    };
    for elevation in [4.0, 15.0, 60.0, 90.0] {
        let day = clear_day(200.0, elevation);
        let picture = device.picture(&scene, visibility([160, 120], shadows), &day, &camera);
        let on_plane = |(pixel, v): ([usize; 2], DVec3)| {
            let p = on_ground(&camera, picture.size, pixel)?;
            (p.x.abs() < 19.0 && p.z.abs() < 19.0).then_some(v.x)
        };
        let lit: Vec<f64> = picture.pixels().filter_map(on_plane).collect();
        let dark = lit.iter().filter(|v| **v < 0.999).count();
        println!(
            "sun at {elevation} deg: {dark} of {} pixels are dark",
            lit.len()
        );
        assert!(dark == 0 && lit.len() > 5000);
    }
}

/// Squares above a plain of two kilometres: distance from the eye, half edge, height, metres.
const SQUARES: [[f64; 3]; 4] = [
    [6.0, 0.6, 0.5],
    [25.0, 3.0, 2.0],
    [120.0, 14.0, 9.0],
    [500.0, 60.0, 40.0],
];

fn plain() -> Scene {
    let grey = matt(0.5);
    let model = Model::default().ground(1000.0, &grey);
    let with = |model: Model, [distance, half, height]: [f64; 3]| {
        model.square([0.0, height as f32, -distance as f32], half as f32, &grey)
    };
    SQUARES.into_iter().fold(model, with).build()
}

fn in_shadow(p: DVec3, sun: DVec3) -> bool {
    SQUARES.iter().any(|[distance, half, height]| {
        let at = p + sun * (height / sun.y);
        at.x.abs() <= *half && (at.z + distance).abs() <= *half
    })
}

/// Ground pixels with the wrong visibility, and all tested ones; pixels near shadow edges are left out.
fn wrong(picture: &Picture, camera: &Camera, sun: DVec3) -> [usize; 2] {
    let (mut wrong, mut all) = (0, 0);
    for (pixel, v) in picture.pixels() {
        let Some(p) = on_ground(camera, picture.size, pixel) else {
            continue;
        };
        let far = (p - camera.eye.as_dvec3()).length();
        // Leave out pixels where a square hides the ground.
        if far > 600.0 || hides(camera, p) {
            continue;
        }
        let margin = 0.1 + 0.06 * far;
        let truth = in_shadow(p, sun);
        let ring = [[1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]];
        let beside = ring.map(|[x, z]| in_shadow(p + margin * DVec3::new(x, 0.0, z), sun));
        if beside.contains(&!truth) {
            continue;
        }
        all += 1;
        wrong += usize::from((v.x < 0.5) != truth);
    }
    [wrong, all]
}

/// Whether a square hides a point of the ground from the eye.
fn hides(camera: &Camera, p: DVec3) -> bool {
    let eye = camera.eye.as_dvec3();
    SQUARES.iter().any(|[distance, half, height]| {
        let at = p + (eye - p) * (height / eye.y);
        let margin = 1.05 * half + 0.02 * distance;
        *height < eye.y && at.x.abs() <= margin && (at.z + distance).abs() <= margin
    })
}

#[test]
fn cascades_shade_near_and_far() {
    let mut device = Device::new();
    let scene = plain();
    let day = clear_day(130.0, 35.0);
    let mut of = |eye: [f32; 3], target: [f32; 3], cascades: u32| {
        let camera = Camera {
            fov_deg: 50.0,
            ..crate::gpu::camera(eye, target)
        };
        let shadows = Shadows {
            cascades,
            penumbrae: false,
        };
        let picture = device.picture(&scene, visibility([320, 240], shadows), &day, &camera);
        wrong(&picture, &camera, day.sun_direction)
    };
    for (eye, target) in [
        ([0.0, 1.7, 0.0], [0.0, 0.0, -6.0]),
        ([0.0, 6.0, 0.0], [0.0, 0.0, -40.0]),
        ([0.0, 60.0, 20.0], [0.0, 0.0, -150.0]),
    ] {
        let [[bad, all], [bad_alone, _]] = [of(eye, target, 0), of(eye, target, 1)];
        println!(
            "eye {eye:?}: of {all} pixels {bad} are wrong with cascades, {bad_alone} with one map"
        );
        assert!(all > 5000 && bad * 500 < all, "{bad} of {all}");
        // From above one map is nearly as good; near the ground its texels are larger than the nearest shadow.
        let needs_them = eye[1] < 2.0;
        assert!(bad_alone >= if needs_them { 10 } else { bad });
    }
}

/// A long wall along z: the edge of its shadow crosses all cascades as it recedes from the viewer.
fn long_wall() -> Scene {
    let grey = matt(0.5);
    let wall = ([-2.0, 0.0, 5.0], [0.0, 0.0, -900.0], [0.0, 3.0, 0.0]);
    Model::default()
        .ground(1000.0, &grey)
        .quad(wall.0, wall.1, wall.2, &grey)
        .build()
}

/// Width of the wall's shadow edge at distances along the view, metres: from 5 % to 95 % of the light, by integration of
/// the values in between. Only where a pixel is narrower than the edge.
fn edge_widths(picture: &Picture, camera: &Camera, edge: f64) -> Vec<(f64, f64)> {
    let [width, height] = picture.size;
    let row_at = |y: usize| -> Option<(f64, f64)> {
        let points: Vec<(DVec3, f64)> = (0..width)
            .filter_map(|x| Some((on_ground(camera, picture.size, [x, y])?, picture.at(x, y).x)))
            .filter(|(p, _)| (p.x - edge).abs() < 12.0)
            .collect();
        let pixel = points.get(1)?.0.x - points.first()?.0.x;
        let away = (points[0].0.z - f64::from(camera.eye.z)).abs();
        // For a linear ramp from dark to light, the integral of 4 V (1 - V) is two thirds of its width.
        let sum: f64 = points
            .iter()
            .map(|(_, v)| 4.0 * v * (1.0 - v) * pixel)
            .sum();
        let width = 1.5 * sum;
        (width > 2.0 * pixel).then_some((away, width))
    };
    (0..height).rev().filter_map(row_at).collect()
}

#[test]
fn cascades_are_far_sharper_near_the_viewer_and_widen_without_a_seam() {
    let mut device = Device::new();
    let scene = long_wall();
    // Sun in the west: the 3 m shadow lies east of the wall.
    let day = clear_day(270.0, 40.0);
    let edge = -2.0 + 3.0 / 40f64.to_radians().tan();
    let camera = Camera {
        fov_deg: 50.0,
        ..crate::gpu::camera([edge as f32, 1.7, 0.0], [edge as f32, 0.0, -7.0])
    };
    let mut widths = |cascades: u32| {
        let shadows = Shadows {
            cascades,
            penumbrae: false,
        };
        // The maps alone, as while the view moves: rays sharpen the edges of coarse maps otherwise.
        let set = visibility([1280, 960], shadows);
        let mut frame = device.frame(&scene, set, &day, &camera);
        device.run(|rec| frame.preview(rec, &day, &camera));
        let picture = device.picture_of(&frame);
        edge_widths(&picture, &camera, edge)
    };
    let (many, one) = (widths(0), widths(1));
    let near = |list: &[(f64, f64)]| {
        let near: Vec<f64> = list
            .iter()
            .filter(|(z, _)| *z < 8.0)
            .map(|(_, w)| *w)
            .collect();
        assert!(near.len() > 20, "{} rows near the viewer", near.len());
        near.iter().sum::<f64>() / near.len() as f64
    };
    let (sharp, soft) = (near(&many), near(&one));
    println!("the edge is {sharp:.3} m wide within 8 m of the viewer, with one map {soft:.2} m");
    assert!(sharp < 0.12 && soft > 10.0 * sharp, "{sharp} {soft}");

    // The nearest cascade ends at 20 m and blends from 17 m on. The width changes gradually there.
    let at = |from: f64, to: f64| {
        let rows: Vec<f64> = many
            .iter()
            .filter(|(z, _)| (from..to).contains(z))
            .map(|(_, w)| *w)
            .collect();
        rows.iter().sum::<f64>() / rows.len() as f64
    };
    let steps: Vec<f64> = (0..14)
        .map(|i| at(15.0 + 0.5 * f64::from(i), 15.5 + 0.5 * f64::from(i)))
        .collect();
    println!("widths from 15 m to 22 m: {steps:.3?}");
    let whole = steps[13] - steps[0];
    assert!(whole > 2.0 * steps[0], "the next map is coarser: {steps:?}");
    for pair in steps.windows(2) {
        let step = (pair[1] - pair[0]).abs();
        assert!(step < 0.45 * whole, "a seam: {steps:?}");
    }
}
