//! Values of options: their types, text to value with a clear message, and value to text.

use std::fmt;
use std::ops::RangeInclusive;

use chrono::{DateTime, FixedOffset, NaiveDate};

use super::Choice;
use crate::daylight::cities;
use crate::daylight::false_colour::Range;
use crate::frame::FrameSettings;

/// Width and height of a picture, pixels, 1..32 768 each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// A place on the earth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// Degrees, north positive, −90..90.
    pub latitude: f64,
    /// Degrees, east positive, −180..180.
    pub longitude: f64,
}

/// The lecture's inputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SolarTime {
    /// Day of the year, 1..366.
    pub day: u32,
    /// Solar time, hours, 0..24; 12 is when the sun is highest.
    pub hours: f64,
}

/// A direction to the sun.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Direction {
    /// Degrees clockwise from north, 0..360.
    pub azimuth_deg: f64,
    /// Degrees above the horizon, −90..90.
    pub elevation_deg: f64,
}

/// `--exposure`: the opposite of `--ev100`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum ExposureMode {
    #[default]
    /// From the picture's log-average luminance.
    Auto,
}

/// A set of defaults.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Preset {
    /// As in the lecture: its sun, its sky, Monte Carlo, and its linear scale.
    Lecture,
}

/// On or off, where the default is not plainly off.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Switch {
    /// On.
    #[default]
    On,
    /// Off.
    Off,
}

/// How mirrors depend on the angle.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Fresnel {
    /// Not at all: the lecture's ρ_s.
    #[default]
    Off,
    /// Schlick's approximation of Fresnel's equations.
    Schlick,
}

/// How wide the edges of the sun's shadow are in a single frame.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Penumbra {
    /// A texel of the map; the mean of several samples has the true ones.
    #[default]
    Map,
    /// As the sun's disc makes them.
    Sun,
}

/// How finely ambient occlusion is computed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum AoResolution {
    /// Half from 720 rows on, full below.
    #[default]
    Auto,
    /// From every pixel, at every second of every second row.
    Full,
    /// From every second pixel of every second row, at every fourth of every fourth.
    Half,
}

impl AoResolution {
    /// Pixels of a picture of so many rows to an occluder, each way.
    pub fn downscale(self, rows: u32) -> u32 {
        match self {
            Self::Full => 1,
            Self::Half => 2,
            Self::Auto => 1 + u32::from(rows >= 720),
        }
    }
}

impl Default for Size {
    fn default() -> Self {
        let [width, height] = FrameSettings::default().size.to_array();
        Self { width, height }
    }
}

/// As [`size`] reads it.
impl fmt::Display for Size {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}

/// As [`place`] reads it.
impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.latitude, self.longitude)
    }
}

/// As [`sun`] reads it.
impl fmt::Display for Direction {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.azimuth_deg, self.elevation_deg)
    }
}

/// As [`solar`] reads it.
impl fmt::Display for SolarTime {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{},{}", self.day, self.hours)
    }
}

/// The text that an option is set with, the reverse of its parser; none for what is not set.
pub(super) trait Written {
    fn written(&self) -> Option<String>;
}

impl<T: Choice> Written for T {
    fn written(&self) -> Option<String> {
        Some(self.option_name().to_owned())
    }
}

impl<T: Written> Written for Option<T> {
    fn written(&self) -> Option<String> {
        self.as_ref().and_then(Written::written)
    }
}

/// A flag: it is set or it is not.
impl Written for bool {
    fn written(&self) -> Option<String> {
        self.then(|| "true".to_owned())
    }
}

impl Written for DateTime<FixedOffset> {
    fn written(&self) -> Option<String> {
        Some(self.to_rfc3339())
    }
}

impl Written for [f64; 3] {
    fn written(&self) -> Option<String> {
        Some(self.map(|v| v.to_string()).join(","))
    }
}

impl Written for Range {
    fn written(&self) -> Option<String> {
        Some(format!("{},{}", self.min, self.max))
    }
}

/// Values whose [`fmt::Display`] is what their parser reads.
macro_rules! written_as_displayed {
    ($($type:ty)*) => {
        $(impl Written for $type {
            fn written(&self) -> Option<String> {
                Some(self.to_string())
            }
        })*
    };
}

written_as_displayed! { u32 f64 String Size Place Direction SolarTime }

/// A finite number.
pub(super) fn number(text: &str) -> Result<f64, String> {
    let value: f64 = text
        .trim()
        .parse()
        .map_err(|_| format!("\"{}\" is not a number", text.trim()))?;
    if value.is_finite() {
        Ok(value)
    } else {
        Err(format!("\"{}\" is not a finite number", text.trim()))
    }
}

fn within(name: &str, unit: &str, range: RangeInclusive<f64>, value: f64) -> Result<f64, String> {
    if range.contains(&value) {
        return Ok(value);
    }
    let unit = if unit.is_empty() {
        String::new()
    } else {
        format!(" {unit}")
    };
    Err(format!(
        "{name} must be {} to {}{unit}",
        range.start(),
        range.end()
    ))
}

/// Defines a parser of a number within a range.
macro_rules! ranged {
    ($($function:ident: $name:literal, $unit:literal, $range:expr;)*) => {
        $(pub(crate) fn $function(text: &str) -> Result<f64, String> {
            within($name, $unit, $range, number(text)?)
        })*
    };
}

ranged! {
    turbidity: "turbidity", "", -100.0..=100.0;
    sky_illuminance: "illuminance of the sky", "lux", 0.0..=1e6;
    ground_albedo: "ground albedo", "", 0.0..=1.0;
    fov: "field of view", "degrees", 1.0..=170.0;
    ev100: "exposure value", "", -20.0..=40.0;
    gamma: "gamma", "", 0.1..=10.0;
    scale: "scale", "", 0.0..=1e6;
    exposure_factor: "exposure", "", 1e-9..=1e9;
    ratio: "ratio", "", 0.0..=1e9;
    noise: "noise", "", 1e-6..=1.0;
    irradiance_error: "error", "percent", 0.0..=100.0;
    ao_radius: "radius", "metres", 0.0..=1000.0;
    specular: "specular scale", "", 0.0..=100.0;
    crease: "crease angle", "degrees", 0.0..=180.0;
}

fn list<const N: usize>(text: &str, form: &str) -> Result<[f64; N], String> {
    let values: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
    values.try_into().map_err(|_| format!("write {form}"))
}

/// `X,Y,Z`, metres.
pub(super) fn point(text: &str) -> Result<[f64; 3], String> {
    let point = list(text, "three numbers, for instance -17.5,3,13")?;
    for value in point {
        within("a coordinate", "metres", -1e9..=1e9, value)?;
    }
    Ok(point)
}

/// `LAT,LON`, degrees, or the name of a city.
pub(super) fn place(text: &str) -> Result<Place, String> {
    if text.trim().starts_with(char::is_alphabetic) {
        let city = cities::named(text)?;
        return Ok(Place {
            latitude: city.latitude,
            longitude: city.longitude,
        });
    }
    let [latitude, longitude] = list(text, "LAT,LON in degrees, for instance 55.79,12.52")?;
    within("latitude", "degrees", -90.0..=90.0, latitude)?;
    within("longitude", "degrees", -180.0..=180.0, longitude)?;
    Ok(Place {
        latitude,
        longitude,
    })
}

/// `MIN,MAX` of false colours.
pub(super) fn colour_range(text: &str) -> Result<Range, String> {
    let [min, max] = list(text, "MIN,MAX, for instance 100,10000")?;
    for value in [min, max] {
        within("a value of the range", "", 1e-9..=1e12, value)?;
    }
    if min >= max {
        return Err("the first value of the range must be less than the second".to_owned());
    }
    Ok(Range { min, max })
}

/// `AZIMUTH,ELEVATION`, degrees.
pub(crate) fn sun(text: &str) -> Result<Direction, String> {
    let [azimuth, elevation] = list(text, "AZIMUTH,ELEVATION in degrees, for instance 135,40")?;
    within("azimuth", "degrees", -360.0..=360.0, azimuth)?;
    within("elevation", "degrees", -90.0..=90.0, elevation)?;
    Ok(Direction {
        azimuth_deg: azimuth.rem_euclid(360.0),
        elevation_deg: elevation,
    })
}

/// `J,T`: day of the year and solar time in hours.
pub(super) fn solar(text: &str) -> Result<SolarTime, String> {
    let [day, hours] = list(
        text,
        "J,T: day of the year and solar time in hours, for instance 172,15",
    )?;
    if day.fract() != 0.0 || !(1.0..=366.0).contains(&day) {
        return Err("the day of the year must be a whole number from 1 to 366".to_owned());
    }
    within("solar time", "hours", 0.0..=24.0, hours)?;
    Ok(SolarTime {
        day: day as u32,
        hours,
    })
}

/// `1280x720`.
pub(super) fn size(text: &str) -> Result<Size, String> {
    let form = || "write WIDTHxHEIGHT in pixels, for instance 1280x720".to_owned();
    let (width, height) = text.split_once(['x', 'X']).ok_or_else(form)?;
    let edge = |text: &str| match text.trim().parse::<u32>() {
        Ok(edge @ 1..=32_768) => Ok(edge),
        Ok(_) => Err("width and height must be 1 to 32768 pixels".to_owned()),
        Err(_) => Err(form()),
    };
    let (width, height) = (edge(width)?, edge(height)?);
    Ok(Size { width, height })
}

/// RFC 3339 with its offset; seconds may be missing.
pub(super) fn when(text: &str) -> Result<DateTime<FixedOffset>, String> {
    let text = text.trim();
    let zulu = text
        .strip_suffix(['Z', 'z'])
        .map(|head| format!("{head}+00:00"));
    let text = zulu.as_deref().unwrap_or(text);
    let short = || DateTime::parse_from_str(text, "%Y-%m-%dT%H:%M%:z");
    let parsed = DateTime::parse_from_rfc3339(text).or_else(|_| short());
    parsed.map_err(|_| what_is_wrong(text))
}

fn what_is_wrong(text: &str) -> String {
    let form = "write a date, a time and its UTC offset, for instance 2026-06-21T15:00+02:00";
    let (date, time) = text.split_once(['T', 't', ' ']).unwrap_or((text, ""));
    let parts: Option<Vec<u32>> = date.split('-').map(|part| part.parse().ok()).collect();
    let Some(&[year, month, day]) = parts.as_deref() else {
        return form.to_owned();
    };
    if NaiveDate::from_ymd_opt(year as i32, month, day).is_none() {
        return format!("{date} is a date that does not exist");
    }
    if time.is_empty() {
        return format!("the time is missing; {form}");
    }
    let (clock, offset) = match time.rfind(['+', '-']) {
        Some(at) => time.split_at(at),
        None => (time, ""),
    };
    if offset.is_empty() {
        return format!("the UTC offset is missing; {form}");
    }
    let clock: Option<Vec<f64>> = clock.split(':').map(|part| part.parse().ok()).collect();
    match clock.as_deref() {
        Some([hour, rest @ ..]) if *hour >= 24.0 || rest.iter().any(|part| *part >= 60.0) => {
            format!("{time} is a time that does not exist")
        }
        _ => form.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pictures_have_an_occluder_at_every_pixel() {
        let of = |rows| AoResolution::Auto.downscale(rows);
        assert_eq!([of(360), of(719), of(720), of(2160)], [1, 1, 2, 2]);
    }

    #[test]
    fn moments_need_an_offset_and_may_lack_seconds() {
        let expected = DateTime::parse_from_rfc3339("2026-06-21T12:00:00Z").expect("a moment");
        for text in [
            "2026-06-21T14:00+02:00",
            "2026-06-21T14:00:00+02:00",
            "2026-06-21T12:00Z",
            "2026-06-21 14:00:00+02:00",
        ] {
            assert_eq!(when(text), Ok(expected), "{text}");
        }
        for (text, part) in [
            (
                "2026-02-30T12:00+01:00",
                "2026-02-30 is a date that does not exist",
            ),
            ("2025-02-29T12:00:00Z", "does not exist"),
            ("2026-13-01T12:00Z", "does not exist"),
            ("2026-06-21T25:00+02:00", "a time that does not exist"),
            ("2026-06-21T14:00", "offset is missing"),
            ("2026-06-21", "time is missing"),
            ("tomorrow", "write a date"),
            ("", "write a date"),
            ("99999999999-01-01T00:00Z", "write a date"),
            ("2026-06-21T14:00+99:00", "write a date"),
        ] {
            let error = when(text).expect_err(text);
            assert!(error.contains(part), "{text}: {error}");
        }
    }

    #[test]
    fn numbers_are_finite_and_in_range() {
        assert_eq!(
            size("1280x720"),
            Ok(Size {
                width: 1280,
                height: 720
            })
        );
        assert_eq!(point("-17.5, 3,13"), Ok([-17.5, 3.0, 13.0]));
        assert_eq!(
            sun("-90,10"),
            Ok(Direction {
                azimuth_deg: 270.0,
                elevation_deg: 10.0
            })
        );
        for text in [
            "0x0",
            "0x720",
            "32769x1",
            "12",
            "axb",
            "-1x5",
            "1x",
            "99999999999x1",
        ] {
            assert!(size(text).is_err(), "{text}");
        }
        for text in [
            "1,2",
            "1,2,3,4",
            "1,2,nan",
            "1,2,inf",
            "1,2,1e400",
            "",
            "a,b,c",
        ] {
            assert!(point(text).is_err(), "{text}");
        }
        for text in ["91,0", "0,181", "NaN,0", "1", "-90.1,0"] {
            assert!(place(text).is_err(), "{text}");
        }
        let lisbon = Place {
            latitude: 38.72,
            longitude: -9.14,
        };
        assert_eq!(place(" lisboa"), Ok(lisbon));
        assert_eq!(place("38.72,-9.14"), Ok(lisbon));
        assert_eq!(
            colour_range("10,2e3"),
            Ok(Range {
                min: 10.0,
                max: 2000.0
            })
        );
        for text in [
            "10", "0,10", "-1,10", "10,10", "20,10", "1,inf", "a,b", "1,2,3",
        ] {
            assert!(colour_range(text).is_err(), "{text}");
        }
        for text in ["0,12", "367,12", "1.5,12", "172,25", "172"] {
            assert!(solar(text).is_err(), "{text}");
        }
        for text in ["abc", "inf", "101", "-101"] {
            assert!(turbidity(text).is_err(), "{text}");
        }
    }
}
