//! All that a run found, for its outputs: JSON, pictures, the report.

use serde_json::{Value, json};

use super::drawings::{Heat, Plan, hours, limit};
use super::summary::Summary;
use super::table::{Column, csv, objects, overview, place};
use super::{blinds, ill, report};
use crate::cli::{DaylightArgs, Metric};
use crate::daylight::metrics::Measures;
use crate::daylight::weather::Weather;
use crate::daylight::weather::clock::ClockCheck;
use crate::error::{Error, Result};
use crate::options::{Options, OptionsError, name};
use crate::output::Drawing;
use crate::scene::Scene;
use crate::sensors::{Sensor, Year, YearLight};

/// A run with metrics.
pub(super) struct Results<'a> {
    pub args: &'a DaylightArgs,
    pub settings: &'a Options,
    pub scene: &'a Scene,
    pub weather: Option<&'a Weather>,
    pub clock: Option<&'a ClockCheck>,
    pub light: &'a YearLight,
    pub measures: &'a Measures,
    /// Those that are measured.
    pub sensors: &'a [Sensor],
    pub year: &'a Year,
    pub columns: &'a [Column],
    pub summary: Summary,
    /// Warnings.
    pub told: &'a [String],
}

impl Results<'_> {
    /// What `--json` prints.
    pub fn json(&self) -> Value {
        json!({
            "sensors": objects(self.sensors, self.columns, self.scene.origin),
            "sda": self.summary.sda_json(),
            "ase": self.summary.ase,
            "en17037": self.summary.en17037_json(),
            "blinds": name(self.args.blinds),
            "blinds_closed_hours": self.measures.closed_hours(),
            "schedule": self.args.schedule.to_string(),
            "occupied_hours": self.measures.occupied_hours(),
            "bounces": self.settings.bounces.to_string(),
            "paths": self.paths(),
            "weather": self.weather.map(|weather| weather_json(weather, self.clock)),
            "warnings": self.told,
        })
    }

    /// Paths of a sensor.
    pub fn paths(&self) -> u32 {
        self.year.sensors.first().map_or(0, |sensor| sensor.paths)
    }

    /// What is printed: a table, or JSON or CSV.
    pub fn text(&self) -> String {
        if self.args.json {
            return format!("{:#}\n", self.json());
        }
        if self.args.csv {
            return csv(self.sensors, self.columns, self.scene.origin);
        }
        self.head() + &overview(self.columns) + &self.summary.text()
    }

    fn head(&self) -> String {
        let place = self.weather.map(|weather| {
            let hours = self.measures.occupied_hours();
            let name = &weather.station.name;
            format!(
                "{name}\n{hours} h, {} every day; {}; ",
                self.args.schedule,
                blinds(self.args)
            )
        });
        format!(
            "{}{} sensors; bounces: {}\n\n",
            place.unwrap_or_default(),
            self.sensors.len(),
            self.settings.bounces,
        )
    }

    /// Writes the matrix, the plan, the heat map and the report that are asked for.
    ///
    /// # Errors
    /// A file cannot be written, or the plan has no such metric.
    pub fn write_files(&self) -> Result<()> {
        if let (Some(path), Some(weather)) = (&self.args.ill, self.weather) {
            ill::write(path, weather, self.light, self.year)?;
        }
        if let Some(path) = &self.args.report {
            report::write(path, self)?;
        }
        if let Some(path) = &self.args.plan {
            self.plan(self.plan_column()?).write(path)?;
        }
        if let (Some(path), Some(weather)) = (&self.args.heat, self.weather) {
            self.heat(weather).write(path)?;
        }
        Ok(())
    }

    /// A plan of a column.
    pub fn plan(&self, column: &Column) -> Drawing {
        let mut notes = Vec::new();
        if let Some(weather) = self.weather {
            notes.push(format!(
                "{}; occupied {} every day, {} h; {}; bounces: {}",
                weather.station.name,
                self.args.schedule,
                self.measures.occupied_hours(),
                blinds(self.args),
                self.settings.bounces
            ));
        }
        let plan = Plan {
            sensors: self.sensors,
            scene: self.scene,
            column,
            limit: limit(&column.name, self.measures.en17037_hours()),
            notes,
            map: self.settings.colour_map,
        };
        plan.drawing()
    }

    /// The heat map of the sensor that is asked for, or of the mean.
    pub fn heat(&self, weather: &Weather) -> Drawing {
        let sensor = self.args.heat_of.map(|number| number as usize - 1);
        let title = match sensor.and_then(|number| self.sensors.get(number)) {
            Some(sensor) => {
                let [x, y, z] = [0, 1, 2].map(|k| place(sensor, self.scene.origin)[k].1);
                let number = self.args.heat_of.unwrap_or_default();
                format!("Illuminance at sensor {number} ({x}, {y}, {z})")
            }
            None => format!("Illuminance, mean of {} sensors", self.sensors.len()),
        };
        let heat = Heat {
            weather,
            lux: hours(weather, self.light, self.year, sensor),
            title,
            schedule: self.args.schedule,
            map: self.settings.colour_map,
        };
        heat.drawing()
    }

    /// The column of this name.
    pub fn column(&self, name: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// The column that a plan shows: the one asked for, or that of the first metric.
    fn plan_column(&self) -> Result<&Column> {
        let metrics = self.args.asked_metrics();
        let asked = self.args.plan_of.clone();
        let asked = asked.or_else(|| metrics.first().map(ToString::to_string));
        let asked = asked.unwrap_or_default();
        let of_metric = metrics.iter().find(|metric| metric.to_string() == asked);
        let found = self.column(&asked).or_else(|| self.column_of(*of_metric?));
        found.ok_or_else(|| {
            let known: Vec<&str> = self.columns.iter().map(|c| c.name.as_str()).collect();
            Error::from(OptionsError(format!(
                "--plan-of {asked} was not measured; choose of {}",
                known.join(", ")
            )))
        })
    }

    /// The column that stands for a metric.
    fn column_of(&self, metric: Metric) -> Option<&Column> {
        let starts = match metric {
            Metric::Df => "df",
            Metric::Da => "da",
            Metric::Cda => "cda",
            Metric::Udi => "udi_aut",
            Metric::Sda => "da300",
            Metric::Ase => "ase_hours",
            Metric::En17037 => "en17037_hours_ge300",
            Metric::Illuminance => "mean_lux",
            Metric::Vsc => "vsc",
            Metric::Sunhours => "sun_hours",
        };
        let mut columns = self.columns.iter();
        columns.find(|column| column.name.starts_with(starts))
    }
}

fn weather_json(weather: &Weather, clock: Option<&ClockCheck>) -> Value {
    let station = &weather.station;
    json!({
        "place": station.name,
        "latitude": station.place.latitude,
        "longitude": station.place.longitude,
        "zone_hours": station.zone_hours,
        "hours": weather.records.len() as f64 * weather.step_hours,
        "clock_minutes": clock.map(|c| c.minutes),
        "clock_is_off": clock.map(ClockCheck::is_off),
    })
}
