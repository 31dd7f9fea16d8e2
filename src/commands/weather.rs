//! `skylight weather`: what a weather file holds. Needs no device.

use std::fmt::Write as _;
use std::io::ErrorKind;
use std::path::Path;

use serde_json::{Value, json};

use super::tell;
use crate::cli::WeatherArgs;
use crate::daylight::weather::clock::ClockCheck;
use crate::daylight::weather::summary::{Sums, months, year};
use crate::daylight::weather::{BUNDLED, Station, Weather, bundled};
use crate::error::{Error, Result};
use crate::options::OptionValues;
use crate::output::print;

/// Largest weather file, bytes: a year by the minute has 90 MB.
const MAX_BYTES: u64 = 1 << 28;

/// Where files are to be had.
const SOURCES: &str = "climate.onebuilding.org has files of most places";

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

/// Reads a weather file, `.wea` by its extension, or bundled weather by its name.
///
/// # Errors
/// A file that cannot be read or is damaged.
pub fn read_weather(path: &Path) -> Result<Weather> {
    let failed = |reason: String| Error::Weather {
        path: path.to_owned(),
        reason,
    };
    if let Some(text) = bundled(path) {
        return Weather::parse(text, false).map_err(failed);
    }
    let io = |error: std::io::Error| match error.kind() {
        ErrorKind::NotFound => failed(format!("no such file; {} is bundled, {SOURCES}", names())),
        _ => failed(error.to_string()),
    };
    if std::fs::metadata(path).map_err(io)?.len() > MAX_BYTES {
        return Err(failed("larger than 256 MiB".to_owned()));
    }
    let bytes = std::fs::read(path).map_err(io)?;
    let is_wea = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("wea"));
    Weather::parse(&String::from_utf8_lossy(&bytes), is_wea).map_err(failed)
}

/// Names of the bundled weather.
fn names() -> String {
    BUNDLED.map(|(name, _)| name).join(", ")
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
