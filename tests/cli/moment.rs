//! Places and moments in the forms that people write, end to end.

use std::process::{Command, Output};

use serde_json::Value;

fn run(words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .args(words)
        .output()
        .expect("it starts")
}

/// The moment and the sun's elevation (degrees) reported by `skylight sky`.
fn sky(words: &[&str]) -> (String, f64) {
    let output = run(&[&["sky", "--json"], words].concat());
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{words:?}: {errors}");
    let found: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let when = found["inputs"]["when"].as_str().expect("a moment");
    let elevation = found["sun"]["elevation_deg"].as_f64();
    (when.to_owned(), elevation.expect("an elevation"))
}

/// The single line on stderr of a run that fails.
fn error(words: &[&str]) -> String {
    let output = run(&[&["sky"], words].concat());
    let text = String::from_utf8(output.stderr).expect("UTF-8");
    assert!(!output.status.success(), "{words:?}");
    assert_eq!(text.lines().count(), 1, "{words:?}: {text}");
    assert!(
        !text.contains(".cargo") && !text.contains("panicked"),
        "{text}"
    );
    text
}

#[test]
fn a_place_has_an_afternoon_of_its_own() {
    for (place, expected, low, high) in [
        ("tokyo", "2026-06-21T15:00:00+09:00", 45.0, 50.0),
        ("35.68,139.69", "2026-06-21T15:00:00+09:00", 45.0, 50.0),
        (
            "33.87° S, 151.21° E",
            "2026-06-21T15:00:00+10:00",
            15.0,
            20.0,
        ),
        (
            "-33.87° N, 151.21° E",
            "2026-06-21T15:00:00+10:00",
            15.0,
            20.0,
        ),
        ("New York", "2026-06-21T15:00:00-04:00", 55.0, 60.0),
        // Far from any city: the offset is the whole hour of the longitude.
        ("0,-160", "2026-06-21T15:00:00-11:00", 30.0, 40.0),
    ] {
        let (when, elevation) = sky(&["--place", place]);
        assert_eq!(when, expected, "{place}");
        assert!((low..high).contains(&elevation), "{place}: {elevation}");
    }
    assert_eq!(sky(&[]).0, "2026-06-21T15:00:00+02:00");
}

#[test]
fn local_times_need_no_offset() {
    for (place, when, expected) in [
        ("tokyo", "2026-12-21T15:00", "2026-12-21T15:00:00+09:00"),
        ("tokyo", "2026-12-21 15:00", "2026-12-21T15:00:00+09:00"),
        (
            "oslo",
            "2026-12-21 15:00 Asia/Tokyo",
            "2026-12-21T15:00:00+09:00",
        ),
        ("oslo", "2026-06-21 15:00", "2026-06-21T15:00:00+02:00"),
        ("oslo", "2026-06-21 15:00 +02", "2026-06-21T15:00:00+02:00"),
        ("oslo", "2026-06-21t15:00+0200", "2026-06-21T15:00:00+02:00"),
        ("oslo", "2016-12-31T23:59:60z", "2016-12-31T23:59:60+00:00"),
        ("oslo", "3000-12-31T12:00Z", "3000-12-31T12:00:00+00:00"),
        ("oslo", "-0500-01-01T12:00Z", "-0500-01-01T12:00:00+00:00"),
    ] {
        let (found, elevation) = sky(&["--place", place, "--when", when]);
        assert_eq!(found, expected, "{place} {when}");
        let again = sky(&["--place", place, "--when", &found]);
        assert_eq!(again, (found, elevation), "{when}");
    }
}

#[test]
fn what_cannot_be_meant_is_told_with_the_remedy() {
    for (words, part) in [
        (
            ["--place=oslo", "--when=2026-10-25 02:30"],
            "write 2026-10-25T02:30+02:00 or 2026-10-25T02:30+01:00",
        ),
        (
            ["--place=oslo", "--when=2026-03-29T02:30"],
            "write 2026-03-29T03:30+02:00 or 2026-03-29T01:30+01:00",
        ),
        (
            ["--place=tokio", "--when=2026-03-29T02:30"],
            "did you mean \"Tokyo\"?",
        ),
        (
            ["--place=-33.87 S,151.21 E", "--when=2026-03-29T02:30"],
            "write 33.87 S or -33.87",
        ),
        (
            ["--place=oslo", "--when=3001-01-01T12:00Z"],
            "the years -500 to 3000",
        ),
        (
            ["--sun-position=lecture", "--when=+262142-12-31T23:59Z"],
            "the years -500 to 3000",
        ),
        (
            ["--place=oslo", "--when=2026-03-29 12:00 Tokyo"],
            "did you mean Asia/Tokyo?",
        ),
    ] {
        let text = error(&words);
        assert!(text.contains(part), "{words:?}: {text}");
    }
}

#[test]
fn a_scene_file_has_local_times_too() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(
        folder.path().join("m.obj"),
        "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    )
    .expect("written");
    let scene = folder.path().join("s.toml");
    let text = "[[mesh]]\nfile = \"m.obj\"\n[place]\nplace = \"Tokyo\"\n\
                [[moment]]\nname = \"winter\"\nwhen = 2026-12-21T15:00:00\n\
                [[moment]]\nname = \"twice\"\nplace = \"Oslo\"\nwhen = \"2026-10-25 02:30\"\n";
    std::fs::write(&scene, text).expect("written");
    let picture = folder.path().join("p.png");
    let [scene, picture] = [&scene, &picture].map(|path| path.to_str().expect("UTF-8"));
    let render = |words: &[&str]| {
        let size = ["render", scene, "-o", picture, "--size", "16x9"];
        let quick = ["--bounces", "0", "--ambient", "ssao"];
        run(&[&size[..], &quick, words].concat())
    };
    let metadata = |words: &[&str]| {
        let output = render(words);
        assert!(
            output.status.success(),
            "{}",
            String::from_utf8_lossy(&output.stderr)
        );
        String::from_utf8_lossy(&std::fs::read(picture).expect("a picture")).into_owned()
    };
    assert!(metadata(&[]).contains("2026-06-21T15:00:00+09:00"));
    assert!(metadata(&["--moment", "winter"]).contains("2026-12-21T15:00:00+09:00"));
    let sydney = metadata(&["--moment", "winter", "--place", "sydney"]);
    assert!(sydney.contains("2026-12-21T15:00:00+11:00"));
    let output = render(&["--moment", "twice"]);
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(text.contains("2026-10-25T02:30+02:00"), "{text}");
}
