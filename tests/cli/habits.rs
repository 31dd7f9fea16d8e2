//! Habits of the shell: the user's file of defaults, colours, tables as JSON, the sidecar of a picture.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

/// A folder that is the user's, with this file of defaults.
fn home(config: &str) -> tempfile::TempDir {
    let home = tempfile::tempdir().expect("a scratch folder");
    let folder = home.path().join("skylight");
    fs::create_dir(&folder).expect("a folder");
    fs::write(folder.join("config.toml"), config).expect("written");
    home
}

fn run(home: &Path, words: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(home)
        .env("XDG_CONFIG_HOME", home)
        .env_remove("SKYLIGHT_CONFIG")
        .env_remove("NO_COLOR")
        .args(words.split_whitespace())
        .output()
        .expect("it runs")
}

fn json(output: &Output) -> Value {
    assert!(output.status.success(), "{output:?}");
    serde_json::from_slice(&output.stdout).expect("JSON")
}

fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

#[test]
#[cfg(target_os = "linux")]
fn defaults_of_the_user_are_below_all_else() {
    let home = home("place = \"oslo\"\nwhen = \"2026-03-21T12:00\"\n");
    let place = |words: &str| json(&run(home.path(), words))["inputs"]["place"].clone();
    let oslo = place("sky --json");
    assert_eq!(oslo, place("sky --json --place oslo --config none"));
    assert_eq!(place("sky --json --place 10,20"), "10,20");
    assert_ne!(place("sky --json --config none"), oslo);
    let printed = run(home.path(), "--print-config");
    let printed = String::from_utf8_lossy(&printed.stdout).into_owned();
    assert!(
        printed.contains("config.toml\n") && printed.contains("place = \"oslo\""),
        "{printed}"
    );
    let off = Command::new(env!("CARGO_BIN_EXE_skylight"))
        .env("XDG_CONFIG_HOME", home.path())
        .env("SKYLIGHT_CONFIG", "none")
        .args(["sky", "--json"])
        .output();
    assert_ne!(json(&off.expect("it runs"))["inputs"]["place"], oslo);
}

#[test]
#[cfg(target_os = "linux")]
fn a_bad_file_of_defaults_is_refused_with_its_line() {
    let home = home("# mine\n\nplaec = \"oslo\"\n");
    for words in ["sky", "render -o a.png", "--print-config"] {
        let output = run(home.path(), words);
        assert_eq!(output.status.code(), Some(2), "{words}");
        let said = said(&output);
        assert!(
            said.contains("config.toml: line 3: unknown option \"plaec\"; write \"place\""),
            "{said}"
        );
        assert_eq!(said.lines().count(), 1, "{said}");
    }
    let missing = run(home.path(), "sky --config no-such-file");
    assert_eq!(missing.status.code(), Some(1));
    assert!(
        said(&missing).contains("no-such-file"),
        "{}",
        said(&missing)
    );
}

#[test]
fn messages_are_coloured_where_it_is_asked_for() {
    let home = home("");
    let coloured = |words: &str| said(&run(home.path(), words)).contains('\x1b');
    assert!(!coloured("sky --place nowhere"), "a pipe has no colours");
    assert!(coloured("sky --place nowhere --color always"));
    assert!(coloured("--color=always sky --place nowhere"));
    assert!(!coloured("sky --place nowhere --color never"));
    let wrong = run(home.path(), "sky --color sometimes");
    assert_eq!(wrong.status.code(), Some(2));
}

#[test]
fn a_sidecar_tells_how_a_picture_was_made() {
    let home = home("samples = 2\n");
    let words = "render --size 32x18 --sidecar --place oslo --when 2026-06-21T12:00+02:00";
    for name in ["a.png", "b.png"] {
        let output = run(home.path(), &format!("{words} -o {name}"));
        assert!(output.status.success(), "{}", said(&output));
    }
    let read = |name: &str| fs::read_to_string(home.path().join(name)).expect(name);
    let text = read("a.png.json");
    assert_eq!(text, read("b.png.json").replace("b.png", "a.png"));
    let sidecar: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(sidecar["options"]["size"], "32x18");
    assert_eq!(sidecar["size"], serde_json::json!([32, 18]));
    assert_eq!(sidecar["place"]["when"], "2026-06-21T12:00:00+02:00");
    assert!(
        sidecar["ev100"]
            .as_f64()
            .is_some_and(|ev| (8.0..18.0).contains(&ev)),
        "{text}"
    );
    assert!(sidecar["device"]["name"].is_string() && sidecar["version"].is_string());
    if cfg!(target_os = "linux") {
        // The command is complete without the user's defaults.
        let command = sidecar["command"].as_str().unwrap_or_default();
        assert!(
            command.contains("--samples 2") && command.contains("--config none"),
            "{command}"
        );
        assert_eq!(sidecar["samples"], 2);
    }
    let stream = run(home.path(), &format!("{words} -o -"));
    assert_eq!(stream.status.code(), Some(2));
    assert!(
        said(&stream).contains("name a file with -o"),
        "{}",
        said(&stream)
    );
    let compared = json(&run(home.path(), "compare a.png b.png --json"));
    assert_eq!(
        (&compared["flip"], &compared["pixels"]),
        (&0.0.into(), &(32 * 18).into())
    );
}
