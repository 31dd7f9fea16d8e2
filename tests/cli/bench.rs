//! `skylight bench`, end to end: its table, its files, and its comparison with an earlier run.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::{Value, json};

/// A small model.
const OBJ: &str = "v -2 0 2\nv 2 0 2\nv 2 0 -2\nv -2 0 -2\nv 0 2 0\nf 1 2 3\nf 1 3 4\nf 1 2 5\n";

/// A folder that contains the model.
fn place() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("m.obj"), OBJ).expect("a model");
    folder
}

/// Benchmarks a few frames of a small picture of direct light.
fn bench(folder: &Path, words: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder)
        .args(["bench", "m.obj", "--frames", "2", "--size", "64x36"])
        .args(["--irradiance-samples", "64", "--quiet"])
        .args(["--bounces", "0", "--ambient", "ssao"])
        .args(words.split_whitespace())
        .output()
        .expect("the program starts")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("text")
}

#[track_caller]
fn succeeded(output: &Output) -> String {
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    text(&output.stdout)
}

fn read(folder: &Path, name: &str) -> String {
    fs::read_to_string(folder.join(name)).expect("written")
}

/// Edits the JSON file `name` in place.
fn change(folder: &Path, name: &str, change: impl FnOnce(&mut Value)) {
    let mut value: Value = serde_json::from_str(&read(folder, name)).expect("JSON");
    change(&mut value);
    fs::write(folder.join(name), value.to_string()).expect("written");
}

/// Multiplies the times in a JSON report, of every pass and of whole frames, by `factor`.
fn scale(report: &mut Value, factor: f64) {
    let Value::Object(fields) = report else {
        return;
    };
    for (name, value) in fields {
        match value {
            Value::Number(n) if name.ends_with("_ms") => {
                *value = json!(n.as_f64().expect("a number") * factor);
            }
            Value::Array(list) => list.iter_mut().for_each(|row| scale(row, factor)),
            other => scale(other, factor),
        }
    }
}

#[test]
fn the_report_says_what_was_measured_and_where() {
    let folder = place();
    let output = bench(folder.path(), "--json t.json --motion sun");
    let table = succeeded(&output);
    for part in [
        "median",
        "p5",
        "p95",
        "CPU",
        "GB/s",
        "64x36",
        "3 triangles",
        "recording",
    ] {
        assert!(table.contains(part), "no {part}: {table}");
    }
    assert!(table.contains("the passes sum to"), "{table}");
    let report: Value = serde_json::from_str(&read(folder.path(), "t.json")).expect("JSON");
    for path in [
        "/device/name",
        "/device/driver",
        "/device/vulkan",
        "/commit",
        "/settings/sky",
    ] {
        let found = report.pointer(path).and_then(Value::as_str);
        assert!(found.is_some_and(|s| !s.is_empty()), "{path}: {found:?}");
    }
    assert_eq!(report["triangles"], 3);
    assert_eq!(report["motion"], "sun");
    assert!(
        report
            .pointer("/parts_to_whole/within_15_percent")
            .is_some_and(Value::is_boolean)
    );
    assert!(
        report
            .pointer("/frame/record/median_ms")
            .is_some_and(Value::is_f64)
    );
}

#[test]
fn bytes_come_from_formats_and_sizes_and_counters_from_the_device() {
    let folder = place();
    succeeded(&bench(folder.path(), "--json t.json"));
    let report: Value = serde_json::from_str(&read(folder.path(), "t.json")).expect("JSON");
    let pass = |name: &str| {
        let passes = report["passes"].as_array().expect("a list");
        let found = passes.iter().find(|pass| pass["name"] == name);
        found
            .unwrap_or_else(|| panic!("no {name}: {passes:?}"))
            .clone()
    };
    // One triangle; writes 8-bit colours from one lookup per pixel.
    let tone = pass("tone map");
    assert_eq!(tone["pixels"], 64 * 36);
    assert_eq!(tone["bytes_written_per_pixel"], 4.0);
    assert!(
        tone["bytes_read_per_pixel"]
            .as_f64()
            .is_some_and(|b| (2.0..=16.0).contains(&b))
    );
    // 32-bit depth of 2048² texels; positions and indices of three triangles.
    let shadow = pass("shadow map");
    assert_eq!(shadow["pixels"], 2048 * 2048);
    assert!(
        shadow["bytes_read_per_pixel"]
            .as_f64()
            .is_some_and(|b| b < 1e-3)
    );
    let counted = &shadow["statistics"];
    if counted.is_null() {
        println!("the device has no pipeline statistics");
    } else {
        assert_eq!(counted["vertices"], 9);
        assert!(tone["statistics"]["fragment_invocations"].as_u64() >= Some(64 * 36));
    }
}

#[test]
fn csv_holds_every_pass_and_frame() {
    let folder = place();
    succeeded(&bench(folder.path(), "--json t.json --csv t.csv"));
    let report: Value = serde_json::from_str(&read(folder.path(), "t.json")).expect("JSON");
    let rows = report["passes"].as_array().expect("a list").len() + 2;
    let sheet = read(folder.path(), "t.csv");
    let mut reader = csv::Reader::from_reader(sheet.as_bytes());
    let head = reader.headers().expect("a head").clone();
    let column = |name: &str| head.iter().position(|c| c == name).expect("a column");
    let lines: Vec<csv::StringRecord> = reader.records().map(|r| r.expect("a row")).collect();
    assert_eq!(lines.len(), rows);
    for line in &lines {
        let median: f64 = line[column("median_ms")].parse().expect("a number");
        assert!(median > 0.0, "{line:?}");
        assert_eq!(&line[column("width")], "64");
        assert_eq!(
            &line[column("device")],
            report["device"]["name"].as_str().expect("text")
        );
    }
}

#[test]
fn a_device_without_geometry_shaders_is_enough_and_says_so() {
    let folder = place();
    let run = |words: &str| {
        Command::new(env!("CARGO_BIN_EXE_skylight"))
            .current_dir(folder.path())
            .args(words.split_whitespace())
            .output()
            .expect("the program starts")
    };
    let render = "render m.obj --size 64x36 --irradiance-samples 16 -o a.png";
    let output = run(&format!("{render} --without geometry-shader"));
    succeeded(&output);
    let said = text(&output.stderr);
    assert!(
        said.starts_with("notice: ") && said.contains("compute shaders"),
        "{said}"
    );
    let output = run(&format!("{render} --without geometry-shader --quiet"));
    succeeded(&output);
    assert_eq!(text(&output.stderr), "");
    let told = succeeded(&run("info --without geometry-shader"));
    assert!(told.contains("geometryShader: no"), "{told}");
    assert!(told.contains("nothing that skylight needs"), "{told}");
    succeeded(&bench(folder.path(), "--without geometry-shader"));
}

#[test]
fn start_up_is_told_step_by_step_and_the_cache_is_kept() {
    let folder = place();
    let run = || {
        let output = Command::new(env!("CARGO_BIN_EXE_skylight"))
            .args(["info", "--startup"])
            .env("XDG_CACHE_HOME", folder.path())
            .output()
            .expect("the program starts");
        succeeded(&output)
    };
    let told = run();
    let parts = [
        "instance",
        "device",
        "pipelines",
        "first frame",
        "total",
        "shader modules",
    ];
    for part in parts {
        assert!(told.contains(part), "no {part}: {told}");
    }
    assert!(told.contains("pipeline cache: new"), "{told}");
    let cache = folder.path().join("skylight");
    let files: Vec<_> = fs::read_dir(&cache).expect("a folder").collect();
    assert_eq!(files.len(), 1, "{files:?}");
    assert!(run().contains("pipeline cache: loaded"));
    // A cache folder that cannot be created is not a failure.
    fs::remove_dir_all(&cache).expect("gone");
    fs::write(&cache, "a file").expect("written");
    run();
}

#[test]
fn an_earlier_run_is_a_yardstick() {
    let folder = place();
    succeeded(&bench(folder.path(), "--json old.json"));
    let table = succeeded(&bench(folder.path(), "--compare old.json"));
    for part in ["compared with old.json", "ratio", "noise", "±"] {
        assert!(table.contains(part), "no {part}: {table}");
    }
    assert!(!table.contains("note:"), "the same was measured: {table}");
    // As if everything had been a hundred times faster before; a slowdown alone is not a failure.
    change(folder.path(), "old.json", |report| scale(report, 0.01));
    let table = succeeded(&bench(folder.path(), "--compare old.json"));
    assert!(table.contains("slower"), "{table}");
    let output = bench(folder.path(), "--compare old.json --fail-above 2");
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.contains("slower than 2 times old.json") && said.contains("whole frame"));
    assert_eq!(said.lines().count(), 1, "{said}");
    succeeded(&bench(folder.path(), "--compare old.json --fail-above 1e6"));
}

#[test]
fn what_differs_from_the_earlier_run_is_said() {
    let folder = place();
    succeeded(&bench(folder.path(), "--json old.json --aod 0.2"));
    let table = succeeded(&bench(folder.path(), "--compare old.json --motion none"));
    for part in ["aod was 0.2, is 0.1", "motion was camera, is none"] {
        assert!(table.contains(part), "no {part}: {table}");
    }
}

#[test]
fn a_sweep_shows_how_cost_grows() {
    let folder = place();
    let output = bench(folder.path(), "--sweep shadow --json s.json --csv s.csv");
    let table = succeeded(&output);
    for part in ["exponent", "256²", "4096²", "shadow map", "whole frame"] {
        assert!(table.contains(part), "no {part}: {table}");
    }
    let report: Value = serde_json::from_str(&read(folder.path(), "s.json")).expect("JSON");
    let sizes = report["sizes"].as_array().expect("sizes").len();
    assert_eq!(sizes, 5);
    let rows = report["rows"].as_array().expect("rows");
    for row in rows {
        assert_eq!(row["times"].as_array().map(Vec::len), Some(sizes), "{row}");
        assert!(row["exponent"].is_f64(), "{row}");
    }
    let mut sheet = csv::Reader::from_path(folder.path().join("s.csv")).expect("a file");
    assert_eq!(sheet.records().count(), sizes * rows.len());
}

#[test]
fn bad_yardsticks_are_named() {
    let folder = place();
    fs::write(folder.path().join("bad.json"), "{\"passes\": 3}").expect("written");
    for (words, code, part) in [
        ("--compare none.json", 1, "none.json"),
        ("--compare bad.json", 1, "skylight bench --json"),
        ("--compare .", 1, "cannot read ."),
        ("--fail-above 2", 2, "--compare"),
        ("--compare bad.json --fail-above -1", 2, "--fail-above"),
        ("--sweep everything", 2, "resolution"),
        ("--sweep ssao --compare bad.json", 2, "--compare"),
        ("--csv no/such/a.csv", 1, "no/such"),
    ] {
        let output = bench(folder.path(), words);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(code), "{words}: {said}");
        assert!(said.contains(part), "{words}: {said}");
        assert_eq!(said.lines().count(), 1, "{words}: {said}");
    }
}
