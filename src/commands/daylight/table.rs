//! Results at sensors: columns of values with their errors, as CSV, as JSON, as a short table.

use std::fmt::Write as _;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::exact;
use crate::options::{in_world, shortest};
use crate::sensors::Sensor;

/// A quantity at every sensor.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub(in crate::commands) struct Column {
    /// Its key in JSON and CSV.
    pub name: String,
    /// Its unit, for the eye.
    pub unit: String,
    /// Its values, in the order of the sensors.
    #[serde(with = "exact::list")]
    pub values: Vec<f64>,
    /// Their standard errors.
    #[serde(with = "exact::list")]
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

/// A figure of the whole grid.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Figure {
    /// What it is.
    pub name: String,
    /// As it is printed.
    pub text: String,
}

impl Figure {
    /// A number.
    pub fn new(name: &str, value: f64) -> Self {
        Self::said(name, format!("{value:.2}"))
    }

    /// A word.
    pub fn said(name: &str, text: impl Into<String>) -> Self {
        Self {
            name: name.to_owned(),
            text: text.into(),
        }
    }
}

/// Keys of position and normal in JSON and CSV.
pub(super) const PLACE: [&str; 6] = ["x", "y", "z", "nx", "ny", "nz"];

/// Position and normal of a sensor in the model's axes.
pub(in crate::commands) fn place(sensor: &Sensor, origin: DVec3) -> [f64; 6] {
    let [x, y, z] = in_world(sensor.position, origin);
    let [nx, ny, nz] = sensor.normal.to_array().map(shortest);
    [x, y, z, nx, ny, nz]
}

/// A list of objects, one for each sensor.
pub(super) fn objects(places: &[[f64; 6]], columns: &[Column]) -> Value {
    let object = |(at, place): (usize, &[f64; 6])| {
        let mut object = Map::new();
        for (name, value) in PLACE.iter().zip(place) {
            object.insert((*name).to_owned(), (*value).into());
        }
        for column in columns {
            object.insert(column.name.clone(), rounded(column.values[at]).into());
            let error = format!("{}_se", column.name);
            object.insert(error, rounded(column.errors[at]).into());
        }
        Value::from(object)
    };
    places.iter().enumerate().map(object).collect()
}

/// A line for each sensor, under one of names.
pub(in crate::commands) fn csv(places: &[[f64; 6]], columns: &[Column]) -> String {
    let mut text = PLACE.join(",");
    for column in columns {
        let _ = write!(text, ",{0},{0}_se", column.name);
    }
    text.push('\n');
    for (at, place) in places.iter().enumerate() {
        text += &place.map(|v| v.to_string()).join(",");
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
