//! `skylight daylight` at a moment: illuminance at the sensors of a grid, with its parts.

use std::fmt::Write as _;

use glam::DVec3;
use serde_json::json;

use super::super::job::Job;
use super::super::{progress, tell, tell_no_device};
use super::drawings::Plan;
use super::table::{Column, place};
use super::{bounces, sensors};
use crate::cli::DaylightArgs;
use crate::error::{Error, Result};
use crate::options::{OptionValues, OptionsError, in_world};
use crate::output::{Drawing, check_writable, print};
use crate::sensors::{Accuracy, Lights, Reading, Sensor, TracedScene, measure};

/// Measures all sensors and prints them in the order of the file.
///
/// # Errors
/// Fails when the grid or the model cannot be read, or when options are invalid.
pub fn run(args: &DaylightArgs, options: &OptionValues) -> Result<()> {
    if args.plan_of.is_some() {
        let what = "--plan-of is for metrics; the plan of a moment shows all light".to_owned();
        return Err(Error::from(OptionsError(what)));
    }
    let job = Job::new(Some(&args.scene), options)?;
    tell_no_device("daylight", &job.settings);
    args.files().try_for_each(|path| check_writable(path))?;
    let sensors = sensors(args, &job.scene)?;
    let accuracy = Accuracy {
        relative_error: args.error,
        max_paths: args.max_paths,
        seed: job.settings.seed,
        bounces: bounces(&job.settings),
    };
    let (scene, lights) = (TracedScene::new(&job.scene), Lights::new(&job.daylight));
    let bar = progress(sensors.len() as u64, "sensors", job.settings.quiet);
    let readings = measure(&sensors, &scene, &lights, &accuracy, &|| bar.inc(1));
    bar.finish_and_clear();
    let rows: Vec<(Sensor, Reading)> = sensors.into_iter().zip(readings).collect();
    let imprecise = imprecise(&rows, args);
    tell(&job.settings, imprecise.iter())?;
    if let Some(path) = &args.plan {
        plan(&rows, &job, args).write(path)?;
    }
    let origin = job.scene.origin;
    let text = if args.json {
        let warnings = job.warnings().chain(&imprecise);
        let warnings: Vec<&String> = warnings.collect();
        let list: Vec<_> = rows.iter().map(|(s, r)| object(s, r, origin)).collect();
        format!("{:#}\n", json!({ "sensors": list, "warnings": warnings }))
    } else if args.csv {
        csv(&rows, origin)
    } else {
        table(&rows, origin)
    };
    print(&text)
}

/// A plan of all light.
fn plan(rows: &[(Sensor, Reading)], job: &Job, args: &DaylightArgs) -> Drawing {
    let sensors: Vec<Sensor> = rows.iter().map(|(sensor, _)| *sensor).collect();
    let column = Column {
        name: "total_lux".to_owned(),
        unit: "lux",
        values: rows.iter().map(|(_, reading)| reading.total()).collect(),
        errors: rows.iter().map(|(_, r)| r.standard_error).collect(),
    };
    let sun = job.sun;
    let mut notes = vec![format!(
        "sun: azimuth {:.2}°, elevation {:.2}°; bounces: {}",
        sun.azimuth_deg, sun.apparent_elevation_deg, job.settings.bounces
    )];
    let hour = args.weather.iter().zip(args.hour);
    notes.extend(hour.map(|(file, hour)| format!("{}, {hour}", file.display())));
    let plan = Plan {
        sensors: &sensors,
        scene: &job.scene,
        column: &column,
        limit: None,
        notes,
        map: job.settings.colour_map,
    };
    plan.drawing()
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
fn columns(sensor: &Sensor, reading: &Reading, origin: DVec3) -> [(&'static str, f64); 13] {
    let [x, y, z, nx, ny, nz] = place(sensor, origin);
    [
        x,
        y,
        z,
        nx,
        ny,
        nz,
        ("sky_direct_lux", reading.sky_direct),
        ("sun_direct_lux", reading.sun_direct),
        ("reflected_lux", reading.reflected),
        ("total_lux", reading.total()),
        ("standard_error_lux", reading.standard_error),
        ("sky_reflected_lux", reading.sky_reflected),
        ("sun_reflected_lux", reading.sun_reflected),
    ]
}

fn object(sensor: &Sensor, reading: &Reading, origin: DVec3) -> serde_json::Value {
    let columns = columns(sensor, reading, origin).into_iter();
    columns
        .map(|(name, value)| (name.to_owned(), value))
        .collect()
}

fn csv(rows: &[(Sensor, Reading)], origin: DVec3) -> String {
    let line = |cells: Vec<String>| cells.join(",") + "\n";
    let names = columns(&Sensor::default(), &Reading::default(), DVec3::ZERO);
    let head = line(names.map(|(name, _)| name.to_owned()).to_vec());
    let rows = rows.iter().map(|(sensor, reading)| {
        line(
            columns(sensor, reading, origin)
                .map(|(_, value)| value.to_string())
                .to_vec(),
        )
    });
    head + &rows.collect::<String>()
}

fn table(rows: &[(Sensor, Reading)], origin: DVec3) -> String {
    let head = format!(
        "{:>9}{:>9}{:>9}{:>12}{:>12}{:>12}{:>12}{:>10}\n",
        "x, m", "y", "z", "sky, lux", "sun", "reflected", "total", "error"
    );
    rows.iter().fold(head, |mut text, (s, r)| {
        let [x, y, z] = in_world(s.position, origin);
        let _ = writeln!(
            text,
            "{:>9.2}{:>9.2}{:>9.2}{:>12.1}{:>12.1}{:>12.1}{:>12.1}{:>10.1}",
            x,
            y,
            z,
            r.sky_direct,
            r.sun_direct,
            r.reflected,
            r.total(),
            r.standard_error
        );
        text
    })
}
