//! Small pictures of the bundled scene, one per camera, against those in `tests/golden`.
//!
//! `SKYLIGHT_BLESS=1 cargo test --test gpu golden` overwrites them: look at them before committing.

use std::path::{Path, PathBuf};
use std::process::Command;

use image::RgbImage;

/// Largest mean difference of the channels, of 255.
const MEAN: f64 = 2.0;
/// Largest difference of any channel in 99.5 % of the pixels, of 255: rasterisers disagree along edges.
const MOST: u8 = 12;
const SHARE: f64 = 0.995;

fn golden(camera: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("tests/golden/{camera}.png"))
}

fn render(camera: &str, to: &Path) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_skylight"));
    command.arg("render").arg("-o").arg(to);
    command.args(["--camera", camera, "--size", "160x90", "--samples", "4"]);
    command.args(["--quiet", "--validate"]);
    if let Ok(device) = std::env::var("SKYLIGHT_TEST_DEVICE") {
        command.args(["--device", &device]);
    }
    let output = command.output().expect("skylight runs");
    let talk = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{camera}: {talk}");
}

fn read(path: &Path) -> RgbImage {
    let picture = image::open(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    picture.to_rgb8()
}

fn compare(camera: &str, found: &RgbImage, expected: &RgbImage) {
    assert_eq!(found.dimensions(), expected.dimensions(), "{camera}");
    let (mut sum, mut near) = (0u64, 0usize);
    let pixels = found.pixels().len();
    for (a, b) in found.pixels().zip(expected.pixels()) {
        let differences = [0, 1, 2].map(|c| a.0[c].abs_diff(b.0[c]));
        sum += differences.iter().map(|d| u64::from(*d)).sum::<u64>();
        near += usize::from(differences.iter().all(|d| *d <= MOST));
    }
    let mean = sum as f64 / (3 * pixels) as f64;
    let share = near as f64 / pixels as f64;
    println!(
        "{camera}: mean difference {mean:.3}, {:.2} % of {pixels} pixels within {MOST}",
        share * 100.0
    );
    assert!(
        mean <= MEAN && share >= SHARE,
        "{camera} looks different: mean {mean:.2} of 255, {:.2} % of the pixels within {MOST}; if it should, bless it: \
         SKYLIGHT_BLESS=1 cargo test --test gpu golden",
        share * 100.0
    );
}

fn check(camera: &str) {
    let (folder, golden) = (tempfile::tempdir().expect("a folder"), golden(camera));
    let path = folder.path().join("picture.png");
    render(camera, &path);
    if std::env::var("SKYLIGHT_BLESS").is_ok_and(|value| value == "1") {
        std::fs::create_dir_all(golden.parent().expect("a folder")).expect("made");
        std::fs::copy(&path, &golden).expect("copied");
        println!("blessed {}: look at it", golden.display());
        return;
    }
    assert!(
        golden.is_file(),
        "{} is missing: make it with SKYLIGHT_BLESS=1 cargo test --test gpu golden, look at it, commit it",
        golden.display()
    );
    compare(camera, &read(&path), &read(&golden));
}

#[test]
fn pool() {
    check("pool");
}

#[test]
fn porch() {
    check("porch");
}

#[test]
fn high() {
    check("high");
}
