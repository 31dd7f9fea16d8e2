//! Weather and sensors in the window: the hours of a file by keys, and values as those of `skylight daylight`.

use std::fmt::Write as _;
use std::path::Path;
use std::time::Duration;

use crate::running::{Running, program, shared_machine};
use crate::x::{keysym, until};

/// Two days of an EPW file in June.
fn two_days() -> String {
    let mut text =
        "LOCATION,Havnby,-,DNK,made,0,55.1,8.6,1.0,4.0\nDATA PERIODS,1,1,Data,Sunday, 6/20, 6/21\n"
            .to_owned();
    for at in 0..48 {
        let (day, hour) = (20 + at / 24, at % 24);
        let diffuse = if (5..21).contains(&hour) { 100 + at } else { 0 };
        let _ = writeln!(
            text,
            "2001,6,{day},{},0,?,15,9,70,101300,0,0,300,9999,0,{diffuse},0,0,0,0,0,0,0,0,20",
            hour + 1
        );
    }
    text
}

/// The newest file of the window's folder with this ending, once it is whole.
fn saved(running: &Running, number: u32, ending: &str) -> Option<Vec<u8>> {
    let name = format!("skylight-colonnade-{number}.{ending}");
    std::fs::read(running.folder.path().join(name)).ok()
}

/// A folder with the weather and a grid, and the words that open a window on them.
fn opened(folder: &Path) -> Vec<String> {
    std::fs::write(folder.join("a.epw"), two_days()).expect("written");
    std::fs::write(folder.join("g.csv"), "30,1,40\n-3,1,-2\n-4,1,-2\n").expect("written");
    let file = |name: &str| folder.join(name).display().to_string();
    let words = [
        "--size",
        "160x90",
        "--samples",
        "2",
        "--no-warnings",
        "--weather",
    ];
    let mut words: Vec<String> = words.map(str::to_owned).to_vec();
    words.extend([file("a.epw"), "--grid".to_owned(), file("g.csv")]);
    words.extend(["--hour", "6-20T11"].map(str::to_owned));
    words
}

#[test]
fn the_hours_of_a_weather_file_are_walked_by_keys() {
    let _machine = shared_machine();
    let folder = tempfile::tempdir().expect("a folder");
    let words = opened(folder.path());
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let running = Running::bare(&words);
    running.daylit();
    // An hour later, and the day after.
    running.display.typed('h');
    running.display.typed('j');
    running.picture();
    running.display.key(keysym::F12, false);
    let png = until("a picture", || saved(&running, 1, "png"));
    let holds = |text: &str| png.windows(text.len()).any(|part| part == text.as_bytes());
    // 12 to 13 of the second day is record 36.
    assert!(holds("2019-06-21T12:30:00+01:00"));
    assert!(holds("--dhi 136") && holds("--sky perez"));
    running.close_well();
}

#[test]
fn the_sensors_have_the_values_of_the_command() {
    let _machine = shared_machine();
    let folder = tempfile::tempdir().expect("a folder");
    let words = opened(folder.path());
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let mut command = program(folder.path());
    command.args([
        "daylight",
        "colonnade",
        "--weather",
        "a.epw",
        "--grid",
        "g.csv",
    ]);
    command.args(["--metrics", "illuminance", "--csv", "--no-warnings"]);
    let expected = String::from_utf8(command.output().expect("it runs").stdout).expect("text");
    // The last two columns: the mean of all hours and its error.
    let of_command =
        |line: &str| -> Vec<String> { line.split(',').skip(6).map(str::to_owned).collect() };
    let expected: Vec<Vec<String>> = expected.lines().map(of_command).collect();
    assert_eq!(
        (expected.len(), expected[0].join(",").as_str()),
        (4, "mean_lux,mean_lux_se")
    );
    let running = Running::bare(&words);
    running.daylit();
    let mut number = 0;
    // It is refined until its error is that of the command; then the numbers are the same, to the last digit.
    until("the values", || {
        number += 1;
        running.display.key(keysym::F12, false);
        until("a picture", || saved(&running, number, "exr"));
        std::thread::sleep(Duration::from_millis(500));
        let text = String::from_utf8(saved(&running, number, "csv")?).expect("text");
        let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
        let at = rows[0]
            .iter()
            .position(|name| *name == "mean_lux")
            .expect("a column");
        let found: Vec<Vec<String>> = rows
            .iter()
            .map(|row| row[at..at + 2].iter().map(ToString::to_string).collect())
            .collect();
        (found == expected).then_some(())
    });
    running.close_well();
}
