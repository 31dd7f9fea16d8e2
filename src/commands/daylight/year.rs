//! `skylight daylight` with metrics: over the year of a weather file, or of what needs none.

use glam::DVec3;
use serde_json::{Value, json};

use super::super::hour::{NoHour, check_given, expand};
use super::super::job::{load_options, scene_of};
use super::super::merge::{FileBeside, JobKey, Kind};
use super::super::weather::{read_weather, warnings};
use super::super::{interrupt, progress, tell, tell_no_device};
use super::exact::Exact;
use super::outcome::{Common, Form, Outcome};
use super::results::Results;
use super::shards::YearPart;
use super::summary::Asked;
use super::table::{Column, place};
use super::unreflected::unreflected;
use super::{blinds, bounces, deliver, ill, sensors, shards};
use crate::cli::{DaylightArgs, Metric};
use crate::daylight::metrics::{Blinds, Measures, SPATIAL_LUX};
use crate::daylight::weather::Weather;
use crate::daylight::weather::clock::ClockCheck;
use crate::error::{Error, Result};
use crate::options::{OptionValues, Options, name};
use crate::output::check_writable;
use crate::scene::{self, Scene};
use crate::sensors::{
    Accuracy, BLOCK, Sensor, Shard, TracedScene, Year, YearLight, YearRun, close_blinds,
    measure_year,
};

/// Most records of a weather file: with more, the skies of the year no longer fit into memory.
const MOST_RECORDS: usize = 60_000;

/// Measures and prints a year, or what needs no hours of it.
///
/// # Errors
/// A grid, a model or a weather file that cannot be read, or invalid options.
pub fn run(args: &DaylightArgs, options: &OptionValues) -> Result<()> {
    args.files().try_for_each(|path| check_writable(path))?;
    let given = Given::new(args, options)?;
    tell_no_device("daylight", &given.settings);
    tell(&given.settings, given.told.iter())?;
    given.measured(args, |results| {
        let outcome = results.outcome;
        if let Some(shard) = args.shard {
            return given.write_shard(args, shard, results);
        }
        tell(&given.settings, outcome.oddities().iter())?;
        results.write_files()?;
        deliver(args.output.as_deref(), &outcome.text())
    })
}

/// What a run is given: model, sensors, weather.
pub(super) struct Given {
    weather: Option<Weather>,
    clock: Option<ClockCheck>,
    settings: Options,
    scene: Scene,
    /// What is odd about model and weather.
    told: Vec<String>,
    sensors: Vec<Sensor>,
}

impl Given {
    /// Reads all of it.
    ///
    /// # Errors
    /// A grid, a model or a weather file that cannot be read, or invalid options.
    pub fn new(args: &DaylightArgs, options: &OptionValues) -> Result<Self> {
        let weather = weather(args, options)?;
        let mut loaded = scene::load_with_progress(
            Some(&args.scene),
            &load_options(&options.alone()?),
            &|_, _| (),
        )?;
        expand(&mut loaded, NoHour::PlaceAlone)?;
        let settings = Options::resolve(options, &loaded)?;
        let scene = scene_of(&mut loaded, &settings)?;
        let clock = weather.as_ref().and_then(ClockCheck::of);
        let mut told = scene.warnings.clone();
        told.extend(weather.iter().flat_map(|w| warnings(w, clock.as_ref())));
        Ok(Self {
            sensors: sensors(args, &scene)?,
            weather,
            clock,
            settings,
            scene,
            told,
        })
    }

    /// The job of these arguments.
    pub fn key(&self, args: &DaylightArgs) -> JobKey {
        let weather = self.weather.as_ref().map(|w| (&w.station, &w.records));
        let given = (&self.scene, &self.sensors[..]);
        shards::key(
            Kind::Year,
            args,
            &self.settings,
            given,
            format!("{weather:?}"),
        )
    }

    /// Measures the sensors, of a shard those that are its own, and gives the results to `then`.
    ///
    /// # Errors
    /// A metric that cannot be measured, or those of `then`.
    pub fn measured<T>(
        &self,
        args: &DaylightArgs,
        then: impl FnOnce(&Results) -> Result<T>,
    ) -> Result<T> {
        let (settings, all, weather) = (&self.settings, &self.sensors, self.weather.as_ref());
        let light = match weather {
            Some(weather) if args.needs_hours() => YearLight::new(weather, settings.ground_albedo),
            _ => YearLight::overcast(settings.ground_albedo),
        };
        let mut measures = measures(args, weather, &light)?;
        check_pictures(args, &measures, all.len())?;
        let traced = TracedScene::new(&self.scene);
        if args.blinds == Blinds::Lm83 {
            measures.close_blinds(close_blinds(all, &traced, &light));
        }
        let year = measured(args, settings, &traced, &light, &measures, all);
        let sensors: Vec<(usize, Sensor)> = year.numbers.iter().map(|n| (*n, all[*n])).collect();
        let mut columns = columns(args, &measures, &year);
        columns.extend(unreflected(args, weather, settings, &sensors, &traced)?);
        let mut common = common(args, settings, &measures, &light);
        if let Some(weather) = weather {
            common.weather = weather_json(weather, self.clock.as_ref()).to_string();
            common.place = Some(weather.station.name.clone());
        }
        (common.sensors, common.warnings) = (all.len(), self.told.clone());
        let outcome = outcome(common, (&sensors, self.scene.origin), columns, &year);
        let sensors: Vec<Sensor> = sensors.into_iter().map(|(_, sensor)| sensor).collect();
        then(&Results {
            args,
            settings,
            scene: &self.scene,
            weather,
            clock: self.clock.as_ref(),
            light: &light,
            measures: &measures,
            sensors: &sensors,
            year: &year,
            outcome: &outcome,
        })
    }

    /// Writes the result of a shard.
    ///
    /// # Errors
    /// See [`shards::write`].
    fn write_shard(&self, args: &DaylightArgs, shard: Shard, results: &Results) -> Result<()> {
        let key = self.key(args);
        let mine = (0..self.sensors.len()).filter(|at| shard.takes(at / BLOCK));
        let count = [results.outcome.numbers.len(), mine.count()];
        let mut part = YearPart {
            outcome: results.outcome.clone(),
            ill: None,
        };
        if let (Some(path), [done, all]) = (&args.ill, count)
            && done == all
        {
            let path = ill::of_shard(path, shard);
            results.write_matrix(&path)?;
            part.ill = Some(FileBeside::new(&path)?);
        }
        shards::write(args, (&key, shard), &part, (count, "sensors"))
    }
}

/// What is printed of sensors with their numbers in the grid.
fn outcome(
    common: Common,
    (sensors, origin): (&[(usize, Sensor)], DVec3),
    columns: Vec<Column>,
    year: &Year,
) -> Outcome {
    let places = sensors.iter().flat_map(|(_, s)| place(s, origin));
    Outcome {
        common,
        places: places.collect(),
        columns,
        paths: year.sensors.iter().map(|sensor| sensor.paths).collect(),
        error_so_far: year.error.into(),
        numbers: year.numbers.clone(),
    }
}

/// What is the same for all sensors, but for weather and warnings.
fn common(
    args: &DaylightArgs,
    settings: &Options,
    measures: &Measures,
    light: &YearLight,
) -> Common {
    let asks = |metric| args.asked_metrics().contains(&metric);
    let hours = || {
        let median = measures.median_diffuse_lux(&light.hours);
        Exact(vec![measures.en17037_hours(), median])
    };
    Common {
        form: Form::of(args),
        asked: Asked {
            sda: asks(Metric::Sda),
            has_blinds: args.blinds == Blinds::Lm83,
            ase: asks(Metric::Ase),
            en17037: asks(Metric::En17037).then(hours),
        },
        blinds: name(args.blinds).to_owned(),
        blinds_closed_hours: measures.closed_hours().into_iter().collect(),
        blinds_said: blinds(args).to_owned(),
        schedule: args.schedule.to_string(),
        occupied_hours: measures.occupied_hours().into(),
        bounces: settings.bounces.to_string(),
        weather: Value::Null.to_string(),
        place: None,
        error: args.error.into(),
        sensors: 0,
        warnings: Vec::new(),
    }
}

/// The weather file, if one is given.
fn weather(args: &DaylightArgs, options: &OptionValues) -> Result<Option<Weather>> {
    let wrong = |what: String| Err(Error::usage(what));
    let Some(file) = &args.weather else {
        let mut metrics = args.metrics.iter().filter(|metric| metric.needs_hours());
        return match metrics.next() {
            Some(metric) => wrong(format!(
                "{metric} needs the hours of a year; add --weather FILE"
            )),
            None => Ok(None),
        };
    };
    check_given(options)?;
    let weather = read_weather(file)?;
    if weather.records.len() > MOST_RECORDS {
        return wrong(format!(
            "{}: more than {MOST_RECORDS} records; average them to hours",
            file.display()
        ));
    }
    Ok(Some(weather))
}

fn measures(args: &DaylightArgs, weather: Option<&Weather>, light: &YearLight) -> Result<Measures> {
    let Some(weather) = weather else {
        return Ok(Measures::default());
    };
    let mut thresholds = args.thresholds.clone();
    if args.asked_metrics().contains(&Metric::Sda) && !thresholds.contains(&SPATIAL_LUX) {
        thresholds.push(SPATIAL_LUX);
    }
    let measures = Measures::new(weather, &light.hours, args.schedule, thresholds);
    measures.map_err(Error::usage)
}

/// Fails early with a picture of what is not measured.
///
/// # Errors
/// See above.
fn check_pictures(args: &DaylightArgs, measures: &Measures, sensors: usize) -> Result<()> {
    let wrong = |what: String| Err(Error::usage(what));
    if args.heat_of.is_some_and(|number| number as usize > sensors) {
        return wrong(format!("--heat-of is a sensor from 1 to {sensors}"));
    }
    let Some(asked) = &args.plan_of else {
        return Ok(());
    };
    let metrics = args.asked_metrics();
    let mut known: Vec<String> = metrics.iter().map(ToString::to_string).collect();
    let names = names(measures).into_iter();
    known.extend(names.filter(|name| is_wanted(args, name) && *name != "df"));
    if metrics.contains(&Metric::En17037) && !metrics.contains(&Metric::Df) {
        known.push("df".to_owned());
    }
    if metrics.contains(&Metric::Ase) {
        known.push("ase_hours".to_owned());
    }
    let is_date = metrics.contains(&Metric::Sunhours) && asked.starts_with("sun_hours");
    if is_date || known.contains(asked) {
        return Ok(());
    }
    wrong(format!(
        "--plan-of {asked} is not measured; choose of {}, or add it to --metrics",
        known.join(", ")
    ))
}

/// Whether a value is part of a metric that was asked for.
fn is_wanted(args: &DaylightArgs, name: &str) -> bool {
    let is_of = |metric: &Metric| match metric {
        Metric::Df => name == "df",
        Metric::Da => name.starts_with("da"),
        Metric::Cda => name.starts_with("cda"),
        Metric::Udi => name.starts_with("udi"),
        Metric::Sda => name == "da300",
        Metric::En17037 => name.starts_with("en17037") || name == "df",
        Metric::Illuminance => name == "mean_lux",
        Metric::Ase | Metric::Vsc | Metric::Sunhours => false,
    };
    args.asked_metrics().iter().any(is_of) || (args.ill.is_some() && name == "mean_lux")
}

/// Names of the values of a sensor.
fn names(measures: &Measures) -> Vec<String> {
    let mut names = measures.names();
    names.push("df".to_owned());
    names
}

fn measured(
    args: &DaylightArgs,
    settings: &Options,
    scene: &TracedScene,
    light: &YearLight,
    measures: &Measures,
    sensors: &[Sensor],
) -> Year {
    interrupt::listen();
    let shard = args.shard.unwrap_or(Shard::ALL);
    let mine = (0..sensors.len()).filter(|at| shard.takes(at / BLOCK));
    let bar = progress(mine.count() as u64, "sensors", settings.quiet);
    let names = names(measures);
    // The daylight factor of EN 17037 comes along with its hours.
    let asks_for_factor = args.metrics.contains(&Metric::Df);
    let counts = |name: &String| is_wanted(args, name) && (name != "df" || asks_for_factor);
    let wanted = names.iter().map(counts);
    let year = measure_year(
        sensors,
        &YearRun {
            scene,
            light,
            measures,
            accuracy: Accuracy {
                relative_error: args.error,
                max_paths: args.max_paths,
                seed: settings.seed,
                bounces: bounces(settings),
            },
            wanted: wanted.collect(),
            keeps_hours: args.keeps_hours(),
            shard,
            progress: &|done, error| {
                bar.set_position(done as u64);
                if let Some(error) = error {
                    bar.set_message(format!("sensors, standard error so far {error:.4}"));
                }
            },
            is_stopped: &interrupt::is_interrupted,
        },
    );
    bar.finish_and_clear();
    year
}

/// The columns of the metrics that were asked for, those of exposure last.
fn columns(args: &DaylightArgs, measures: &Measures, year: &Year) -> Vec<Column> {
    let unit = |name: &str| match name {
        "mean_lux" => "lux",
        _ if name.starts_with("en17037") => "h",
        _ => "%",
    };
    let names = names(measures);
    let of = |(at, name): (usize, &String)| Column {
        name: name.clone(),
        unit: unit(name).to_owned(),
        values: year.sensors.iter().map(|s| s.values[at]).collect(),
        errors: year.sensors.iter().map(|s| s.errors[at]).collect(),
    };
    let wanted = names
        .iter()
        .enumerate()
        .filter(|(_, name)| is_wanted(args, name));
    let mut columns: Vec<Column> = wanted.map(of).collect();
    if args.asked_metrics().contains(&Metric::Ase) {
        columns.push(Column {
            name: "ase_hours".to_owned(),
            unit: "h".to_owned(),
            values: year.sensors.iter().map(|s| s.exposed_hours).collect(),
            errors: vec![0.0; year.sensors.len()],
        });
    }
    columns
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
