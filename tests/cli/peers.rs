//! `scripts/peers`, with a stand-in for a peer: the figures of real ones are in `docs/speed.md`. Skipped without `python3`.

use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

/// Draws nothing in five frames, and finds what the script has written for it.
const STAND_IN: &str = r#"
import json, os, sys
if '--version' in sys.argv: print('3.9.stand-in'); sys.exit(0)
os.chdir(sys.argv[sys.argv.index('--path') + 1])
view = json.load(open('view.json'))
assert os.environ['DISPLAY'].startswith(':')
assert 'window/size/width=64' in open('project.godot').read() and 'look_at' in open('main.gd').read()
words = sum(6 * p['vertices'] + p['indices'] for p in view['parts'])
assert os.path.getsize('mesh.bin') == 4 * words, words
print('mark', view['warm_up'], file=sys.stderr)
sum(range(3_000_000))
print('mark', view['warm_up'] + view['frames'], file=sys.stderr)
"#;

/// A wall of a quad and a triangle without normals.
const WALL: &str =
    "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nv 1 3 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\nf -2 -3 -1\n";

/// What the script says with these words; `None` without an interpreter.
fn peers(folder: &Path, words: &[&str]) -> Option<Output> {
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/scripts/peers");
    let mut command = Command::new("python3");
    let output = command
        .current_dir(folder)
        .arg(script)
        .args(["--binary", env!("CARGO_BIN_EXE_skylight")])
        .args(words)
        .output();
    if output.is_err() {
        println!("skipped: there is no python3");
    }
    output.ok()
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// A stand-in for Godot that begins with this line.
fn stand_in(folder: &Path, line: &str) -> String {
    let path = folder.join("godot");
    fs::write(&path, format!("#!/usr/bin/env python3\n{line}{STAND_IN}")).expect("written");
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).expect("runs");
    path.to_str().expect("UTF-8").to_owned()
}

#[test]
fn a_dry_run_names_who_is_here_and_who_is_not() {
    let folder = tempfile::tempdir().expect("a folder");
    let godot = stand_in(folder.path(), "");
    let words = [
        "--dry-run",
        "--godot",
        &godot,
        "--chromium",
        "nowhere/chromium",
        "--python",
        "nowhere/python",
    ];
    let Some(output) = peers(folder.path(), &words) else {
        return;
    };
    let told = text(&output.stdout);
    assert!(output.status.success(), "{told}{}", text(&output.stderr));
    let lines = [
        "colonnade.obj, 1280x720, 3 rounds",
        "skylight: skylight bench --sky preetham --bounces 0 --ambient ssao --aa off",
        "skylight-window: skylight bench --aa taa",
        "godot: Godot 3.9: ",
        "skipped: three: Chromium is not here (apt install chromium",
        "skipped: filament: Open3D is not here (pip install open3d-cpu",
    ];
    assert!(lines.iter().all(|line| told.contains(line)), "{told}");
    let left = fs::read_dir(folder.path()).expect("the folder").count();
    assert_eq!(left, 1, "the stand-in alone");
}

#[test]
fn a_run_tells_ratios_to_skylight_and_who_failed() {
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("wall.obj"), WALL).expect("written");
    let view = [
        "--model",
        "wall.obj",
        "--eye=1,1,5",
        "--target=1,1,0",
        "--sun=180,40",
    ];
    let brief = [
        "--size",
        "64x36",
        "--frames",
        "4",
        "--rounds",
        "2",
        "--peer",
        "godot",
        "--json",
        "report.json",
    ];
    for (line, is_well) in [("", true), ("raise SystemExit('no screen')", false)] {
        let godot = stand_in(folder.path(), line);
        let words = [&view[..], &brief, &["--godot", &godot]].concat();
        let Some(output) = peers(folder.path(), &words) else {
            return;
        };
        let told = format!("{}{}", text(&output.stdout), text(&output.stderr));
        assert_eq!(output.status.success(), is_well, "{told}");
        let report = fs::read_to_string(folder.path().join("report.json")).expect("written");
        let report: Value = serde_json::from_str(&report).expect("JSON");
        assert_eq!(report["triangles"], 3);
        let rows = report["rows"].as_array().expect("rows");
        let names: Vec<_> = rows.iter().map(|row| row["name"].as_str()).collect();
        let own = [Some("skylight"), Some("skylight-window")];
        assert_eq!(names[..2], own, "{told}");
        assert_eq!(names.len(), if is_well { 3 } else { 2 }, "{told}");
        for row in rows {
            assert_eq!(row["runs"].as_array().map(Vec::len), Some(2));
            let number = |value: &serde_json::Value| value.as_f64().expect("a number");
            let ratio = number(&row["cpu_ms"]) / number(&rows[0]["cpu_ms"]);
            let told = number(&row["cpu_by"]["skylight"]);
            // A reader of JSON may round the last bit.
            assert!((told / ratio - 1.0).abs() < 1e-12, "{row}");
        }
        let failed = &report["failed"]["godot"];
        assert_eq!(failed.as_str(), (!is_well).then_some("no screen"));
    }
}

#[test]
fn a_model_that_is_not_there_is_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let Some(output) = peers(
        folder.path(),
        &["--model", "nowhere.obj", "--peer", "godot"],
    ) else {
        return;
    };
    let told = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{told}");
    assert!(
        told.contains("nowhere.obj is not there: give --model"),
        "{told}"
    );
}
