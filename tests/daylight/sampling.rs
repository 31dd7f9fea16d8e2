//! When `render` stops sampling: at a number of samples, at a noise level, or on Ctrl-C; and what the metadata records.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A small picture of the bundled scene that is quick to render.
const SMALL: [&str; 9] = [
    "render",
    "--size",
    "96x54",
    "--dome-size",
    "256",
    "--dome-directions",
    "4",
    "--bounces",
    "0",
];

fn program(folder: &Path, words: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_skylight"));
    command.current_dir(folder).args(SMALL).args(words);
    command
        .stdin(Stdio::null())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped());
    command
}

fn run(folder: &Path, words: &[&str]) -> String {
    let output = program(folder, words).output().expect("the program starts");
    done(&output)
}

/// Output of a run that succeeded without complaints.
fn done(output: &Output) -> String {
    let [said, complaint] =
        [&output.stdout, &output.stderr].map(|s| String::from_utf8_lossy(s).into_owned());
    assert!(output.status.success(), "{:?} {complaint}", output.status);
    assert_eq!(complaint, "");
    said
}

/// Text chunks of a PNG.
fn texts(path: &Path) -> BTreeMap<String, String> {
    let file = fs::File::open(path).expect("a picture");
    let decoder = png::Decoder::new(std::io::BufReader::new(file));
    let reader = decoder.read_info().expect("a PNG");
    let chunks = reader.info().utf8_text.iter();
    chunks
        .map(|t| (t.keyword.clone(), t.get_text().expect("text")))
        .collect()
}

/// Luminance of every pixel of an EXR, and its parameters.
fn exr(path: &Path) -> (Vec<f64>, BTreeMap<String, String>) {
    use exr::prelude::*;
    let image = read_all_flat_layers_from_file(path).expect("an EXR");
    let layer = &image.layer_data[0];
    let channel = |name: &str| -> Vec<f64> {
        let found = layer
            .channel_data
            .list
            .iter()
            .find(|c| c.name.to_string() == name);
        found
            .expect(name)
            .sample_data
            .values_as_f32()
            .map(f64::from)
            .collect()
    };
    let [r, g, b] = ["R", "G", "B"].map(channel);
    let luminance = (0..r.len()).map(|i| 0.2126 * r[i] + 0.7152 * g[i] + 0.0722 * b[i]);
    let parameters = layer.attributes.other.iter().chain(&image.attributes.other);
    let texts = parameters.filter_map(|(name, value)| match value {
        AttributeValue::Text(text) => {
            Some((name.to_string().replace("skylight:", ""), text.to_string()))
        }
        _ => None,
    });
    (luminance.collect(), texts.collect())
}

fn number(texts: &BTreeMap<String, String>, key: &str) -> f64 {
    let text = texts
        .get(key)
        .unwrap_or_else(|| panic!("no {key} in {texts:?}"));
    text.parse().unwrap_or_else(|e| panic!("{key} {text}: {e}"))
}

#[test]
fn it_stops_when_the_noise_is_small_enough_and_the_picture_is_that_near() {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    run(
        folder.path(),
        &["-o", "truth.exr", "--samples", "400", "--seed", "7"],
    );
    let (truth, _) = exr(&at("truth.exr"));
    let mean = truth.iter().sum::<f64>() / truth.len() as f64;
    let mut before = 0.0;
    for wanted in [0.1, 0.02] {
        let said = run(
            folder.path(),
            &["-o", "a.exr", "--noise", &wanted.to_string()],
        );
        let (picture, texts) = exr(&at("a.exr"));
        let (samples, told) = (
            number(&texts, "samples drawn"),
            number(&texts, "noise estimated"),
        );
        let squares = picture
            .iter()
            .zip(&truth)
            .map(|(a, b)| (a - b).powi(2))
            .sum::<f64>();
        let error = (squares / truth.len() as f64).sqrt() / mean;
        println!("--noise {wanted}: {samples} samples, told {told:.4}, found {error:.4}");
        assert!(
            said.contains(&format!(", {samples} samples, noise ")),
            "{said}"
        );
        assert!(samples > before && samples < 4096.0, "{samples}");
        // The estimate is of the same size as the error.
        assert!(told <= wanted, "{told}");
        assert!(error < 2.0 * told && error > told / 4.0, "{told} {error}");
        assert_eq!(number(&texts, "samples"), 4096.0);
        before = samples;
    }
}

#[test]
fn the_number_of_samples_still_rules_and_the_same_seed_makes_the_same_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let words = ["--noise", "1e-6", "--samples", "20", "--seed", "3", "-o"];
    for name in ["a.png", "b.png"] {
        let said = run(folder.path(), &[&words[..], &[name]].concat());
        assert!(said.contains(", 20 samples, noise "), "{said}");
    }
    let [a, b] = ["a.png", "b.png"].map(|name| fs::read(folder.path().join(name)).expect("it"));
    assert!(a == b, "the files differ");
    let texts = texts(&folder.path().join("a.png"));
    assert_eq!(texts.get("samples drawn").map(String::as_str), Some("20"));
    assert!(!texts.contains_key("interrupted"), "{texts:?}");
    let command = &texts["command"];
    assert!(
        command.contains("--noise 0.000001") && command.contains("--samples 20"),
        "{command}"
    );
}

#[test]
fn senseless_noise_is_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    for value in ["0", "-1", "1.5", "nan", "x"] {
        let output = program(folder.path(), &["--noise", value])
            .output()
            .expect("it starts");
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{value}: {said}");
        assert_eq!(said.trim_end().lines().count(), 1, "{said}");
        assert!(said.contains("noise") && said.contains(value), "{said}");
    }
    assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 0);
}

#[cfg(unix)]
fn interrupt(child: &Child) {
    // The shell's own: bare systems have no program of that name.
    let kill = format!("kill -s INT {}", child.id());
    let kill = Command::new("sh").args(["-c", &kill]).status();
    assert!(kill.expect("kill").success());
}

/// Starts a long render and waits until it draws samples, from when on it handles Ctrl-C.
#[cfg(target_os = "linux")]
fn at_work(folder: &Path, words: &[&str]) -> Child {
    let child = program(folder, words).spawn().expect("the program starts");
    let started = Instant::now();
    let catches = || {
        let status = fs::read_to_string(format!("/proc/{}/status", child.id())).expect("it runs");
        let line = status
            .lines()
            .find_map(|l| l.strip_prefix("SigCgt:"))
            .expect("a mask");
        u64::from_str_radix(line.trim(), 16).expect("hexadecimal") >> 1 & 1 == 1
    };
    while !catches() {
        assert!(
            started.elapsed() < Duration::from_secs(60),
            "it does not begin"
        );
        std::thread::sleep(Duration::from_millis(10));
    }
    std::thread::sleep(Duration::from_millis(700));
    child
}

#[test]
#[cfg(target_os = "linux")]
fn ctrl_c_writes_what_there_is_and_says_so() {
    for name in ["a.png", "a.exr"] {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join(name);
        fs::write(&path, "old").expect("an old file");
        let child = at_work(folder.path(), &["--samples", "65536", "-o", name]);
        interrupt(&child);
        let said = done(&child.wait_with_output().expect("an end"));
        let texts = if name == "a.png" {
            texts(&path)
        } else {
            exr(&path).1
        };
        let samples = number(&texts, "samples drawn");
        assert!((1.0..65_536.0).contains(&samples), "{samples}");
        let what = format!("after {samples} of 65536 samples");
        assert_eq!(texts.get("interrupted"), Some(&what));
        assert!(said.contains(&format!("interrupted {what}")), "{said}");
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 1);
    }
}

#[test]
#[cfg(target_os = "linux")]
fn layers_that_are_whole_are_kept() {
    let folder = tempfile::tempdir().expect("a folder");
    let child = at_work(
        folder.path(),
        &["--samples", "65536", "--layers", "-o", "a.exr"],
    );
    interrupt(&child);
    let said = done(&child.wait_with_output().expect("an end"));
    assert!(said.contains("1 layer(s), interrupted"), "{said}");
}
