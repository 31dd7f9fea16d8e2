//! The metrics of `skylight daylight` are those that honeybee-radiance-postprocess (PyPI) makes of its hourly matrix.

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::vary::{BASE, scratch, succeed};

/// Metrics of a matrix in the order of [`OURS`]: rows are sensors there, columns here.
const SCRIPT: &str = "
import json, sys
import numpy as np
from honeybee_radiance_postprocess import metrics as m
rows = np.loadtxt(sys.argv[1])
hours = rows[(rows[:, 2] >= 8) & (rows[:, 2] < 18), 3:].T
found = [m.da_array2d(hours, threshold=300), m.cda_array2d(hours, threshold=300), m.udi_lower_array2d(hours, min_t=100),
         m.udi_array2d(hours, min_t=100, max_t=3000), m.udi_upper_array2d(hours, max_t=3000), m.ase_array2d(hours)[1]]
print(json.dumps([list(map(float, f)) for f in found]))
";

/// Columns whose sums are each of the metrics of [`SCRIPT`].
const OURS: [&[&str]; 6] = [
    &["da300"],
    &["cda300"],
    &["udi_low"],
    &["udi_sup", "udi_aut"],
    &["udi_high"],
    &["ase_hours"],
];

/// A Python that has the package.
fn python() -> Option<String> {
    let python = std::env::var("SKYLIGHT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let words = ["-c", "import honeybee_radiance_postprocess"];
    let found = Command::new(&python).args(words).output();
    if found.is_ok_and(|output| output.status.success()) {
        return Some(python);
    }
    println!(
        "skipped: pip install honeybee-radiance-postprocess, or a python that has it in SKYLIGHT_PYTHON"
    );
    None
}

/// Both for the sensors of a run: ours and theirs, metric by metric.
fn compared(python: &str, folder: &Path, words: &str) -> Vec<[Vec<f64>; 2]> {
    let words = format!("{BASE} --weather a.epw --ill a.ill --json {words}");
    let report = succeed(folder, &words);
    let report: serde_json::Value = serde_json::from_str(&report).expect("JSON");
    let sensors = report["sensors"].as_array().expect("a list");
    let output = Command::new(python)
        .current_dir(folder)
        .args(["-c", SCRIPT, "a.ill"])
        .output();
    let output = output.expect("python");
    assert!(
        output.status.success(),
        "{}",
        String::from_utf8_lossy(&output.stderr)
    );
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let last = text.lines().last().expect("a line");
    let theirs: Vec<Vec<f64>> = serde_json::from_str(last).expect("numbers");
    let ours = OURS.map(|columns| {
        let of = |sensor: &serde_json::Value| {
            columns
                .iter()
                .map(|c| sensor[*c].as_f64().expect("a number"))
                .sum()
        };
        sensors.iter().map(of).collect::<Vec<f64>>()
    });
    ours.into_iter()
        .zip(theirs)
        .map(|(ours, theirs)| [ours, theirs])
        .collect()
}

#[test]
fn the_metrics_are_those_of_honeybee() {
    let Some(python) = python() else {
        return;
    };
    let folder = scratch();
    let folder = folder.path();
    // Behind the wall, looking down, along and up: dim and bright.
    let grid = "0,1,-3,0,-1,0\n0,1,-2,0,0,-1\n0,0.1,-1.2\n8.5,1,0\n0,1,0,0,-1,0\n0,1,0\n0,1,0,0,0,1\n2,1,5\n";
    fs::write(folder.join("grid.csv"), grid).expect("written");
    // Skies from 1 to 80 W/m², the sun in every third hour.
    let weather = |diffuse: fn(usize) -> usize| {
        let mut text = "LOCATION,Havnby,-,DNK,made,0,55.1,8.6,1.0,4.0\nDATA PERIODS,1,1,Data,Sunday, 6/ 1, 6/20\n".to_owned();
        for at in 0..20 * 24 {
            let (day, hour) = (1 + at / 24, at % 24);
            let is_day = (5..21).contains(&hour);
            let [direct, diffuse] = if is_day {
                [if at % 3 == 0 { 600 } else { 0 }, diffuse(at)]
            } else {
                [0, 0]
            };
            text += &format!(
                "2001,6,{day},{},0,?,15,9,70,101300,0,0,300,9999,{direct},{diffuse},0,0,0,0,0,0,0,0,20\n",
                hour + 1
            );
        }
        fs::write(folder.join("a.epw"), text).expect("written");
    };
    weather(|at| 1 + at * 7919 % 80);
    for (metric, [ours, theirs]) in OURS.iter().zip(compared(&python, folder, "")).take(5) {
        println!("{metric:?}: {ours:?} and {theirs:?}");
        let worst = ours
            .iter()
            .zip(&theirs)
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        assert!(worst < 1e-3, "{metric:?} differs by {worst}");
        let most = ours.iter().copied().fold(0.0, f64::max);
        let least = ours.iter().copied().fold(f64::INFINITY, f64::min);
        assert!(most > least, "{metric:?} is the same at all sensors");
    }
    // The sun alone: hardly any sky, no reflection.
    weather(|_| 1);
    let [ours, theirs] = &compared(&python, folder, "--bounces 0")[5];
    println!("hours of direct sun: {ours:?} and {theirs:?}");
    assert_eq!(ours, theirs);
    assert!(ours.iter().any(|hours| *hours > 20.0) && ours.contains(&0.0));
}
