//! `skylight daylight --facade`: sensors before outer walls.

use std::path::Path;
use std::process::{Command, Output};

/// A house of 8 x 6 x 5 m, faces outward, with a pane before its southern wall.
const HOUSE: &str = "mtllib house.mtl\nv 0 0 0\nv 8 0 0\nv 8 5 0\nv 0 5 0\nv 0 0 -6\nv 8 0 -6\nv 8 5 -6\nv 0 5 -6\n\
v 2 1 0.1\nv 6 1 0.1\nv 6 4 0.1\nv 2 4 0.1\n\
usemtl brick\nf 1 2 3 4\nf 6 5 8 7\nf 5 1 4 8\nf 2 6 7 3\nusemtl roof\nf 4 3 7 8\nusemtl sill\nf 9 10 11 12\n";

fn daylight(folder: &Path, words: &str) -> Output {
    std::fs::write(folder.join("house.obj"), HOUSE).expect("written");
    let material = |name| format!("newmtl {name}\nKd 0.4 0.4 0.4\n");
    let materials: String = ["brick", "roof", "sill"].map(material).concat();
    std::fs::write(folder.join("house.mtl"), materials).expect("written");
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder)
        .args(["daylight", "house.obj", "--quiet", "--no-warnings"])
        .args(words.split_whitespace())
        .output()
        .expect("it runs")
}

/// Positions, normals, values of a run.
fn sensors(folder: &Path, words: &str) -> Vec<[f64; 7]> {
    let output = daylight(folder, &format!("--metrics vsc --json {words}"));
    assert!(output.status.success(), "{output:?}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let sensor = |s: &serde_json::Value| {
        ["x", "y", "z", "nx", "ny", "nz", "vsc"].map(|key| s[key].as_f64().expect(key))
    };
    report["sensors"]
        .as_array()
        .expect("a list")
        .iter()
        .map(sensor)
        .collect()
}

#[test]
fn free_walls_have_the_vertical_sky_component_of_the_closed_form() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let found = sensors(
        folder.path(),
        "--facade --spacing 2 --offset 0.02 --plan a.svg",
    );
    let of = |nx: f64, nz: f64| {
        let facing = found.iter().filter(|s| (s[3], s[5]) == (nx, nz));
        facing.copied().collect::<Vec<_>>()
    };
    // Walls of 8 x 5 and 6 x 5 m; the pane-like sheet hides the middle of the southern one.
    assert_eq!(
        [of(0.0, -1.0).len(), of(1.0, 0.0).len(), of(-1.0, 0.0).len()],
        [12, 9, 9]
    );
    for sensor in of(0.0, -1.0) {
        assert!((sensor[2] + 6.02).abs() < 1e-6, "{sensor:?}");
        // Overcast sky of the CIE on a free façade: 3/14 + 4/(7π).
        assert!((sensor[6] - 39.6177).abs() < 0.05, "{sensor:?}");
    }
    let svg = std::fs::read_to_string(folder.path().join("a.svg")).expect("a plan");
    let xml = roxmltree::Document::parse(&svg).expect("XML");
    let words: Vec<&str> = xml.descendants().filter_map(|n| n.text()).collect();
    assert!(
        words.iter().any(|w| w.starts_with("facing 0° from north")),
        "{words:?}"
    );
    assert!(words.iter().any(|w| w.starts_with("facing 90° from north")));
    assert!(!words.contains(&"N"), "an elevation has no north");
}

#[test]
fn named_facades_are_those_of_the_material() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let found = sensors(folder.path(), "--facade=sill --spacing 1");
    assert_eq!(found.len(), 12);
    assert!(
        found
            .iter()
            .all(|s| (s[2] - 0.15).abs() < 1e-6 && s[5] == 1.0)
    );
    for (words, what, code) in [
        ("--metrics vsc --facade=stone", "brick", 1),
        ("--metrics vsc --facade=roof", "no upright surface", 1),
        ("--metrics vsc --facade --plane 1", "--plane", 2),
        ("--metrics vsc --plane 1 --offset 1", "--offset", 2),
        ("--metrics vsc --facade --inset 1", "--inset", 2),
        (
            "--metrics vsc --facade --offset 0",
            "distance from a façade",
            2,
        ),
    ] {
        let output = daylight(folder.path(), words);
        let line = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{words}: {line}");
        assert_eq!(line.lines().count(), 1, "{line}");
        assert!(line.contains(what), "{line} for {what}");
    }
}
