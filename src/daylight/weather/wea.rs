//! Radiance's `.wea`, the input of `gendaymtx`: a head of words and lines of month, day, hour, direct and diffuse irradiance.

use super::{Record, Station, Weather, date, number, plausible_irradiance, zone};
use crate::daylight::place::Place;

pub(super) fn parse(text: &str) -> Result<Weather, String> {
    let mut head = Head::default();
    let mut records = Vec::new();
    for (at, line) in (1..).zip(text.lines()) {
        let words: Vec<&str> = line.split_whitespace().collect();
        match words.as_slice() {
            [] => {}
            [first, ..] if first.starts_with(|c: char| c.is_ascii_digit()) => {
                records.push(record(&words, at)?);
            }
            [key, rest @ ..] => head.read(key, rest, at)?,
        }
    }
    let step_hours = step(&records);
    Ok(Weather {
        station: head.station()?,
        records,
        step_hours,
        warnings: Vec::new(),
    })
}

/// The words before the hours. Longitude and meridian are positive toward the west.
#[derive(Default)]
struct Head {
    name: String,
    latitude: Option<f64>,
    west: Option<f64>,
    meridian_west: Option<f64>,
    elevation_m: f64,
}

impl Head {
    fn read(&mut self, key: &str, rest: &[&str], at: usize) -> Result<(), String> {
        let value = || number(rest.first().unwrap_or(&""), key, at);
        match key {
            "place" => self.name = rest.join(" ").replace('_', " "),
            "latitude" => self.latitude = Some(value()?),
            "longitude" => self.west = Some(value()?),
            "time_zone" => self.meridian_west = Some(value()?),
            "site_elevation" => self.elevation_m = value()?,
            "weather_data_file_units" if value()? != 1.0 => {
                return Err(format!(
                    "line {at}: only weather_data_file_units 1, direct normal and diffuse horizontal W/m², can be read"
                ));
            }
            "weather_data_file_units" => {}
            other => {
                let shown: String = other.chars().take(20).collect();
                return Err(format!("line {at}: \"{shown}\" is no word of a .wea file"));
            }
        }
        Ok(())
    }

    fn station(self) -> Result<Station, String> {
        let given = |value: Option<f64>, key| value.ok_or(format!("it has no {key}"));
        let place = Place::new(
            given(self.latitude, "latitude")?,
            -given(self.west, "longitude")?,
        );
        let meridian = -given(self.meridian_west, "time_zone")?;
        Ok(Station {
            name: self.name,
            place: place?,
            zone_hours: zone(meridian / 15.0, 4)?,
            elevation_m: self.elevation_m,
        })
    }
}

fn record(words: &[&str], at: usize) -> Result<Record, String> {
    let [month, day, hour, direct, diffuse] = words else {
        return Err(format!(
            "line {at} has {} numbers instead of 5; the file is cut or damaged",
            words.len()
        ));
    };
    let (month, day, hour) = date(
        number(month, "the month", at)?,
        number(day, "the day", at)?,
        number(hour, "the hour", at)?,
        at,
    )?;
    let irradiance = |text, what| {
        let watts = number(text, what, at)?;
        Ok::<_, String>(plausible_irradiance(watts))
    };
    Ok(Record {
        month,
        day,
        hour,
        global_w: None,
        direct_normal_w: irradiance(direct, "the direct irradiance")?,
        diffuse_w: irradiance(diffuse, "the diffuse irradiance")?,
        dew_point_c: None,
    })
}

/// The least distance of two hours of one day; 1 without any.
fn step(records: &[Record]) -> f64 {
    let pairs = records.windows(2);
    let apart = pairs
        .filter(|p| p[0].day == p[1].day)
        .map(|p| p[1].hour - p[0].hour);
    let least = apart
        .filter(|hours| *hours > 0.0)
        .fold(f64::INFINITY, f64::min);
    if least.is_finite() { least } else { 1.0 }
}
