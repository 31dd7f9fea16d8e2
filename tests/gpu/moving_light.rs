//! The light of a moving view: it follows a moving sun, and it is steady while nothing but the camera moves.

use crate::gpu::{Device, Model, Picture, camera, clear_day, matt, settings};
use skylight::daylight::colour::luminance;
use skylight::daylight::sky::Daylight;
use skylight::frame::{Frame, FrameSettings, Visibility};
use skylight::passes::bounces::cells::{Bounces, Cells};
use skylight::passes::light::lighting::{Ambient, Show};
use skylight::scene::{Camera, Scene};

/// A court: a floor between two walls of different reflectance.
fn court() -> Scene {
    let (bright, dark) = (matt(0.8), matt(0.3));
    Model::default()
        .ground(6.0, &matt(0.5))
        .quad([-3.0, 0.0, 4.0], [0.0, 0.0, -8.0], [0.0, 4.0, 0.0], &bright)
        .quad([3.0, 0.0, -4.0], [0.0, 0.0, 8.0], [0.0, 4.0, 0.0], &dark)
        .build()
}

/// Settings of single frames that show the light of the cells.
fn moving(show: Show) -> FrameSettings {
    let mut set = settings(128, 72);
    set.bounces = Bounces::All;
    set.lighting.ambient = Ambient::Cells;
    set.showing(show)
}

fn previews(device: &mut Device, frame: &mut Frame, day: &Daylight, eye: &Camera, count: u32) {
    for _ in 0..count {
        device.run(|rec| frame.preview(rec, day, eye));
    }
}

fn mean(picture: &Picture) -> f64 {
    picture.pixels().map(|(_, l)| luminance(l)).sum::<f64>() / picture.texels.len() as f64
}

#[test]
fn the_light_follows_a_moving_sun_within_four_frames() {
    let mut device = Device::new();
    let scene = court();
    let eye = camera([0.0, 2.0, 7.0], [0.0, 1.0, 0.0]);
    let days = [
        clear_day(90.0, 30.0),
        clear_day(150.0, 50.0),
        clear_day(260.0, 20.0),
    ];
    for show in [Show::Bounces, Show::Sky] {
        let set = moving(show);
        let mut frame = device.run(|rec| Frame::new(rec, &scene, set).expect("a frame"));
        previews(&mut device, &mut frame, &days[0], &eye, 24);
        for day in &days[1..] {
            let mut other = device.run(|rec| Frame::new(rec, &scene, set).expect("a frame"));
            previews(&mut device, &mut other, day, &eye, 48);
            let finally = device.picture_of(&other);
            // The first frame already is right on the mean, but for light that was reflected more often; and the noise is less with each.
            for (count, tolerance) in [(1, 0.1), (2, 0.08), (3, 0.06), (4, 0.05)] {
                previews(&mut device, &mut frame, day, &eye, 1);
                let [ratio, median] = errors(&device.picture_of(&frame), &finally);
                println!("{show:?} after {count}: ratio {ratio:.4}, median error {median:.4}");
                assert!((ratio - 1.0).abs() < tolerance, "{show:?} after {count}");
            }
            previews(&mut device, &mut frame, day, &eye, 8);
        }
    }
}

/// What the first frame after a jump shows is noisier than what follows, and about as bright: the mean over several seeds. Light that was reflected
/// more often than its paths are long is still the old one's, scaled.
#[test]
fn the_first_frame_after_a_jump_is_right_on_the_mean() {
    const SEEDS: u32 = 6;
    let mut device = Device::new();
    let scene = court();
    let eye = camera([0.0, 2.0, 7.0], [0.0, 1.0, 0.0]);
    let (old, new) = (clear_day(90.0, 30.0), clear_day(150.0, 50.0));
    let [mut first, mut last] = [0.0; 2];
    for seed in 0..SEEDS {
        let mut set = moving(Show::Bounces);
        set.sampling.dome.seed = seed;
        let mut frame = device.run(|rec| Frame::new(rec, &scene, set).expect("a frame"));
        previews(&mut device, &mut frame, &old, &eye, 24);
        previews(&mut device, &mut frame, &new, &eye, 1);
        first += mean(&device.picture_of(&frame));
        previews(&mut device, &mut frame, &new, &eye, 48);
        last += mean(&device.picture_of(&frame));
    }
    let ratio = first / last;
    println!("first frame over converged light: {ratio:.4}");
    assert!((ratio - 1.0).abs() < 0.06);
}

/// A jump of the light makes no frame long: each has one round of the cells.
#[test]
fn a_frame_has_one_round_of_the_cells_whatever_the_light_does() {
    let mut device = Device::new();
    let (scene, set) = (court(), moving(Show::Beauty));
    let eye = camera([0.0, 2.0, 7.0], [0.0, 1.0, 0.0]);
    let days = [(90.0, 30.0), (200.0, 50.0), (202.0, 50.0)].map(|(a, h)| clear_day(a, h));
    let mut frame = device.run(|rec| Frame::new(rec, &scene, set).expect("a frame"));
    let rounds = |frame: &Frame| frame.cells().map_or(0, Cells::rounds);
    previews(&mut device, &mut frame, &days[0], &eye, 24);
    for day in [1, 1, 2, 2, 0, 2, 2] {
        let before = rounds(&frame);
        previews(&mut device, &mut frame, &days[day], &eye, 1);
        assert_eq!(rounds(&frame) - before, 1);
    }
}

/// The mean over the pixels of the temporal standard deviation of their luminance, relative to the mean luminance.
fn flicker(pictures: &[Picture]) -> f64 {
    let count = pictures.len() as f64;
    let luminances: Vec<Vec<f64>> = pictures
        .iter()
        .map(|picture| picture.pixels().map(|(_, l)| luminance(l)).collect())
        .collect();
    let pixels = luminances[0].len();
    let (mut deviations, mut sum) = (0.0, 0.0);
    for pixel in 0..pixels {
        let values = luminances.iter().map(|picture| picture[pixel]);
        let mean = values.clone().sum::<f64>() / count;
        let variance = values.map(|v| (v - mean).powi(2)).sum::<f64>() / count;
        deviations += variance.sqrt();
        sum += mean;
    }
    deviations / sum
}

#[test]
fn still_pixels_do_not_flicker_while_the_cells_are_refined() {
    let mut device = Device::new();
    let eye = camera([0.0, 2.0, 7.0], [0.0, 1.0, 0.0]);
    let set = moving(Show::Beauty);
    let mut frame = device.run(|rec| Frame::new(rec, &court(), set).expect("a frame"));
    let day = clear_day(150.0, 40.0);
    previews(&mut device, &mut frame, &day, &eye, 30);
    let pictures: Vec<Picture> = (0..16)
        .map(|_| {
            previews(&mut device, &mut frame, &day, &eye, 1);
            device.picture_of(&frame)
        })
        .collect();
    let flicker = flicker(&pictures);
    println!(
        "temporal standard deviation {:.3} % of the mean",
        100.0 * flicker
    );
    assert!(flicker < 0.01);
}

/// Ratio of the means, and the median of the relative errors of the pixels, of a picture against another one.
fn errors(picture: &Picture, truth: &Picture) -> [f64; 2] {
    let pairs = picture.pixels().zip(truth.pixels());
    let lit = pairs.filter(|(_, (_, truth))| luminance(*truth) > 0.0);
    let relative = lit.map(|((_, a), (_, b))| (luminance(a) / luminance(b) - 1.0).abs());
    let mut relative: Vec<f64> = relative.collect();
    relative.sort_by(f64::total_cmp);
    [mean(picture) / mean(truth), relative[relative.len() / 2]]
}

/// A walk of sixty frames into the court and past its wall: on the way the light of sky and bounces is that of a converged picture.
#[test]
fn on_a_walk_the_light_is_right() {
    let mut device = Device::new();
    let (scene, day) = (court(), clear_day(150.0, 40.0));
    let at = |step: u32| {
        let along = step as f32 / 60.0;
        camera([-1.5, 1.7, 8.0 - 5.0 * along], [2.0 - along, 1.0, 0.0])
    };
    let mut frame = device.run(|rec| Frame::new(rec, &scene, moving(Show::Sky)).expect("a frame"));
    let mut step = 0;
    for stop in [30, 60] {
        for show in [Show::Sky, Show::Bounces] {
            while step < stop {
                previews(&mut device, &mut frame, &day, &at(step), 1);
                step += 1;
            }
            frame.show(show).expect("shown");
            previews(&mut device, &mut frame, &day, &at(stop), 1);
            let moving_picture = device.picture_of(&frame);
            let mut set = moving(show);
            set.samples = 48;
            set.sampling.visibility = Visibility::Dome;
            let truth = device.picture(&scene, set, &day, &at(stop));
            let [ratio, median] = errors(&moving_picture, &truth);
            println!("{show:?} at step {stop}: ratio {ratio:.4}, median error {median:.4}");
            // The noise of the converged bounces is in it.
            assert!(
                (ratio - 1.0).abs() < 0.03 && median < 0.15,
                "{show:?} {stop}"
            );
        }
    }
}

/// The 99.9 % quantile, over pixels and frames, of what the logarithm of the luminance jumps by: its second difference in time. Much
/// darker light than the mean does not count.
fn largest_jumps(pictures: &[Picture]) -> f64 {
    let floor = 0.02 * pictures.iter().map(mean).sum::<f64>() / pictures.len() as f64;
    let log = |picture: &Picture| -> Vec<f64> {
        let values = picture.pixels();
        values.map(|(_, l)| (luminance(l) + floor).ln()).collect()
    };
    let logs: Vec<Vec<f64>> = pictures.iter().map(log).collect();
    let mut jumps: Vec<f64> = logs
        .windows(3)
        .flat_map(|three| {
            let pixels = 0..three[0].len();
            pixels.map(|i| (three[0][i] - 2.0 * three[1][i] + three[2][i]).abs())
        })
        .collect();
    jumps.sort_by(f64::total_cmp);
    jumps[(jumps.len() - 1) * 999 / 1000]
}

/// A roof on thirty-six posts.
fn hall() -> Scene {
    let (stone, floor) = (matt(0.6), matt(0.4));
    let model = Model::default().ground(16.0, &floor);
    let model = model.square([0.0, 3.5, 0.0], 6.0, &stone);
    (0..36)
        .fold(model, |model, i| {
            let (x, z) = (2.0 * (i % 6) as f32 - 5.0, 2.0 * (i / 6) as f32 - 5.0);
            let (edge, up) = (0.4, [0.0, 3.5, 0.0]);
            model
                .quad([x, 0.0, z + edge], [edge, 0.0, 0.0], up, &stone)
                .quad([x + edge, 0.0, z], [-edge, 0.0, 0.0], up, &stone)
                .quad([x, 0.0, z], [0.0, 0.0, edge], up, &stone)
                .quad([x + edge, 0.0, z + edge], [0.0, 0.0, -edge], up, &stone)
        })
        .build()
}

/// The camera turns to what it has not seen and stops there. As nothing moves any more, all that changes are the cells.
#[test]
fn what_comes_into_view_does_not_jump() {
    let mut device = Device::new();
    let (scene, day) = (hall(), clear_day(150.0, 40.0));
    let turned = |steps: u32| {
        let (sin, cos) = (10.0 * steps as f32).to_radians().sin_cos();
        camera([0.9, 1.7, 7.0], [0.9 + 5.0 * sin, 1.5, 7.0 - 5.0 * cos])
    };
    let set = moving(Show::Sky);
    let mut frame = device.run(|rec| Frame::new(rec, &scene, set).expect("a frame"));
    previews(&mut device, &mut frame, &day, &turned(14), 20);
    for steps in (1..14).rev() {
        previews(&mut device, &mut frame, &day, &turned(steps), 1);
    }
    let pictures: Vec<Picture> = (0..12)
        .map(|_| {
            previews(&mut device, &mut frame, &day, &turned(0), 1);
            device.picture_of(&frame)
        })
        .collect();
    let jumps = largest_jumps(&pictures);
    println!("99.9 % of the pixels jump by less than {jumps:.3}");
    assert!(jumps < 1.4, "{jumps}");
}
