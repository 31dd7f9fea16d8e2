//! Ambient occlusion: an open plane, a corner in closed form, limiting cases, and path-traced references.

use std::f64::consts::PI;

use crate::common::{Worst, shared};
use crate::gpu::{Device, Model, Picture, camera, clear_day, matt, on_ground, settings};
use crate::truth::{VIEWS, View};
use skylight::frame::FrameSettings;
use skylight::passes::light::lighting::Show;
use skylight::passes::occlusion::ssao::SsaoSettings;
use skylight::scene::{Camera, Scene};

/// Radii (m) with a path-traced reference, and the RMSE allowed with occluders at every and at every second pixel, on geometry
/// 2 pixels away from the background. By default pictures of 640x360 have an occluder at every pixel.
const TRUTH_RMSE: [(f32, [f64; 2]); 2] = [(1.0, [0.065, 0.085]), (5.0, [0.1, 0.115])];
const TRUTH_BIAS: f64 = 0.03;

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
        let off = picture.pixels().filter(|(_, a)| a.x != 1.0).count();
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
                    assert!((0.0..=1.0).contains(&a.x), "{a} at {pixel:?} from {eye:?}");
                    count += 1;
                    darkest = darkest.min(a.x);
                }
            }
        }
    }
    println!("{count} pixels within 0..=1, the darkest {darkest:.3}");
    assert!(darkest < 0.4, "nothing is occluded");
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

/// Cosine-weighted fraction of the hemisphere that a rectangle parallel to the ground covers. Its edges are at `x` and `z`
/// relative to the point (configuration factor of parallel rectangles, summed over its quarters).
fn overhead(x: [f64; 2], z: [f64; 2], height: f64) -> f64 {
    let quarter = |a: f64, b: f64| {
        let (a, b) = (a / height, b / height);
        let term = |a: f64, b: f64| a / (1.0 + a * a).sqrt() * (b / (1.0 + a * a).sqrt()).atan();
        (term(a, b) + term(b, a)) / (2.0 * PI)
    };
    quarter(x[1], z[1]) - quarter(x[0], z[1]) - quarter(x[1], z[0]) + quarter(x[0], z[0])
}

#[test]
fn a_roof_that_the_picture_does_not_show_hides_the_sky() {
    let mut device = Device::new();
    let grey = matt(0.5);
    let (half, height) = (2.2, 1.5);
    let side = 2.0 * half as f32;
    let scene = Model::default()
        .ground(10.0, &grey)
        .quad(
            [-half as f32, height as f32, -half as f32],
            [0.0, 0.0, side],
            [side, 0.0, 0.0],
            &grey,
        )
        .build();
    let camera = camera([0.0, 1.2, 0.001], [0.0; 3]);
    let mut worst = Worst::new("mean of A under a roof against its closed form", 0.05);
    for downscale in [1, 2] {
        let picture = occlusion(&mut device, &scene, &camera, 5.0, downscale);
        let errors: Vec<f64> = picture
            .pixels()
            .filter_map(|(pixel, a)| {
                let p = on_ground(&camera, picture.size, pixel)?;
                let edges = |at: f64| [-half - at, half - at];
                Some(a.x - (1.0 - overhead(edges(p.x), edges(p.z), height)))
            })
            .collect();
        let mean = errors.iter().sum::<f64>() / errors.len() as f64;
        worst.see(mean, format!("1/{downscale} of {} pixels", errors.len()));
    }
    worst.finish();
}

#[test]
fn the_truth_is_near() {
    let Some(shared) = shared() else { return };
    let mut device = Device::new();
    let mut bias = Worst::new("bias of A against the truth", TRUTH_BIAS);
    let mut rmse = Worst::new("RMSE of A against the truth, of what is allowed", 1.0);
    for name in VIEWS {
        let view = View::load(&shared, name);
        for (radius, most) in TRUTH_RMSE {
            for (downscale, most) in (1..).zip(most) {
                let (b, r) = against_truth(&mut device, &view, radius, downscale);
                bias.see(b, format!("{name} {radius} m 1/{downscale}"));
                rmse.see(r / most, format!("{name} {radius} m 1/{downscale}: {r:.4}"));
            }
        }
    }
    bias.finish();
    rmse.finish();
}
