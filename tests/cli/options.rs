//! Options, end to end: output files, messages, and files that must stay unchanged.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

/// A small, quick picture that suffices for most tests: the light of sun and sky alone.
const SMALL: [&str; 8] = [
    "--size",
    "64x36",
    "--irradiance-samples",
    "16",
    "--bounces",
    "0",
    "--ambient",
    "ssao",
];

/// A model with a material and a texture.
const OBJ: &str = "mtllib m.mtl\nv -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\nv 0 2 0\nvt 0 0\nvt 1 0\nvt 1 1\nusemtl paint\n\
                   f 1/1 2/2 3/3\nf 1/1 3/2 4/3\nf 1/1 2/2 5/3\n";
const MTL: &str = "newmtl paint\nKd 0.8 0.4 0.2\n";

fn program(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_skylight"));
    command.current_dir(folder).stdin(Stdio::null());
    command
}

/// A scratch folder and the program in it.
struct Place(tempfile::TempDir);

impl Place {
    /// A folder with `m.obj` and `m.mtl`.
    fn new() -> Self {
        let place = Self(tempfile::tempdir().expect("a scratch folder"));
        place.put("m.obj", OBJ);
        place.put("m.mtl", MTL);
        place
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn put(&self, name: &str, text: &str) {
        fs::write(self.path().join(name), text).expect("a file");
    }

    fn run(&self, words: &[&str]) -> Ended {
        let output = program(self.path()).args(words).output();
        Ended::of(words, output.expect("the program starts"))
    }

    /// Runs the program; if it takes longer than `limit`, kills it and fails.
    fn run_within(&self, limit: Duration, words: &[&str]) -> Ended {
        let mut command = program(self.path());
        command.args(words);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("the program starts");
        let started = Instant::now();
        while child.try_wait().expect("a state").is_none() {
            if started.elapsed() > limit {
                child.kill().expect("it runs");
                child.wait().expect("an end");
                panic!("{words:?}: still at work after {limit:?}");
            }
            std::thread::sleep(Duration::from_millis(20));
        }
        // The output is one line at most, so it fits into the pipes.
        Ended::of(words, child.wait_with_output().expect("its words"))
    }

    /// Runs `render` with a small picture.
    fn render(&self, words: &[&str]) -> Ended {
        self.run(&[&["render"], words, &SMALL[..]].concat())
    }

    /// Every path below the folder, with file contents.
    fn contents(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        fn walk(folder: &Path, found: &mut BTreeMap<PathBuf, Vec<u8>>) {
            for entry in fs::read_dir(folder).expect("a folder") {
                let path = entry.expect("an entry").path();
                if path.is_dir() {
                    found.insert(path.clone(), Vec::new());
                    walk(&path, found);
                } else {
                    found.insert(path.clone(), fs::read(&path).expect("a file"));
                }
            }
        }
        let mut found = BTreeMap::new();
        walk(self.path(), &mut found);
        found
    }

    /// Names of the entries in the folder.
    fn names(&self) -> Vec<String> {
        let entries = fs::read_dir(self.path()).expect("the folder");
        let name = |entry: std::io::Result<fs::DirEntry>| entry.expect("an entry").file_name();
        let mut names: Vec<_> = entries
            .map(|entry| name(entry).to_string_lossy().into_owned())
            .collect();
        names.sort();
        names
    }
}

/// Result of a run of the program.
struct Ended {
    words: String,
    code: Option<i32>,
    stdout: String,
    stderr: String,
}

impl Ended {
    fn of(words: &[&str], output: Output) -> Self {
        Self {
            words: words.join(" "),
            code: output.status.code(),
            stdout: String::from_utf8(output.stdout).expect("text"),
            stderr: String::from_utf8(output.stderr).expect("text"),
        }
    }

    /// Checks for exit code 0. Warnings on stderr are allowed.
    #[track_caller]
    fn succeeded(self) -> Self {
        assert_eq!(self.code, Some(0), "{}: {}", self.words, self.stderr);
        assert!(!self.stdout.is_empty(), "{}: no result", self.words);
        self
    }

    /// Checks for exit code 0 and an empty stderr.
    #[track_caller]
    fn silently(self) -> Self {
        let ended = self.succeeded();
        assert_eq!(ended.stderr, "", "{}", ended.words);
        ended
    }

    /// Checks the exit code, and that the only output is one line of error that contains every part.
    #[track_caller]
    fn failed(self, code: i32, parts: &[&str]) {
        let Self { words, stderr, .. } = self;
        assert_eq!(self.code, Some(code), "{words}: {stderr}");
        assert_eq!(self.stdout, "", "{words}");
        assert_eq!(stderr.lines().count(), 1, "{words}: {stderr}");
        assert!(stderr.starts_with("error: "), "{words}: {stderr}");
        assert!(stderr.ends_with('\n'), "{words}: {stderr}");
        for part in parts {
            assert!(stderr.contains(part), "{words}: no {part} in {stderr}");
        }
        for word in ["panicked", "RUST_BACKTRACE", "Os {", "os error"] {
            assert!(!stderr.contains(word), "{words}: {stderr}");
        }
    }
}

/// Parameters, size and pixels of a PNG; it must be 8-bit RGB.
fn png(path: &Path) -> (BTreeMap<String, String>, [u32; 2], Vec<u8>) {
    let file = std::io::BufReader::new(fs::File::open(path).expect("the picture"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
    reader.next_frame(&mut pixels).expect("whole");
    reader.finish().expect("an end");
    let info = reader.info();
    assert_eq!(
        (info.color_type, info.bit_depth),
        (png::ColorType::Rgb, png::BitDepth::Eight)
    );
    let texts = info.utf8_text.iter();
    let texts = texts.map(|t| (t.keyword.clone(), t.get_text().expect("text")));
    (texts.collect(), [info.width, info.height], pixels)
}

/// Channels by name, parameters and size of an EXR; every channel must be 32-bit float.
struct Exr {
    channels: BTreeMap<String, Vec<f32>>,
    parameters: BTreeMap<String, String>,
    size: [usize; 2],
}

fn exr(path: &Path) -> Exr {
    use exr::prelude::*;
    let image = read_all_flat_layers_from_file(path).expect("an EXR");
    let [layer] = &image.layer_data[..] else {
        panic!("one part, not {}", image.layer_data.len())
    };
    assert!(image.attributes.chromaticities.is_some());
    let channels = layer.channel_data.list.iter().map(|channel| {
        let FlatSamples::F32(values) = &channel.sample_data else {
            panic!("{} is not 32-bit float", channel.name)
        };
        (channel.name.to_string(), values.clone())
    });
    let parameters = layer.attributes.other.iter();
    let parameters = parameters.filter_map(|(key, value)| match value {
        // Prefixed, because some option names (exposure) are standard attributes of other types.
        AttributeValue::Text(text) => {
            let key = key.to_string().strip_prefix("skylight:")?.to_owned();
            Some((key, text.to_string()))
        }
        _ => None,
    });
    Exr {
        channels: channels.collect(),
        parameters: parameters.collect(),
        size: [layer.size.x(), layer.size.y()],
    }
}

#[test]
fn a_png_is_8_bit_rgb_with_its_parameters() {
    let place = Place(tempfile::tempdir().expect("a scratch folder"));
    let ended = place
        .render(&["-o", "a.png", "--sun", "215,42", "--turbidity", "4.5"])
        .silently();
    assert!(ended.stdout.starts_with("a.png: 64x36"), "{}", ended.stdout);
    assert_eq!(ended.stdout.lines().count(), 1);
    assert_eq!(place.names(), ["a.png"], "nothing but the picture remains");
    let (texts, size, pixels) = png(&place.path().join("a.png"));
    assert_eq!(size, [64, 36]);
    for (key, value) in [
        ("size", "64x36"),
        ("sun", "215,42"),
        ("turbidity", "4.5"),
        ("scene", "bundled"),
        ("Software", concat!("skylight ", env!("CARGO_PKG_VERSION"))),
    ] {
        assert_eq!(texts.get(key).map(String::as_str), Some(value), "{key}");
    }
    let distinct: std::collections::BTreeSet<&[u8]> = pixels.chunks(3).collect();
    assert!(distinct.len() > 100, "{} colours", distinct.len());
    let mean = pixels.iter().map(|p| f64::from(*p)).sum::<f64>() / pixels.len() as f64;
    assert!((40.0..220.0).contains(&mean), "mean {mean}");
}

#[test]
fn a_night_stays_dark_from_the_exposure_on_that_is_asked_for() {
    let place = Place(tempfile::tempdir().expect("a scratch folder"));
    let night = ["-o", "a.png", "--sky", "atmosphere", "--sun", "0,-30"];
    for (more, is_dark) in [
        (&["--min-ev100", "-2"][..], true),
        (&["--min-ev100", "-2", "--tile", "64"], true),
        (&["--min-ev100", "-20"], false),
        (&[], false),
    ] {
        let said = place.render(&[&night[..], more].concat()).silently().stdout;
        // The stars alone ask for less than -10.
        let expected = if is_dark {
            ", EV100 -2.00"
        } else {
            ", EV100 -1"
        };
        assert!(said.contains(expected), "{more:?}: {said}");
    }
}

#[test]
fn nothing_given_writes_skylight_png() {
    let place = Place(tempfile::tempdir().expect("a scratch folder"));
    place.render(&[]).silently();
    assert_eq!(place.names(), ["skylight.png"]);
}

#[test]
fn bundled_scenes_go_by_their_names_unless_a_file_does() {
    let place = Place::new();
    let words = ["render", "island", "--camera", "veranda", "-o", "i.png"];
    place.run(&[&words[..], &SMALL].concat()).succeeded();
    let (parameters, size, _) = png(&place.path().join("i.png"));
    assert_eq!(size, [64, 36]);
    assert!(parameters["command"].contains(" island "));
    // A file of that name is a model without an extension.
    place.put("island", OBJ);
    let ended = place.run(&["render", "island", "-o", "j.png"]);
    ended.failed(1, &["island"]);
}

#[test]
#[cfg(target_os = "linux")]
fn without_a_display_the_window_says_so() {
    let place = Place::new();
    let mut command = program(place.path());
    for name in ["DISPLAY", "WAYLAND_DISPLAY", "WAYLAND_SOCKET"] {
        command.env_remove(name);
    }
    let ended = Ended::of(&["view"], command.arg("view").output().expect("it starts"));
    assert!(!ended.stderr.contains(".rs:"), "{}", ended.stderr);
    ended.failed(1, &["no display", "DISPLAY is set", "skylight render"]);
}

/// File names are bytes on Unix.
#[test]
#[cfg(unix)]
fn an_output_path_need_not_be_utf_8() {
    use std::ffi::OsStr;
    use std::os::unix::ffi::OsStrExt as _;
    let place = Place::new();
    for name in [&b"h\xf8j.png"[..], b"h\xf8j.exr"] {
        let name = OsStr::from_bytes(name);
        let mut command = program(place.path());
        command.args(["render", "m.obj"]).args(SMALL);
        let output = command.arg("-o").arg(name).output();
        let ended = Ended::of(&["render -o"], output.expect("it starts")).silently();
        assert!(ended.stdout.starts_with("h\u{fffd}j."), "{}", ended.stdout);
        assert!(place.path().join(name).is_file());
    }
    let mut command = program(place.path());
    command.args(["render", "--turbidity"]);
    let output = command.arg(OsStr::from_bytes(b"3\xff")).output();
    Ended::of(&["--turbidity"], output.expect("it starts")).failed(2, &["3\u{fffd}", "not UTF-8"]);
}

#[test]
fn metadata_name_flags_and_the_preset() {
    let place = Place::new();
    let words = ["m.obj", "-o", "a.png", "--limb-darkening", "--smooth", "30"];
    let words = [&words[..], &["--preset", "lecture", "--quiet"]].concat();
    place.render(&words).silently();
    let (texts, ..) = png(&place.path().join("a.png"));
    for (key, value) in [
        ("limb-darkening", "true"),
        ("smooth", "30"),
        ("preset", "lecture"),
        ("quiet", "true"),
        ("size", "64x36"),
    ] {
        assert_eq!(texts.get(key).map(String::as_str), Some(value), "{key}");
    }
}

#[test]
fn an_exr_is_32_bit_float_with_its_parameters() {
    let place = Place(tempfile::tempdir().expect("a scratch folder"));
    let words = ["render", "-o", "a.EXR", "--sun", "215,42"];
    place.run(&[&words[..], &SMALL[..4]].concat()).silently();
    assert_eq!(place.names(), ["a.EXR"]);
    let exr = exr(&place.path().join("a.EXR"));
    assert_eq!(exr.size, [64, 36]);
    let names: Vec<_> = exr.channels.keys().map(String::as_str).collect();
    assert_eq!(names, ["B", "G", "R"]);
    for (key, value) in [
        ("sun", "215,42"),
        ("turbidity", "3.2"),
        ("samples", "1"),
        ("bounces", "all"),
        ("ambient", "cells"),
    ] {
        assert_eq!(exr.parameters.get(key).map(String::as_str), Some(value));
    }
    // Scene luminances in daylight are thousands of cd/m², not display values.
    let green = &exr.channels["G"];
    let mean = green.iter().sum::<f32>() / green.len() as f32;
    assert!((500.0..20_000.0).contains(&mean), "{mean} cd/m²");
}

#[test]
fn the_addends_of_layers_sum_to_the_picture() {
    let place = Place(tempfile::tempdir().expect("a scratch folder"));
    let ended = place
        .render(&["-o", "a.exr", "--layers", "--samples", "3"])
        .silently();
    assert!(ended.stdout.contains("15 layer"), "{}", ended.stdout);
    let exr = exr(&place.path().join("a.exr"));
    let addends = [
        "sun",
        "sky",
        "bounces",
        "emission",
        "sun-specular",
        "sky-specular",
        "air",
        "background",
    ];
    let mut names = vec![
        "visibility.Y".to_owned(),
        "occlusion.Y".into(),
        "depth.Z".into(),
    ];
    names.extend(["R", "G", "B"].map(str::to_owned));
    names.extend(["X", "Y", "Z"].map(|c| format!("normal.{c}")));
    for layer in addends.iter().chain(&["irradiance", "albedo"]) {
        names.extend(["R", "G", "B"].map(|c| format!("{layer}.{c}")));
    }
    names.sort();
    let found: Vec<_> = exr.channels.keys().cloned().collect();
    assert_eq!(found, names);
    let mut seen = [false; 8];
    for c in ["R", "G", "B"] {
        let layers = addends.map(|layer| &exr.channels[&format!("{layer}.{c}")]);
        for (i, whole) in exr.channels[c].iter().enumerate() {
            let parts = layers.map(|layer| layer[i]);
            let sum: f32 = parts.iter().sum();
            assert!((sum - whole).abs() <= 4e-6 * whole, "{sum} is not {whole}");
            for (seen, part) in seen.iter_mut().zip(parts) {
                *seen |= part > 0.0;
            }
        }
    }
    let expected = addends.map(|addend| !["bounces", "emission"].contains(&addend));
    assert_eq!(seen, expected, "the others are seen: {addends:?}");
}

#[test]
fn anti_aliasing_of_a_file_is_done_or_refused() {
    let place = Place::new();
    for (words, remedy) in [
        (&["-o", "a.png", "--aa", "taa"][..], "smaa"),
        (&["-o", "a.exr", "--aa", "smaa"], ".png"),
        (
            &["-o", "a.png", "--aa", "smaa", "--show", "normal"],
            "leave it out",
        ),
        (
            &["-o", "a.png", "--aa", "smaa", "--false-colour", "luminance"],
            "leave it out",
        ),
    ] {
        let before = place.contents();
        let words = [&["m.obj"], words].concat();
        place
            .render(&words)
            .failed(2, &["--aa", remedy, "--samples"]);
        assert_eq!(place.contents(), before, "{words:?}");
    }
    let written = |name: &str, words: &[&str]| {
        place
            .render(&[&["m.obj", "-o", name], words].concat())
            .succeeded();
        png(&place.path().join(name))
    };
    let (plain, smooth) = (
        written("off.png", &[]),
        written("smaa.png", &["--aa", "smaa"]),
    );
    assert_eq!(plain.0["aa"], "off");
    assert_eq!(smooth.0["aa"], "smaa");
    assert!(plain.2 != smooth.2, "smaa changes nothing");
    // Samples smooth a picture by themselves.
    let [with, without] =
        ["taa", "off"].map(|aa| written(&format!("{aa}4.png"), &["--samples", "4", "--aa", aa]));
    assert!(with.2 == without.2);
}

#[test]
fn bad_words_end_with_2_and_touch_nothing() {
    let place = Place::new();
    place.put("old.png", "old");
    place.put("old.exr", "old");
    place.put(
        "two.toml",
        "[[mesh]]\nfile = \"m.obj\"\n[[camera]]\nname = \"porch\"\neye = [9, 1, 1]\n",
    );
    let before = place.contents();
    let cases: [(&[&str], &[&str]); 20] = [
        (
            &["render", "-o", "old.png", "--size", "0x0"],
            &["0x0", "1 to 32768"],
        ),
        (
            &["render", "-o", "old.png", "--size", "12"],
            &["--size", "1280x720"],
        ),
        (
            &["render", "-o", "old.png", "--turbidity", "abc"],
            &["--turbidity", "\"abc\" is not a number"],
        ),
        (
            &["render", "-o", "old.png", "--when", "2026-02-30T12:00Z"],
            &["2026-02-30 is a date that does not exist"],
        ),
        (
            &["render", "-o", "old.png", "--when", "2026-06-21"],
            &["the time is missing"],
        ),
        (&["render", "-o", "old.png", "--polish", "3"], &["--polish"]),
        (
            &[
                "render", "-o", "old.png", "--sky", "cie-12", "--aerial", "on",
            ],
            &[
                "--aerial on",
                "--sky atmosphere",
                "--sky cie-12",
                "--aerial off",
            ],
        ),
        (
            &["render", "-o", "old.png", "--aerial", "half"],
            &["--aerial", "half", "on, off"],
        ),
        (
            &["render", "-house.obj", "-o", "old.png"],
            &["-house.obj", "./-house.obj"],
        ),
        (
            &[
                "render",
                "-o",
                "old.png",
                "--sun",
                "1,2",
                "--when",
                "2026-06-21T12:00Z",
            ],
            &["--sun", "--when"],
        ),
        (
            &["render", "-o", "old.png", "--layers"],
            &["--layers", ".exr"],
        ),
        (&["render", "-o", "old.jpg"], &["old.jpg", ".png or .exr"]),
        (&["render", "m.obj", "m.obj", "-o", "old.png"], &["m.obj"]),
        (
            &["render", "m.obj", "-o", "old.png", "--camera", "porch"],
            &["\"porch\"", "no cameras", "--eye"],
        ),
        (
            &["render", "two.toml", "-o", "old.png", "--camera", "attic"],
            &["\"attic\"", "has porch"],
        ),
        (
            &[
                "render", "-o", "old.png", "--eye", "1,1,1", "--target", "1,1,1",
            ],
            &["--eye and --target"],
        ),
        (&["paint"], &["'paint'", "skylight --help"]),
        (&[], &["no command", "skylight --help"]),
        (&["bench", "--frames", "0"], &["--frames"]),
        (&["info", "--size", "3x3"], &["--size"]),
    ];
    for (words, parts) in cases {
        place.run(words).failed(2, parts);
    }
    assert_eq!(place.contents(), before, "no file is new or changed");
}

#[test]
fn bad_scenes_end_with_1_and_touch_nothing() {
    let place = Place::new();
    place.put("old.png", "old");
    place.put("empty.obj", "");
    place.put("cut.obj", &OBJ[..27]);
    place.put("model.gltf", "{}");
    place.put("text.txt", "v 0 0 0");
    fs::create_dir(place.path().join("folder")).expect("a folder");
    fs::create_dir(place.path().join("folder.obj")).expect("a folder");
    let mesh = "[[mesh]]\nfile = \"m.obj\"\n";
    place.put("key.toml", &format!("{mesh}[sky]\nturbidty = 3\n"));
    place.put("value.toml", &format!("{mesh}[sky]\nturbidity = \"abc\"\n"));
    place.put(
        "date.toml",
        &format!("{mesh}[place]\nwhen = \"2026-02-30T12:00Z\"\n"),
    );
    place.put(
        "both.toml",
        &format!("{mesh}[sun]\nsun = [1, 2]\nwhen = \"2026-02-28T12:00Z\"\n"),
    );
    place.put(
        "camera.toml",
        &format!("{mesh}[[camera]]\nname = \"a\"\nfov = 20\n[[camera]]\nname = \"b\"\nfov = 900\n"),
    );
    place.put("broken.toml", &format!("{mesh}[sky\n"));
    place.put("gone.toml", "[[mesh]]\nfile = \"gone.obj\"\n");
    place.put("none.toml", "");
    let before = place.contents();
    let cases: [(&[&str], &[&str]); 17] = [
        (&["no.obj"], &["no.obj", "no such file"]),
        (&["m.obj/x.obj"], &["m.obj/x.obj", "no such file"]),
        (&["folder"], &["folder is a directory", ".obj"]),
        (&["folder.obj"], &["folder.obj is a directory"]),
        (&["empty.obj"], &["empty.obj has no triangles"]),
        (&["cut.obj"], &["cut.obj has no triangles", "line 3"]),
        (
            &["model.gltf"],
            &["model.gltf has no triangles", "export it"],
        ),
        (&["text.txt"], &["text.txt", ".obj"]),
        (&["key.toml"], &["key.toml", "\"turbidty\"", "turbidity"]),
        (
            &["value.toml"],
            &["value.toml", "turbidity", "\"abc\" is not a number"],
        ),
        (
            &["date.toml"],
            &["date.toml", "2026-02-30 is a date that does not exist"],
        ),
        (&["both.toml"], &["both.toml", "--sun", "--when"]),
        (
            &["camera.toml", "--camera", "b"],
            &["camera.toml", "1 to 170"],
        ),
        (&["broken.toml"], &["broken.toml", "line 3"]),
        (&["gone.toml"], &["gone.obj", "no such file"]),
        (&["none.toml"], &["none.toml", "[[mesh]]"]),
        (
            &["--device", "Nonesuch 9000"],
            &["\"Nonesuch 9000\"", "there are: "],
        ),
    ];
    for (words, parts) in cases {
        let words = [words, &["-o", "old.png"]].concat();
        place.render(&words).failed(1, parts);
    }
    assert_eq!(place.contents(), before, "no file is new or changed");
}

#[test]
fn outputs_that_cannot_be_written_are_named_before_the_work() {
    let place = Place::new();
    fs::create_dir(place.path().join("folder.png")).expect("a folder");
    let before = place.contents();
    let mut cases = vec![
        (vec!["render", "-o", "no/such/a.png"], "no/such/a.png"),
        (vec!["render", "-o", "m.obj/a.png"], "m.obj"),
        (vec!["render", "-o", "folder.png"], "folder.png"),
        (vec!["bench", "--json", "no/such/a.json"], "no/such/a.json"),
        (vec!["bench", "--json", "folder.png"], "folder.png"),
    ];
    if cfg!(target_os = "linux") {
        // Root may write anywhere except to file systems that create no files.
        cases.push((vec!["render", "-o", "/proc/a.png"], "/proc/a.png"));
        cases.push((vec!["render", "-o", "/proc/a.exr"], "/proc/a.exr"));
    }
    for (words, part) in cases {
        // So long that a check after rendering would exceed the time limit.
        let long: &[&str] = match words[0] {
            "render" => &["--samples", "60000"],
            _ => &["--frames", "100000"],
        };
        place
            .run_within(Duration::from_secs(20), &[&words, long].concat())
            .failed(1, &["cannot write", part]);
    }
    assert_eq!(place.contents(), before, "no file is new or changed");
}

#[test]
fn missing_helpers_are_warnings_that_no_warnings_silences() {
    let place = Place::new();
    place.put("nomtl.obj", &OBJ.replace("m.mtl", "gone.mtl"));
    place.put("notex.obj", &OBJ.replace("m.mtl", "t.mtl"));
    place.put("t.mtl", "newmtl paint\nmap_Kd gone.png\n");
    for (scene, part) in [("nomtl.obj", "gone.mtl"), ("notex.obj", "gone.png")] {
        let ended = place.render(&[scene, "-o", "a.png"]).succeeded();
        assert!(ended.stderr.contains(part), "{}", ended.stderr);
        for line in ended.stderr.lines() {
            assert!(line.starts_with("warning: "), "{line}");
        }
        png(&place.path().join("a.png"));
        fs::remove_file(place.path().join("a.png")).expect("it was there");
        let quiet = place.render(&[scene, "-o", "a.png", "--quiet"]).succeeded();
        assert_eq!(quiet.stderr, ended.stderr, "quiet hides progress");
        place
            .render(&[scene, "-o", "a.png", "--no-warnings"])
            .silently();
        png(&place.path().join("a.png"));
        fs::remove_file(place.path().join("a.png")).expect("it was there");
        place
            .render(&[scene, "-o", "a.png", "--strict"])
            .failed(1, &["error: ", part, "--strict", "nothing is written"]);
        assert!(!place.path().join("a.png").exists(), "nothing is written");
    }
    place
        .render(&["m.obj", "-o", "a.png", "--strict"])
        .silently();
    // Cut off within a vertex that no face has.
    place.put("vertex.obj", &format!("{OBJ}v 0 1"));
    let ended = place.render(&["vertex.obj", "-o", "a.png"]).succeeded();
    assert!(
        ended.stderr.contains("needs three numbers"),
        "{}",
        ended.stderr
    );
    // Cut off within its last face: the complete faces are drawn.
    place.put("cut.obj", &OBJ[..OBJ.len() - 6]);
    let ended = place.render(&["cut.obj", "-o", "a.png"]).succeeded();
    assert!(ended.stderr.contains("fewer than three corners"));
    let hazy = ["m.obj", "-o", "a.png", "--turbidity", "90"];
    let ended = place.render(&hazy).succeeded();
    assert!(ended.stderr.contains("turbidity"), "{}", ended.stderr);
    place
        .render(&[&hazy[..], &["--no-warnings"]].concat())
        .silently();
    place
        .render(&[&hazy[..], &["--strict"]].concat())
        .failed(1, &["turbidity", "--strict"]);
    let sky = ["sky", "--sky", "preetham", "--turbidity", "90"];
    place.run(&sky).succeeded();
    place
        .run(&[&sky[..], &["--strict"]].concat())
        .failed(1, &["turbidity", "--strict"]);
}

#[test]
fn the_command_line_overrides_the_scene_file() {
    let place = Place::new();
    place.put(
        "s.toml",
        "[[mesh]]\nfile = \"m.obj\"\n[sun]\nsun = [120, 30]\n[sky]\nturbidity = 5\nground-albedo = 0.1\n\
         [camera]\neye = [0, 2, 9]\ntarget = [0, 1, 0]\nfov = 33\n[[mesh]]\nfile = \"m.obj\"\ntranslate = [3, 0, 0]\n",
    );
    let parameters = |words: &[&str]| {
        let words = [&["s.toml", "-o", "a.png"], words].concat();
        place.render(&words).silently();
        let (texts, _, pixels) = png(&place.path().join("a.png"));
        let get = |key: &str| texts.get(key).cloned().unwrap_or_default();
        let keys = ["sun", "turbidity", "ground-albedo", "eye", "target", "fov"];
        (keys.map(get), get("when"), pixels)
    };
    let (file, when, first) = parameters(&[]);
    assert_eq!(file, ["120,30", "5", "0.1", "0,2,9", "0,1,0", "33"]);
    assert_eq!(when, "");
    let (user, _, second) = parameters(&[
        "--sun",
        "200,50",
        "--turbidity",
        "2.5",
        "--ground-albedo",
        "0",
        "--eye",
        "1,3,8",
        "--fov",
        "50",
    ]);
    assert_eq!(user, ["200,50", "2.5", "0", "1,3,8", "0,1,0", "50"]);
    assert_ne!(first, second);
    let (moment, when, _) = parameters(&["--when", "2026-06-21T12:00Z"]);
    assert_eq!(moment[0], "", "a moment replaces the file's direction");
    assert_eq!(when, "2026-06-21T12:00:00+00:00");
}

#[test]
fn a_scene_file_has_measured_skies_and_clouds() {
    let place = Place::new();
    place.put(
        "s.toml",
        "[[mesh]]\nfile = \"m.obj\"\n[sun]\nsun = [120, 30]\n\
         [sky]\nsky = \"perez\"\ndni = 600\ndhi = 90.5\ndew-point = -3\n\
         [[moment]]\nname = \"cloudy\"\nsky = \"hosek\"\ncloud-cover = 0.7\n",
    );
    let keys = ["sky", "dni", "dhi", "dew-point", "cloud-cover"];
    for (words, expected) in [
        (&[][..], ["perez", "600", "90.5", "-3", "0"]),
        (&["--dni", "20"], ["perez", "20", "90.5", "-3", "0"]),
        (
            &["--moment", "cloudy"],
            ["hosek", "600", "90.5", "-3", "0.7"],
        ),
    ] {
        place
            .render(&[&["s.toml", "-o", "a.png"], words].concat())
            .silently();
        let (texts, ..) = png(&place.path().join("a.png"));
        assert_eq!(keys.map(|key| texts[key].as_str()), expected);
    }
    place.put("t.toml", "[[mesh]]\nfile = \"m.obj\"\n[sky]\ndni = -5\n");
    let ended = place.render(&["t.toml", "-o", "a.png"]);
    ended.failed(1, &["dni", "irradiance must be 0 to 1500 W/m²"]);
}

#[test]
fn cameras_of_a_scene_file_are_chosen_by_name() {
    let place = Place::new();
    place.put(
        "s.toml",
        "[[mesh]]\nfile = \"m.obj\"\n[[camera]]\nname = \"front\"\neye = [0, 2, 9]\n[[camera]]\nname = \"side\"\neye = [9, 2, 0]\n",
    );
    for (words, eye) in [(&[][..], "0,2,9"), (&["--camera", "side"][..], "9,2,0")] {
        place
            .render(&[&["s.toml", "-o", "a.png"], words].concat())
            .silently();
        let (texts, ..) = png(&place.path().join("a.png"));
        assert_eq!(texts["eye"], eye);
    }
}

#[test]
fn help_version_and_info_are_results() {
    let place = Place::new();
    let before = place.contents();
    for (words, parts) in [
        (
            &["--help"][..],
            &["render", "bench", "info", "Exit code"][..],
        ),
        (
            &["render", "--help"],
            &[
                "--turbidity",
                "--layers",
                "--bounces <N>",
                "--ambient <SOURCE>",
                "[default: all]",
                "[default: cells]",
                "[default: 1280x720]",
            ],
        ),
        (&["bench", "--help"], &["--json", "--frames"]),
        (
            &["--version"],
            &[concat!("skylight ", env!("CARGO_PKG_VERSION"))],
        ),
        (&["info"], &["Vulkan", "driver", "lacks", "MiB"]),
        (&["info", "--json"], &["\"devices\"", "\"budget_bytes\""]),
    ] {
        let ended = place.run(words).silently();
        for part in parts {
            assert!(
                ended.stdout.contains(part),
                "{words:?}: no {part}: {}",
                ended.stdout
            );
        }
    }
    assert_eq!(place.contents(), before);
}

#[test]
fn a_device_is_chosen_by_number() {
    let place = Place::new();
    place
        .render(&["m.obj", "-o", "a.png", "--device", "0"])
        .silently();
}

#[test]
fn bench_prints_a_table_and_writes_json() {
    let place = Place::new();
    let ended = place
        .run(&[
            "bench", "m.obj", "--frames", "2", "--size", "64x36", "--json", "t.json",
        ])
        .silently();
    for part in ["median", "lighting", "shadow map", "whole frame"] {
        assert!(ended.stdout.contains(part), "no {part}: {}", ended.stdout);
    }
    assert_eq!(place.names(), ["m.mtl", "m.obj", "t.json"]);
    let text = fs::read(place.path().join("t.json")).expect("the table");
    let table: serde_json::Value = serde_json::from_slice(&text).expect("JSON");
    assert_eq!(table["size"], serde_json::json!([64, 36]));
    let passes = table["passes"].as_array().expect("a list");
    assert!(passes.len() >= 8, "{passes:?}");
    let times = passes.iter().chain([&table["frame"]]);
    for time in times.map(|row| row["median_ms"].as_f64().expect("a number")) {
        assert!(time > 0.0 && time < 60_000.0, "{time} ms");
    }
}

/// Starts a render that takes minutes and waits until it has drawn for a while.
fn started(place: &Place, output: &str) -> Child {
    let mut child = program(place.path())
        .args([
            "render",
            "-o",
            output,
            "--size",
            "320x180",
            "--samples",
            "65536",
        ])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .expect("the program starts");
    std::thread::sleep(Duration::from_millis(2500));
    assert!(
        child.try_wait().expect("a state").is_none(),
        "it still draws"
    );
    child
}

#[test]
#[cfg(unix)]
fn killed_in_the_middle_the_old_picture_stays() {
    use std::os::unix::process::ExitStatusExt as _;
    for (signal, number) in [("KILL", 9), ("TERM", 15)] {
        let place = Place::new();
        place.put("old.png", "old");
        let before = place.contents();
        for output in ["old.png", "new.exr"] {
            let mut child = started(&place, output);
            // The shell's own: bare systems have no program of that name.
            let kill = format!("kill -s {signal} {}", child.id());
            let kill = Command::new("sh").args(["-c", &kill]).status();
            assert!(kill.expect("kill").success());
            let status = child.wait().expect("an end");
            assert_eq!(status.signal(), Some(number), "{signal}: {status}");
            assert_eq!(place.contents(), before, "{signal}");
        }
    }
}

/// A stdout that cannot be written is an error, never a panic.
#[test]
#[cfg(target_os = "linux")]
fn a_full_or_closed_stdout_is_no_panic() {
    let place = Place::new();
    let full = fs::OpenOptions::new().write(true).open("/dev/full");
    for words in [
        &["info"][..],
        &["--help"],
        &["sky"],
        &["render", "m.obj", "-o", "a.png", "--size", "8x8"],
    ] {
        let full = full.as_ref().expect("/dev/full").try_clone().expect("it");
        let output = program(place.path()).args(words).stdout(full).output();
        Ended::of(words, output.expect("it starts")).failed(1, &["standard output"]);
    }
    let mut child = program(place.path())
        .arg("--help")
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("an end");
    let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!stderr.contains("panicked"), "{stderr}");
}
