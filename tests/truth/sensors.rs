//! Sensors in rooms against a path tracer: `skylight daylight`, all bounces.

use std::path::Path;
use std::process::Command;

use crate::common;

/// Columns of a CSV text after its header.
fn rows(text: &str) -> Vec<Vec<f64>> {
    let lines = text.lines().skip(1).filter(|line| !line.is_empty());
    let cells = lines.map(|line| line.split(',').map(|cell| cell.parse().expect("a number")));
    cells.map(Iterator::collect).collect()
}

/// Runs `skylight daylight` for a model and its sensors, with this relative error; its CSV.
fn ran(model: &Path, grid: &Path, error: &str, light: &[&str]) -> Vec<Vec<f64>> {
    let output = Command::new(env!("CARGO_BIN_EXE_skylight"))
        .arg("daylight")
        .arg(model)
        .arg("--grid")
        .arg(grid)
        .args(light)
        .args(["--ground-albedo", "0", "--error", error])
        .args(["--csv", "--quiet"])
        .output()
        .expect("it runs");
    let errors = String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{errors}");
    rows(&String::from_utf8_lossy(&output.stdout))
}

/// Runs `skylight daylight` for the sensors of a room; its CSV.
fn measured(room: &str, sensors: &[Vec<f64>], light: &[&str]) -> Vec<Vec<f64>> {
    let shared = common::shared().expect("the folder");
    let folder = tempfile::tempdir().expect("a scratch folder");
    let grid = folder.path().join("grid.csv");
    let lines: Vec<String> = sensors
        .iter()
        .map(|s| format!("{},{},{}", s[0], s[1], s[2]))
        .collect();
    std::fs::write(&grid, lines.join("\n")).expect("written");
    let model = shared.join(format!("gi/{room}/{room}.obj"));
    ran(&model, &grid, "0.02", light)
}

/// Sensors of a room under a light against the path tracer's: the mean of all within 1 %, of each row of six within 3 %, and errors
/// as large as both programs say.
fn check(room: &str, table: &str, light: &[&str]) {
    let Some(shared) = common::shared() else {
        return;
    };
    let path = shared.join(format!("gi/{room}/sensors_{table}.csv"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    let truth = rows(&text);
    assert_eq!(truth.len(), 72);
    let ours = measured(room, &truth, light);
    assert_eq!(ours.len(), truth.len());
    let differences: Vec<f64> = ours
        .iter()
        .zip(&truth)
        .map(|(o, t)| o[9] / t[3] - 1.0)
        .collect();
    let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
    let worst = differences
        .chunks(6)
        .map(|row| mean(row).abs())
        .fold(0.0, f64::max);
    let in_errors: Vec<f64> = ours
        .iter()
        .zip(&truth)
        .map(|(o, t)| ((o[9] - t[3]) / o[10].hypot(t[4])).powi(2))
        .collect();
    let spread = mean(&in_errors).sqrt();
    println!(
        "{room}, {table}: mean {:+.4}, worst row {worst:.4}, spread {spread:.2} standard errors",
        mean(&differences)
    );
    assert!(mean(&differences).abs() < 0.01);
    assert!(worst < 0.03);
    assert!((0.6..1.6).contains(&spread));
}

/// CIE overcast sky of 10 000 lux on open ground.
const OVERCAST: [&str; 6] = [
    "--sky",
    "overcast",
    "--sky-illuminance",
    "10000",
    "--sun",
    "180,40",
];

#[test]
fn an_office_meets_the_path_tracer() {
    check(
        "office",
        "clear_sky_and_sun",
        &["--sun", "200,38", "--sky", "preetham", "--turbidity", "3"],
    );
    check("office", "overcast_10klx", &OVERCAST);
}

#[test]
fn an_office_under_an_overhang_meets_the_path_tracer() {
    check("office_overhang", "overcast_10klx", &OVERCAST);
}

#[test]
fn no_light_comes_through_a_partition() {
    if common::shared().is_none() {
        return;
    }
    let sensors: Vec<Vec<f64>> = (0..6)
        .map(|i| vec![0.5 + f64::from(i), 0.8, -7.0])
        .collect();
    let lux = measured("office_leak", &sensors, &["--sun", "200,38"]);
    assert!(lux.iter().all(|row| row[9] == 0.0), "{lux:?}");
}

/// Number, sun (azimuth and elevation, degrees), direct normal and diffuse horizontal irradiance (W/m²) and dew point (°C) of moments
/// with and without sun on the window.
const MOMENTS: [(u32, &str, [&str; 3]); 3] = [
    (0, "143.0951,17.9093", ["522", "81", "-9.4"]),
    (1, "191.6244,47.7692", ["810", "133", "-8.3"]),
    (3, "267.7369,24.1363", ["0", "89", "2.2"]),
];

#[test]
fn an_office_behind_glass_meets_the_path_tracer() {
    let Some(shared) = common::shared() else {
        return;
    };
    let folder = shared.join("daylight");
    let table = std::fs::read_to_string(folder.join("pit/office_glass_pit.csv")).expect("a table");
    let header: Vec<&str> = table.lines().next().expect("a header").split(',').collect();
    let truth = rows(&table);
    for (moment, sun, [dni, dhi, dew_point]) in MOMENTS {
        let dew_point = format!("--dew-point={dew_point}");
        let light = [
            "--sun", sun, "--sky", "perez", "--dni", dni, "--dhi", dhi, &dew_point,
        ];
        let ours = ran(
            &folder.join("models/office_glass.obj"),
            &folder.join("models/office.pts"),
            "0.03",
            &light,
        );
        assert_eq!(ours.len(), truth.len());
        let sum = |names: &[&str]| -> f64 {
            let names = names.iter().map(|name| format!("m{moment}_{name}"));
            let columns = names.map(|name| header.iter().position(|own| *own == name));
            let sums = columns.map(|i| {
                truth
                    .iter()
                    .map(|row| row[i.expect("a column")])
                    .sum::<f64>()
            });
            sums.sum()
        };
        // Where the edge of the sun's light lies on a sensor, the two differ.
        for (what, column, names, bound) in [
            ("sky", 6, &["sky_direct"][..], 0.02),
            ("reflected", 8, &["sky_reflected", "sun_reflected"], 0.02),
            ("total", 9, &["total"], 0.02),
        ] {
            let found: f64 = ours.iter().map(|row| row[column]).sum();
            let ratio = found / sum(names);
            println!("moment {moment}, {what}: {ratio:.4}");
            assert!(
                (ratio - 1.0).abs() < bound,
                "moment {moment}, {what}: {ratio}"
            );
        }
    }
}
