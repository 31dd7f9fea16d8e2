//! Several pictures of one scene: in one call of `render`, as a sequence, as a study; the shards of a sequence.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};

/// Small and quick: without bounces, under a quick sky.
const SMALL: &str =
    "--sky hosek --size 64x40 --irradiance-samples 64 --quiet --bounces 0 --ambient ssao";
/// With the cells of all bounces, which keep light from picture to picture.
const LIT: &str = "--sky hosek --size 48x32 --irradiance-samples 64 --quiet";

fn run(folder: &Path, line: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder)
        .args(line.split_whitespace())
        .output()
        .expect("it starts")
}

fn succeed(folder: &Path, line: &str) -> String {
    let output = run(folder, line);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{line}: {errors}");
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// The one line on stderr of a run that fails, and its exit code.
fn fail(folder: &Path, line: &str) -> (String, Option<i32>) {
    let output = run(folder, line);
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(!output.status.success(), "{line}");
    assert_eq!(text.lines().count(), 1, "{line}: {text}");
    (text, output.status.code())
}

fn scratch() -> tempfile::TempDir {
    tempfile::tempdir().expect("a scratch folder")
}

fn sidecar(folder: &Path, name: &str) -> serde_json::Value {
    let text = fs::read_to_string(folder.join(name)).expect(name);
    serde_json::from_str(&text).expect("JSON")
}

/// Every file of a folder with its bytes, hidden ones too.
fn contents(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder)
        .expect("a folder")
        .map(|e| e.expect("an entry"));
    let files = entries.filter(|entry| entry.path().is_file());
    let named = files.map(|entry| {
        let name = entry.file_name().to_string_lossy().into_owned();
        (name, fs::read(entry.path()).expect("a file"))
    });
    named.collect()
}

/// The parameters in a PNG file, all of whose pixels are read.
fn texts(path: &Path) -> BTreeMap<String, String> {
    let file = std::io::BufReader::new(fs::File::open(path).expect("a file"));
    let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
    let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
    reader.next_frame(&mut pixels).expect("all pixels");
    let chunks = reader.info().utf8_text.iter();
    let pair = |c: &png::text_metadata::ITXtChunk| (c.keyword.clone(), c.get_text().expect("text"));
    chunks.map(pair).collect()
}

#[test]
fn pictures_of_one_call_are_those_of_single_calls() {
    let folder = scratch();
    let [noon, late] = ["2026-09-24T12:00", "2026-09-24T17:30"];
    for (extension, options) in [
        ("png", LIT.to_owned()),
        ("png", format!("{SMALL} --samples 16 --visibility dome")),
        ("png", format!("{SMALL} --false-colour luminance")),
        ("exr", format!("{SMALL} --layers")),
    ] {
        let words = format!("render colonnade {options}");
        let all = format!("{words} --camera porch,pool --when {noon} --when {late}");
        let said = succeed(
            folder.path(),
            &format!("{all} -o {{camera}}-{{moment}}.{extension}"),
        );
        assert_eq!(said.lines().count(), 4, "{said}");
        for (camera, when) in [("pool", noon), ("porch", late)] {
            let name = format!("{camera}-{}.{extension}", when.replace(':', ""));
            let single = format!("{words} --camera {camera} --when {when} -o single.{extension}");
            succeed(folder.path(), &single);
            let read = |name: &str| fs::read(folder.path().join(name)).expect(name);
            let is_same = read(&name) == read(&format!("single.{extension}"));
            assert!(is_same, "{name} with {options} differs");
        }
    }
    let words = format!("render island {SMALL} --moment noon,storm -o {{moment}}.png");
    let (error, code) = fail(folder.path(), &words);
    assert!(
        error.contains("no moment \"storm\"") && code == Some(2),
        "{error}"
    );
    assert!(
        !folder.path().join("dusk.png").exists(),
        "nothing is drawn before"
    );
}

#[test]
fn frames_are_single_pictures_and_shards_of_them_are_the_sequence() {
    let (whole, parts) = (scratch(), scratch());
    let line = format!(
        "sequence colonnade --from 2026-09-24T16:00 --to 2026-09-24T17:45 --step 30min --expose smooth {SMALL} -o f_%02d.png"
    );
    let said = succeed(whole.path(), &line);
    assert!(said.starts_with("f_00.png .. f_03.png: 4 frames"), "{said}");
    let drawn = contents(whole.path());
    assert_eq!(
        drawn.keys().collect::<Vec<_>>(),
        ["f_00.png", "f_01.png", "f_02.png", "f_03.png"]
    );
    let of_last = texts(&whole.path().join("f_03.png"));
    assert_eq!(of_last["when"], "2026-09-24T17:30:00+02:00");
    // The light falls toward the evening, and so does the exposure.
    let ev = |name: &str| -> f64 {
        let text = &texts(&whole.path().join(name))["ev100"];
        text.parse().expect("a number")
    };
    assert!(
        ev("f_03.png") < ev("f_00.png") - 0.3,
        "{} {}",
        ev("f_03.png"),
        ev("f_00.png")
    );
    let single = format!(
        "render colonnade --when 2026-09-24T17:30 --ev100 {} {SMALL} -o single.png",
        ev("f_03.png")
    );
    succeed(parts.path(), &single);
    let single = parts.path().join("single.png");
    assert!(
        fs::read(&single).expect("a picture") == drawn["f_03.png"],
        "a single picture"
    );
    fs::remove_file(single).expect("there");

    for shard in ["1/3", "2/3", "3/3"] {
        succeed(parts.path(), &format!("{line} --shard {shard}"));
    }
    let mut of_parts = contents(parts.path());
    let shards: Vec<String> = of_parts
        .keys()
        .filter(|n| n.ends_with(".shard"))
        .cloned()
        .collect();
    assert_eq!(
        shards,
        ["f_1-of-3.shard", "f_2-of-3.shard", "f_3-of-3.shard"]
    );
    of_parts.retain(|name, _| !name.ends_with(".shard"));
    assert!(of_parts == drawn, "shards draw the same frames");
    let merge = format!("merge {}", shards.join(" "));
    assert_eq!(succeed(parts.path(), &merge), "4 frames, all whole\n");

    // A frame that changed, one that is gone, and a shard that was killed: only they are run again.
    fs::write(parts.path().join("f_01.png"), "half a frame").expect("written");
    fs::remove_file(parts.path().join("f_03.png")).expect("there");
    let (error, code) = fail(parts.path(), &merge);
    let expected = [
        "f_03.png is missing: run again with --shard 1/3",
        "f_01.png is damaged: run again with --shard 2/3",
    ];
    assert!(
        expected.iter().all(|part| error.contains(part)) && code == Some(1),
        "{error}"
    );
    fs::remove_file(parts.path().join("f_2-of-3.shard")).expect("there");
    let (error, _) = fail(parts.path(), "merge f_1-of-3.shard f_3-of-3.shard");
    assert!(
        error.contains("a shard is missing: run again with --shard 2/3"),
        "{error}"
    );
    for shard in ["1/3", "2/3"] {
        succeed(parts.path(), &format!("{line} --shard {shard}"));
    }
    assert_eq!(succeed(parts.path(), &merge), "4 frames, all whole\n");
}

#[test]
fn an_interrupted_sequence_leaves_whole_frames() {
    let folder = scratch();
    let line = format!(
        "sequence colonnade --from 2026-06-21T06:00 --to 2026-06-21T20:00 --step 1min --ev100 14 --samples 4 {SMALL} -o f_%d.png"
    );
    let child = Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder.path())
        .args(line.split_whitespace())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("it starts");
    let started = Instant::now();
    while !folder.path().join("f_1.png").exists() {
        assert!(started.elapsed() < Duration::from_secs(300), "no frame");
        sleep(Duration::from_millis(20));
    }
    let interrupt = Command::new("sh")
        .args(["-c", &format!("kill -s INT {}", child.id())])
        .status();
    assert!(interrupt.expect("a shell").success());
    let output = child.wait_with_output().expect("it ends");
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    let files = contents(folder.path());
    let told = format!("interrupted: {} of 841 frames are written", files.len());
    assert!(
        error.contains(&told) && output.status.code() == Some(1),
        "{error}"
    );
    for number in 0..files.len() {
        let of_frame = texts(&folder.path().join(format!("f_{number}.png")));
        assert!(!of_frame.contains_key("interrupted"), "{number}");
    }
}

/// A program that stands in for ffmpeg: it makes a film of the names of its frames.
#[cfg(unix)]
fn with_ffmpeg(folder: &Path) -> PathBuf {
    use std::os::unix::fs::PermissionsExt as _;
    let tools = folder.join("tools");
    fs::create_dir(&tools).expect("a folder");
    let text = "#!/bin/sh\nfor last; do :; done\n[ \"$last\" = -version ] || ls > \"$last\"\n";
    let path = tools.join("ffmpeg");
    fs::write(&path, text).expect("a script");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("executable");
    tools
}

#[cfg(unix)]
#[test]
fn films_are_made_of_the_frames_in_their_order() {
    let folder = scratch();
    let tools = with_ffmpeg(folder.path());
    let run = |path: &str, line: &str| {
        Command::new(env!("CARGO_BIN_EXE_skylight"))
            .current_dir(folder.path())
            .args(line.split_whitespace())
            .env("PATH", path)
            .output()
            .expect("it starts")
    };
    let line = format!(
        "sequence colonnade --from 2026-09-24T16:00 --to 2026-09-24T17:00 --step 1h --ev100 14 {SMALL}"
    );
    let output = run("/nowhere", &format!("{line} -o day.mp4"));
    let error = String::from_utf8_lossy(&output.stderr).into_owned();
    let remedy = "day.mp4: films need ffmpeg, which is not installed (apt install ffmpeg); or write frames, -o day_%04d.png";
    assert!(
        error.contains(remedy) && error.lines().count() == 1,
        "{error}"
    );
    let path = format!("{}:/usr/bin:/bin", tools.display());
    let output = run(&path, &format!("{line} -o day.mp4 --sidecar"));
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let frames = &sidecar(folder.path(), "day.mp4.json")["frames"];
    assert_eq!(frames.as_array().map(Vec::len), Some(2));
    assert_eq!(frames[1]["place"]["when"], "2026-09-24T17:00:00+02:00");
    let film = |name: &str| fs::read_to_string(folder.path().join(name)).expect("a film");
    assert_eq!(film("day.mp4"), "000000.png\n000001.png\n");
    // The same of shards.
    for shard in ["1/2", "2/2"] {
        assert!(
            run(
                &path,
                &format!("{line} -o f%d.png --sidecar --shard {shard}")
            )
            .status
            .success()
        );
    }
    let output = run(&path, "merge f_2-of-2.shard f_1-of-2.shard -o merged.mp4");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    assert_eq!(film("merged.mp4"), film("day.mp4"));
    let left = contents(folder.path());
    assert!(left.contains_key("f0.png.json") && left.contains_key("f1.png.json"));
    assert!(
        left.keys().all(|name| !name.starts_with('.')),
        "{:?}",
        left.keys()
    );
}

#[test]
fn a_study_is_one_sheet_of_all_days_and_hours() {
    let folder = scratch();
    let line =
        format!("study colonnade --dates 3-21,2026-12-21 --hours 9,12:30,17 --samples 1 {SMALL}");
    let said = succeed(folder.path(), &format!("{line} -o sheet.png --sidecar"));
    assert!(said.contains(", 6 pictures"), "{said}");
    let pictures = &sidecar(folder.path(), "sheet.png.json")["pictures"];
    assert_eq!(pictures.as_array().map(Vec::len), Some(6));
    assert_eq!(pictures[4]["place"]["when"], "2026-12-21T12:30:00+01:00");
    let of_sheet = texts(&folder.path().join("sheet.png"));
    assert_eq!(of_sheet["dates"], "3-21,2026-12-21");
    assert_eq!(of_sheet["hours"], "09:00,12:30,17:00");
    assert!(!of_sheet.contains_key("when"));
    let said = succeed(folder.path(), &format!("{line} --plan -o plan.png"));
    assert!(
        said.contains("m above, north up (perspective of 2°)"),
        "{said}"
    );
    succeed(
        folder.path(),
        &format!("{line} --plan=40 --target 3,0,2 -o near.png"),
    );
    let bytes = |name: &str| fs::read(folder.path().join(name)).expect("a sheet");
    assert!(bytes("plan.png") != bytes("sheet.png") && bytes("plan.png") != bytes("near.png"));
    succeed(folder.path(), &format!("{line} --plan -o again.png"));
    assert!(
        bytes("plan.png") == bytes("again.png"),
        "the same words, the same sheet"
    );
}

#[test]
fn what_cannot_be_drawn_is_one_line() {
    let folder = scratch();
    let sequence = "sequence colonnade --from 2026-06-21T10:00 --to 2026-06-21T12:00 --step 10min";
    for (line, part, code) in [
        (
            "render --camera porch,pool -o a.png",
            "several pictures would be a.png; tell them apart",
            2,
        ),
        ("render -o {camera}.png", "{camera} in -o needs --camera", 2),
        (
            "render --sun 1,2 -o {moment}.png",
            "{moment} in -o needs --moment",
            2,
        ),
        (
            "render --camera porch,nave -o {camera}.png",
            "no camera \"nave\"",
            2,
        ),
        ("render --size 1x1 --size 2x2", "--size", 2),
        (
            &format!("{sequence} -o a.png"),
            "-o a.png has no place for the number of a frame",
            2,
        ),
        (&format!("{sequence} -o a%d.jpg"), ".png or .exr or .mp4", 2),
        (
            &format!("{sequence} -o a%d.png --when 2026-06-21T10:00"),
            "leave out --when",
            2,
        ),
        (
            &format!("{sequence} -o no/such/a%d.png"),
            "does not exist",
            1,
        ),
        (
            &format!("{sequence} -o a.mp4 --shard 1/2"),
            "a shard draws frames: -o a_%04d.png",
            2,
        ),
        (
            &format!("{sequence} -o a%d.png --shard 3/2"),
            "for instance 1/12",
            2,
        ),
        (
            "sequence --from 2026-06-21T10:00 --to 2026-06-21T09:00 --step 1h -o a%d.png",
            "is before the start",
            2,
        ),
        (
            "sequence --from 2026-06-21T10:00 --to 2026-06-21T12:00 --step 1m -o a%d.png",
            "for instance 10min",
            2,
        ),
        (
            "sequence --place oslo --from 2026-03-29T02:30 --to 2026-06-21T12:00 --step 1d -o a%d.png",
            "--from: 2026-03-29 02:30 is skipped",
            2,
        ),
        (
            &format!("{sequence} -o a%d.png --tile 64"),
            "drawn in one piece, not in tiles",
            2,
        ),
        (
            &format!("{sequence} -o a%d.png --layers"),
            "--layers needs an .exr",
            2,
        ),
        ("study --dates year", "are days", 2),
        ("study --dates 2026-2-29", "month and day", 2),
        ("study --dates 2-29", "2026 has no 2-29", 2),
        ("study --hours 25", "for instance 9", 2),
        ("study --sun 1,2", "leave out --sun", 2),
        ("study --plan --camera porch", "cannot be used with", 2),
        ("study --size 9000x9000", "choose a smaller --size", 2),
        ("merge", "FILE.shard", 2),
        ("merge nothing.shard", "cannot read nothing.shard", 1),
    ] {
        let (error, found) = fail(folder.path(), line);
        assert!(error.contains(part), "{line}: {error}");
        assert_eq!(found, Some(code), "{line}: {error}");
    }
    assert_eq!(contents(folder.path()).len(), 0, "nothing is written");
}
