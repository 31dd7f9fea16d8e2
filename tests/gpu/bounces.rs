//! Light that surfaces reflect onto others, from rays in converged pictures and from the cells in single frames: closed forms, sums,
//! repeatability, and no light through walls.

use crate::common::Worst;
use crate::gpu::{Device, Model, Picture, camera, clear_day, constant_sky, matt, showing};
use crate::lighting::{check_sum, glossy_scene, roundings};
use glam::DVec3;
use skylight::daylight::colour::luminance;
use skylight::daylight::quadrature::SphereQuadrature;
use skylight::daylight::sky::Daylight;
use skylight::frame::{Frame, FrameSettings, Visibility};
use skylight::passes::bounces::cells::Bounces;
use skylight::passes::light::lighting::Show;
use skylight::scene::{Camera, Encoding, Material, Scene, Texture, Wrap};
pub use skylight::validate::device::from_cells as single;
pub use skylight::validate::surfaces::mean;
use std::f64::consts::PI;

/// Settings of a converged picture with all bounces.
pub fn converged(width: u32, height: u32, samples: u32) -> FrameSettings {
    let mut set = single(width, height);
    set.samples = samples;
    set.sampling.visibility = Visibility::Dome;
    set.sampling.dome.map_edge = 512;
    set
}

pub fn with_bounces(bounces: Bounces, settings: FrameSettings) -> FrameSettings {
    FrameSettings {
        bounces,
        ..settings
    }
}

fn brightest(picture: &Picture) -> f64 {
    let channels = picture.pixels().map(|(_, l)| l.max_element());
    channels.fold(0.0, f64::max)
}

/// Half the width of each of the two rooms, their height and half their depth, metres.
const HALF: f32 = 2.0;
const HEIGHT: f32 = 3.0;
/// Where the partition stands: off the round coordinates, so that it divides cells.
const PARTITION: f32 = 0.11;

/// Two rooms on one floor beside a partition without thickness. The one at x > 0 has an opening in its roof; the other is closed.
fn rooms(paint: &Material) -> Scene {
    let (depth, up) = ([0.0, 0.0, 2.0 * HALF], [0.0, HEIGHT, 0.0]);
    let (long, left) = ([4.0 * HALF, 0.0, 0.0], -2.0 * HALF);
    let wall = |model: Model, x: f32| model.quad([x, 0.0, -HALF], depth, up, paint);
    let roof = |model: Model, from: f32, to: f32| {
        model.quad([from, HEIGHT, -HALF], [to - from, 0.0, 0.0], depth, paint)
    };
    let mut model = Model::default()
        .quad([left, 0.0, HALF], long, [0.0, 0.0, -2.0 * HALF], paint)
        .quad([left, 0.0, -HALF], long, up, paint)
        .quad([left, 0.0, HALF], long, up, paint);
    for x in [left, PARTITION, 2.0 * HALF] {
        model = wall(model, x);
    }
    for (from, to) in [(left, 1.2), (2.8, 2.0 * HALF)] {
        model = roof(model, from, to);
    }
    model.build()
}

/// From one end of a room toward the partition: of the dark one, or of the lit one.
fn inside(dark: bool) -> Camera {
    let side = if dark { -1.0 } else { 1.0 };
    Camera {
        fov_deg: 75.0,
        ..camera([3.7 * side, 1.6, 1.2], [0.0, 1.2, -0.4])
    }
}

#[test]
fn the_same_seed_makes_the_same_light() {
    let (scene, day, view) = (rooms(&matt(0.6)), clear_day(150.0, 60.0), inside(false));
    for (what, set) in [
        ("converged", converged(96, 64, 4)),
        ("single", single(96, 64)),
    ] {
        let with_seed = |seed: u32| {
            let mut set = set;
            set.sampling.dome.seed = seed;
            Device::new().picture(&scene, set, &day, &view)
        };
        let (a, b, c) = (with_seed(3), with_seed(3), with_seed(4));
        let differ = a.texels.iter().zip(&b.texels).filter(|(a, b)| a != b);
        let ratio = mean(&a) / mean(&c);
        println!(
            "{what}: {} texels differ; mean to that of another seed {ratio:.4}",
            differ.clone().count()
        );
        assert_eq!(differ.count(), 0, "{what}");
        assert_ne!(a.texels, c.texels);
        assert!((ratio - 1.0).abs() < 0.03, "{what}: {ratio}");
    }
}

/// A room of 6 x 8 x 3 m on wide ground, with an opening of 4 x 1.6 m in the wall at z = 4 m.
fn room_with_a_window() -> Scene {
    let paint = matt(0.6);
    let (up, depth) = ([0.0, 3.0, 0.0], [0.0, 0.0, 8.0]);
    let front = |model: Model, [x, y]: [f32; 2], [width, height]: [f32; 2]| {
        model.quad([x, y, 4.0], [width, 0.0, 0.0], [0.0, height, 0.0], &paint)
    };
    let model = Model::default()
        .ground(40.0, &paint)
        .quad([-3.0, 3.0, -4.0], [6.0, 0.0, 0.0], depth, &paint)
        .quad([-3.0, 0.0, -4.0], [6.0, 0.0, 0.0], up, &paint)
        .quad([-3.0, 0.0, -4.0], depth, up, &paint)
        .quad([3.0, 0.0, -4.0], depth, up, &paint);
    let model = front(model, [-3.0, 0.0], [6.0, 0.8]);
    let model = front(model, [-3.0, 2.4], [6.0, 0.6]);
    let model = front(model, [-3.0, 0.8], [1.0, 1.6]);
    front(model, [2.0, 0.8], [1.0, 1.6]).build()
}

/// Few cells are in view, many beyond: those in view have little noise all the same.
#[test]
fn a_single_frame_of_a_small_part_of_a_room_is_right() {
    let mut device = Device::new();
    let (scene, day) = (room_with_a_window(), clear_day(150.0, 60.0));
    let view = Camera {
        fov_deg: 3.0,
        ..camera([-2.4, 2.3, -3.6], [0.0, 0.0, -1.0])
    };
    let mut light =
        |set: FrameSettings| mean(&device.picture(&scene, showing(Show::Sky, set), &day, &view));
    let right = light(converged(32, 18, 64));
    for seed in 0..6 {
        let mut set = single(32, 18);
        set.sampling.dome.seed = seed;
        let ratio = light(set) / right;
        println!(
            "seed {seed}: sky of a single frame over that of the converged picture {ratio:.3}"
        );
        assert!((ratio - 1.0).abs() < 0.15, "{seed}: {ratio}");
    }
}

#[test]
fn the_addends_with_bounces_sum_to_the_picture() {
    let mut device = Device::new();
    let (scene, day) = (glossy_scene(), clear_day(150.0, 35.0));
    let view = camera([1.0, 1.6, 4.5], [0.0, 0.6, 0.0]);
    let mut check = |set: FrameSettings, worst: Worst| {
        let mut frame = device.frame(&scene, set, &day, &view);
        let mut shown = |show| {
            frame.show(show).expect("shown");
            device.draw(&mut frame, &day, &view);
            let picture = device.picture_of(&frame);
            picture.pixels().map(|p| p.1).collect::<Vec<_>>()
        };
        let addends = Show::ADDENDS.map(&mut shown);
        check_sum(&shown(Show::Beauty), &addends, &[Show::Air], worst);
    };
    check(single(96, 54), roundings("sum of the addends, cells"));
    // The means of the frames round at each step.
    let worst = Worst::new("sum of the addends, converged", 1e-5);
    check(converged(96, 54, 4), worst);
}

#[test]
fn without_bounces_there_is_direct_light_alone() {
    let mut device = Device::new();
    let (scene, day, view) = (rooms(&matt(0.6)), clear_day(150.0, 60.0), inside(false));
    for (what, set) in [
        ("converged", converged(96, 64, 4)),
        ("single", single(96, 64)),
    ] {
        let mut draw = |show, bounces| {
            let set = with_bounces(bounces, showing(show, set));
            device.picture(&scene, set, &day, &view)
        };
        let none = draw(Show::Bounces, Bounces::UpTo(0));
        assert_eq!(brightest(&none), 0.0, "{what}: bounces");
        let direct = draw(Show::Beauty, Bounces::UpTo(0));
        let (whole, bounced) = (
            draw(Show::Beauty, Bounces::All),
            draw(Show::Bounces, Bounces::All),
        );
        println!(
            "{what}: direct {:.4}, bounces {:.4} kcd/m2",
            mean(&direct),
            mean(&bounced)
        );
        assert!(mean(&bounced) > 0.1 * mean(&direct));
        let mut worst = Worst::new("picture without its bounces against direct light", 1e-5);
        for (pixel, l) in whole.pixels() {
            let [x, y] = pixel;
            let rest = l - bounced.at(x, y) - direct.at(x, y);
            worst.see(
                rest.abs().max_element() / l.max_element(),
                format!("{what} {pixel:?}"),
            );
        }
        worst.finish();
    }
}

#[test]
fn more_bounces_are_brighter_and_those_beyond_the_eighth_are_few() {
    let mut device = Device::new();
    let (scene, day, view) = (rooms(&matt(0.5)), clear_day(150.0, 60.0), inside(false));
    for (what, set) in [
        ("converged", converged(64, 48, 32)),
        ("single", single(64, 48)),
    ] {
        let counts = [1, 2, 8].map(Bounces::UpTo);
        let [one, two, eight, all] =
            [counts[0], counts[1], counts[2], Bounces::All].map(|bounces| {
                let set = with_bounces(bounces, showing(Show::Bounces, set));
                mean(&device.picture(&scene, set, &day, &view))
            });
        println!("{what}: 1, 2, 8 and all bounces {one:.4} {two:.4} {eight:.4} {all:.4} kcd/m2");
        assert!(0.0 < one && one < two && two < eight, "{what}");
        // At most half of the light is reflected each time: beyond the eighth there is less than 1 % of it.
        assert!((all / eight - 1.0).abs() < 0.03, "{what}: {}", all / eight);
    }
}

/// A window goes over from previews, whose cells have all bounces asked for, to rays, whose cells have one less.
#[test]
fn few_bounces_at_rest_are_those_of_a_file() {
    let mut device = Device::new();
    let (scene, day, view) = (rooms(&matt(0.6)), clear_day(150.0, 60.0), inside(false));
    for bounces in [Bounces::UpTo(2), Bounces::All] {
        let set = with_bounces(bounces, showing(Show::Bounces, converged(64, 48, 8)));
        let file = mean(&device.picture(&scene, set, &day, &view));
        let mut set = set;
        set.sampling.visibility = Visibility::Progressive;
        let mut frame = device.run(|rec| Frame::new(rec, &scene, set).expect("a frame"));
        device.run(|rec| frame.preview(rec, &day, &view));
        for index in 0..set.samples {
            device.run(|rec| frame.record(rec, &day, &view, index));
        }
        let window = mean(&device.picture_of(&frame));
        println!("{bounces:?}: a file {file:.4}, at rest {window:.4} kcd/m2");
        assert!((window / file - 1.0).abs() < 0.02, "{bounces:?}");
    }
}

/// A white floor with a white cube: under a uniform sky everything is as bright as the sky, corners too.
#[test]
fn in_the_furnace_bounces_make_up_for_what_is_hidden() {
    let mut device = Device::new();
    let white = matt(1.0);
    let scene = Model::default()
        .ground(4.0, &white)
        .cube([0.0, 1.0, 0.0], 1.0, &white)
        .build();
    let (day, view) = (
        constant_sky(1000.0),
        camera([4.0, 2.5, 5.0], [0.0, 0.7, 0.0]),
    );
    let direct = with_bounces(Bounces::UpTo(0), single(64, 48));
    let darkest = |picture: &Picture| {
        let pixels = picture.pixels().map(|(_, l)| l.min_element());
        pixels.fold(f64::INFINITY, f64::min)
    };
    let without = darkest(&device.picture(&scene, direct, &day, &view));
    println!("without bounces the darkest pixel has {without:.3}");
    assert!(without < 0.7, "{without}");
    for (what, set, rmse_limit) in [
        ("converged", converged(64, 48, 64), 0.05),
        ("single", single(64, 48), 0.08),
    ] {
        let picture = device.picture(&scene, set, &day, &view);
        let (mean, pixels) = (mean(&picture), picture.texels.len() as f64);
        let squares = picture
            .pixels()
            .map(|(_, l)| (l - DVec3::ONE).length_squared() / 3.0);
        let rmse = (squares.sum::<f64>() / pixels).sqrt();
        println!(
            "{what}: mean {mean:.4}, RMSE {rmse:.4}, darkest {:.3}",
            darkest(&picture)
        );
        assert!((mean - 1.0).abs() < 0.01, "{what}: {mean}");
        assert!(rmse < rmse_limit, "{what}: {rmse}");
    }
}

/// A ball with its whole hemisphere of sky at every point: E(n) of the sky, from cells that hold it for few normals.
#[test]
fn on_a_curved_surface_the_sky_of_a_cell_follows_the_normal() {
    let mut device = Device::new();
    let scene = Model::default()
        .sphere([0.0; 3], 1.0, 64, &matt(0.5))
        .build();
    // From where a cell has a third of the size of the ball.
    let view = Camera {
        fov_deg: 18.0,
        ..camera([5.0, 2.5, 7.5], [0.0; 3])
    };
    let day = clear_day(150.0, 30.0);
    let mut frame = device.frame(&scene, single(96, 72), &day, &view);
    let [sky, normals] = [Show::Sky, Show::Normal].map(|show| {
        frame.show(show).expect("shown");
        for _ in 0..12 {
            device.run(|rec| frame.preview(rec, &day, &view));
        }
        device.picture_of(&frame)
    });
    let quadrature = SphereQuadrature::sphere(64, 128);
    let (mut squares, mut count) = (0.0, 0.0);
    for ([x, y], light) in sky.pixels() {
        let n = normals.at(x, y);
        // Background, and edges of the ball, which not every pixel of a square of two by two shows.
        if n.length() < 0.5 || n.dot((view.eye - view.target).as_dvec3().normalize()) < 0.4 {
            continue;
        }
        let unhidden = quadrature.irradiance(n.normalize(), |d| day.radiance(d));
        let expected = luminance(unhidden) / 1000.0 * 0.5 / PI;
        squares += (luminance(light) / expected - 1.0).powi(2);
        count += 1.0;
    }
    let rms = (squares / count).sqrt();
    println!("{count} pixels, RMS of the relative error {rms:.4}");
    assert!(count > 1000.0 && rms < 0.045, "{count} {rms}");
}

/// An upright leaf with the normal of the crown that it stands for, upward: half of its light comes through the card.
#[test]
fn a_leaf_has_the_sky_of_its_crown_in_a_single_frame_as_when_converged() {
    let mut device = Device::new();
    let leaf = Material {
        alpha_cutoff: Some(0.5),
        diffuse_texture: Some(0),
        ..matt(0.5)
    };
    let mut scene = Model::default()
        .quad([-1.0, -1.0, 0.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0], &leaf)
        .build();
    scene.normals.fill([0.0, 1.0, 0.0]);
    scene.textures = vec![Texture {
        name: String::from("leaf"),
        width: 1,
        height: 1,
        rgba8: vec![255; 4],
        encoding: Encoding::Srgb,
        wrap: [Wrap::Clamp; 2],
    }];
    let day = clear_day(150.0, 50.0);
    let expected = luminance(day.sky_irradiance_up) / 1000.0 * 0.5 / PI;
    for eye in [[0.0, 0.5, 3.0], [0.5, 0.5, -3.0]] {
        let view = camera(eye, [0.0; 3]);
        for (name, set) in [
            ("single", single(64, 64)),
            ("converged", converged(64, 64, 64)),
        ] {
            let picture = device.picture(&scene, showing(Show::Sky, set), &day, &view);
            let light = luminance(picture.at(32, 32)) / expected;
            println!("{name} from {eye:?}: {light:.4} of the light of the sky above");
            assert!((light - 1.0).abs() < 0.05, "{light}");
        }
    }
}

/// The picture in the dark room after eight previews in the lit one and `count` in the dark one, with the cells of both. Cells at the
/// partition are divided once both sides are seen; what the dark cells took from them before fades with their further paths.
fn after_a_walk(
    device: &mut Device,
    scene: &Scene,
    set: FrameSettings,
    day: &Daylight,
    count: u32,
) -> Picture {
    let mut frame = device.frame(scene, set, day, &inside(false));
    for (dark, count) in [(false, 8), (true, count)] {
        for _ in 0..count {
            device.run(|rec| frame.preview(rec, day, &inside(dark)));
        }
    }
    device.picture_of(&frame)
}

#[test]
fn no_light_comes_through_a_wall_without_thickness() {
    let mut device = Device::new();
    let (scene, day) = (rooms(&matt(0.7)), clear_day(90.0, 65.0));
    let check = |what: &str, lit: &Picture, dark: &Picture, limit: f64| {
        let (share, most) = (mean(dark) / mean(lit), brightest(dark) / mean(lit));
        println!(
            "{what}: lit {:.4} kcd/m2; of it in the dark room {share:.2e}, at most {most:.2e}",
            mean(lit)
        );
        assert!(mean(lit) > 0.0 && share < limit, "{what}: {share}");
    };
    // Light from the cells and of the rays; the maps of sun and sky have tests of their own.
    for (show, limit) in [(Show::Sky, 1e-3), (Show::Bounces, 2e-2)] {
        let set = showing(show, single(96, 64));
        let [lit, dark] =
            [false, true].map(|dark| device.picture(&scene, set, &day, &inside(dark)));
        check(&format!("single, {show:?}"), &lit, &dark, 1e-3);
        // Sixteen frames later little is left of what came through before the cells were divided.
        let walked = after_a_walk(&mut device, &scene, set, &day, 16);
        check(&format!("after a walk, {show:?}"), &lit, &walked, limit);
    }
    let set = showing(Show::Bounces, converged(96, 64, 16));
    let [lit, dark] = [false, true].map(|dark| device.picture(&scene, set, &day, &inside(dark)));
    check("converged, bounces", &lit, &dark, 1e-3);
}
