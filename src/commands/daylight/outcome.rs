//! All that is printed of a run over a year, or without hours: made by a single run, or of the parts of several machines.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::exact::Exact;
use super::summary::{Asked, Summary};
use super::table::{Column, Figure, csv, objects, overview};
use crate::cli::DaylightArgs;

/// The form of the result.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub(super) enum Form {
    /// For the eye.
    Table,
    /// Machine-readable.
    Json,
    /// A line for each sensor.
    Csv,
}

impl Form {
    /// As asked for.
    pub fn of(args: &DaylightArgs) -> Self {
        match (args.json, args.csv) {
            (true, _) => Self::Json,
            (_, true) => Self::Csv,
            _ => Self::Table,
        }
    }
}

/// What is the same for all sensors.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Common {
    /// The form.
    pub form: Form,
    /// Figures of the whole grid that are wanted.
    pub asked: Asked,
    /// The rule of the blinds, and the hours in which they are closed in each room.
    pub blinds: String,
    pub blinds_closed_hours: Exact,
    /// What is said of blinds.
    pub blinds_said: String,
    /// Occupied hours of every day.
    pub schedule: String,
    /// How many those are in the year.
    pub occupied_hours: Exact,
    /// Limit of bounces.
    pub bounces: String,
    /// The weather, as JSON.
    pub weather: String,
    /// Name of its place, if there is weather.
    pub place: Option<String>,
    /// Standard error at which to stop.
    pub error: Exact,
    /// Sensors of the grid.
    pub sensors: usize,
    /// What is odd about model and weather.
    pub warnings: Vec<String>,
}

/// The result at sensors.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Outcome {
    /// What is the same for all.
    pub common: Common,
    /// Numbers of these sensors in the grid.
    pub numbers: Vec<usize>,
    /// Six coordinates for each: position and normal.
    pub places: Exact,
    /// Values.
    pub columns: Vec<Column>,
    /// Paths of each.
    pub paths: Vec<u32>,
    /// Largest standard error.
    pub error_so_far: Exact,
}

impl Outcome {
    /// What a reader must know of an incomplete result, one line each.
    pub fn oddities(&self) -> Vec<String> {
        let (done, all) = (self.numbers.len(), self.common.sensors);
        let mut lines = Vec::new();
        if done < all {
            lines.push(format!("interrupted: {done} of {all} sensors are measured"));
        }
        let (found, wanted) = (self.error_so_far.one(), self.common.error.one());
        if found > wanted {
            lines.push(format!(
                "the standard error is {found:.4}, above {wanted}; raise --max-paths or --error"
            ));
        }
        lines
    }

    /// All warnings: of model and weather, and of the result.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.common.warnings.clone();
        warnings.extend(self.oddities());
        warnings
    }

    /// The text of the result.
    pub fn text(&self) -> String {
        match self.common.form {
            Form::Json => format!("{:#}\n", self.json()),
            Form::Csv => csv(&self.places.rows(), &self.columns),
            Form::Table => self.head() + &overview(&self.columns) + &self.summary().text(),
        }
    }

    /// Figures of the whole grid.
    pub fn summary(&self) -> Summary {
        Summary::of(&self.common.asked, &self.columns)
    }

    /// Means of the columns, and figures of the whole grid.
    pub fn figures(&self) -> Vec<Figure> {
        let means = self.columns.iter();
        let means = means.map(|column| Figure::new(&column.name, column.figures()[0]));
        means.chain(self.summary().figures()).collect()
    }

    /// Paths of a sensor, in the mean.
    pub fn paths(&self) -> u32 {
        let sum: u64 = self.paths.iter().map(|n| u64::from(*n)).sum();
        (sum / self.paths.len().max(1) as u64) as u32
    }

    /// What `--json` prints.
    pub fn json(&self) -> Value {
        let (common, summary) = (&self.common, self.summary());
        let weather: Value = serde_json::from_str(&common.weather).unwrap_or_default();
        json!({
            "sensors": objects(&self.places.rows(), &self.columns),
            "sda": summary.sda_json(),
            "ase": summary.ase,
            "en17037": summary.en17037_json(),
            "blinds": common.blinds,
            "blinds_closed_hours": common.blinds_closed_hours.mean(),
            "blinds_closed_hours_of_rooms": common.blinds_closed_hours.0,
            "schedule": common.schedule,
            "occupied_hours": common.occupied_hours.one(),
            "bounces": common.bounces,
            "paths": self.paths(),
            "weather": weather,
            "warnings": self.warnings(),
        })
    }

    /// Place, hours and bounces, for the eye.
    pub fn head(&self) -> String {
        let common = &self.common;
        let mut text = String::new();
        if let Some(name) = &common.place {
            let hours = common.occupied_hours.one();
            let schedule = &common.schedule;
            let blinds = &common.blinds_said;
            let _ = write!(text, "{name}\n{hours} h, {schedule} every day; {blinds}; ");
        }
        let _ = write!(
            text,
            "{} sensors; bounces: {}\n\n",
            self.numbers.len(),
            common.bounces
        );
        text
    }

    /// All parts as one: the sensors in the order of the grid. `None` if a sensor is missing or there twice, or without parts.
    pub fn merged(parts: Vec<Self>) -> Option<Self> {
        let mut all = parts.first()?.clone();
        let count = all.common.sensors;
        let mut from = vec![None; count];
        for (part, report) in parts.iter().enumerate() {
            for (at, number) in report.numbers.iter().enumerate() {
                if from.get_mut(*number)?.replace((part, at)).is_some() {
                    return None;
                }
            }
        }
        let from: Vec<(usize, usize)> = from.into_iter().collect::<Option<_>>()?;
        let places: Vec<Vec<[f64; 6]>> = parts.iter().map(|part| part.places.rows()).collect();
        all.numbers = (0..count).collect();
        all.places = from
            .iter()
            .flat_map(|(part, at)| places[*part][*at])
            .collect();
        all.paths = from
            .iter()
            .map(|(part, at)| parts[*part].paths[*at])
            .collect();
        for (number, column) in all.columns.iter_mut().enumerate() {
            let of = |(part, at): &(usize, usize)| {
                let column = &parts[*part].columns[number];
                (column.values[*at], column.errors[*at])
            };
            (column.values, column.errors) = from.iter().map(of).unzip();
        }
        let largest = parts.iter().map(|part| part.error_so_far.one());
        all.error_so_far = Exact::from(largest.fold(0.0, f64::max));
        Some(all)
    }
}
