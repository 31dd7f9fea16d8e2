//! `skylight daylight` with metrics: keys of the result, defaults, wrong usage.

use std::path::Path;
use std::process::{Command, Output};

/// Two days of an EPW file in June.
pub fn two_days() -> String {
    let mut text =
        "LOCATION,Havnby,-,DNK,made,0,55.1,8.6,1.0,4.0\nDATA PERIODS,1,1,Data,Sunday, 6/20, 6/21\n"
            .to_owned();
    for at in 0..48 {
        let (day, hour) = (20 + at / 24, at % 24);
        let diffuse = if (5..21).contains(&hour) { 150 } else { 0 };
        let direct = if hour % 2 == 0 { 500 } else { 0 };
        text += &format!(
            "2001,6,{day},{},0,?,15,9,70,101300,0,0,300,9999,{direct},{diffuse},0,0,0,0,0,0,0,0,20\n",
            hour + 1
        );
    }
    text
}

fn daylight(folder: &Path, words: &str) -> Output {
    std::fs::write(folder.join("a.csv"), "30,1,40\n-30,1,40\n").expect("written");
    daylight_at(folder, "a.csv", words)
}

/// A run in a folder that has the two days as `a.epw`, with a grid of the folder.
pub fn daylight_at(folder: &Path, grid: &str, words: &str) -> Output {
    std::fs::write(folder.join("a.epw"), two_days()).expect("written");
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder)
        .args(["daylight", "colonnade", "--grid", grid, "--quiet"])
        .args(words.split_whitespace())
        .output()
        .expect("it runs")
}

#[test]
fn a_year_has_the_keys_of_its_metrics() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let words = "--weather a.epw --json --error 0.2 --max-paths 1024 --no-warnings";
    let output = daylight(folder.path(), words);
    assert!(output.status.success(), "{output:?}");
    let again = daylight(folder.path(), words);
    assert_eq!(output.stdout, again.stdout);
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let sensor = &report["sensors"][0];
    for key in [
        "x",
        "ny",
        "da300",
        "cda300",
        "udi_low",
        "udi_sup",
        "udi_aut",
        "udi_high",
        "ase_hours",
    ] {
        assert!(sensor[key].is_number(), "{key} in {sensor}");
    }
    for key in ["da300_se", "cda300_se", "udi_aut_se", "ase_hours_se"] {
        assert!(sensor[key].is_number(), "{key} in {sensor}");
    }
    assert!(sensor["df"].is_null());
    // In the open every hour from 8 to 18 has 300 lux, and ten of the twenty direct sun.
    assert_eq!(
        (&sensor["da300"], &sensor["ase_hours"]),
        (&100.0.into(), &10.0.into())
    );
    assert_eq!(report["sda"]["percent"], 100.0);
    assert_eq!(report["ase"], 0.0);
    assert_eq!(report["blinds"], "none");
    assert_eq!(report["occupied_hours"], 20.0);
    assert_eq!(report["weather"]["place"], "Havnby, DNK");
    assert!(report["weather"]["clock_minutes"].is_null());
    assert!(report["en17037"].is_null());
}

#[test]
fn metrics_schedule_and_thresholds_are_options() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let words = "--weather a.epw --metrics da,en17037,illuminance --schedule 0-8 --thresholds 200,500 --csv --error 0.2 --max-paths 1024 --no-warnings --ill a.ill";
    let output = daylight(folder.path(), words);
    assert!(output.status.success(), "{output:?}");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let head = text.lines().next().expect("a header");
    assert_eq!(
        head,
        "x,y,z,nx,ny,nz,da200,da200_se,da500,da500_se,en17037_hours_ge100,en17037_hours_ge100_se,en17037_hours_ge300,en17037_hours_ge300_se,en17037_hours_ge500,en17037_hours_ge500_se,en17037_hours_ge750,en17037_hours_ge750_se,mean_lux,mean_lux_se,df,df_se"
    );
    let open = text.lines().nth(1).expect("a sensor");
    // Three of eight hours are light.
    assert_eq!(open.split(',').nth(6), Some("37.5"));
    let ill = std::fs::read_to_string(folder.path().join("a.ill")).expect("a matrix");
    assert_eq!(ill.lines().count(), 48);
    assert_eq!(ill.lines().next(), Some("6 20 0.5 0 0"));
    let table = daylight(
        folder.path(),
        "--metrics df,vsc --error 0.2 --max-paths 1024",
    );
    let table = String::from_utf8_lossy(&table.stdout).into_owned();
    assert!(table.contains("vsc") && table.contains("df"), "{table}");
}

#[test]
fn what_cannot_be_measured_is_one_line() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for (words, what, code) in [
        (
            "--metrics da",
            "da needs the hours of a year; add --weather FILE",
            2,
        ),
        ("--weather a.epw --metrics light", "light", 2),
        ("--weather a.epw --schedule 18-8", "for instance 8-18", 2),
        (
            "--weather a.epw --schedule 2.6-2.9",
            "no hours from 2.6-2.9",
            2,
        ),
        ("--weather a.epw --thresholds -3", "threshold", 2),
        ("--weather a.epw --place london", "leave out --place", 2),
        ("--weather a.epw --hour 6-20T12 --metrics da", "--hour", 2),
        ("--hour 6-20T12", "--weather", 2),
        ("--weather b.epw", "b.epw", 1),
        ("--metrics sunhours --sun 180,40", "need a place", 2),
        ("--metrics sunhours --dates 2-30", "for instance 3-21", 2),
        (
            "--metrics sunhours --dates 2-29 --place london",
            "no 29 February",
            2,
        ),
    ] {
        let output = daylight(folder.path(), words);
        let line = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{words}: {line}");
        let lines: Vec<&str> = line.lines().filter(|l| !l.starts_with("warning")).collect();
        assert_eq!(lines.len(), 1, "{line}");
        assert!(line.contains(what), "{line} for {what}");
    }
}
