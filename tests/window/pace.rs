//! Frames go on while options change: other threads make the passes and the daylight.

use std::fs;
use std::path::Path;

use crate::running::{DIRECT, Running, shared_machine};

/// The table that `SKYLIGHT_PACE` writes: its rows, cell by cell, and its last line.
fn measured(words: &[&str], options: &str) -> (Vec<Vec<String>>, String) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let file = folder.path().join("pace.tsv");
    let variables = [
        ("SKYLIGHT_PACE", &*file),
        ("SKYLIGHT_PACE_OF", Path::new(options)),
    ];
    let running = Running::with(words, &variables);
    let output = running.ended();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success() && said.is_empty(), "{said}");
    let text = fs::read_to_string(&file).expect("a table");
    println!("{text}");
    let cells = |line: &str| line.split('\t').map(str::to_owned).collect();
    let mut rows: Vec<Vec<String>> = text.lines().skip(1).map(cells).collect();
    let last = rows.pop().expect("a summary");
    (rows, last.concat())
}

#[test]
fn whatever_option_changes_frames_go_on_until_it_shows() {
    let _machine = shared_machine();
    let words = ["--size", "64x36", "--validate", "--sky", "atmosphere"];
    let words = [&words[..], &DIRECT].concat();
    let (rows, summary) = measured(&words, "aa,ground-albedo,shadow-size,size");
    // There and back, each value.
    assert_eq!(rows.len(), 10);
    for pair in rows.chunks(2) {
        let option = pair[0][0].split('=').next().expect("a name");
        assert_eq!(pair[1][0], format!("{option} back"));
    }
    assert!(
        rows.iter().all(|row| !row[0].contains(": ")),
        "an option is refused"
    );
    // Passes that are made take the place of the old ones with a later frame than the one that asks for them, however quick they are.
    let made = ["aa", "shadow-size", "size"];
    for row in &rows {
        let frames: u32 = row[2].parse().expect("a number");
        let is_made = made.iter().any(|name| row[0].starts_with(name));
        assert!(frames >= if is_made { 2 } else { 1 }, "{row:?}");
    }
    assert!(summary.starts_with("worst: "), "{summary}");
}
