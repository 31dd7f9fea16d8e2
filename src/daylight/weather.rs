//! Weather files: the irradiances of a year at a place, hour by hour.
//!
//! [`Weather::parse`] reads EnergyPlus weather (`.epw`) and Radiance's `.wea`. [`clock`] tells whether the clock of a file is that of its
//! irradiances, [`summary`] sums them up. [`bundled`] weather needs no file.

mod bundled;
pub mod clock;
mod epw;
pub mod summary;
#[cfg(test)]
mod tests;
mod wea;

pub use bundled::{BUNDLED, bundled};

use chrono::{DateTime, Duration, FixedOffset, NaiveDate};

use super::perez::{DEW_POINTS, MOST_IRRADIANCE_W, Measured};
use super::place::Place;
use super::sun_position::{SunPosition, spa};

/// Year for the position of the sun in files of 365 days a year. Weather years are composed of months of several years.
const COMMON_YEAR: i32 = 2019;
/// The same for files with 29 February.
const LEAP_YEAR: i32 = 2020;

/// The place of a weather file.
#[derive(Debug, Clone, PartialEq)]
pub struct Station {
    /// Name, with region and country as far as the file has them.
    pub name: String,
    /// Latitude and longitude, degrees.
    pub place: Place,
    /// Clock of the file: hours east of UTC, −12..=14; quarters and halves occur. Local standard time, without daylight saving.
    pub zone_hours: f64,
    /// Height above the sea, metres.
    pub elevation_m: f64,
}

/// The weather of one interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Record {
    /// 1..=12.
    pub month: u32,
    /// 1..=31.
    pub day: u32,
    /// Middle of the interval, hours of local standard time, 0..24.
    pub hour: f64,
    /// Irradiance of a horizontal plane by sun and sky, W/m². These three are `None` where they are missing.
    pub global_w: Option<f64>,
    /// Irradiance by the sun at normal incidence, W/m².
    pub direct_normal_w: Option<f64>,
    /// Irradiance of a horizontal plane by the sky, W/m².
    pub diffuse_w: Option<f64>,
    /// Dew point, °C; `None` where it is missing or implausible.
    pub dew_point_c: Option<f64>,
}

/// A weather file.
#[derive(Debug, Clone, PartialEq)]
pub struct Weather {
    /// Its place.
    pub station: Station,
    /// Its intervals, in the order of the year.
    pub records: Vec<Record>,
    /// Length of an interval, hours.
    pub step_hours: f64,
    /// What is odd about the file, one line each.
    pub warnings: Vec<String>,
}

impl Weather {
    /// Reads the text of a file. `is_wea`: it is a `.wea`, else an `.epw`.
    ///
    /// # Errors
    /// One line that names the line of the file and what is wrong with it.
    pub fn parse(text: &str, is_wea: bool) -> Result<Self, String> {
        let text = text.trim_start_matches('\u{feff}');
        // Lines of old Macs end with CR alone.
        let text = &text.replace("\r\n", "\n").replace('\r', "\n");
        let mut weather = if is_wea {
            wea::parse(text)?
        } else {
            epw::parse(text)?
        };
        weather.check_order()?;
        weather.warn();
        Ok(weather)
    }

    /// The middle of an interval as a moment.
    pub fn moment(&self, record: &Record) -> DateTime<FixedOffset> {
        let date = NaiveDate::from_ymd_opt(self.year(), record.month, record.day);
        self.moment_on(date.unwrap_or_default(), record.hour)
    }

    /// The moment of a date and an hour, 0..24, of the file's clock.
    pub fn moment_on(&self, date: NaiveDate, hour: f64) -> DateTime<FixedOffset> {
        let seconds = |hours: f64| (hours * 3600.0).round();
        let zone = FixedOffset::east_opt(seconds(self.station.zone_hours) as i32);
        let zone = zone.unwrap_or_else(|| chrono::Offset::fix(&chrono::Utc));
        let midnight = date.and_time(chrono::NaiveTime::MIN);
        let local = midnight + Duration::seconds(seconds(hour) as i64);
        DateTime::from_naive_utc_and_offset(local - zone, zone)
    }

    /// The year for the position of the sun: one with the days of the file.
    pub fn year(&self) -> i32 {
        if self.records.iter().any(|r| (r.month, r.day) == (2, 29)) {
            LEAP_YEAR
        } else {
            COMMON_YEAR
        }
    }

    /// Position of the sun in the middle of an interval.
    pub fn sun(&self, record: &Record) -> SunPosition {
        self.sun_at(self.moment(record))
    }

    /// Position of the sun at a moment.
    pub fn sun_at(&self, moment: DateTime<FixedOffset>) -> SunPosition {
        let Place {
            latitude,
            longitude,
        } = self.station.place;
        // The ephemeris covers the years of all files.
        spa(moment, latitude, longitude).unwrap_or_else(|_| SunPosition::from_true(0.0, -90.0))
    }

    /// The measurement for Perez' sky. Missing irradiances are zero.
    pub fn measured(&self, record: &Record) -> Measured {
        use chrono::Datelike;
        Measured {
            direct_normal_w: record.direct_normal_w.unwrap_or_default(),
            diffuse_horizontal_w: record.diffuse_w.unwrap_or_default(),
            dew_point_c: record.dew_point_c,
            day_of_year: Some(self.moment(record).ordinal()),
        }
    }

    /// The interval that holds a time; `None` if the file has none.
    pub fn at(&self, time: YearHour) -> Option<&Record> {
        let half = 0.5 * self.step_hours;
        let holds = |r: &&Record| {
            let apart = time.hour - r.hour;
            (r.month, r.day) == (time.month, time.day) && (-half..half).contains(&apart)
        };
        self.records.iter().find(holds)
    }

    /// Whether the file covers a whole year.
    pub fn is_a_year(&self) -> bool {
        let days = if self.year() == LEAP_YEAR {
            366.0
        } else {
            365.0
        };
        (self.records.len() as f64 * self.step_hours - 24.0 * days).abs() < 0.5
    }

    /// Intervals must follow each other without doubles.
    fn check_order(&self) -> Result<(), String> {
        if self.records.is_empty() {
            return Err("it has no hours; take a whole file".to_owned());
        }
        let stamp = |r: &Record| (r.month, r.day, r.hour);
        let date = |r: &Record| format!("{}/{} {:.2} h", r.month, r.day, r.hour);
        let pairs = self.records.windows(2);
        let mut wrong = pairs.filter(|pair| stamp(&pair[0]) >= stamp(&pair[1]));
        match wrong.next() {
            None => Ok(()),
            Some([a, b]) if stamp(a) == stamp(b) => Err(format!(
                "the hour {} is there twice; take another copy of the file",
                date(a)
            )),
            Some(pair) => Err(format!(
                "the hour {} comes after {}; its hours are not in order",
                date(&pair[1]),
                date(&pair[0])
            )),
        }
    }

    fn warn(&mut self) {
        let count =
            |missing: fn(&Record) -> bool| self.records.iter().filter(|r| missing(r)).count();
        let all = self.records.len();
        let mut lines = Vec::new();
        if !self.is_a_year() {
            let hours = all as f64 * self.step_hours;
            lines.push(format!("it has {hours} hours, not those of a year"));
        }
        for (what, missing) in [
            (
                "direct normal irradiance",
                count(|r| r.direct_normal_w.is_none()),
            ),
            (
                "diffuse horizontal irradiance",
                count(|r| r.diffuse_w.is_none()),
            ),
            ("dew point", count(|r| r.dew_point_c.is_none())),
        ] {
            if missing > 0 {
                lines.push(format!("{missing} of {all} hours have no {what}"));
            }
        }
        let solar_zone = self.station.place.longitude / 15.0;
        if (solar_zone - self.station.zone_hours).abs() > 3.0 {
            lines.push(format!(
                "its clock is UTC{:+}, that of its longitude UTC{solar_zone:+.1}; one of the two may have a wrong sign",
                self.station.zone_hours
            ));
        }
        self.warnings.extend(lines);
    }
}

/// A time of a weather file's clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct YearHour {
    /// 1..=12.
    pub month: u32,
    /// 1..=31.
    pub day: u32,
    /// Hours of local standard time, 0..24.
    pub hour: f64,
}

impl std::fmt::Display for YearHour {
    /// In the form that is read.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let (hour, minute) = (self.hour.floor(), (self.hour.fract() * 60.0).round());
        write!(f, "{}-{}T{hour:02}:{minute:02}", self.month, self.day)
    }
}

impl std::str::FromStr for YearHour {
    type Err = String;

    /// `M-DThh` or `M-DThh:mm`, also with a blank for the T.
    fn from_str(text: &str) -> Result<Self, String> {
        let parts = || {
            let (date, time) = text.trim().split_once(['T', 't', ' '])?;
            let (month, day) = date.split_once('-')?;
            let (hour, minute) = time.trim().split_once(':').unwrap_or((time.trim(), "0"));
            let [month, day, hour, minute] =
                [month, day, hour, minute].map(|part| part.parse::<u32>().ok());
            let (month, day, hour, minute) = (month?, day?, hour?, minute?);
            let exists = NaiveDate::from_ymd_opt(LEAP_YEAR, month, day).is_some();
            (exists && hour < 24 && minute < 60).then_some(Self {
                month,
                day,
                hour: f64::from(hour) + f64::from(minute) / 60.0,
            })
        };
        parts().ok_or_else(|| {
            "write month, day and hour of the file's clock, for instance 3-21T12 or 12-21T15:30"
                .to_owned()
        })
    }
}

/// An irradiance that can be one. Files write 9999, 999999 or -1 where there is none.
fn plausible_irradiance(watts: f64) -> Option<f64> {
    (0.0..=MOST_IRRADIANCE_W).contains(&watts).then_some(watts)
}

/// A dew point that can be one.
fn plausible_dew_point(celsius: f64) -> Option<f64> {
    (DEW_POINTS.0..=DEW_POINTS.1)
        .contains(&celsius)
        .then_some(celsius)
}

/// A number of a line of the file, 1 for the first.
fn number(text: &str, what: &str, line: usize) -> Result<f64, String> {
    let parsed = text.trim().parse().ok().filter(|v: &f64| v.is_finite());
    parsed.ok_or_else(|| {
        let shown: String = text.trim().chars().take(20).collect();
        format!("line {line}: {what} is \"{shown}\", not a number")
    })
}

/// A month, day and middle of an interval that exist.
fn date(month: f64, day: f64, hour: f64, line: usize) -> Result<(u32, u32, f64), String> {
    let (m, d) = (month as u32, day as u32);
    let exists = NaiveDate::from_ymd_opt(LEAP_YEAR, m, d).is_some();
    if !exists || month.fract() != 0.0 || day.fract() != 0.0 || !(0.0..24.0).contains(&hour) {
        return Err(format!(
            "line {line}: {month}/{day} {hour} h is no hour of a year"
        ));
    }
    Ok((m, d, hour))
}

/// A clock that is in use somewhere, hours east of UTC.
fn zone(hours: f64, line: usize) -> Result<f64, String> {
    if !(-12.0..=14.0).contains(&hours) || (hours * 4.0).fract() != 0.0 {
        return Err(format!(
            "line {line}: the time zone {hours} is none; it must be -12 to 14 hours, in quarters"
        ));
    }
    Ok(hours)
}
