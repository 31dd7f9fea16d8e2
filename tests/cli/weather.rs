//! `skylight weather`: JSON, table, warnings, damage.

use std::path::Path;
use std::process::{Command, Output};

/// Two days of an EPW file; in the second the sun shines at midnight.
fn two_days() -> String {
    let mut text =
        "LOCATION,Havnby,-,DNK,made,0,55.1,8.6,1.0,4.0\nDATA PERIODS,1,1,Data,Sunday, 6/20, 6/21\n"
            .to_owned();
    for hour in 0..48 {
        let (day, hour) = (20 + hour / 24, hour % 24 + 1);
        let diffuse = if (5..21).contains(&hour) { 100 } else { 0 };
        let direct = if hour == 12 { 800 } else { 0 };
        text += &format!(
            "2001,6,{day},{hour},0,?,15,9,70,101300,0,0,300,9999,{direct},{diffuse},0,0,0,0,0,0,0,0,20\n"
        );
    }
    text
}

fn weather(folder: &Path, words: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder)
        .arg("weather")
        .args(words)
        .output()
        .expect("it runs")
}

#[test]
fn a_file_is_summed_and_what_is_odd_is_told() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    std::fs::write(folder.path().join("a.epw"), two_days()).expect("written");
    let output = weather(folder.path(), &["a.epw", "--json"]);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{told}");
    assert_eq!(told.lines().count(), 1, "{told}");
    assert!(told.contains("48 hours, not those of a year"), "{told}");
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(report["place"]["latitude"], 55.1);
    assert_eq!(report["zone_hours"], 1.0);
    assert_eq!(report["months"][5]["direct_normal_kwh"], 1.6);
    assert_eq!(report["year"]["sunshine_hours"], 2.0);
    // Without the global irradiance the clock cannot be checked.
    assert!(report["clock_minutes"].is_null());
    let output = weather(folder.path(), &["a.epw", "--no-warnings"]);
    let table = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.stderr.is_empty());
    assert!(
        table.contains("Havnby") && table.contains("not checked"),
        "{table}"
    );
    let strict = weather(folder.path(), &["a.epw", "--strict"]);
    assert_eq!(strict.status.code(), Some(1));
}

#[test]
fn an_hour_of_a_file_is_its_place_its_sun_and_its_sky() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    std::fs::write(folder.path().join("a.epw"), two_days()).expect("written");
    let sky = |words: &str| {
        Command::new(env!("CARGO_BIN_EXE_skylight"))
            .current_dir(folder.path())
            .arg("sky")
            .args(words.split(' '))
            .args(["--json", "--no-warnings"])
            .output()
            .expect("it runs")
    };
    let of_file = sky("--weather a.epw --hour 6-20T11:59");
    assert!(of_file.status.success(), "{of_file:?}");
    let given = "--place 55.1,8.6 --when 2019-06-20T11:30:00+01:00 --sky perez --dni 800 --dhi 100 --dew-point 9";
    let by_hand = sky(given);
    assert!(by_hand.status.success(), "{by_hand:?}");
    assert_eq!(of_file.stdout, by_hand.stdout);
    for (words, what) in [
        (
            "--weather a.epw --hour 7-1T11",
            "a.epw has no hour 7-1T11:00",
        ),
        ("--weather a.epw --hour noon", "3-21T12"),
        ("--weather a.epw", "--hour"),
        ("--hour 6-20T11", "--weather"),
        ("--weather a.epw --hour 6-20T11 --dni 3", "leave out --dni"),
    ] {
        let output = sky(words);
        let line = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{words}: {line}");
        assert_eq!(line.lines().count(), 1, "{line}");
        assert!(line.contains(what), "{line} for {what}");
    }
}

#[test]
fn files_that_cannot_be_used_are_one_line() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let damaged = two_days().replace(",800,", ",bright,");
    std::fs::write(folder.path().join("b.epw"), damaged).expect("written");
    for (words, what) in [
        (["b.epw"], "line 14: the direct irradiance is \"bright\""),
        (
            ["c.epw"],
            "no such file; chicago is bundled, climate.onebuilding.org",
        ),
    ] {
        let output = weather(folder.path(), &words);
        let line = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(1), "{line}");
        assert_eq!(line.lines().count(), 1, "{line}");
        assert!(line.contains(words[0]) && line.contains(what), "{line}");
    }
}

#[test]
fn bundled_weather_has_a_name_which_a_file_may_take() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let name = || {
        let output = weather(folder.path(), &["chicago", "--json", "--no-warnings"]);
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        report["place"]["name"].as_str().map(str::to_owned)
    };
    assert_eq!(name().as_deref(), Some("Chicago OHare Intl AP, IL, USA"));
    let file = |text: &str| std::fs::write(folder.path().join(text), two_days()).expect("written");
    file("chicago");
    assert!(name().is_some_and(|name| !name.contains("Chicago")));
}

/// Measures open ground with `skylight daylight` in a folder.
fn measured(folder: &Path, words: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder)
        .arg("daylight")
        .args(words.split(' '))
        .args(["--grid", "g.csv", "--json", "--no-warnings"])
        .output()
        .expect("it runs")
}

#[test]
fn a_scene_file_may_name_an_hour_of_a_file_beside_it() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let write = |name: &str, text: &str| {
        std::fs::write(folder.path().join(name), text).expect("written");
    };
    let sensors = |output: &Output| {
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
        report["sensors"].clone()
    };
    std::fs::create_dir(folder.path().join("scenes")).expect("a folder");
    write("scenes/a.epw", &two_days());
    write("scenes/m.obj", "v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 3 2\n");
    write("g.csv", "5 1 5\n");
    let scene = |name: &str, sky: &str, rest: &str| {
        let mesh = "[[mesh]]\nfile = \"m.obj\"\n";
        write(name, &format!("{mesh}[sky]\n{sky}\n{rest}"));
    };
    let moment = "[[moment]]\nname = \"late\"\nhour = \"6-20T18\"\n";
    scene(
        "scenes/s.toml",
        "weather = \"a.epw\"\nhour = \"6-20T11\"\nground-albedo = 0.3",
        moment,
    );
    let by_hand = |hour: &str| {
        let words =
            format!("scenes/m.obj --ground-albedo 0.3 --weather scenes/a.epw --hour {hour}");
        sensors(&measured(folder.path(), &words))
    };
    for (words, hour) in [
        ("scenes/s.toml", "6-20T11"),
        ("scenes/s.toml --moment late", "6-20T18"),
        ("scenes/s.toml --hour 6-20T9", "6-20T9"),
    ] {
        let output = measured(folder.path(), words);
        assert!(output.status.success(), "{words}: {output:?}");
        assert_eq!(sensors(&output), by_hand(hour), "{words}");
    }
    assert_ne!(by_hand("6-20T11"), by_hand("6-20T18"));
    scene(
        "scenes/c.toml",
        "weather = \"chicago\"\nhour = \"6-20T11\"",
        "",
    );
    let (bundled, same) = (
        "scenes/c.toml",
        "scenes/m.obj --weather chicago --hour 6-20T11",
    );
    let [bundled, same] = [bundled, same].map(|words| sensors(&measured(folder.path(), words)));
    assert_eq!(bundled, same);
    for (sky, rest, what) in [
        ("weather = \"a.epw\"", "", "no hour; add hour = \"3-21T12\""),
        ("hour = \"6-20T11\"", "", "add weather = \"FILE.epw\""),
        (
            "weather = \"a.epw\"\nhour = \"6-20T11\"\ndni = 3",
            "",
            "leave out dni",
        ),
        ("weather = \"b.epw\"\nhour = \"6-20T11\"", "", "b.epw"),
        (
            "weather = \"a.epw\"\nhour = \"7-1T11\"",
            "",
            "no hour 7-1T11:00",
        ),
        (
            "weather = \"a.epw\"\nhour = \"noon\"",
            "",
            "hour: write month",
        ),
        ("wether = \"a.epw\"", "", "weather, hour"),
    ] {
        scene("scenes/t.toml", sky, rest);
        let output = measured(folder.path(), "scenes/t.toml");
        let line = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!output.status.success(), "{sky}");
        assert_eq!(line.lines().count(), 1, "{line}");
        assert!(line.contains(what), "{line} for {what}");
    }
}
