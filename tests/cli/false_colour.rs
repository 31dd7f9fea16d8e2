//! False-colour pictures, end to end: values read from the colours equal those of `skylight sky`.
//!
//! Verified to fail without the sky's irradiance in the illuminance, and with the range in thousands of its unit.

use std::path::Path;
use std::process::{Command, Output};

use glam::DVec3;
use skylight::daylight::colour::srgb_oetf;
use skylight::daylight::false_colour::{ColourMap, Range};

const PLANE: &str = "v -500 0 500\nv 500 0 500\nv 500 0 -500\nv -500 0 -500\nf 1 2 3 4\n";
const VIEW: [&str; 8] = [
    "--eye",
    "0,20,1",
    "--target",
    "0,0,0",
    "--ao-radius",
    "0",
    "--size",
    "320x240",
];
const SUN: [&str; 4] = ["--sun", "135,40", "--turbidity", "2.5"];

struct Picture {
    rgb: Vec<u8>,
    width: usize,
    texts: Vec<(String, String)>,
}

impl Picture {
    fn read(path: &Path) -> Self {
        let file = std::fs::File::open(path).expect("a picture");
        let mut reader = png::Decoder::new(std::io::BufReader::new(file))
            .read_info()
            .expect("a PNG");
        let mut rgb = vec![0; reader.output_buffer_size().expect("small")];
        reader.next_frame(&mut rgb).expect("pixels");
        let info = reader.info();
        let texts = info.utf8_text.iter();
        let texts = texts
            .map(|t| (t.keyword.clone(), t.get_text().expect("text")))
            .collect();
        Self {
            rgb,
            width: info.width as usize,
            texts,
        }
    }

    fn at(&self, x: usize, y: usize) -> DVec3 {
        let first = 3 * (y * self.width + x);
        DVec3::from_array([0, 1, 2].map(|i| f64::from(self.rgb[first + i])))
    }

    fn text(&self, key: &str) -> Option<&str> {
        self.texts.iter().find(|t| t.0 == key).map(|t| t.1.as_str())
    }
}

fn skylight(folder: &Path, words: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_skylight"));
    command
        .current_dir(folder)
        .args(words)
        .output()
        .expect("the program starts")
}

/// Renders the plane; returns the picture and the program's stdout.
fn render(folder: &Path, words: &[&str]) -> (Picture, String) {
    std::fs::write(folder.join("plane.obj"), PLANE).expect("a file");
    let all = [
        &["render", "plane.obj", "-o", "p.png"],
        &VIEW[..],
        &SUN,
        words,
    ]
    .concat();
    let output = skylight(folder, &all);
    let told = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    assert!(output.status.success(), "{}", told(&output.stderr));
    (Picture::read(&folder.join("p.png")), told(&output.stdout))
}

/// The value with the nearest colour, as read from the legend.
fn value_of(colour: DVec3, range: &Range) -> f64 {
    let steps = 4000;
    let value = |i: i32| range.min * (range.max / range.min).powf(f64::from(i) / f64::from(steps));
    let map = ColourMap::default();
    let distance = |v: f64| {
        map.colour(range.share(v))
            .map(|c| 255.0 * srgb_oetf(c))
            .distance(colour)
    };
    let nearest = (0..=steps)
        .map(value)
        .min_by(|a, b| distance(*a).total_cmp(&distance(*b)));
    nearest.expect("a value")
}

fn horizontal_lux(folder: &Path) -> f64 {
    let output = skylight(folder, &[&["sky", "--json"], &SUN[..]].concat());
    let json: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    json["global_horizontal_lux"].as_f64().expect("a number")
}

#[test]
fn the_illuminance_of_the_ground_can_be_read() {
    let folder = tempfile::tempdir().expect("a folder");
    let range = Range { min: 1e3, max: 1e6 };
    let words = [
        "--false-colour",
        "illuminance",
        "--false-colour-range",
        "1000,1000000",
    ];
    let (picture, told) = render(folder.path(), &words);
    let (read, expected) = (
        value_of(picture.at(40, 120), &range),
        horizontal_lux(folder.path()),
    );
    println!("read {read:.0} lux off the picture; the sky says {expected:.0}");
    assert!((read / expected - 1.0).abs() < 0.03, "{read} {expected}");
    assert!(told.contains("1 000 to 1 000 000 lux"), "{told}");
    assert_eq!(picture.text("false-colour"), Some("illuminance"));
    assert_eq!(
        picture.text("false-colour-range used"),
        Some("1000,1000000")
    );
}

#[test]
fn the_luminance_of_grey_ground_is_a_share_of_its_illuminance() {
    let folder = tempfile::tempdir().expect("a folder");
    let words = ["--false-colour", "luminance", "--gamma", "2.2"];
    let (picture, _) = render(folder.path(), &words);
    let used = picture.text("false-colour-range used").expect("a range");
    let (min, max) = used.split_once(',').expect("two numbers");
    let range = Range {
        min: min.parse().expect("a number"),
        max: max.parse().expect("a number"),
    };
    // A model without materials is a 0.5 grey Lambert body.
    let expected = 0.5 / std::f64::consts::PI * horizontal_lux(folder.path());
    let read = value_of(picture.at(40, 120), &range);
    println!("read {read:.0} cd/m² off the picture of {used}; the sky says {expected:.0}");
    assert!((read / expected - 1.0).abs() < 0.03, "{read} {expected}");
    assert!(range.min <= expected && expected <= range.max);
    // The range is half a decade around one value.
    assert!((range.max / range.min).log10() < 0.51, "{used}");
}

#[test]
fn what_has_no_meaning_is_one_line() {
    let folder = tempfile::tempdir().expect("a folder");
    for (words, part) in [
        (
            vec!["--false-colour", "illuminance", "--show", "normal"],
            "leave one out",
        ),
        (
            vec!["--false-colour", "luminance", "--show", "irradiance"],
            "leave one out",
        ),
        (
            vec!["--false-colour", "luminance", "--false-colour-range", "5,1"],
            "less than the second",
        ),
        (vec!["--false-colour", "heat"], "luminance, illuminance"),
    ] {
        let output = skylight(folder.path(), &[vec!["render"], words].concat());
        let told = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success() && told.contains(part), "{told}");
        assert_eq!(told.trim().lines().count(), 1, "{told}");
    }
}
