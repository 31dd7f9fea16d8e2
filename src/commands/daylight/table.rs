//! Results at sensors: columns of values with their errors, as CSV, as JSON, as a short table.

use std::fmt::Write as _;

use glam::DVec3;
use serde_json::{Map, Value};

use crate::options::{in_world, shortest};
use crate::sensors::Sensor;

/// A quantity at every sensor.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Column {
    /// Its key in JSON and CSV.
    pub name: String,
    /// Its unit, for the eye.
    pub unit: &'static str,
    /// Its values, in the order of the sensors.
    pub values: Vec<f64>,
    /// Their standard errors.
    pub errors: Vec<f64>,
}

impl Column {
    /// Mean, root mean square of the standard errors, least and largest value.
    pub fn figures(&self) -> [f64; 4] {
        let least = self.values.iter().copied().fold(f64::INFINITY, f64::min);
        let most = self.values.iter().copied().fold(0.0, f64::max);
        [self.mean(), self.error(), least, most]
    }

    fn mean(&self) -> f64 {
        self.values.iter().sum::<f64>() / self.values.len().max(1) as f64
    }

    /// Root mean square of the standard errors.
    fn error(&self) -> f64 {
        let squares: f64 = self.errors.iter().map(|e| e * e).sum();
        (squares / self.errors.len().max(1) as f64).sqrt()
    }
}

/// Position and normal of a sensor in the model's axes, with their keys in JSON and CSV.
pub(super) fn place(sensor: &Sensor, origin: DVec3) -> [(&'static str, f64); 6] {
    let [x, y, z] = in_world(sensor.position, origin);
    let [nx, ny, nz] = sensor.normal.to_array().map(shortest);
    [
        ("x", x),
        ("y", y),
        ("z", z),
        ("nx", nx),
        ("ny", ny),
        ("nz", nz),
    ]
}

/// A list of objects, one for each sensor.
pub(super) fn objects(sensors: &[Sensor], columns: &[Column], origin: DVec3) -> Value {
    let object = |(at, sensor): (usize, &Sensor)| {
        let mut object = Map::new();
        for (name, value) in place(sensor, origin) {
            object.insert(name.to_owned(), value.into());
        }
        for column in columns {
            object.insert(column.name.clone(), rounded(column.values[at]).into());
            let error = format!("{}_se", column.name);
            object.insert(error, rounded(column.errors[at]).into());
        }
        Value::from(object)
    };
    sensors.iter().enumerate().map(object).collect()
}

/// A line for each sensor, under one of names.
pub(super) fn csv(sensors: &[Sensor], columns: &[Column], origin: DVec3) -> String {
    let mut text = place(&Sensor::default(), DVec3::ZERO)
        .map(|(name, _)| name)
        .join(",");
    for column in columns {
        let _ = write!(text, ",{0},{0}_se", column.name);
    }
    text.push('\n');
    for (at, sensor) in sensors.iter().enumerate() {
        text += &place(sensor, origin).map(|(_, v)| v.to_string()).join(",");
        for column in columns {
            let [value, error] = [column.values[at], column.errors[at]].map(rounded);
            let _ = write!(text, ",{value},{error}");
        }
        text.push('\n');
    }
    text
}

/// Mean, least and largest value and error of each column.
pub(super) fn overview(columns: &[Column]) -> String {
    let mut text = format!(
        "{:24}{:>8}{:>12}{:>12}{:>12}{:>10}\n",
        "", "", "mean", "least", "most", "error"
    );
    for column in columns {
        let [mean, error, least, most] = column.figures();
        let _ = writeln!(
            text,
            "{:24}{:>8}{mean:>12.2}{least:>12.2}{most:>12.2}{error:>10.2}",
            column.name, column.unit
        );
    }
    text
}

/// Without digits that say nothing.
pub(super) fn rounded(value: f64) -> f64 {
    (value * 1e4).round() / 1e4
}
