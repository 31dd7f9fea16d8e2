//! `skylight daylight` at a moment: illuminance at the sensors of a grid, with its parts.

use std::fmt::Write as _;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::super::job::Job;
use super::super::merge::{JobKey, Kind};
use super::super::{progress, tell, tell_no_device};
use super::drawings::Plan;
use super::exact::Exact;
use super::outcome::Form;
use super::table::{Column, Figure, PLACE, place};
use super::{bounces, deliver, sensors, shards};
use crate::cli::DaylightArgs;
use crate::error::{Error, Result};
use crate::options::OptionValues;
use crate::output::{Drawing, check_writable};
use crate::sensors::{Accuracy, Lights, Reading, Sensor, Shard, TracedScene, measure_shard};

/// Columns of JSON and CSV after the place: lux.
const COLUMNS: [&str; 7] = [
    "sky_direct_lux",
    "sun_direct_lux",
    "reflected_lux",
    "total_lux",
    "standard_error_lux",
    "sky_reflected_lux",
    "sun_reflected_lux",
];

/// Measures all sensors and prints them in the order of the file.
///
/// # Errors
/// Fails when the grid or the model cannot be read, or when options are invalid.
pub fn run(args: &DaylightArgs, options: &OptionValues) -> Result<()> {
    if args.plan_of.is_some() {
        let what = "--plan-of is for metrics; the plan of a moment shows all light";
        return Err(Error::usage(what));
    }
    args.files().try_for_each(|path| check_writable(path))?;
    let given = Given::new(args, options)?;
    tell(&given.job.settings, given.job.warnings())?;
    tell_no_device("daylight", &given.job.settings);
    let (readings, report) = given.measured(args);
    if let Some(shard) = args.shard {
        let count = report.numbers.len();
        return shards::write(
            args,
            (&given.key(args), shard),
            &report,
            ([count; 2], "sensors"),
        );
    }
    tell(&given.job.settings, report.oddities().iter())?;
    if let Some(path) = &args.plan {
        plan(&given.sensors, &readings, &given.job, args).write(path)?;
    }
    deliver(args.output.as_deref(), &report.text())
}

/// What a run is given: model and moment, sensors.
pub(super) struct Given {
    job: Job,
    sensors: Vec<Sensor>,
}

impl Given {
    /// Reads all of it, and tells nothing.
    ///
    /// # Errors
    /// A grid or a model that cannot be read, or invalid options.
    pub fn new(args: &DaylightArgs, options: &OptionValues) -> Result<Self> {
        let job = Job::untold(Some(&args.scene), options)?;
        let sensors = sensors(args, &job.scene)?;
        Ok(Self { job, sensors })
    }

    /// The job of these arguments.
    pub fn key(&self, args: &DaylightArgs) -> JobKey {
        let given = (&*self.job.scene, &self.sensors[..]);
        shards::key(Kind::Moment, args, &self.job.settings, given, String::new())
    }

    /// Measures the sensors, of a shard those that are its own.
    pub fn measured(&self, args: &DaylightArgs) -> (Vec<Reading>, MomentReport) {
        let (job, sensors) = (&self.job, &self.sensors);
        let accuracy = Accuracy {
            relative_error: args.error,
            max_paths: args.max_paths,
            seed: job.settings.seed,
            bounces: bounces(&job.settings),
        };
        let shard = args.shard.unwrap_or(Shard::ALL);
        let numbers: Vec<usize> = (0..sensors.len()).filter(|at| shard.takes(*at)).collect();
        let (scene, lights) = (TracedScene::new(&job.scene), Lights::new(&job.daylight));
        let bar = progress(numbers.len() as u64, "sensors", job.settings.quiet);
        let readings = measure_shard(sensors, shard, &scene, &lights, &accuracy, &|| bar.inc(1));
        bar.finish_and_clear();
        let row = |(number, reading): (&usize, &Reading)| {
            row(&sensors[*number], reading, job.scene.origin)
        };
        let report = MomentReport {
            form: Form::of(args),
            error: args.error.into(),
            max_paths: args.max_paths,
            sensors: sensors.len(),
            warnings: job.warnings().cloned().collect(),
            rows: numbers.iter().zip(&readings).flat_map(row).collect(),
            numbers,
        };
        (readings, report)
    }
}

/// A plan of all light.
fn plan(sensors: &[Sensor], readings: &[Reading], job: &Job, args: &DaylightArgs) -> Drawing {
    let column = Column {
        name: "total_lux".to_owned(),
        unit: "lux".to_owned(),
        values: readings.iter().map(Reading::total).collect(),
        errors: readings.iter().map(|r| r.standard_error).collect(),
    };
    let sun = job.sun;
    let mut notes = vec![format!(
        "sun: azimuth {:.2}°, elevation {:.2}°; bounces: {}",
        sun.azimuth_deg, sun.apparent_elevation_deg, job.settings.bounces
    )];
    let hour = args.weather.iter().zip(args.hour);
    notes.extend(hour.map(|(file, hour)| format!("{}, {hour}", file.display())));
    let plan = Plan {
        sensors,
        scene: &job.scene,
        column: &column,
        limit: None,
        notes,
        map: job.settings.colour_map,
    };
    plan.drawing()
}

/// A sensor: its place and its light, in the order of [`PLACE`] and [`COLUMNS`].
type Row = [f64; PLACE.len() + COLUMNS.len()];

fn row(sensor: &Sensor, r: &Reading, origin: DVec3) -> Row {
    let light = [
        r.sky_direct,
        r.sun_direct,
        r.reflected,
        r.total(),
        r.standard_error,
        r.sky_reflected,
        r.sun_reflected,
    ];
    let mut row = Row::default();
    let (of_place, of_light) = row.split_at_mut(PLACE.len());
    of_place.copy_from_slice(&place(sensor, origin));
    of_light.copy_from_slice(&light);
    row
}

/// Where the total and its error are in a [`Row`].
const TOTAL: usize = PLACE.len() + 3;

/// The result at sensors.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct MomentReport {
    form: Form,
    /// Relative standard error at which to stop.
    error: Exact,
    max_paths: u32,
    /// Sensors of the grid.
    sensors: usize,
    /// What is odd about model and light.
    warnings: Vec<String>,
    /// Numbers of these sensors in the grid.
    numbers: Vec<usize>,
    /// A [`Row`] for each.
    rows: Exact,
}

impl MomentReport {
    /// Sensors that ran out of paths before they were precise enough, in one line.
    pub fn oddities(&self) -> Vec<String> {
        let rows: Vec<Row> = self.rows.rows();
        let error = self.error.one();
        let is_imprecise = |row: &&Row| row[TOTAL + 1] > error * row[TOTAL];
        let count = rows.iter().filter(is_imprecise).count();
        let line = || {
            format!(
                "{count} of {} sensors have a standard error above {error} after {} paths; raise --max-paths or --error",
                rows.len(),
                self.max_paths
            )
        };
        (count > 0).then(line).into_iter().collect()
    }

    /// All warnings: of model and light, and of the result.
    pub fn warnings(&self) -> Vec<String> {
        let mut warnings = self.warnings.clone();
        warnings.extend(self.oddities());
        warnings
    }

    /// What `--json` prints.
    pub fn json(&self) -> Value {
        let rows: Vec<Row> = self.rows.rows();
        let list: Vec<_> = rows.iter().map(object).collect();
        json!({ "sensors": list, "warnings": self.warnings() })
    }

    /// Means of its parts, and the least and the largest total, lux.
    pub fn figures(&self) -> Vec<Figure> {
        let rows: Vec<Row> = self.rows.rows();
        let all = |at: usize| rows.iter().map(move |row| row[at]);
        let mean = |at: usize| all(at).sum::<f64>() / rows.len().max(1) as f64;
        let names = COLUMNS.iter().take(4).enumerate();
        let figure = |(at, name): (usize, &&str)| Figure::new(name, mean(PLACE.len() + at));
        let mut figures: Vec<Figure> = names.map(figure).collect();
        let least = all(TOTAL).fold(f64::INFINITY, f64::min);
        figures.push(Figure::new("least", least));
        figures.push(Figure::new("most", all(TOTAL).fold(0.0, f64::max)));
        figures
    }

    /// The text of the result.
    pub fn text(&self) -> String {
        let rows: Vec<Row> = self.rows.rows();
        match self.form {
            Form::Json => format!("{:#}\n", self.json()),
            Form::Csv => csv(&rows),
            Form::Table => table(&rows),
        }
    }

    /// All parts as one, in the order of the grid. `None` if a sensor is missing or there twice, or without parts.
    pub fn merged(parts: Vec<Self>) -> Option<Self> {
        let mut all = parts.first()?.clone();
        let mut rows: Vec<Option<Row>> = vec![None; all.sensors];
        for part in &parts {
            for (number, row) in part.numbers.iter().zip(part.rows.rows()) {
                if rows.get_mut(*number)?.replace(row).is_some() {
                    return None;
                }
            }
        }
        let rows: Vec<Row> = rows.into_iter().collect::<Option<_>>()?;
        all.numbers = (0..all.sensors).collect();
        all.rows = rows.into_iter().flatten().collect();
        Some(all)
    }
}

fn names() -> impl Iterator<Item = &'static str> {
    PLACE.into_iter().chain(COLUMNS)
}

fn object(row: &Row) -> Value {
    let pairs = names().zip(row);
    pairs
        .map(|(name, value)| (name.to_owned(), *value))
        .collect()
}

fn csv(rows: &[Row]) -> String {
    let mut text = names().collect::<Vec<_>>().join(",") + "\n";
    for row in rows {
        text += &row.map(|value| value.to_string()).join(",");
        text.push('\n');
    }
    text
}

fn table(rows: &[Row]) -> String {
    let head = format!(
        "{:>9}{:>9}{:>9}{:>12}{:>12}{:>12}{:>12}{:>10}\n",
        "x, m", "y", "z", "sky, lux", "sun", "reflected", "total", "error"
    );
    rows.iter().fold(head, |mut text, row| {
        let [x, y, z, _, _, _, sky, sun, reflected, total, error, ..] = row;
        let _ = writeln!(
            text,
            "{x:>9.2}{y:>9.2}{z:>9.2}{sky:>12.1}{sun:>12.1}{reflected:>12.1}{total:>12.1}{error:>10.1}"
        );
        text
    })
}
