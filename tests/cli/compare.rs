//! `skylight compare`, end to end, on pictures with known differences.

use std::path::Path;
use std::process::{Command, Output};

use skylight::output::{Channels, Layer, write_exr};

fn compare(words: &[&Path]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .arg("compare")
        .args(words)
        .output()
        .expect("the program starts")
}

/// A grey ramp scaled by a factor.
fn picture(path: &Path, size: [u32; 2], factor: f32) {
    let texels = (0..size[0] * size[1])
        .map(|i| [(100.0 + i as f32) * factor; 4])
        .collect();
    let layer = Layer {
        name: "",
        channels: Channels::Rgb,
        texels,
    };
    write_exr(path, size, &[layer], &Vec::new()).expect("written");
}

fn figure(output: &Output, name: &str) -> f64 {
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let line = text.lines().find(|l| l.starts_with(name));
    let line = line.unwrap_or_else(|| panic!("no {name} in {text}"));
    let word = line[name.len()..].split_whitespace().next();
    word.and_then(|w| w.parse().ok())
        .unwrap_or_else(|| panic!("{line}"))
}

#[test]
fn known_differences_come_out_as_numbers_and_as_a_picture() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let (a, b, diff) = (path("a.exr"), path("b.exr"), path("d.png"));
    picture(&a, [64, 48], 1.0);
    picture(&b, [64, 48], 1.1);
    let same = compare(&[&a, &a]);
    assert!(same.status.success());
    assert_eq!(figure(&same, "RMSE / mean"), 0.0);
    assert_eq!(figure(&same, "FLIP, HDR"), 0.0);
    let other = compare(&[&a, &b, Path::new("--diff"), &diff]);
    assert!((figure(&other, "mean ratio") - 1.1).abs() < 1e-4);
    assert!((figure(&other, "relative error, median") - 0.1).abs() < 1e-4);
    let flip = figure(&other, "FLIP, shown");
    assert!((0.01..0.2).contains(&flip), "{flip}");
    let map = image::open(&diff)
        .expect("the difference picture")
        .to_rgb8();
    assert_eq!(map.dimensions(), (64, 48));
    assert!(map.pixels().any(|p| p.0[0] > 0));
}

#[test]
fn pictures_that_cannot_be_compared_are_one_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    let (a, small, text) = (path("a.exr"), path("small.exr"), path("text.png"));
    picture(&a, [8, 8], 1.0);
    picture(&small, [4, 4], 1.0);
    std::fs::write(&text, "no picture").expect("written");
    for (words, part) in [
        ([&a, &small], "8x8 and 4x4"),
        ([&a, &text], "cannot read"),
        ([&path("none.exr"), &a], "none.exr"),
    ] {
        let output = compare(&words.map(|p| p.as_path()));
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{stderr}");
        assert_eq!(stderr.lines().count(), 1, "{stderr}");
        assert!(stderr.contains(part), "{stderr}");
    }
}
