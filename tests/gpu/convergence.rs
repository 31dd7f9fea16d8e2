//! Convergence of the accumulated dome lighting: the rate of the error, and no remaining bias.

use std::f64::consts::PI;

use crate::gpu::{Device, camera, clear_day, constant_sky, matt, on_ground, settings, showing};
use crate::room::{ROOM, configuration_factor, room, under_the_roof};
use skylight::daylight::colour::luminance;
use skylight::frame::{Frame, FrameSettings, Visibility};
use skylight::passes::light::lighting::Show;

fn dome(edge: u32, map_edge: u32, directions: u32) -> FrameSettings {
    let mut set = showing(Show::Irradiance, settings(edge, edge));
    set.sampling.visibility = Visibility::Dome;
    set.sampling.dome.directions = directions;
    set.sampling.dome.map_edge = map_edge;
    set
}

/// Least-squares fit of the exponent in error = c n^exponent.
fn exponent(list: &[(u32, f64)]) -> f64 {
    let points: Vec<(f64, f64)> = list
        .iter()
        .map(|(n, e)| (f64::from(*n).ln(), e.ln()))
        .collect();
    let count = points.len() as f64;
    let mean = |f: &dyn Fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / count;
    let (x, y) = (mean(&|p| p.0), mean(&|p| p.1));
    mean(&|p| (p.0 - x) * (p.1 - y)) / mean(&|p| (p.0 - x).powi(2))
}

#[test]
fn the_error_falls_at_least_as_the_root_of_the_number_and_no_bias_stays() {
    const L: f64 = 5000.0;
    let mut device = Device::new();
    let (scene, view, day) = (room(ROOM[2], &matt(0.8)), under_the_roof(), constant_sky(L));
    let set = FrameSettings {
        samples: 512,
        ..dome(48, 512, 4)
    };
    let mut frame = device.run(|rec| Frame::new(rec, &scene, set).expect("a frame"));
    while !frame.is_refined() {
        device.run(|rec| frame.record_light(rec, &day));
    }
    let mut list = Vec::new();
    let mut ratio = 0.0;
    for index in 0..512u32 {
        device.run(|rec| frame.record(rec, &day, &view, index));
        if !(index + 1).is_power_of_two() {
            continue;
        }
        let picture = device.picture_of(&frame);
        let (mut squares, mut sum, mut found, mut count) = (0.0, 0.0, 0.0, 0.0);
        for (pixel, e) in picture.pixels() {
            let floor = on_ground(&view, picture.size, pixel)
                .filter(|p| p.x.abs().max(p.z.abs()) < f64::from(ROOM[0]) - 0.15);
            let Some(p) = floor else { continue };
            let exact = PI * L * configuration_factor(p);
            squares += (1e3 * luminance(e) - exact).powi(2);
            (sum, found, count) = (sum + exact, found + 1e3 * luminance(e), count + 1.0);
        }
        let error = f64::sqrt(squares / count) / (sum / count);
        ratio = found / sum;
        println!(
            "{:4} samples of 4 directions: RMSE/mean {error:.5}, mean ratio {ratio:.5}",
            index + 1
        );
        list.push((index + 1, error));
    }
    // From the first frame to where only the error from the texel size of the maps remains.
    let falling = exponent(&list[..8]);
    println!("error falls as N^{falling:.2}");
    assert!(falling <= -0.5, "{falling}");
    assert!((ratio - 1.0).abs() < 0.01, "{ratio}");
}

#[test]
fn open_ground_has_no_bias() {
    let mut device = Device::new();
    let scene = crate::gpu::Model::default()
        .ground(20.0, &matt(0.5))
        .build();
    let day = clear_day(200.0, 35.0);
    let set = FrameSettings {
        samples: 4096,
        ..showing(Show::Sky, dome(8, 64, 4))
    };
    let view = camera([0.0, 3.0, 0.0], [2.0, 0.0, -1.0]);
    let picture = device.picture(&scene, set, &day, &view);
    let exact = luminance(day.sky_irradiance_up) * 0.5 / PI * 1e-3;
    let mean =
        picture.pixels().map(|(_, l)| luminance(l)).sum::<f64>() / picture.texels.len() as f64;
    println!(
        "open ground, 4096 samples: {:+.3} %",
        100.0 * (mean / exact - 1.0)
    );
    assert!((mean / exact - 1.0).abs() < 3e-3, "{}", mean / exact);
}
