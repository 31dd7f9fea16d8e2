//! The real window when nothing moves: from ambient occlusion it goes over to the sky's true visibility, without a jump.

#[path = "common/running.rs"]
mod running;
#[path = "common/x.rs"]
mod x;

use std::thread::sleep;
use std::time::{Duration, Instant};

use running::{Running, difference, program};
use skylight::compare::{Picture, read};

/// Under a porch, where ambient occlusion lets in too much sky.
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

/// Mean light of the display, 0..1.
fn brightness(picture: &Picture) -> f64 {
    picture
        .luminance()
        .iter()
        .map(|l| f64::from(*l))
        .sum::<f64>()
        / picture.rgb.len() as f64
}

/// A picture by `render`.
fn rendered(words: &[&str]) -> Picture {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("a.png");
    let mut command = program(folder.path());
    command
        .arg("render")
        .args(VIEW)
        .args(words)
        .arg("-o")
        .arg(&file);
    let output = command.output().expect("the program starts");
    let complaint = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{complaint}");
    read(&file).expect("a picture")
}

#[test]
#[ignore = "minutes on a software device: cargo test --test window_rest -- --ignored"]
fn at_rest_the_window_converges_to_the_dome_without_a_jump() {
    let running = Running::bare(&VIEW);
    // Half an hour on and back: the light of the command line again, from the first preview on.
    let later = running.after(|display| display.typed('h'));
    running.display.key('h'.into(), true);
    running.display.wait_for_change(running.window, &later);
    // Everything that is shown until nothing changes for a while.
    let (mut seen, mut changed) = (Vec::<Picture>::new(), Instant::now());
    while changed.elapsed() < Duration::from_secs(4) {
        let now = running.display.picture(running.window, None);
        let is_blank = now.rgb.iter().all(|p| *p == now.rgb[0]);
        if !is_blank && seen.last() != Some(&now) {
            seen.push(now);
            changed = Instant::now();
        }
        sleep(Duration::from_millis(30));
    }
    let last = seen.last().expect("a picture");
    let list: Vec<f64> = seen.iter().map(brightness).collect();
    let steps = list.windows(2).map(|w| (w[1] / w[0] - 1.0).abs());
    let largest = steps.fold(0.0, f64::max);
    let dome = rendered(&["--samples", "256", "--visibility", "dome"]);
    let ssao = rendered(&["--samples", "15", "--visibility", "ssao"]);
    let [to_dome, to_ssao] = [&dome, &ssao].map(|picture| difference(picture, last));
    println!(
        "{} pictures, largest step of brightness {:.2} %; FLIP to the dome {to_dome:.4}, to ambient occlusion {to_ssao:.4}",
        seen.len(),
        100.0 * largest
    );
    assert!(seen.len() > 5, "{}", seen.len());
    // A picture of the screen may fall between two that the window showed: a step may be a few frames'.
    assert!(largest < 0.03, "{largest}: {list:?}");
    assert!(
        to_dome < 0.02 && to_dome < 0.6 * to_ssao,
        "{to_dome} {to_ssao}"
    );
    running.close_well();
}

#[test]
#[ignore = "minutes on a software device: cargo test --test window_rest -- --ignored"]
fn who_asks_for_ambient_occlusion_keeps_it() {
    let running = Running::bare(&[&VIEW[..], &["--visibility", "ssao"]].concat());
    let shown = running.picture();
    let ssao = rendered(&["--samples", "64", "--visibility", "ssao"]);
    let flip = difference(&ssao, &shown);
    println!("FLIP of the window against render with ambient occlusion: {flip:.4}");
    assert!(flip < 0.01, "{flip}");
    running.close_well();
}
