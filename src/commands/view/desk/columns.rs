//! What the desk knows, as columns of values for all sensors.

use super::Desk;
use super::metric::Metric;
use crate::commands::daylight::{Column, Scale, csv, is_share};
use crate::commands::job::Job;
use crate::daylight::false_colour::ColourMap;
use crate::options::Choice as _;
use crate::sensors::{Reading, SensorYear};

/// Values of all sensors: NaN where there is none yet.
#[derive(Debug, Clone, PartialEq)]
pub struct Values {
    pub column: Column,
    pub scale: Scale,
}

impl Desk {
    /// The values of what is shown, once there are some; `record` is the hour of the weather file that is shown.
    pub fn values(&self, record: Option<usize>, map: ColourMap) -> Option<Values> {
        let column = if self.takes_moment(record) || self.is_early() {
            self.moment_column()
        } else if self.metric == Metric::Now {
            self.hour_column(record?)
        } else {
            self.column(self.metric)
        }?;
        let known: Vec<f64> = column
            .values
            .iter()
            .copied()
            .filter(|v| v.is_finite())
            .collect();
        if known.is_empty() {
            return None;
        }
        let unit = &column.unit;
        let scale = match self.metric {
            Metric::Now | Metric::Mean => Scale::logarithmic(known.into_iter(), unit, map),
            _ => Scale::linear(&known, unit, is_share(&column.name), map),
        };
        Some(Values { column, scale })
    }

    fn moment_column(&self) -> Option<Column> {
        (!self.readings.is_empty()).then(|| Column {
            name: Metric::Now.column().to_owned(),
            unit: Metric::Now.unit().to_owned(),
            values: self.readings.iter().map(Reading::total).collect(),
            errors: self.readings.iter().map(|r| r.standard_error).collect(),
        })
    }

    /// Illuminances of an hour of the year. Its standard errors are not known.
    fn hour_column(&self, record: usize) -> Option<Column> {
        let hour = *self.hours.as_ref()?.of_record.get(record)?;
        let lux = |year: &SensorYear| match hour {
            _ if year.paths == 0 => f64::NAN,
            None => 0.0,
            Some(hour) => year.lux.get(hour).map_or(f64::NAN, |lux| f64::from(*lux)),
        };
        (!self.years.is_empty()).then(|| Column {
            name: Metric::Now.column().to_owned(),
            unit: Metric::Now.unit().to_owned(),
            values: self.years.iter().map(lux).collect(),
            errors: vec![0.0; self.years.len()],
        })
    }

    /// A metric of the year at all sensors.
    pub fn column(&self, metric: Metric) -> Option<Column> {
        self.named(metric.column(), metric.unit())
    }

    /// A column of the year by its name, as `skylight daylight` has it.
    pub fn named(&self, name: &str, unit: &str) -> Option<Column> {
        if self.years.is_empty() {
            return None;
        }
        let mut names = self.hours.as_ref()?.measures.names();
        names.push(Metric::Df.column().to_owned());
        let at = names.iter().position(|own| own == name);
        let is_exposure = name == Metric::Ase.column();
        if at.is_none() && !is_exposure {
            return None;
        }
        let pairs = self.years.iter().map(|year| match at {
            _ if year.paths == 0 => [f64::NAN, 0.0],
            Some(at) => [year.values[at], year.errors[at]],
            None => [year.exposed_hours, 0.0],
        });
        let (values, errors) = pairs.map(|[value, error]| (value, error)).unzip();
        Some(Column {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values,
            errors,
        })
    }

    /// All that is measured, as `skylight daylight --csv` has it; `None` before all sensors are. `record` is the hour that is shown.
    pub fn csv(&self, job: &Job, record: Option<usize>) -> Option<String> {
        let mut columns = Vec::new();
        if self.metric == Metric::Now {
            columns.extend(
                self.values(record, job.settings.colour_map)
                    .map(|v| v.column),
            );
        }
        let metrics = Metric::VALUES.iter().map(|(metric, ..)| *metric);
        columns.extend(metrics.filter_map(|metric| self.column(metric)));
        let is_whole = |column: &Column| column.values.iter().all(|value| value.is_finite());
        let places = (0..self.sensors.len()).map(|sensor| self.place(sensor, job));
        let is_measured = !columns.is_empty() && columns.iter().all(is_whole);
        is_measured.then(|| csv(&places.collect::<Vec<_>>(), &columns))
    }

    /// Half of the daylight hours of EN 17037, and the median of their diffuse illuminance, lux.
    pub fn en17037(&self) -> Option<[f64; 2]> {
        let hours = self.hours.as_ref().filter(|_| self.weather.is_some())?;
        let measures = &hours.measures;
        Some([
            measures.en17037_hours(),
            measures.median_diffuse_lux(&hours.light.hours),
        ])
    }

    /// Illuminance of a sensor in each record of the weather file, lux; none in the dark. `None` before it is measured.
    pub fn hours_of(&self, sensor: usize) -> Option<Vec<Option<f64>>> {
        let year = self.years.get(sensor).filter(|year| year.paths > 0)?;
        let lux = |hour: &Option<usize>| hour.and_then(|at| year.lux.get(at)).copied();
        let records = self.hours.as_ref()?.of_record.iter();
        Some(records.map(|hour| lux(hour).map(f64::from)).collect())
    }
}
