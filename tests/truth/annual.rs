//! A year in rooms against a path tracer: `skylight daylight --weather`.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::common::{self, Table};

/// Every `n`th sensor of a grid, unpacked weather, and a folder for both.
pub struct Case {
    folder: tempfile::TempDir,
    shared: PathBuf,
    pub every: usize,
}

impl Case {
    pub fn new(grid: &str, weather: &str, every: usize) -> Option<Self> {
        let shared = common::shared()?.join("daylight");
        let folder = tempfile::tempdir().expect("a scratch folder");
        let points =
            std::fs::read_to_string(shared.join(format!("models/{grid}.pts"))).expect("a grid");
        let some: Vec<&str> = points.lines().step_by(every).collect();
        std::fs::write(folder.path().join("grid.pts"), some.join("\n")).expect("written");
        let packed =
            std::fs::read(shared.join(format!("weather/{weather}.epw.xz"))).expect("a file");
        let mut bytes = Vec::new();
        lzma_rust2::XzReader::new(&packed[..], false)
            .read_to_end(&mut bytes)
            .expect("unpacked");
        std::fs::write(folder.path().join("a.epw"), bytes).expect("written");
        Some(Self {
            folder,
            shared,
            every,
        })
    }

    /// The JSON of a run.
    pub fn run(&self, model: &str, words: &str) -> serde_json::Value {
        let path = |name: &str| -> PathBuf { self.folder.path().join(name) };
        let mut command = Command::new(env!("CARGO_BIN_EXE_skylight"));
        command
            .arg("daylight")
            .arg(self.shared.join(format!("models/{model}.obj")))
            .arg("--grid")
            .arg(path("grid.pts"))
            .args(["--ground-albedo", "0", "--json", "--quiet", "--no-warnings"])
            .args(words.split_whitespace());
        if !words.contains("--place") {
            command.arg("--weather").arg(path("a.epw"));
        }
        let output = command.output().expect("it runs");
        let errors = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success(), "{errors}");
        serde_json::from_slice(&output.stdout).expect("JSON")
    }

    /// Differences between a value of each sensor and a column of a table; relative where that is asked for.
    fn differences(
        &self,
        report: &serde_json::Value,
        key: &str,
        (table, column): (&str, &str),
        is_relative: bool,
    ) -> Vec<f64> {
        let table = Table::at(&format!("daylight/{table}")).expect("the folder");
        let truth = table.rows().step_by(self.every);
        let sensors = report["sensors"].as_array().expect("a list");
        let pairs = sensors.iter().zip(truth);
        let found: Vec<f64> = pairs
            .map(|(sensor, row)| {
                let (ours, theirs) = (sensor[key].as_f64().expect(key), row.get(column));
                if is_relative {
                    ours / theirs - 1.0
                } else {
                    ours - theirs
                }
            })
            .collect();
        assert!(found.len() > 8, "{}", found.len());
        found
    }
}

/// Prints mean and largest of some differences; both are bounded.
fn check(what: &str, found: &[f64], mean_bound: f64, bound: f64) {
    let mean = found.iter().sum::<f64>() / found.len() as f64;
    let worst = found.iter().fold(0.0_f64, |worst, d| worst.max(d.abs()));
    println!("{what}: mean {mean:+.4}, largest {worst:.4}");
    assert!(mean.abs() <= mean_bound, "{what}: mean {mean}");
    assert!(worst <= bound, "{what}: {worst}");
}

const PERCENTAGES: [&str; 6] = [
    "da300", "cda300", "udi_low", "udi_sup", "udi_aut", "udi_high",
];

#[test]
fn the_year_of_an_office_behind_glass_is_the_path_tracers() {
    let Some(case) = Case::new("office", "chicago", 6) else {
        return;
    };
    let report = case.run("office_glass", "--metrics da,cda,udi,ase --error 0.01");
    let table = "annual/office_glass_chicago_total_metrics.csv";
    for key in PERCENTAGES {
        let found = case.differences(&report, key, (table, key), false);
        check(key, &found, 1.0, 3.0);
    }
    // The edge of the sun's light lies on some sensors for some hours.
    let found = case.differences(&report, "ase_hours", (table, "ase_hours_gt1000"), false);
    check("hours of direct sun", &found, 6.0, 15.0);
}

#[test]
fn blinds_close_as_often_as_the_path_tracers() {
    // All sensors: the rule counts them.
    let Some(case) = Case::new("office", "chicago", 1) else {
        return;
    };
    let words = "--metrics da,sda,ase --blinds lm83 --error 0.03";
    let report = case.run("office_glass", words);
    assert_eq!(report["blinds"], "lm83");
    let hours = report["blinds_closed_hours"].as_f64().expect("hours");
    println!("{hours} occupied hours with closed blinds");
    assert!((hours - 1661.0).abs() <= 10.0, "{hours}");
    let table = "annual/office_glass_chicago_total_metrics.csv";
    let found = case.differences(&report, "da300", (table, "da300_blinds5"), false);
    // At a standard error of three points.
    check("da300 with blinds", &found, 1.0, 7.0);
    let sda = report["sda"]["percent"].as_f64().expect("percent");
    let sensors = (sda - 32.142_857) / 100.0 * 84.0;
    println!("{sensors:+.0} sensors of sDA");
    assert!(sensors.abs() <= 3.01, "{sda}");
    // Exposure knows no blinds.
    let found = case.differences(&report, "ase_hours", (table, "ase_hours_gt1000"), false);
    check("hours of direct sun", &found, 6.0, 15.0);
}

#[test]
fn the_year_without_bounces_is_the_path_tracers() {
    let Some(case) = Case::new("openplan", "amsterdam_iwec", 8) else {
        return;
    };
    let words = "--metrics da,illuminance,en17037 --bounces 0 --error 0.003";
    let report = case.run("openplan_glass", words);
    let table = "annual/openplan_glass_amsterdam_iwec_noreflect_metrics.csv";
    let found = case.differences(&report, "mean_lux", (table, "mean_lx_8760"), true);
    // The reference has 262 144 rays a sensor. Of those of a sensor that sees a daylight factor D through panes that leave 0.88, about
    // D / 0.7 reach the sky: at 0.02 % that is 75 rays.
    let sensors = report["sensors"].as_array().expect("a list");
    let noise = |sensor: &serde_json::Value| {
        let seen = sensor["df"].as_f64().expect("df") / 100.0 / 0.7;
        (262_144.0 * seen).sqrt().recip()
    };
    let noise: Vec<f64> = sensors.iter().map(noise).collect();
    for (at, (off, noise)) in found.iter().zip(&noise).enumerate() {
        let bound = 0.01 + 2.0 * noise;
        assert!(off.abs() <= bound, "sensor {at}: {off}, {bound}");
    }
    let in_noise = found
        .iter()
        .zip(&noise)
        .map(|(off, noise)| (off / noise).powi(2));
    let spread = (in_noise.sum::<f64>() / found.len() as f64).sqrt();
    println!("mean illuminance: {spread:.2} times the noise of the reference");
    assert!(spread <= 1.0, "{spread}");
    let noisiest = noise.iter().copied().fold(0.0, f64::max);
    check("mean illuminance", &found, 0.01, 0.01 + 2.0 * noisiest);
    let found = case.differences(&report, "da300", (table, "da300"), false);
    check("da300", &found, 0.5, 1.5);
    let key = "en17037_hours_ge300";
    let found = case.differences(&report, key, (table, key), false);
    check(key, &found, 22.0, 80.0);
    let median = report["en17037"]["median_diffuse_lux"]
        .as_f64()
        .expect("lux");
    assert!((median / 14_357.07 - 1.0).abs() < 2e-3, "{median}");
}

#[test]
fn daylight_factors_are_the_path_tracers() {
    let Some(case) = Case::new("office", "chicago", 8) else {
        return;
    };
    let place = "--place london --metrics df";
    let report = case.run("office_glass", &format!("{place} --error 0.01"));
    let table = "df/office_glass_df.csv";
    let found = case.differences(&report, "df", (table, "df_percent"), true);
    check("daylight factor", &found, 0.015, 0.03);
    let report = case.run(
        "office_glass",
        &format!("{place} --bounces 0 --error 0.003"),
    );
    let found = case.differences(&report, "df", (table, "sky_component_percent"), true);
    check("sky component", &found, 0.01, 0.02);
}

#[test]
fn a_facade_has_the_sky_and_the_sun_of_the_formula() {
    let Some(case) = Case::new("street", "chicago", 1) else {
        return;
    };
    let dates = "--dates 2026-03-21,2026-02-01,2026-12-21";
    for (above, name) in [("0", "alt0"), ("10", "alt10")] {
        let words =
            format!("--place london --metrics vsc,sunhours {dates} --min-elevation {above}");
        let report = case.run("street", &words);
        let table = "vsc/vsc_sun.csv";
        let found = case.differences(&report, "vsc", (table, "vsc_percent"), false);
        check("vertical sky component", &found, 0.02, 0.05);
        for day in ["2026-03-21", "2026-02-01", "2026-12-21"] {
            let sensors = report["sensors"].as_array().expect("a list");
            let truth = Table::at(&format!("daylight/{table}")).expect("the folder");
            let key = format!("sun_hours_{day}");
            let found: Vec<f64> = sensors
                .iter()
                .zip(truth.rows())
                .map(|(sensor, row)| {
                    let minutes = 60.0 * sensor[&key].as_f64().expect("hours");
                    minutes - row.get(&format!("london_{day}_min_{name}"))
                })
                .collect();
            check(
                &format!("minutes of {day} above {above}°"),
                &found,
                2.0,
                2.0,
            );
        }
    }
}

/// The hourly matrix and the metrics are of the same numbers.
#[test]
fn the_matrix_has_a_line_for_every_hour() {
    let Some(case) = Case::new("office", "amsterdam_iwec", 12) else {
        return;
    };
    let path = case.folder.path().join("a.ill");
    let ill = path.to_string_lossy();
    let words = format!("--metrics da,illuminance --max-paths 1024 --ill {ill}");
    let report = case.run("office_open", &words);
    let hours = rows(&path);
    assert_eq!(hours.len(), 8760);
    assert_eq!(hours[4000][..3], [6.0, 16.0, 16.5]);
    for (at, sensor) in report["sensors"]
        .as_array()
        .expect("a list")
        .iter()
        .enumerate()
    {
        let lux: Vec<f64> = hours.iter().map(|row| row[3 + at]).collect();
        let mean = lux.iter().sum::<f64>() / 8760.0;
        let told = sensor["mean_lux"].as_f64().expect("lux");
        assert!((mean - told).abs() < 0.01 + 1e-4 * told, "{mean} {told}");
        let occupied = hours.iter().filter(|row| (8.0..18.0).contains(&row[2]));
        let enough = occupied.filter(|row| row[3 + at] >= 300.0).count();
        let told = sensor["da300"].as_f64().expect("percent");
        assert!(
            (enough as f64 / 36.5 - told).abs() < 0.06,
            "{enough} {told}"
        );
    }
}

fn rows(path: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(path).expect("a matrix");
    let line = |line: &str| {
        line.split(' ')
            .map(|v| v.parse().expect("a number"))
            .collect()
    };
    text.lines().map(line).collect()
}
