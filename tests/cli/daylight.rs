//! `skylight daylight`: grids, forms of the result, errors.

use std::fs;
use std::process::{Command, Output};

fn run(folder: &std::path::Path, grid: &str, words: &[&str]) -> Output {
    let path = folder.join("grid.csv");
    fs::write(&path, grid).expect("written");
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .args(["daylight", "colonnade", "--grid"])
        .arg(&path)
        .args(["--error", "0.1", "--quiet"])
        .args(words)
        .output()
        .expect("it runs")
}

#[test]
fn sensors_come_back_in_order_with_their_parts() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let grid = "x,y,z\n30,1,40\n30,1,-40,0,-1,0\n";
    let output = run(folder.path(), grid, &["--json", "--seed", "7"]);
    assert!(output.status.success(), "{output:?}");
    let again = run(folder.path(), grid, &["--json", "--seed", "7"]);
    assert_eq!(
        output.stdout, again.stdout,
        "the same seed, the same numbers"
    );
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let sensors = report["sensors"].as_array().expect("a list");
    assert!(report["warnings"].is_array());
    assert_eq!(sensors.len(), 2);
    let number = |i: usize, key: &str| sensors[i][key].as_f64().expect("a number");
    assert_eq!(
        (number(0, "z"), number(1, "z"), number(1, "ny")),
        (40.0, -40.0, -1.0)
    );
    for i in 0..2 {
        let parts = ["sky_direct_lux", "sun_direct_lux", "reflected_lux"];
        let sum: f64 = parts.iter().map(|key| number(i, key)).sum();
        assert!((sum / number(i, "total_lux") - 1.0).abs() < 1e-9);
        assert!(number(i, "standard_error_lux") <= 0.1 * number(i, "total_lux"));
    }
    assert!(number(0, "total_lux") > 2.0 * number(1, "total_lux"));
    assert_eq!(number(1, "sun_direct_lux"), 0.0, "it looks down");
}

#[test]
fn bad_grids_are_named_in_one_line() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for (grid, what) in [("1 2\n", "line 1: 2 numbers"), ("x y z\n", "no sensors")] {
        let output = run(folder.path(), grid, &[]);
        let line = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{line}");
        assert_eq!(line.lines().count(), 1, "{line}");
        assert!(line.contains("grid.csv") && line.contains(what), "{line}");
    }
}

#[test]
fn sensors_are_of_a_file_or_made_and_where_none_fits_one_line_says_so() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let ended = |words: &[&str]| {
        let output = Command::new(env!("CARGO_BIN_EXE_skylight"))
            .current_dir(folder.path())
            .args(["daylight", "colonnade", "--metrics", "vsc"])
            .args(words)
            .output()
            .expect("it runs");
        let line = String::from_utf8_lossy(&output.stderr).into_owned();
        (output.status.code(), line)
    };
    let (code, line) = ended(&[]);
    assert!(code == Some(2) && line.contains("--grid"), "{line}");
    let (code, line) = ended(&["--grid", "g.csv", "--plane", "0.8"]);
    assert!(code == Some(2) && line.contains("--plane"), "{line}");
    let (code, line) = ended(&["--plane", "0.8", "--rooms", "carpet"]);
    assert!(
        code == Some(1) && line.contains("no material \"carpet\""),
        "{line}"
    );
    assert_eq!(line.lines().count(), 1, "{line}");
}
