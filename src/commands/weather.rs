//! `skylight weather`: what a weather file holds. Needs no device.

use std::fmt::Write as _;
use std::path::Path;

use serde_json::{Value, json};

use super::tell;
use crate::cli::{HourArgs, WeatherArgs};
use crate::daylight::weather::clock::ClockCheck;
use crate::daylight::weather::summary::{Sums, months, year};
use crate::daylight::weather::{Station, Weather};
use crate::error::{Error, Result};
use crate::options::{OptionValues, OptionsError};
use crate::output::print;

/// Largest weather file, bytes: a year by the minute has 90 MB.
const MAX_BYTES: u64 = 1 << 28;

pub(super) const MONTHS: [&str; 12] = [
    "January",
    "February",
    "March",
    "April",
    "May",
    "June",
    "July",
    "August",
    "September",
    "October",
    "November",
    "December",
];

/// Prints place, clock and sums of a file.
///
/// # Errors
/// A file that cannot be read, or a warning with `--strict`.
pub fn run(args: &WeatherArgs, options: &OptionValues) -> Result<()> {
    let settings = options.alone()?;
    let weather = read_weather(&args.file)?;
    let clock = ClockCheck::of(&weather);
    let warnings = warnings(&weather, clock.as_ref());
    tell(&settings, warnings.iter())?;
    let months = months(&weather);
    print(&if args.json {
        format!(
            "{:#}\n",
            object(&weather, clock.as_ref(), &months, &warnings)
        )
    } else {
        table(&weather, clock.as_ref(), &months)
    })
}

/// Reads a weather file; `.wea` by its extension.
///
/// # Errors
/// A file that cannot be read or is damaged.
pub fn read_weather(path: &Path) -> Result<Weather> {
    let failed = |reason: String| Error::Weather {
        path: path.to_owned(),
        reason,
    };
    let io = |error: std::io::Error| failed(error.to_string());
    if std::fs::metadata(path).map_err(io)?.len() > MAX_BYTES {
        return Err(failed("larger than 256 MiB".to_owned()));
    }
    let bytes = std::fs::read(path).map_err(io)?;
    let is_wea = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("wea"));
    Weather::parse(&String::from_utf8_lossy(&bytes), is_wea).map_err(failed)
}

/// What `--weather` gives; none of it can be given besides.
const GIVEN: [&str; 8] = [
    "place",
    "when",
    "solar",
    "sun",
    "sky",
    "dni",
    "dhi",
    "dew-point",
];

/// Fails with the first option that a weather file gives, too.
///
/// # Errors
/// See above.
pub(super) fn check_given(options: &OptionValues) -> Result<()> {
    match GIVEN.iter().find(|name| options.get(name).is_some()) {
        None => Ok(()),
        Some(name) => Err(Error::from(OptionsError(format!(
            "--weather gives place, sun and sky; leave out --{name}"
        )))),
    }
}

/// The options with place, moment and sky of an hour of a weather file, if one is given. Tells what is odd about the file.
///
/// # Errors
/// A file that cannot be used, an hour that it lacks, options that it gives too, or a warning with `--strict`.
pub fn applied(at: &HourArgs, mut options: OptionValues) -> Result<OptionValues> {
    let (Some(file), Some(hour)) = (&at.weather, at.hour) else {
        return Ok(options);
    };
    let wrong = |what: String| Error::from(OptionsError(what));
    check_given(&options)?;
    let weather = read_weather(file)?;
    let shown = file.display();
    let record = weather.at(hour);
    let record = record.ok_or_else(|| wrong(format!("{shown} has no hour {hour}")))?;
    let (Some(dni), Some(dhi)) = (record.direct_normal_w, record.diffuse_w) else {
        return Err(wrong(format!("{shown} has no irradiances at {hour}")));
    };
    let place = weather.station.place;
    options.set("place", format!("{},{}", place.latitude, place.longitude));
    options.set("when", weather.moment(record).to_rfc3339());
    options.set("sky", "perez");
    // An hour without light of the sky is dark.
    options.set("dni", if dhi > 0.0 { dni } else { 0.0 });
    options.set("dhi", dhi);
    if let Some(dew_point) = record.dew_point_c {
        options.set("dew-point", dew_point);
    }
    let warnings = warnings(&weather, ClockCheck::of(&weather).as_ref());
    tell(&options.alone()?, warnings.iter())?;
    Ok(options)
}

/// What is odd about a file and its clock.
pub(super) fn warnings(weather: &Weather, clock: Option<&ClockCheck>) -> Vec<String> {
    let mut lines = weather.warnings.clone();
    lines.extend(clock.and_then(ClockCheck::warning));
    lines
}

fn object(
    weather: &Weather,
    clock: Option<&ClockCheck>,
    months: &[Sums; 12],
    warnings: &[String],
) -> Value {
    let Station {
        name,
        place,
        zone_hours,
        elevation_m,
    } = &weather.station;
    let list = MONTHS.iter().zip(months).map(|(name, sums)| {
        let mut month = columns(sums);
        month.insert("month".to_owned(), (*name).into());
        Value::from(month)
    });
    json!({
        "place": { "name": name, "latitude": place.latitude, "longitude": place.longitude, "elevation_m": elevation_m },
        "zone_hours": zone_hours,
        "hours": weather.records.len() as f64 * weather.step_hours,
        "step_hours": weather.step_hours,
        "clock_minutes": clock.map(|c| c.minutes),
        "clock_residual_w": clock.map(|c| c.residual_w),
        "clock_unshifted_residual_w": clock.map(|c| c.unshifted_residual_w),
        "clock_is_off": clock.map(ClockCheck::is_off),
        "sunny_hours_at_night": clock.map(|c| c.sunny_hours_at_night),
        "months": list.collect::<Vec<_>>(),
        "year": columns(&year(months)),
        "warnings": warnings,
    })
}

fn columns(sums: &Sums) -> serde_json::Map<String, Value> {
    let pairs = [
        ("global_kwh", sums.global_kwh),
        ("direct_normal_kwh", sums.direct_normal_kwh),
        ("diffuse_kwh", sums.diffuse_kwh),
        ("sunshine_hours", sums.sunshine_hours),
        ("diffuse_klxh", sums.diffuse_klxh),
        ("direct_normal_klxh", sums.direct_normal_klxh),
    ];
    pairs
        .map(|(name, value)| (name.to_owned(), value.into()))
        .into_iter()
        .collect()
}

fn table(weather: &Weather, clock: Option<&ClockCheck>, months: &[Sums; 12]) -> String {
    let station = &weather.station;
    let clock = match clock {
        Some(c) if c.is_off() => format!(
            "off by {} minutes, residual {:.1} W/m²",
            c.minutes, c.residual_w
        ),
        Some(c) => format!("right, residual {:.1} W/m²", c.unshifted_residual_w),
        None => "not checked: that takes global, direct and diffuse irradiance".to_owned(),
    };
    let hours = weather.records.len() as f64 * weather.step_hours;
    let mut text = format!(
        "place       {}\n            {}, {} m above the sea\nclock       UTC{:+}, {clock}\nhours       {hours}\n\n{:12}{:>10}{:>10}{:>10}{:>10}{:>12}{:>12}\n{:12}{:>10}{:>10}{:>10}{:>10}{:>12}{:>12}\n",
        station.name,
        station.place,
        station.elevation_m,
        station.zone_hours,
        "",
        "global",
        "direct",
        "diffuse",
        "sunshine",
        "sky",
        "sun",
        "",
        "kWh/m²",
        "normal",
        "",
        "h",
        "klx h",
        "normal",
    );
    let year = year(months);
    for (name, sums) in MONTHS.iter().zip(months).chain([(&"year", &year)]) {
        let _ = writeln!(
            text,
            "{name:12}{:>10.1}{:>10.1}{:>10.1}{:>10.0}{:>12.0}{:>12.0}",
            sums.global_kwh,
            sums.direct_normal_kwh,
            sums.diffuse_kwh,
            sums.sunshine_hours,
            sums.diffuse_klxh,
            sums.direct_normal_klxh
        );
    }
    text
}
