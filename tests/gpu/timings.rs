//! Pass timings: both timing modes list every pass once, in order, with a positive time.

use crate::gpu::Device;
use skylight::frame::Frame;
use skylight::gpu::{Recorder, Timing};

#[test]
fn both_ways_name_the_same_passes() {
    let device = Device::new();
    let scene = skylight::scene::bundled(&skylight::scene::LoadOptions::default())
        .expect("the bundled scene")
        .scene;
    let daylight = crate::gpu::clear_day(200.0, 40.0);
    let camera = skylight::scene::Camera::framing(&scene.bounds, 40.0, 16.0 / 9.0);
    let names = [Timing::Timestamps, Timing::Isolated].map(|timing| {
        let mut recorder = Recorder::new(&device.context, timing).expect("a recorder");
        recorder.begin().expect("begun");
        let settings = crate::gpu::settings(160, 90);
        let mut frame = Frame::new(&mut recorder, &scene, settings).expect("a frame");
        recorder.finish().expect("finished");
        recorder.begin().expect("begun");
        frame.record(&mut recorder, &daylight, &camera, 0);
        recorder.finish().expect("finished");
        let passes = recorder.timings().passes();
        for pass in passes {
            assert!(pass.ms >= 0.0 && pass.ms < 60_000.0, "{pass:?}");
        }
        assert!(passes.iter().any(|pass| pass.ms > 0.0), "{passes:?}");
        passes.iter().map(|pass| pass.name).collect::<Vec<_>>()
    });
    println!("{:?}", names[0]);
    assert_eq!(names[0], names[1]);
    for wanted in [
        "sky cube",
        "irradiance",
        "shadow map",
        "G-buffer",
        "lighting",
        "tone map",
    ] {
        assert!(names[0].contains(&wanted), "{wanted} is missing");
    }
}
