//! The idle window: it converges from ambient occlusion to the true visibility of the sky, and its exposure adapts, both
//! without a jump.

use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::running::{DIRECT, Running, difference, program, quiet_machine};
use crate::x::{keysym, until};
use skylight::compare::{Picture, read};

/// A view under a porch, where ambient occlusion lets in too much sky.
const VIEW: [&str; 8] = [
    "--size",
    "160x90",
    "--dome-size",
    "256",
    "--camera",
    "porch",
    "--ev100",
    "13",
];

/// Frames accumulated at rest.
const FRAMES: &str = "32";

/// A region of the picture that shows only sky: first and last pixel.
const SKY: [[usize; 2]; 2] = [[27, 24], [31, 28]];

/// Mean luminance of the displayed picture, 0..1.
fn brightness(picture: &Picture) -> f64 {
    picture
        .luminance()
        .iter()
        .map(|l| f64::from(*l))
        .sum::<f64>()
        / picture.rgb.len() as f64
}

/// [`VIEW`] as drawn by `render`.
fn rendered(words: &[&str]) -> Picture {
    rendered_with(&[&VIEW, words].concat())
}

fn rendered_with(words: &[&str]) -> Picture {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.png");
    let mut command = program(folder.path());
    command.arg("render").args(words).arg("-o").arg(&file);
    let output = command.output().expect("the program starts");
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{complaint}");
    read(&file).expect("a picture")
}

/// Mean colour of the sky region: it depends on the daylight only, not on occlusion of surfaces.
fn sky(picture: &Picture) -> [f32; 3] {
    let [[left, top], [right, bottom]] = SKY;
    let pixels = (top..=bottom).flat_map(|y| (left..=right).map(move |x| y * picture.size[0] + x));
    let sum = pixels.fold([0.0; 3], |sum: [f32; 3], i| {
        std::array::from_fn(|c| sum[c] + picture.rgb[i][c])
    });
    sum.map(|v| v / ((right - left + 1) * (bottom - top + 1)) as f32)
}

/// Whether two pictures have the same daylight. Pictures of eight bits that fade into each other are up to a step of them off; half an
/// hour is many steps.
fn same_light(a: &Picture, b: &Picture) -> bool {
    let (a, b) = (sky(a), sky(b));
    (0..3).all(|c| (a[c] - b[c]).abs() < 0.01)
}

/// The pictures of a window that comes to rest after a change of the light, from the first one in the final light on.
fn coming_to_rest(running: &Running) -> Vec<Picture> {
    let shown = || running.stopped_picture();
    // Half an hour forward and back: the original daylight again, from the first preview on.
    let first = until("a picture", || {
        let now = shown();
        now.rgb.iter().any(|p| *p != now.rgb[0]).then_some(now)
    });
    running.display.typed('h');
    until("another light", || {
        (!same_light(&first, &shown())).then_some(())
    });
    running.display.key('H'.into(), true);
    // Records the pictures until nothing changes for a while, and nothing is at work: a busy machine may be slow to draw.
    let (mut seen, mut changed) = (Vec::<Picture>::new(), Instant::now());
    let mut work = running.cpu_seconds();
    loop {
        if changed.elapsed() >= Duration::from_secs(3) {
            let before = std::mem::replace(&mut work, running.cpu_seconds());
            if work - before < 0.1 {
                break;
            }
            changed = Instant::now();
        }
        let now = shown();
        if seen.last() != Some(&now) {
            seen.push(now);
            changed = Instant::now();
        }
        sleep(Duration::from_millis(10));
    }
    let last = seen.last().expect("a picture");
    let other = seen.iter().rposition(|picture| !same_light(picture, last));
    seen.split_off(other.map_or(0, |i| i + 1))
}

/// Change of brightness from the first picture to the last, and the largest step between two, relative.
fn brightening(seen: &[Picture]) -> (f64, f64) {
    let list: Vec<f64> = seen.iter().map(brightness).collect();
    let steps = list.windows(2).map(|w| (w[1] / w[0] - 1.0).abs());
    (
        list[list.len() - 1] / list[0] - 1.0,
        steps.fold(0.0, f64::max),
    )
}

#[test]
fn at_rest_direct_light_converges_to_the_dome_without_a_jump() {
    let _machine = quiet_machine();
    let rest = [&VIEW[..], &DIRECT, &["--samples", FRAMES]].concat();
    let running = Running::bare(&rest);
    let seen = coming_to_rest(&running);
    let (last, (whole, largest)) = (&seen[seen.len() - 1], brightening(&seen));
    let dome = rendered(
        &[
            &DIRECT[..],
            &["--samples", FRAMES, "--dome-directions", "4"],
        ]
        .concat(),
    );
    let converged = rendered(&[&DIRECT[..], &["--samples", "256"]].concat());
    let ssao = rendered(&[&DIRECT[..], &["--samples", "15"]].concat());
    let [to_dome, to_converged, to_ssao, from_ssao] = [
        (&dome, last),
        (&converged, last),
        (&ssao, last),
        (&ssao, &seen[0]),
    ]
    .map(|(a, b)| difference(a, b));
    println!(
        "{} pictures, brightness in all {:.1} %, largest step {:.2} %; FLIP at last to the dome of as many samples \
         {to_dome:.4}, of 256 {to_converged:.4}, to ambient occlusion {to_ssao:.4}; that at first {from_ssao:.4}",
        seen.len(),
        100.0 * whole,
        100.0 * largest
    );
    // It begins with ambient occlusion.
    assert!(from_ssao < 0.5 * to_ssao, "{from_ssao} {to_ssao}");
    // From there the porch gets much darker, but never abruptly; screenshots may skip a few frames.
    assert!(seen.len() > 8 && whole < -0.05, "{} {whole}", seen.len());
    assert!(largest < 0.03, "{largest}");
    // The final picture equals a file with as many samples, without a trace of the preview.
    assert!(to_dome < 0.003, "{to_dome}");
    assert!(to_converged < 0.4 * to_ssao, "{to_converged} {to_ssao}");
    running.close_well();
}

#[test]
fn at_rest_all_bounces_converge_without_a_jump() {
    let _machine = quiet_machine();
    let running = Running::bare(&[&VIEW[..], &["--samples", FRAMES]].concat());
    let seen = coming_to_rest(&running);
    let (last, (whole, largest)) = (&seen[seen.len() - 1], brightening(&seen));
    let dome = rendered(&["--samples", FRAMES, "--dome-directions", "4"]);
    let converged = rendered(&["--samples", "128"]);
    let pairs = [(&dome, last), (&converged, last), (&converged, &seen[0])];
    let [to_dome, to_converged, from_converged] = pairs.map(|(a, b)| difference(a, b));
    println!(
        "{} pictures, brightness in all {:.1} %, largest step {:.2} %; FLIP at last to the dome of as many samples \
         {to_dome:.4}, of 128 {to_converged:.4}, at first {from_converged:.4}",
        seen.len(),
        100.0 * whole,
        100.0 * largest
    );
    // The cells have the light already: it only becomes smoother.
    assert!(
        seen.len() > 8 && whole.abs() < 0.05,
        "{} {whole}",
        seen.len()
    );
    assert!(largest < 0.03, "{largest}");
    // The cells have seen the previews too, so their noise is another one than a file's.
    assert!(to_dome < 0.06, "{to_dome}");
    assert!(
        to_converged < from_converged,
        "{to_converged} {from_converged}"
    );
    running.close_well();
}

#[test]
fn who_asks_for_ambient_occlusion_keeps_it() {
    let _machine = quiet_machine();
    let kept = ["--visibility", "ssao", "--samples", FRAMES];
    let running = Running::bare(&[&VIEW[..], &kept].concat());
    let shown = running.picture();
    let ssao = rendered(&kept);
    let flip = difference(&ssao, &shown);
    println!("FLIP of the window against render with ambient occlusion: {flip:.4}");
    assert!(flip < 0.01, "{flip}");
    running.close_well();
}

#[test]
fn the_exposure_adapts_smoothly_to_what_a_file_has() {
    let _machine = quiet_machine();
    // The sun sets at 18:52.
    let dusk = |when| {
        let view = ["--size", "160x90", "--visibility", "ssao", "--samples", "4"];
        [&view[..], &["--when", when]].concat()
    };
    let running = Running::bare(&dusk("2026-09-24T18:20:00+02:00"));
    let bright = brightness(&running.picture());
    running.display.typed('h');
    // Until nothing changes for a while and nothing is at work: a busy machine may be slow to draw.
    let (mut seen, mut rested) = (Vec::<Picture>::new(), Instant::now());
    while rested.elapsed() < Duration::from_secs(3) {
        let now = running.display.picture(running.window, None);
        if running.is_working() {
            rested = Instant::now();
        }
        if seen.last() != Some(&now) {
            seen.push(now);
            rested = Instant::now();
        }
        sleep(Duration::from_millis(5));
    }
    let list: Vec<f64> = seen.iter().map(brightness).collect();
    let last = list[list.len() - 1];
    let first = list.iter().position(|b| *b < 0.9 * bright).expect("darker");
    let rising = &list[first..];
    let file = rendered_with(&dusk("2026-09-24T18:50:00+02:00"));
    let flip = difference(&file, &seen[seen.len() - 1]);
    println!(
        "brightness {bright:.3}, then {:.3} to {last:.3} in {} pictures; FLIP to a file {flip:.4}",
        rising[0],
        rising.len()
    );
    // Dark at first, since the light dropped before the exposure adapted; from then on it only brightens.
    assert!(rising[0] < 0.9 * last, "{list:?}");
    assert!(rising.windows(2).all(|w| w[1] > 0.98 * w[0]), "{list:?}");
    assert!(flip < 0.01, "{flip}");
    running.close_well();
}

#[test]
fn at_rest_the_panel_tells_of_the_last_frame() {
    let _machine = quiet_machine();
    let running = Running::new(&["--quiet", "--size", "640x360", "--samples", "3"]);
    until("the scene", || {
        (running.display.title(running.window) != "skylight").then_some(())
    });
    let rested = running.picture();
    // Hide and show the panel: it is laid out again, but there is nothing to draw.
    running.after(|display| display.key(keysym::TAB, false));
    let again = running.after(|display| display.key(keysym::TAB, false));
    let apart = difference(&rested, &again);
    println!("FLIP of the panel at rest against the panel laid out anew: {apart:.6}");
    assert!(rested == again, "{apart}");
    running.close_well();
}
