//! A frame change that fails halfway leaves the frame unchanged.

use std::thread;

use skylight::frame::{Frame, FrameSettings, Visibility};
use skylight::gpu::{Recorder, Result, Timing};
use skylight::passes::light::lighting::Show;
use skylight::scene::Scene;

use crate::gpu::{Device, Model, camera, clear_day, matt, settings};

/// The kinds of calls made when passes and images are created.
const CALLS: [&str; 4] = ["memory", "buffer", "image", "pipeline"];

/// A small picture with few samples.
fn small(samples: u32, visibility: Visibility) -> FrameSettings {
    let mut set = settings(32, 18);
    set.samples = samples;
    set.sampling.visibility = visibility;
    set.sampling.dome.directions = 2;
    set.sampling.dome.map_edge = 64;
    set.sky_edge = 32;
    set.irradiance.samples = 16;
    set.shadow_resolution = 128;
    set.ssao.radius = 2.0;
    set
}

fn scene() -> Scene {
    Model::default()
        .ground(8.0, &matt(0.5))
        .cube([0.0, 1.0, 0.0], 1.0, &matt(0.7))
        .build()
}

/// Makes each call of a change fail, one at a time, and checks that the next picture is that of the old settings. Returns the
/// number of failed calls.
fn fail_everywhere(
    set: FrameSettings,
    change: impl Fn(&mut Frame, &mut Recorder) -> Result<()>,
) -> u32 {
    let mut device = Device::new();
    let (scene, view) = (scene(), camera([4.0, 2.5, 5.0], [0.0, 0.7, 0.0]));
    let day = clear_day(150.0, 40.0);
    let mut frame = device.frame(&scene, set, &day, &view);
    let old = *frame.settings();
    let expected = [frame.radiance(), frame.display()].map(|image| device.read(image));
    let mut failed = 0;
    for call in CALLS {
        for number in 1.. {
            let fault = format!("{call}@{number}=out-of-device-memory");
            device.context.plan_fault(Some(&fault)).expect("a fault");
            device.recorder.begin().expect("begun");
            let changed = change(&mut frame, &mut device.recorder);
            device.context.plan_fault(None).expect("none");
            if changed.is_ok() {
                device.recorder.finish().expect("finished");
                // All calls of this kind have been tried. Restore the old settings.
                let reverted = device.run(|rec| frame.apply(rec, old));
                reverted.expect("memory");
            } else {
                device.recorder.abandon().expect("abandoned");
                failed += 1;
                assert_eq!(*frame.settings(), old, "{fault}");
            }
            device.draw(&mut frame, &day, &view);
            let drawn = [frame.radiance(), frame.display()].map(|image| device.read(image));
            assert!(drawn == expected, "{fault}: another picture");
            let messages = device.context.validation_messages();
            assert!(messages.is_empty(), "{fault}: {messages:?}");
            if changed.is_ok() {
                break;
            }
        }
    }
    println!("{failed} calls failed");
    failed
}

/// Settings for the three kinds of frames: a single frame, a mean of frames, dome visibility.
fn ways() -> [FrameSettings; 3] {
    [
        small(1, Visibility::Ssao),
        small(2, Visibility::Ssao),
        small(2, Visibility::Progressive),
    ]
}

/// Settings of which most differ from those of a frame.
fn others(frame: &Frame) -> FrameSettings {
    let mut other = *frame.settings();
    other.sky_edge *= 2;
    other.irradiance.samples *= 2;
    other.shadow_resolution *= 2;
    other.ssao.downscale = 2;
    other.lighting.fresnel = true;
    other.sampling.visibility = match other.sampling.visibility {
        Visibility::Ssao => Visibility::Dome,
        _ => Visibility::Ssao,
    };
    other.samples = 3;
    other
}

#[test]
fn a_resize_that_fails_leaves_the_old_size() {
    for set in ways() {
        let failed = fail_everywhere(set, |frame, rec| {
            let mut larger = *frame.settings();
            larger.size *= 2;
            frame.apply(rec, larger)
        });
        assert!(failed >= 20, "{failed}");
    }
}

#[test]
fn what_is_shown_stays_when_the_change_fails() {
    for set in ways() {
        let failed = fail_everywhere(set, |frame, _| frame.show(Show::Normal));
        assert!(failed >= 8, "{failed}");
    }
}

#[test]
fn settings_that_fail_are_not_taken_over() {
    for set in ways() {
        let failed = fail_everywhere(set, |frame, rec| {
            let other = others(frame);
            frame.apply(rec, other)
        });
        assert!(failed >= 30, "{failed}");
    }
}

#[test]
fn a_tone_map_that_fails_is_not_taken_over() {
    for set in ways() {
        let failed = fail_everywhere(set, |frame, rec| {
            let mut tone = frame.settings().tone;
            tone.gamma = Some(2.2);
            frame.retone(rec, tone)
        });
        assert!(failed >= 2, "{failed}");
    }
}

#[test]
fn frames_go_on_while_another_thread_makes_passes_that_then_show_what_new_ones_do() {
    let (scene, view) = (scene(), camera([4.0, 2.5, 5.0], [0.0, 0.7, 0.0]));
    let day = clear_day(150.0, 40.0);
    for set in ways() {
        let mut device = Device::new();
        let mut frame = device.frame(&scene, set, &day, &view);
        let mut other = others(&frame);
        other.size *= 2;
        let fresh = device.frame(&scene, other, &day, &view);
        let expected = [frame.display(), fresh.display()].map(|image| device.read(image));
        let (change, context) = (frame.change(other), device.context.clone());
        assert!(!change.is_none() && frame.change(set).is_none());
        let making = thread::spawn(move || {
            let mut recorder = Recorder::new(&context, Timing::Off)?;
            change.prepare(&mut recorder)
        });
        let mut drawn = 0;
        while drawn == 0 || !making.is_finished() {
            device.draw(&mut frame, &day, &view);
            assert!(
                device.read(frame.display()) == expected[0],
                "another picture"
            );
            drawn += 1;
        }
        let mut made = making.join().expect("no panic").expect("passes");
        println!("{drawn} pictures while the passes were made");
        frame.swap(&mut made);
        // Those that were replaced, which frames in flight would still use.
        device.run(|rec| rec.keep(made));
        device.draw(&mut frame, &day, &view);
        assert_eq!(frame.settings(), fresh.settings());
        assert!(
            device.read(frame.display()) == expected[1],
            "not the new picture"
        );
    }
}

#[test]
fn passes_that_are_made_again_have_the_pipelines_of_before() {
    let mut device = Device::new();
    let (scene, view) = (scene(), camera([4.0, 2.5, 5.0], [0.0, 0.7, 0.0]));
    let day = clear_day(150.0, 40.0);
    let [single, .., dome] = ways();
    let first = device.frame(&scene, single, &day, &view);
    let expected = device.read(first.display());
    drop(device.frame(&scene, dome, &day, &view));
    let made = device.context.pipelines().len();
    // Both the ones in use and those that nothing used any more.
    let again = [single, dome].map(|set| {
        let mut larger = set;
        larger.size *= 2;
        drop(device.frame(&scene, larger, &day, &view));
        device.frame(&scene, set, &day, &view)
    });
    assert_eq!(device.context.pipelines().len(), made);
    assert!(device.read(again[0].display()) == expected);
    // Other constants are other pipelines.
    let mut other = single;
    other.lighting.fresnel = true;
    drop(device.frame(&scene, other, &day, &view));
    assert!(device.context.pipelines().len() > made);
}
