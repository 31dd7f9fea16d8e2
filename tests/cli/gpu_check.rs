//! `scripts/gpu-check`, on the device that is here, at a small size. Skipped without `python3`.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

/// What the script says with these words; `None` without an interpreter.
fn check(folder: &Path, words: &[&str]) -> Option<Output> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/gpu-check");
    let mut command = Command::new("python3");
    command.current_dir(folder).arg(script).args(words);
    if let Ok(device) = std::env::var("SKYLIGHT_TEST_DEVICE") {
        command.args(["--device", &device]);
    }
    let output = command.output();
    if output.is_err() {
        println!("skipped: there is no python3");
    }
    output.ok()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_dry_run_lists_the_measurements_and_does_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some(output) = check(folder.path(), &["--dry-run", "--binary", "skylight"]) else {
        return;
    };
    assert!(output.status.success(), "{}", text(&output.stderr));
    let told = text(&output.stdout);
    for scene in ["colonnade", "island", "hills", "town", "room"] {
        for size in ["1280x720", "1920x1080", "3840x2160"] {
            for route in ["fragment", "compute"] {
                let row = format!("bench: frame: {scene} {size} --route {route}");
                assert!(told.contains(&row), "{row}: {told}");
            }
        }
    }
    let more = [
        "bench: cells: island",
        "bench: dome: ",
        "bench: irradiance exact: colonnade 1280x720 --route compute",
        "bench: sky hosek: ",
        "tests: none carried",
    ];
    assert!(more.iter().all(|part| told.contains(part)), "{told}");
    let left = fs::read_dir(folder.path()).expect("the folder").count();
    assert_eq!(left, 0);
}

#[test]
fn a_brief_run_writes_a_complete_report_and_compares_with_the_one_before() {
    let folder = tempfile::tempdir().expect("a folder");
    let words = [
        "--binary",
        env!("CARGO_BIN_EXE_skylight"),
        "--brief",
        "--scene",
        "room",
    ];
    let sizes = ["--size", "64x36", "--frames", "2", "--store", "runs"];
    let words = [&words[..], &sizes].concat();
    for is_second in [false, true] {
        let Some(output) = check(folder.path(), &words) else {
            return;
        };
        assert!(
            output.status.success(),
            "{}{}",
            text(&output.stdout),
            text(&output.stderr)
        );
        let report = fs::read_to_string(folder.path().join("gpu-check.json")).expect("written");
        let report: Value = serde_json::from_str(&report).expect("JSON");
        assert!(
            report["devices"][0]["memory"][0]["bytes"].as_u64() > Some(0),
            "{report}"
        );
        for check in report["checks"].as_array().expect("checks") {
            assert_eq!(check["ok"], true, "{check}");
        }
        assert_eq!(report["checks"][0]["what"], "room, single: both routes");
        let bench = report["bench"].as_array().expect("rows");
        assert_eq!(bench.len(), 2);
        for (row, route) in bench.iter().zip(["fragment", "compute"]) {
            assert_eq!(row["route"], route);
            assert_eq!(row["report"]["settings"]["route"], route, "{row}");
            assert!(
                row["report"]["frame"]["median_ms"].as_f64() > Some(0.0),
                "{row}"
            );
        }
        let lighting = &report["routes"][0]["fragment_by_compute"]["lighting"];
        assert!(lighting.as_f64() > Some(0.0), "{report}");
        assert_eq!(
            report["left_out"].as_array().map(Vec::len),
            Some(1),
            "the tests alone"
        );
        let before = &report["before"]["rows"];
        assert_eq!(
            before.as_array().map_or(0, Vec::len),
            if is_second { 2 } else { 0 }
        );
    }
}

#[test]
fn a_program_that_is_not_there_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some(output) = check(folder.path(), &["--binary", "nowhere/skylight"]) else {
        return;
    };
    let told = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(told.contains("nowhere/skylight is not there"), "{told}");
}
