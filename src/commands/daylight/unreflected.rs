//! Columns of what needs no hours of weather: vertical sky component and hours of sun.

use chrono::Datelike;

use super::table::Column;
use crate::cli::{DaylightArgs, Metric};
use crate::daylight::place::Place;
use crate::daylight::sun_hours::Site;
use crate::daylight::weather::Weather;
use crate::error::{Error, Result};
use crate::options::Options;
use crate::sensors::{Sensor, TracedScene, sky_components, suns_seen};

/// The columns of those that are asked for, for sensors with their numbers in the grid.
///
/// # Errors
/// See [`sun_hours`].
pub(super) fn unreflected(
    args: &DaylightArgs,
    weather: Option<&Weather>,
    settings: &Options,
    sensors: &[(usize, Sensor)],
    scene: &TracedScene,
) -> Result<Vec<Column>> {
    let asks = |metric| args.asked_metrics().contains(&metric);
    let mut columns = Vec::new();
    if asks(Metric::Vsc) {
        columns.push(sky_component(sensors, scene, settings.seed));
    }
    if asks(Metric::Sunhours) {
        columns.extend(sun_hours(args, weather, settings, sensors, scene)?);
    }
    Ok(columns)
}

/// The vertical sky component.
fn sky_component(sensors: &[(usize, Sensor)], scene: &TracedScene, seed: u32) -> Column {
    let found = sky_components(sensors, scene, seed);
    Column {
        name: "vsc".to_owned(),
        unit: "%".to_owned(),
        values: found.iter().map(|[value, _]| *value).collect(),
        errors: found.iter().map(|[_, error]| *error).collect(),
    }
}

/// Hours of sun: a column for each of the dates.
///
/// # Errors
/// No place, or a date that does not exist.
fn sun_hours(
    args: &DaylightArgs,
    weather: Option<&Weather>,
    settings: &Options,
    sensors: &[(usize, Sensor)],
    scene: &TracedScene,
) -> Result<Vec<Column>> {
    let site = site(weather, settings)
        .ok_or_else(|| Error::usage("hours of sun need a place; give --place, or --weather"))?;
    let mut columns = Vec::new();
    for date in &args.dates {
        let suns = site.suns(*date, args.min_elevation)?;
        let suns = suns.ok_or_else(|| Error::usage(format!("{} has no 29 February", site.year)))?;
        let directions: Vec<_> = suns.suns.iter().map(|sun| sun.as_vec3()).collect();
        let seen = suns_seen(sensors, scene, &directions);
        columns.push(Column {
            name: format!("sun_hours_{}", suns.name),
            unit: "h".to_owned(),
            values: seen
                .iter()
                .map(|count| *count as f64 * suns.hours)
                .collect(),
            errors: vec![0.0; sensors.len()],
        });
    }
    Ok(columns)
}

fn site(weather: Option<&Weather>, settings: &Options) -> Option<Site> {
    if let Some(weather) = weather {
        let zone = *weather.moment(weather.records.first()?).offset();
        return Some(Site {
            place: weather.station.place,
            zone,
            year: weather.year(),
        });
    }
    let (latitude, longitude, when) = settings.sun.place()?;
    Some(Site {
        place: Place {
            latitude,
            longitude,
        },
        zone: *when.offset(),
        year: when.year(),
    })
}
