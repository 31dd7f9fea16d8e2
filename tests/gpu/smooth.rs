//! Anti-aliasing of what is displayed: temporal means against means of many samples, what is rejected, and what is never touched.

use crate::gpu::{Device, Model, camera, constant_sky, matt, settings};
use glam::Vec3;
use skylight::daylight::false_colour::{ColourMap, Colours, Range};
use skylight::daylight::sky::Daylight;
use skylight::frame::{AntiAliasing, Frame, FrameSettings};
use skylight::passes::light::lighting::Show;
use skylight::scene::{Camera, Scene};

const SIZE: [u32; 2] = [160, 90];

/// A bright board with slanted edges, three metres before a dark wall.
fn board() -> Scene {
    Model::default()
        .quad(
            [-20.0, -20.0, -3.0],
            [40.0, 0.0, 0.0],
            [0.0, 40.0, 0.0],
            &matt(0.1),
        )
        .quad(
            [-0.8, -0.5, 0.0],
            [1.5, 0.2, 0.0],
            [-0.2, 1.0, 0.0],
            &matt(0.9),
        )
        .build()
}

fn eye() -> Camera {
    camera([0.0, 0.2, 4.0], [0.0, 0.1, 0.0])
}

fn aside(metres: f32) -> Camera {
    let step = Vec3::new(metres, 0.0, 0.0);
    let eye = eye();
    Camera {
        eye: eye.eye + step,
        target: eye.target + step,
        ..eye
    }
}

fn with(aa: AntiAliasing) -> FrameSettings {
    FrameSettings {
        aa,
        ..settings(SIZE[0], SIZE[1])
    }
}

struct Shown {
    /// Display values, encoded, and the number of frames in them.
    texels: Vec<[f32; 4]>,
}

impl Shown {
    fn grey(&self, x: usize, y: usize) -> f32 {
        self.texels[y * SIZE[0] as usize + x][0]
    }

    /// Numbers of frames, sorted.
    fn counts(&self) -> Vec<u32> {
        let counts = self.texels.iter().map(|t| (t[3] * 255.0).round() as u32);
        let mut counts: Vec<u32> = counts.collect();
        counts.sort_unstable();
        counts
    }

    /// Root mean square and greatest difference.
    fn apart(&self, other: &Self) -> (f32, f32) {
        let pairs = self.texels.iter().zip(&other.texels);
        let errors: Vec<f32> = pairs.map(|(a, b)| a[0] - b[0]).collect();
        let sum: f32 = errors.iter().map(|e| e * e).sum();
        let most = errors.iter().fold(0f32, |most, e| most.max(e.abs()));
        ((sum / errors.len() as f32).sqrt(), most)
    }
}

fn frame(device: &mut Device, scene: &Scene, settings: FrameSettings) -> Frame {
    device.run(|rec| Frame::new(rec, scene, settings).expect("a frame"))
}

fn moved(device: &mut Device, frame: &mut Frame, day: &Daylight, view: &Camera) -> Shown {
    device.run(|rec| frame.preview(rec, day, view));
    shown(device, frame)
}

fn shown(device: &mut Device, frame: &Frame) -> Shown {
    Shown {
        texels: device.read(frame.display()),
    }
}

/// The mean of many samples.
fn truth(device: &mut Device, scene: &Scene, day: &Daylight, view: &Camera) -> Shown {
    let settings = FrameSettings {
        samples: 64,
        ..with(AntiAliasing::Off)
    };
    let frame = device.frame(scene, settings, day, view);
    shown(device, &frame)
}

#[test]
fn a_view_at_rest_shows_the_mean_of_many_samples() {
    let mut device = Device::new();
    let (scene, day) = (board(), constant_sky(8000.0));
    let truth = truth(&mut device, &scene, &day, &eye());
    let mut error = |aa| {
        let mut frame = frame(&mut device, &scene, with(aa));
        let mut last = moved(&mut device, &mut frame, &day, &eye());
        for _ in 0..31 {
            last = moved(&mut device, &mut frame, &day, &eye());
        }
        last.apart(&truth)
    };
    let [off, smaa, taa] =
        [AntiAliasing::Off, AntiAliasing::Smaa, AntiAliasing::Taa].map(&mut error);
    println!("rms and greatest error: off {off:?}, smaa {smaa:?}, taa {taa:?}");
    assert!(
        taa.0 < 0.2 * off.0 && taa.1 < 0.25 * off.1,
        "{off:?} {taa:?}"
    );
    assert!(smaa.0 < 0.5 * off.0, "{off:?} {smaa:?}");
}

#[test]
fn what_comes_into_view_has_no_ghost() {
    let mut device = Device::new();
    let (scene, day) = (board(), constant_sky(8000.0));
    let mut frame = frame(&mut device, &scene, with(AntiAliasing::Taa));
    for step in 0..12 {
        moved(&mut device, &mut frame, &day, &aside(0.02 * step as f32));
    }
    // The board moves by a tenth of the picture.
    let view = aside(0.6);
    let after = moved(&mut device, &mut frame, &day, &view);
    let truth = truth(&mut device, &scene, &day, &view);
    let (mut away, mut anew) = (0, 0);
    for (i, (test, true_one)) in after.texels.iter().zip(&truth.texels).enumerate() {
        let (x, y) = (i % SIZE[0] as usize, i / SIZE[0] as usize);
        let near = |dx: usize, dy: usize| {
            let (x, y) = (x + dx, y + dy);
            (2..162).contains(&x)
                && (2..92).contains(&y)
                && (truth.grey(x - 2, y - 2) - true_one[0]).abs() > 0.02
        };
        if (0..5).any(|dx| (0..5).any(|dy| near(dx, dy))) {
            continue;
        }
        away += 1;
        anew += usize::from((test[3] * 255.0).round() == 1.0);
        let error = (test[0] - true_one[0]).abs();
        assert!(error < 2.5 / 255.0, "a ghost of {error} at {x}, {y}");
    }
    println!("{away} pixels away from edges, {anew} of them new");
    assert!(
        away > 10_000 && (500..away / 2).contains(&anew),
        "{anew} of {away}"
    );
}

#[test]
fn a_pan_keeps_an_even_plane_even() {
    let mut device = Device::new();
    let scene = Model::default()
        .quad(
            [-20.0, -20.0, -3.0],
            [40.0, 0.0, 0.0],
            [0.0, 40.0, 0.0],
            &matt(0.5),
        )
        .build();
    let day = constant_sky(8000.0);
    let mut frame = frame(&mut device, &scene, with(AntiAliasing::Taa));
    for step in 0..8 {
        let mut view = aside(0.05 * step as f32);
        view.target.x += 0.1 * step as f32;
        let picture = moved(&mut device, &mut frame, &day, &view);
        let values = picture.texels.iter().map(|t| t[0] * 255.0);
        let (least, most) = values.fold((f32::MAX, 0f32), |(a, b), v| (a.min(v), b.max(v)));
        assert!(most - least < 4.5, "{least} to {most} in step {step}");
    }
}

#[test]
fn the_more_a_motion_blurs_the_fewer_frames_count() {
    let mut device = Device::new();
    let scene = Model::default()
        .quad(
            [-20.0, -20.0, 0.0],
            [40.0, 0.0, 0.0],
            [0.0, 40.0, 0.0],
            &matt(0.5),
        )
        .build();
    let day = constant_sky(8000.0);
    let view = |metres: f32| camera([metres, 0.0, 4.0], [metres, 0.0, 0.0]);
    let half = (0.5 * view(0.0).fov_deg.to_radians()).tan();
    let pixel = 2.0 * 4.0 * half / SIZE[1] as f32;
    // 1 / (f (1 - f) / 2 + 1/10) frames for a fraction f of a pixel; see include/temporal.glsl.
    for (pixels, frames) in [(1.0, 10), (1.1, 7), (1.5, 4)] {
        let mut frame = frame(&mut device, &scene, with(AntiAliasing::Taa));
        let mut counts = Vec::new();
        for step in 0..16 {
            let aside = view(pixels * pixel * step as f32);
            counts = moved(&mut device, &mut frame, &day, &aside).counts();
        }
        assert_eq!(counts[counts.len() / 2], frames, "{pixels} pixels a frame");
    }
}

#[test]
fn jumps_of_view_and_light_start_anew() {
    let mut device = Device::new();
    let scene = board();
    let day = |azimuth: f64| crate::gpu::clear_day(azimuth, 40.0);
    let mut frame = frame(&mut device, &scene, with(AntiAliasing::Taa));
    let mut counts = |day: &Daylight, view: &Camera| {
        let counts = moved(&mut device, &mut frame, day, view).counts();
        (counts[0], counts[counts.len() - 1])
    };
    let morning = day(100.0);
    assert_eq!(counts(&morning, &eye()), (1, 1));
    for frames in 2..=10 {
        assert_eq!(counts(&morning, &eye()), (frames, frames));
    }
    assert_eq!(counts(&morning, &eye()), (10, 10));
    // The sun moves on: a few frames count. It jumps: none does.
    assert_eq!(counts(&day(100.25), &eye()), (3, 3));
    assert_eq!(counts(&day(220.0), &eye()), (1, 1));
    assert_eq!(counts(&day(220.0), &eye()), (2, 2));
    let other_way = Camera {
        target: Vec3::new(4.0, 0.1, 2.0),
        ..eye()
    };
    assert_eq!(counts(&day(220.0), &other_way), (1, 1));
}

#[test]
fn numbers_and_quantities_are_not_smoothed() {
    let mut device = Device::new();
    let (scene, day) = (board(), constant_sky(8000.0));
    let false_colour = |set: FrameSettings| {
        let mut set = set;
        set.tone.false_colour = Some(Colours {
            range: Range {
                min: 10.0,
                max: 1e4,
            },
            map: ColourMap::Turbo,
        });
        set
    };
    for show in [Show::Normal, Show::Depth, Show::Visibility, Show::Albedo] {
        let mut both = |aa| {
            let mut frame = frame(&mut device, &scene, with(aa).showing(show));
            moved(&mut device, &mut frame, &day, &eye());
            moved(&mut device, &mut frame, &day, &eye()).texels
        };
        assert_eq!(both(AntiAliasing::Taa), both(AntiAliasing::Off), "{show:?}");
    }
    for aa in [AntiAliasing::Taa, AntiAliasing::Smaa] {
        let mut both = |aa| {
            let mut frame = frame(&mut device, &scene, false_colour(with(aa)));
            moved(&mut device, &mut frame, &day, &eye()).texels
        };
        assert_eq!(both(aa), both(AntiAliasing::Off), "false colours, {aa:?}");
    }
    // Of single frames the values stay, and only what is displayed changes.
    let mut both = |aa| {
        let frame = device.frame(&scene, with(aa), &day, &eye());
        (device.read(frame.radiance()), device.read(frame.display()))
    };
    let (off, smaa) = (both(AntiAliasing::Off), both(AntiAliasing::Smaa));
    assert_eq!(off.0, smaa.0);
    let changed = off.1.iter().zip(&smaa.1).filter(|(a, b)| a[..3] != b[..3]);
    let changed = changed.count();
    println!("smaa changes {changed} of {} pixels", off.1.len());
    assert!((100..1000).contains(&changed), "{changed}");
}

#[test]
fn a_view_that_comes_to_rest_goes_over_to_its_average() {
    let mut device = Device::new();
    let (scene, day) = (board(), constant_sky(8000.0));
    let settings = |aa| FrameSettings {
        samples: 16,
        ..with(aa)
    };
    let plain = device.frame(&scene, settings(AntiAliasing::Off), &day, &eye());
    let plain = shown(&mut device, &plain);
    for aa in [AntiAliasing::Smaa, AntiAliasing::Taa] {
        let mut frame = frame(&mut device, &scene, settings(aa));
        let mut last = moved(&mut device, &mut frame, &day, &eye());
        for _ in 0..11 {
            last = moved(&mut device, &mut frame, &day, &eye());
        }
        for index in 0..16 {
            device.run(|rec| frame.record(rec, &day, &eye(), index));
            let next = shown(&mut device, &frame);
            let step = next.apart(&last);
            assert!(step.1 < 0.15, "{aa:?}: a step of {step:?} in frame {index}");
            last = next;
        }
        let rest = last.apart(&plain);
        assert_eq!(rest, (0.0, 0.0), "{aa:?}");
        // Motion goes on from there.
        let next = moved(&mut device, &mut frame, &day, &eye());
        let (step, counts) = (next.apart(&last), next.counts());
        println!("{aa:?}: a step of {step:?} into motion");
        if aa == AntiAliasing::Taa {
            assert!(step.1 < 0.12 && counts[0] == 10, "{step:?} {}", counts[0]);
        }
    }
}
