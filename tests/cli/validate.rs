//! `skylight validate`: its table, its JSON, its exit code, and the table of the README.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;
use std::thread;

use serde_json::Value;

use crate::pretended::Layer;

/// The README's table begins behind this line.
const BEGIN: &str = "<!-- skylight validate, on Mesa 22.3.6's lavapipe -->\n\n```text\n";

/// Errors of other drivers may be this much larger or smaller than those of the README.
const OTHER_DRIVERS: f64 = 4.0;

/// A line of the table: name, count, reference, error, tolerance.
#[derive(Debug)]
struct Line {
    name: String,
    compared: u64,
    against: String,
    error: f64,
    tolerance: f64,
}

/// Reads a line by the places of its columns, see `skylight validate`.
fn line(text: &str) -> Line {
    let at = |from: usize, count: usize| -> String {
        let part: String = text.chars().skip(from).take(count).collect();
        part.trim().to_owned()
    };
    let number = |from, count| {
        let part = at(from, count);
        part.parse()
            .unwrap_or_else(|e| panic!("{part} in {text}: {e}"))
    };
    Line {
        name: at(0, 35),
        compared: number(36, 8) as u64,
        against: at(72, 19),
        error: number(92, 9),
        tolerance: number(102, 9),
    }
}

fn lines(table: &str) -> Vec<Line> {
    let rows = table.lines().skip_while(|row| !row.starts_with("check "));
    let rows = rows.skip(1).take_while(|row| !row.trim().is_empty());
    rows.map(line).collect()
}

/// One run of the program serves all: it takes a while.
#[test]
fn the_device_passes_and_the_readme_has_its_table() {
    let output = Command::new(env!("CARGO_BIN_EXE_skylight"))
        .args(["validate", "--json"])
        .output()
        .expect("the program starts");
    let told = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && told.is_empty(), "{told}");
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(found["passed"], true);
    for key in ["device", "driver", "kind", "vulkan", "skylight"] {
        assert!(found[key].as_str().is_some_and(|s| !s.is_empty()), "{key}");
    }
    let checks = found["checks"].as_array().expect("a list");
    assert!(checks.len() >= 19, "{}", checks.len());

    let readme = Path::new(env!("CARGO_MANIFEST_DIR")).join("README.md");
    let readme = std::fs::read_to_string(readme).expect("a text");
    let table = readme.split(BEGIN).nth(1).expect("the table is there");
    let rows = lines(table.split("```").next().expect("a block"));
    let mut faults = String::new();
    assert_eq!(
        rows.len(),
        checks.len(),
        "skylight validate has other checks: {rows:?}"
    );
    for (row, check) in rows.iter().zip(checks) {
        let [error, tolerance] =
            ["error", "tolerance"].map(|key| check[key].as_f64().expect("a number"));
        // A float's step of 1 is no error of a driver.
        let ratio = (error + 2e-7) / (row.error + 2e-7);
        let is_same = row.name == check["check"]
            && row.against == check["against"]
            && Some(row.compared) == check["compared"].as_u64()
            && (row.tolerance - tolerance).abs() <= 0.06 * tolerance
            && (OTHER_DRIVERS.recip()..OTHER_DRIVERS).contains(&ratio);
        if !is_same {
            let _ = writeln!(faults, "{row:?}\n    {check}");
        }
    }
    assert!(
        faults.is_empty(),
        "the README's table is of another program:\n{faults}"
    );
}

/// Faults of drivers, by the words of the layer, and a check that sees each.
const FAULTS: [(&str, &str); 4] = [
    ("nearest", "random numbers"),
    ("short", "atmosphere, table of the air"),
    ("deep", "depth of square and plane"),
    ("plain", "cells, a box that glows"),
];

/// The program on the device with a fault: its exit code, and the checks that fail.
fn failed(layer: &Layer, fault: &str) -> (Option<i32>, Vec<String>, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_skylight"))
        .envs(layer.variables(fault))
        .args(["validate", "--json"])
        .output()
        .expect("the program starts");
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let checks = found["checks"].as_array().expect("a list").iter();
    let failed = checks.filter(|check| check["passed"] == false);
    let names = failed.map(|check| check["check"].as_str().expect("a name").to_owned());
    (output.status.code(), names.collect(), told)
}

#[test]
fn faults_of_drivers_are_seen_and_told() {
    let Some(layer) = Layer::get() else { return };
    thread::scope(|scope| {
        for (fault, check) in FAULTS {
            scope.spawn(move || {
                let (code, names, told) = failed(layer, fault);
                println!("{fault}: {names:?}");
                assert_eq!(code, Some(1), "{fault}: {told}");
                assert!(names.iter().any(|name| name == check), "{fault}: {names:?}");
                assert!(told.contains(check), "{fault}: {told}");
            });
        }
    });
}
