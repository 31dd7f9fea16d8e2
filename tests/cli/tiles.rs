//! Tiled rendering: the same picture as in one piece, or one without visible seams.

use std::path::{Path, PathBuf};
use std::process::Command;

use skylight::compare::{Picture, flip, read};

struct Place(tempfile::TempDir);

impl Place {
    fn new() -> Self {
        Self(tempfile::tempdir().expect("a scratch folder"))
    }

    fn render(&self, output: &str, words: &[&str]) -> (PathBuf, String) {
        let path = self.0.path().join(output);
        let run = Command::new(env!("CARGO_BIN_EXE_skylight"))
            .args(["render", "--validate", "--irradiance-samples", "64", "-o"])
            .arg(&path)
            .args(words)
            .output()
            .expect("the program starts");
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        assert!(run.status.success() && said.is_empty(), "{words:?}: {said}");
        (path, String::from_utf8_lossy(&run.stdout).into_owned())
    }
}

/// Largest difference of a pixel's channel, and the share of pixels that differ by more than `step`.
fn differences(a: &Picture, b: &Picture, step: f32) -> (f32, f64) {
    assert_eq!(a.size, b.size);
    let of =
        |(a, b): (&[f32; 3], &[f32; 3])| (0..3).map(|c| (a[c] - b[c]).abs()).fold(0.0f32, f32::max);
    let all: Vec<f32> = a.rgb.iter().zip(&b.rgb).map(of).collect();
    let more = all.iter().filter(|d| **d > step).count();
    let largest = all.iter().copied().fold(0.0, f32::max);
    (largest, more as f64 / all.len() as f64)
}

#[test]
fn tiles_are_the_picture_that_is_drawn_at_once() {
    let place = Place::new();
    let cases = [
        // The cells are made anew for each tile: few tiles, for speed.
        ("--size 317x203", "160", 4.0),
        ("--size 317x203 --samples 3 --visibility ssao", "64", 1.0),
        (
            "--size 317x180 --samples 2 --visibility dome --ev100 14",
            "160",
            1.0,
        ),
        (
            "--size 333x190 --show irradiance --ao-resolution full --ambient ssao",
            "64",
            1.0,
        ),
    ];
    for (line, edge, allowance) in cases {
        let words: Vec<&str> = line.split_whitespace().collect();
        let (whole, _) = place.render("whole.png", &words);
        let (tiles, said) = place.render("tiles.png", &[&words[..], &["--tile", edge]].concat());
        assert!(said.contains("tiles"), "{said}");
        let (whole, tiles) = (read(&whole).expect("whole"), read(&tiles).expect("tiles"));
        let (largest, more) = differences(&whole, &tiles, 1.0 / 64.0);
        let flip = flip::mean(&flip::ldr(&whole, &tiles));
        println!(
            "{line}: FLIP {flip:.6}, largest difference {largest:.4}, {:.4} % above 1/64",
            more * 100.0
        );
        // With another projection, vertices snap to other subpixel positions: a few edges move by that. Light from the cells is
        // for squares of pixels, and lookups beside a wall jump from cell to cell: more pixels move.
        assert!(
            flip < allowance * 5e-4 && more < allowance * 1e-3,
            "{line}: {flip} {more}"
        );
    }
}

#[test]
fn the_air_of_tiles_has_no_seam() {
    let place = Place::new();
    // A plain of 80 km with a wall of 3 km across it, 30 km away.
    let model = place.0.path().join("far.obj");
    let plain =
        "v -40000 0 40000\nv 40000 0 40000\nv 40000 0 -40000\nv -40000 0 -40000\nf 1 2 3 4\n";
    let wall = "v -40000 0 -30000\nv 40000 0 -30000\nv 40000 3000 -34000\nv -40000 3000 -34000\nf 5 6 7 8\n";
    std::fs::write(&model, format!("{plain}{wall}")).expect("a model");
    let far = model.to_string_lossy().into_owned();
    let line =
        "--sky atmosphere --sun 310,8 --show air --eye 0,300,0 --target 0,900,-9000 --size 317x203";
    let words: Vec<&str> = [&*far].into_iter().chain(line.split_whitespace()).collect();
    for samples in ["1", "2"] {
        let words = [&words[..], &["--samples", samples]].concat();
        let (whole, _) = place.render("whole.exr", &words);
        let (tiles, said) = place.render("tiles.exr", &[&words[..], &["--tile", "64"]].concat());
        assert!(said.contains("tiles"), "{said}");
        let (whole, tiles) = (read(&whole).expect("whole"), read(&tiles).expect("tiles"));
        let brightest = whole.rgb.iter().flatten().copied().fold(0.0f32, f32::max);
        let (largest, more) = differences(&whole, &tiles, 1e-4 * brightest);
        println!(
            "brightest {brightest} cd/m2, largest difference {largest}, {:.4} % above 1e-4 of it",
            more * 100.0
        );
        // Edges of the wall snap to other subpixel positions.
        assert!(brightest > 100.0 && more < 1e-3, "{more}");
    }
}

#[test]
fn layers_of_tiles_are_those_of_the_whole() {
    let place = Place::new();
    let line = "--size 150x100 --layers --sun 215,42 --bounces 0 --ambient ssao";
    let words: Vec<&str> = line.split_whitespace().collect();
    let (whole, _) = place.render("whole.exr", &words);
    let (tiles, said) = place.render("tiles.exr", &[&words[..], &["--tile", "64"]].concat());
    assert!(said.contains("6 tiles, 15 layer(s)"), "{said}");
    let channels = |path: &Path| {
        let image = exr::prelude::read_all_flat_layers_from_file(path).expect("an EXR");
        let channels = image.layer_data[0].channel_data.list.clone();
        channels.into_iter().map(|c| {
            let values: Vec<f32> = c.sample_data.values_as_f32().collect();
            (c.name.to_string(), values)
        })
    };
    for ((name, a), (other, b)) in channels(&whole).zip(channels(&tiles)) {
        assert_eq!(name, other);
        let scale = a.iter().fold(1e-3f32, |m, v| m.max(v.abs()));
        let differ = a
            .iter()
            .zip(&b)
            .filter(|(a, b)| (*a - *b).abs() > 1e-3 * scale);
        let share = differ.count() as f64 / a.len() as f64;
        println!("{name}: {:.3} % of the pixels differ", share * 100.0);
        assert!(share < 0.005, "{name}: {share}");
    }
}

/// Mean difference between neighbouring columns: at seams, and everywhere else.
fn steps(picture: &Picture, is_seam: impl Fn(usize) -> bool) -> (f64, f64) {
    let [width, height] = picture.size;
    let luminance = picture.luminance();
    let (mut at, mut beside) = ((0.0, 0u32), (0.0, 0u32));
    for row in 0..height {
        for x in 1..width {
            let step = (luminance[row * width + x] - luminance[row * width + x - 1]).abs();
            let sum = if is_seam(x) { &mut at } else { &mut beside };
            *sum = (sum.0 + f64::from(step), sum.1 + 1);
        }
    }
    (at.0 / f64::from(at.1), beside.0 / f64::from(beside.1))
}

#[test]
fn wider_than_the_device_there_are_no_seams() {
    let place = Place::new();
    // Sky light only: it shows occlusion most clearly.
    let line = "--size 20000x120 --show sky --ambient ssao --fov 3 --ev100 11";
    let words: Vec<&str> = line.split_whitespace().collect();
    let (file, said) = place.render("wide.png", &words);
    assert!(said.contains("20000x120 in 10 tiles"), "{said}");
    let picture = read(&file).expect("a picture");
    let (seams, others) = steps(&picture, |x| x.is_multiple_of(2048));
    println!("mean step of luminance at the seams {seams:.6}, elsewhere {others:.6}");
    assert!(
        others > 0.0 && seams < 2.0 * others + 1e-3,
        "{seams} {others}"
    );
}

#[test]
fn what_tiles_cannot_do_is_said() {
    let place = Place::new();
    for (words, named) in [
        (["--false-colour", "luminance"], "--tile"),
        (["--noise", "0.01"], "--noise"),
    ] {
        let run = Command::new(env!("CARGO_BIN_EXE_skylight"))
            .current_dir(place.0.path())
            .args(["render", "--size", "320x180", "--tile", "64"])
            .args(words)
            .args(["-o", "a.png"])
            .output()
            .expect("the program starts");
        let said = String::from_utf8_lossy(&run.stderr).into_owned();
        assert_eq!(
            (run.status.code(), said.lines().count()),
            (Some(2), 1),
            "{said}"
        );
        assert!(said.contains(named), "{said}");
        assert_eq!(place.0.path().read_dir().expect("the folder").count(), 0);
    }
}
