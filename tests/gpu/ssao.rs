//! Ambient occlusion: an open plane, a corner in closed form, a thin wall, limiting cases, and path-traced references.

use std::f64::consts::PI;

use crate::common::{Worst, shared};
use crate::gpu::{Device, Model, Picture, camera, clear_day, matt, on_ground, settings};
use crate::truth::{VIEWS, View};
use glam::DVec3;
use skylight::frame::FrameSettings;
use skylight::passes::light::lighting::Show;
use skylight::passes::occlusion::ssao::SsaoSettings;
use skylight::scene::{Camera, Scene};

/// A radius (m) with a path-traced reference, and what is allowed on geometry 2 pixels away from the background. At 5 m A is too
/// bright: bodies are thicker than what A takes every surface for, and roofs beyond the picture do not count.
struct Truth {
    radius: f32,
    bias: f64,
    /// With occluders at every and at every second pixel. By default pictures of 640x360 have one at every pixel.
    rmse: [f64; 2],
}

const TRUTHS: [Truth; 2] = [
    Truth {
        radius: 1.0,
        bias: 0.02,
        rmse: [0.073, 0.094],
    },
    Truth {
        radius: 5.0,
        bias: 0.11,
        rmse: [0.19, 0.2],
    },
];

fn with_occlusion(set: FrameSettings, radius: f32, downscale: u32) -> FrameSettings {
    set.showing(Show::Occlusion).with_occlusion(SsaoSettings {
        radius,
        downscale,
        ..SsaoSettings::default()
    })
}

fn occlusion(
    device: &mut Device,
    scene: &Scene,
    camera: &Camera,
    radius: f32,
    downscale: u32,
) -> Picture {
    let set = with_occlusion(settings(240, 180), radius, downscale);
    device.picture(scene, set, &clear_day(180.0, 45.0), camera)
}

#[test]
fn an_open_plane_sees_the_whole_sky() {
    let mut device = Device::new();
    let scene = Model::default().ground(200.0, &matt(0.5)).build();
    let mut worst = Worst::new("A of an open plane against 1", 0.01);
    let views = [
        ([0.0, 1.7, 0.0], [0.0, 1.0, -10.0]),
        ([0.0, 0.2, 0.0], [3.0, 0.1, -10.0]),
        ([5.0, 30.0, 5.0], [0.0, 0.0, 0.0]),
        ([0.0, 10.0, 0.001], [0.0, 0.0, 0.0]),
        ([-4.0, 3.0, 7.0], [9.0, 0.0, 1.0]),
    ];
    for (eye, target) in views {
        for downscale in [1, 2] {
            for radius in [0.3, 1.0, 5.0] {
                let camera = camera(eye, target);
                let picture = occlusion(&mut device, &scene, &camera, radius, downscale);
                for (pixel, a) in picture.pixels() {
                    let at = format!("{pixel:?}, eye {eye:?}, radius {radius}, 1/{downscale}");
                    worst.see(a.x - 1.0, at);
                }
            }
        }
    }
    worst.finish();
}

#[test]
fn the_facets_of_a_smooth_body_do_not_hide_the_sky_from_it() {
    let mut device = Device::new();
    // Shading normals lean up to 11 degrees from the facets.
    let scene = Model::default()
        .sphere([0.0; 3], 1.0, 8, &matt(0.5))
        .build();
    // A pixel on the edge of two facets may get a facet between them.
    let mut worst = Worst::new("A of a sphere in the open against 1", 0.06);
    let mut mean = Worst::new("its mean", 0.003);
    for eye in [[0.0, 0.5, 3.5], [2.0, 2.4, 1.7]] {
        let camera = camera(eye, [0.0; 3]);
        for downscale in [1, 2] {
            let picture = occlusion(&mut device, &scene, &camera, 5.0, downscale);
            for (pixel, a) in picture.pixels() {
                worst.see(a.x - 1.0, format!("{pixel:?} from {eye:?}, 1/{downscale}"));
            }
            let errors: Vec<f64> = picture.pixels().map(|(_, a)| a.x - 1.0).collect();
            let error = errors.iter().sum::<f64>() / errors.len() as f64;
            mean.see(error, format!("from {eye:?}, 1/{downscale}"));
        }
    }
    mean.finish();
    worst.finish();
}

/// A on the ground at a distance from the foot of a wall, both infinite, counting occluders nearer than `radius`.
///
/// The wall at distance x occludes directions w with w·wall > c = x / radius. Cosine-weighted directions are uniform on the
/// unit disc (Nusselt), so the occluded fraction is the segment beyond c: (acos c - c sqrt(1 - c²)) / π; one half at the foot.
fn beside_wall(x: f64, radius: f64) -> f64 {
    let c = (x / radius).clamp(0.0, 1.0);
    1.0 - (c.acos() - c * (1.0 - c * c).sqrt()) / PI
}

/// Mean errors of A by distance from the foot, in bins of a tenth of the radius.
fn ramp_errors(picture: &Picture, camera: &Camera, radius: f64) -> Vec<(usize, f64)> {
    let mut bins = [(0.0, 0.0); 10];
    for (pixel, a) in picture.pixels() {
        let Some(p) = on_ground(camera, picture.size, pixel).filter(|p| p.z > 0.0) else {
            continue;
        };
        // The distance is positive: the cast truncates.
        if let Some(bin) = bins.get_mut((10.0 * p.z / radius) as usize) {
            *bin = (bin.0 + a.x - beside_wall(p.z, radius), bin.1 + 1.0);
        }
    }
    let mean = |(sum, count): (f64, f64)| sum / count;
    bins.into_iter().map(mean).enumerate().collect()
}

#[test]
fn the_foot_of_a_wall_sees_half_of_the_sky() {
    let mut device = Device::new();
    let grey = matt(0.5);
    let scene = Model::default()
        .ground(60.0, &grey)
        .quad(
            [-60.0, 0.0, 0.0],
            [120.0, 0.0, 0.0],
            [0.0, 60.0, 0.0],
            &grey,
        )
        .build();
    let camera = camera([0.5, 2.5, 4.0], [0.0, 0.3, 0.0]);
    // The mean along the wall: single pixels have the noise of their slice.
    let mut foot = Worst::new("A at the foot of a wall against its closed form", 0.04);
    let mut ramp = Worst::new("A up to the radius from the foot", 0.04);
    // Half a metre is only a few texels at half resolution.
    for (downscale, radii) in [(1, vec![0.5, 1.0, 2.0]), (2, vec![1.0, 2.0])] {
        for radius in radii {
            let picture = occlusion(&mut device, &scene, &camera, radius, downscale);
            for (i, error) in ramp_errors(&picture, &camera, f64::from(radius)) {
                let at = format!("{i} tenths of radius {radius}, 1/{downscale}");
                println!("{at}: {error:+.3}");
                let worst = if i == 0 { &mut foot } else { &mut ramp };
                worst.see(error, at);
            }
        }
    }
    ramp.finish();
    foot.finish();
}

#[test]
fn without_a_radius_nothing_occludes() {
    let mut device = Device::new();
    let scene = corner();
    for downscale in [1, 2] {
        let camera = camera([2.0, 2.0, 3.0], [0.0, 0.2, 0.0]);
        let picture = occlusion(&mut device, &scene, &camera, 0.0, downscale);
        let off = picture
            .pixels()
            .filter(|(_, a)| (a.x - 1.0).abs() > 1e-6)
            .count();
        println!("{} pixels, {off} of them are not 1", picture.texels.len());
        assert_eq!(off, 0);
    }
}

fn corner() -> Scene {
    let grey = matt(0.5);
    Model::default()
        .ground(5.0, &grey)
        .quad([-5.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 3.0, 0.0], &grey)
        .sphere([1.0, 0.5, 1.0], 0.5, 24, &grey)
        .cube([-1.0, 0.4, 0.8], 0.4, &grey)
        .build()
}

#[test]
fn occlusion_stays_within_nothing_and_everything() {
    let mut device = Device::new();
    let scene = corner();
    let (mut count, mut darkest) = (0, 1.0f64);
    for downscale in [1, 2] {
        for radius in [0.01, 1.0, 50.0] {
            for eye in [[2.0, 2.0, 3.0], [0.0, 0.3, 4.0], [-2.0, 6.0, 0.5]] {
                let camera = camera(eye, [0.0, 0.2, 0.0]);
                let picture = occlusion(&mut device, &scene, &camera, radius, downscale);
                for (pixel, a) in picture.pixels() {
                    // A device may divide with an error of some steps.
                    assert!(
                        (0.0..=1.0 + 1e-6).contains(&a.x),
                        "{a} at {pixel:?} from {eye:?}"
                    );
                    count += 1;
                    darkest = darkest.min(a.x);
                }
            }
        }
    }
    println!("{count} pixels within 0..=1, the darkest {darkest:.3}");
    assert!(darkest < 0.4, "nothing is occluded");
}

/// A wall without thickness in the plane z = 0, x from -4 to 4, 3 m high, with an opening.
const OPENING: [[f64; 2]; 2] = [[-1.0, 1.0], [0.4, 2.2]];

fn wall_with_an_opening() -> Scene {
    let grey = matt(0.5);
    let [[left, right], [sill, lintel]] = OPENING.map(|edges| edges.map(|edge| edge as f32));
    let [low, wide] = [[-4.0, left], [right, 4.0]];
    let pieces = [
        [low, [0.0, 3.0]],
        [wide, [0.0, 3.0]],
        [[left, right], [0.0, sill]],
        [[left, right], [lintel, 3.0]],
    ];
    let model = Model::default().ground(10.0, &grey);
    let add = |model: Model, [[x0, x1], [y0, y1]]: [[f32; 2]; 2]| {
        let (right, up) = ([x1 - x0, 0.0, 0.0], [0.0, y1 - y0, 0.0]);
        model.quad([x0, y0, 0.0], right, up, &grey)
    };
    pieces.into_iter().fold(model, add).build()
}

/// A of a point of the ground beside that wall, counting what is nearer than `radius`: cosine-weighted directions are uniform
/// on the unit disc (Nusselt).
fn beside_the_opening(p: DVec3, radius: f64) -> f64 {
    const SIDE: usize = 64;
    let [[left, right], [sill, lintel]] = OPENING;
    let at = |i: usize| (2 * i + 1) as f64 / SIDE as f64 - 1.0;
    let (mut open, mut all) = (0, 0);
    for (x, z) in (0..SIDE * SIDE).map(|i| (at(i % SIDE), at(i / SIDE))) {
        let Some(up) = Some(1.0 - x * x - z * z).filter(|up| *up >= 0.0) else {
            continue;
        };
        let t = -p.z / z;
        let (x, y) = (p.x + t * x, t * up.sqrt());
        let in_opening = (left..=right).contains(&x) && (sill..=lintel).contains(&y);
        let is_hidden =
            t > 0.0 && t < radius && x.abs() < 4.0 && (0.0..3.0).contains(&y) && !in_opening;
        (open, all) = (open + usize::from(!is_hidden), all + 1);
    }
    f64::from(open as u32) / f64::from(all as u32)
}

#[test]
fn what_is_seen_through_a_wall_without_thickness_is_not_black() {
    let mut device = Device::new();
    let scene = wall_with_an_opening();
    let mut mean = Worst::new("mean of A behind an opening against its integral", 0.04);
    let mut dark = Worst::new(
        "share of pixels there that are darker by more than 0.3",
        0.01,
    );
    for (eye, target) in [
        ([0.0, 3.5, 4.0], [0.0, 0.5, -1.0]),
        ([2.0, 2.5, 5.0], [0.0, 0.8, 0.0]),
    ] {
        let camera = camera(eye, target);
        for (radius, downscale) in [(5.0, 1), (5.0, 2), (2.0, 1)] {
            let picture = occlusion(&mut device, &scene, &camera, radius, downscale);
            let errors: Vec<f64> = picture
                .pixels()
                .filter_map(|(pixel, a)| {
                    let p = on_ground(&camera, picture.size, pixel).filter(|p| p.z < 0.0)?;
                    let crossing = p.lerp(camera.eye.as_dvec3(), p.z / (p.z - f64::from(eye[2])));
                    // 0.05 m from the edges of the opening, where A is blurred.
                    let is_seen = (crossing.x.abs() < 0.95) && (0.45..2.15).contains(&crossing.y);
                    is_seen.then(|| a.x - beside_the_opening(p, f64::from(radius)))
                })
                .collect();
            let at = format!(
                "eye {eye:?}, radius {radius}, 1/{downscale}, {} pixels",
                errors.len()
            );
            let bias = errors.iter().sum::<f64>() / errors.len() as f64;
            let darker = errors.iter().filter(|e| **e < -0.2).count() as f64 / errors.len() as f64;
            println!("{at}: bias {bias:+.3}, darker {darker:.4}");
            mean.see(bias, &at);
            dark.see(darker, &at);
        }
    }
    mean.finish();
    dark.finish();
}

#[test]
fn a_stays_when_the_view_does_and_a_small_step_changes_it_little() {
    let mut device = Device::new();
    let (scene, day) = (corner(), clear_day(180.0, 45.0));
    let set = with_occlusion(settings(240, 180), 5.0, 1);
    let from = |x: f32| camera([2.0 + x, 2.0, 3.0], [x, 0.2, 0.0]);
    let mut frame = device.frame(&scene, set, &day, &from(0.0));
    let first = device.picture_of(&frame);
    device.draw(&mut frame, &day, &from(0.0));
    assert_eq!(device.picture_of(&frame).texels, first.texels);
    device.draw(&mut frame, &day, &from(0.002));
    let stepped = device.picture_of(&frame);
    let pairs = stepped.pixels().zip(first.pixels());
    let sum: f64 = pairs.map(|((_, a), (_, b))| (a.x - b.x).abs()).sum();
    let mut change = Worst::new("mean change of A by a step of 2 mm", 0.003);
    change.see(sum / first.texels.len() as f64, "the corner");
    change.finish();
}

/// Bias and RMSE of A against the path-traced reference.
fn against_truth(device: &mut Device, view: &View, radius: f32, downscale: u32) -> (f64, f64) {
    let truth = view.exr(&format!("ao_{radius}m"));
    let set = with_occlusion(
        settings(truth.size[0] as u32, truth.size[1] as u32),
        radius,
        downscale,
    );
    let picture = device.picture(&view.scene, set, &clear_day(180.0, 45.0), &view.camera);
    let errors: Vec<f64> = view
        .geometry(2)
        .into_iter()
        .zip(picture.texels.iter().zip(truth.single()))
        .filter(|(inside, _)| *inside)
        .map(|(_, (found, expected))| f64::from(found[0] - expected))
        .collect();
    let count = errors.len() as f64;
    assert!(count > 10_000.0, "{}: {count} pixels", view.name);
    let bias = errors.iter().sum::<f64>() / count;
    let rmse = (errors.iter().map(|e| e * e).sum::<f64>() / count).sqrt();
    println!(
        "{:10} {radius} m, 1/{downscale}: bias {bias:+.4}, RMSE {rmse:.4} on {count} pixels",
        view.name
    );
    (bias, rmse)
}

#[test]
fn a_of_views_is_as_far_from_the_path_tracers_as_is_told() {
    let Some(shared) = shared() else { return };
    let mut device = Device::new();
    let mut bias = Worst::new("bias of A against the truth, of what is allowed", 1.0);
    let mut rmse = Worst::new("RMSE of A against the truth, of what is allowed", 1.0);
    for name in VIEWS {
        let view = View::load(&shared, name);
        for truth in &TRUTHS {
            let radius = truth.radius;
            for (downscale, most) in (1..).zip(truth.rmse) {
                let (b, r) = against_truth(&mut device, &view, radius, downscale);
                let at = format!("{name} {radius} m 1/{downscale}");
                bias.see(b / truth.bias, format!("{at}: {b:.4}"));
                rmse.see(r / most, format!("{at}: {r:.4}"));
            }
        }
    }
    bias.finish();
    rmse.finish();
}
