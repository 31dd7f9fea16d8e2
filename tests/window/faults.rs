//! A failing driver, simulated with `SKYLIGHT_FAULT`: the program exits with a one-line error, or its window recovers; existing
//! files stay unchanged.

use std::fs;
use std::path::Path;
use std::process::Output;

use crate::running::{DIRECT, Running, difference, program, shared_machine};
use crate::x::until;

/// A small, quick picture.
const SMALL: [&str; 6] = [
    "--size",
    "64x36",
    "--irradiance-samples",
    "16",
    "--samples",
    "2",
];

/// Renders a small picture while a call fails. Without the cells if the call is one of drawing, for speed.
fn render(folder: &Path, output: &str, fault: &str) -> Output {
    let draws = ["record", "submit", "wait"];
    let is_direct = draws.iter().any(|call| fault.starts_with(call));
    let light: &[&str] = if is_direct { &DIRECT } else { &[] };
    program(folder)
        .args(["render", "-o", output])
        .args(SMALL)
        .args(light)
        .env("SKYLIGHT_FAULT", fault)
        .output()
        .expect("the program starts")
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("the folder");
    let mut names: Vec<String> = entries
        .map(|e| {
            e.expect("an entry")
                .file_name()
                .to_string_lossy()
                .into_owned()
        })
        .collect();
    names.sort();
    names
}

/// The calls that fail: all of the first ones, then ever fewer.
const NUMBERS: [u32; 8] = [1, 2, 3, 5, 9, 17, 33, 65];

#[test]
fn whatever_call_fails_render_says_so_and_loses_nothing() {
    let _machine = shared_machine();
    let cases = [
        ("memory", "out-of-device-memory", "out of device memory"),
        ("memory", "out-of-host-memory", "out of host memory"),
        ("buffer", "out-of-host-memory", "out of host memory"),
        ("image", "out-of-device-memory", "out of device memory"),
        ("pipeline", "out-of-host-memory", "out of host memory"),
        ("record", "out-of-device-memory", "out of device memory"),
        ("submit", "device-lost", "the device was lost"),
        ("wait", "device-lost", "the device was lost"),
        ("wait", "out-of-host-memory", "out of host memory"),
    ];
    let folder = tempfile::tempdir().expect("a scratch folder");
    fs::write(folder.path().join("old.png"), "old").expect("written");
    let mut struck = 0;
    for (call, answer, said) in cases {
        for number in NUMBERS {
            let fault = format!("{call}@{number}={answer}");
            let output = render(folder.path(), "old.png", &fault);
            let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
            if output.status.success() {
                // There are fewer calls of this kind.
                assert!(number > 1, "{fault} did not strike");
                fs::write(folder.path().join("old.png"), "old").expect("written");
                break;
            }
            struck += 1;
            assert_eq!(output.status.code(), Some(1), "{fault}: {stderr}");
            assert_eq!(stderr.lines().count(), 1, "{fault}: {stderr}");
            assert!(
                stderr.starts_with("error: ") && stderr.contains(said),
                "{fault}: {stderr}"
            );
            let remedy = ["try a smaller --size", "--device"];
            assert!(remedy.iter().any(|r| stderr.contains(r)), "{stderr}");
            assert!(output.stdout.is_empty(), "{fault}");
            let old = fs::read(folder.path().join("old.png")).expect("the old file");
            assert_eq!(
                (names(folder.path()).len(), old),
                (1, b"old".to_vec()),
                "{fault}"
            );
        }
    }
    println!("{struck} faults, each one line and exit code 1");
    assert!(struck >= 35, "only {struck} faults struck");
}

#[test]
fn a_failing_device_of_an_exr_leaves_no_file() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let output = render(folder.path(), "new.exr", "submit@4=device-lost");
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(names(folder.path()), Vec::<String>::new());
}

#[test]
fn a_fault_that_is_none_is_refused() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let output = render(folder.path(), "new.png", "submit@x=device-lost");
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{stderr}");
    assert!(stderr.contains("CALL@OCCURRENCE=ERROR"), "{stderr}");
}

#[test]
fn a_window_lives_on_without_its_surface() {
    let _machine = shared_machine();
    let view = ["--size", "320x180", "--samples", "2", "--validate"];
    let view = [&view[..], &DIRECT].concat();
    let sound = Running::bare(&view);
    let expected = sound.picture();
    sound.close_well();
    for fault in [
        "surface@1=surface-lost",
        "acquire@3=surface-lost",
        "present@3=surface-lost",
        "acquire@4=out-of-date",
        "present@4=out-of-date",
    ] {
        let variables = [("SKYLIGHT_FAULT", Path::new(fault))];
        let running = Running::bare_with(&view, &variables);
        // While the scene loads on a busy machine, the picture may stand still: wait for the expected one.
        until("the picture of the sound window", || {
            let flip = difference(&expected, &running.picture());
            println!("{fault}: FLIP against the sound window {flip:.5}");
            (flip < 0.01).then_some(())
        });
        // The window still reacts.
        running.after(|d| d.typed('3'));
        running.close_well();
    }
}

#[test]
fn a_window_opens_a_lost_device_once_more_and_shows_the_same() {
    let _machine = shared_machine();
    // One sample: a picture taken before it is at rest is nearly the same.
    let view = ["colonnade", "--size", "320x180", "--samples", "1"];
    let view = [&view[..], &DIRECT, &["--validate"]].concat();
    let sound = Running::bare(&view);
    let expected = sound.daylit();
    sound.close_well();
    // Before there is a scene, while it is uploaded, and at rest.
    for number in [2, 6, 40] {
        let fault = format!("submit@{number}=device-lost");
        let running = Running::bare_with(&view, &[("SKYLIGHT_FAULT", Path::new(&fault))]);
        // Every other picture takes submissions, so the fault strikes in the course of these.
        until("the loss", || {
            running.display.typed('3');
            running.display.typed('1');
            running.picture();
            running.said().contains("was opened again").then_some(())
        });
        until("the picture of the sound window", || {
            running.display.typed('1');
            let flip = difference(&expected, &running.picture());
            println!("{fault}: FLIP against the sound window {flip:.5}");
            (flip < 0.02).then_some(())
        });
        let output = running.close();
        assert!(output.status.success(), "{fault}: {output:?}");
    }
}

#[test]
fn a_window_whose_device_is_lost_twice_ends_with_one_line_and_is_resumed() {
    let _machine = shared_machine();
    // While the scene is uploaded, and during the first frames.
    for number in [2, 6] {
        lose_device(number);
    }
    // Once everything is shown. On a busy machine the panel is drawn many times before the scene is loaded: try later ones.
    assert!(
        [40, 160, 640].into_iter().any(lose_device),
        "settings are kept for --resume"
    );
}

/// Runs a window whose devices are lost at the given submission (from 1). Returns whether it saved its settings.
fn lose_device(number: u32) -> bool {
    let state = tempfile::tempdir().expect("a scratch folder");
    let fault = format!("submit@{number}=device-lost,submit@{number}=device-lost");
    let variables = [
        ("SKYLIGHT_FAULT", Path::new(&fault)),
        ("XDG_STATE_HOME", state.path()),
    ];
    let view = ["colonnade", "--size", "320x180", "--samples", "1024"];
    let running = Running::with(&view, &variables);
    let output = running.ended();
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{fault}: {stderr}");
    let lines: Vec<&str> = stderr.lines().collect();
    let [warning, error] = lines[..] else {
        panic!("{fault}: {stderr}");
    };
    assert!(
        warning.starts_with("warning: the device was lost"),
        "{stderr}"
    );
    assert!(
        error.starts_with("error: ") && error.contains("the device was lost"),
        "{stderr}"
    );
    state.path().join("skylight").join("bundled.toml").is_file()
}
