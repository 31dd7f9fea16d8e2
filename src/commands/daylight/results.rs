//! All that a single run found, for its files: pictures, the matrix, the report.

use std::path::Path;

use super::drawings::{Heat, Plan, hours, limit};
use super::outcome::Outcome;
use super::table::{Column, place};
use super::{blinds, ill, report};
use crate::cli::{DaylightArgs, Metric};
use crate::daylight::metrics::Measures;
use crate::daylight::weather::Weather;
use crate::daylight::weather::clock::ClockCheck;
use crate::error::{Error, Result};
use crate::options::Options;
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
    /// What is printed.
    pub outcome: &'a Outcome,
}

impl Results<'_> {
    /// Writes the matrix, the plan, the heat map and the report that are asked for.
    ///
    /// # Errors
    /// A file cannot be written, or the plan has no such metric.
    pub fn write_files(&self) -> Result<()> {
        if let Some(path) = &self.args.ill {
            self.write_matrix(path)?;
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

    /// Writes the illuminances of every hour of the weather file.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_matrix(&self, path: &Path) -> Result<()> {
        match self.weather {
            Some(weather) => ill::write(path, weather, self.light, self.year),
            None => Ok(()),
        }
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
                let [x, y, z] = [0, 1, 2].map(|k| place(sensor, self.scene.origin)[k]);
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
        self.outcome
            .columns
            .iter()
            .find(|column| column.name == name)
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
            let known: Vec<&str> = self
                .outcome
                .columns
                .iter()
                .map(|c| c.name.as_str())
                .collect();
            Error::usage(format!(
                "--plan-of {asked} was not measured; choose of {}",
                known.join(", ")
            ))
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
        let mut columns = self.outcome.columns.iter();
        columns.find(|column| column.name.starts_with(starts))
    }
}
