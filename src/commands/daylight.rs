//! `skylight daylight`: illuminance at the sensors of a grid, with all diffuse bounces. Needs no device.

use std::fmt::Write as _;

use serde_json::json;

use super::job::Job;
use super::progress;
use crate::cli::DaylightArgs;
use crate::error::Result;
use crate::options::{OptionValues, shortest};
use crate::output::print;
use crate::sensors::{Accuracy, Lights, Reading, Sensor, TracedScene, measure, read_grid};

/// Measures all sensors and prints them in the order of the file.
///
/// # Errors
/// Fails when the grid or the model cannot be read, or when options are invalid.
pub fn run(args: &DaylightArgs, options: &OptionValues) -> Result<()> {
    let sensors = read_grid(&args.grid)?;
    let job = Job::new(Some(&args.scene), options)?;
    let accuracy = Accuracy {
        relative_error: args.error,
        max_paths: args.max_paths,
        seed: job.settings.seed,
    };
    let (scene, lights) = (TracedScene::new(&job.scene), Lights::new(&job.daylight));
    let bar = progress(sensors.len() as u64, "sensors", job.settings.quiet);
    let readings = measure(&sensors, &scene, &lights, &accuracy, &|| bar.inc(1));
    bar.finish_and_clear();
    let rows: Vec<(Sensor, Reading)> = sensors.into_iter().zip(readings).collect();
    let imprecise = imprecise(&rows, args);
    if let Some(line) = imprecise.as_ref().filter(|_| !job.settings.quiet) {
        eprintln!("warning: {line}");
    }
    let text = if args.json {
        let warnings = job.warnings().chain(&imprecise);
        let warnings: Vec<&String> = warnings.collect();
        let list: Vec<_> = rows.iter().map(|(s, r)| object(s, r)).collect();
        format!("{:#}\n", json!({ "sensors": list, "warnings": warnings }))
    } else if args.csv {
        csv(&rows)
    } else {
        table(&rows)
    };
    print(&text)
}

/// Sensors that ran out of paths before they were precise enough, in one line.
fn imprecise(rows: &[(Sensor, Reading)], args: &DaylightArgs) -> Option<String> {
    let is_imprecise = |r: &Reading| r.standard_error > args.error * r.total();
    let count = rows.iter().filter(|(_, r)| is_imprecise(r)).count();
    (count > 0).then(|| {
        format!(
            "{count} of {} sensors have a standard error above {} after {} paths; raise --max-paths or --error",
            rows.len(),
            args.error,
            args.max_paths
        )
    })
}

/// Columns of JSON and CSV: metres, unit vector, lux.
fn columns(sensor: &Sensor, reading: &Reading) -> [(&'static str, f64); 11] {
    let (p, n) = (sensor.position, sensor.normal);
    let [x, y, z, nx, ny, nz] = [p.x, p.y, p.z, n.x, n.y, n.z].map(shortest);
    [
        ("x", x),
        ("y", y),
        ("z", z),
        ("nx", nx),
        ("ny", ny),
        ("nz", nz),
        ("sky_direct_lux", reading.sky_direct),
        ("sun_direct_lux", reading.sun_direct),
        ("reflected_lux", reading.reflected),
        ("total_lux", reading.total()),
        ("standard_error_lux", reading.standard_error),
    ]
}

fn object(sensor: &Sensor, reading: &Reading) -> serde_json::Value {
    let columns = columns(sensor, reading).into_iter();
    columns
        .map(|(name, value)| (name.to_owned(), value))
        .collect()
}

fn csv(rows: &[(Sensor, Reading)]) -> String {
    let line = |cells: Vec<String>| cells.join(",") + "\n";
    let names = columns(&Sensor::default(), &Reading::default());
    let head = line(names.map(|(name, _)| name.to_owned()).to_vec());
    let rows = rows.iter().map(|(sensor, reading)| {
        line(
            columns(sensor, reading)
                .map(|(_, value)| value.to_string())
                .to_vec(),
        )
    });
    head + &rows.collect::<String>()
}

fn table(rows: &[(Sensor, Reading)]) -> String {
    let head = format!(
        "{:>9}{:>9}{:>9}{:>12}{:>12}{:>12}{:>12}{:>10}\n",
        "x, m", "y", "z", "sky, lux", "sun", "reflected", "total", "error"
    );
    rows.iter().fold(head, |mut text, (s, r)| {
        let p = s.position;
        let _ = writeln!(
            text,
            "{:>9.2}{:>9.2}{:>9.2}{:>12.1}{:>12.1}{:>12.1}{:>12.1}{:>10.1}",
            p.x,
            p.y,
            p.z,
            r.sky_direct,
            r.sun_direct,
            r.reflected,
            r.total(),
            r.standard_error
        );
        text
    })
}
