//! Suns of dates and of years at a place, at equal steps of time: what hours of sun are counted with.

use chrono::{Duration, FixedOffset, NaiveDate, NaiveTime, TimeZone};
use glam::DVec3;

use super::place::Place;
use super::sun_position::{SunPositionError, direction, spa};

/// Minutes from one sun of a date to the next.
const MINUTES: i64 = 1;
/// The same of a year.
const MINUTES_OF_YEAR: i64 = 10;

/// How much the sun rises in a minute at most, degrees: by the turn of the earth, at the equator.
const FASTEST_DEG: f64 = 0.26;

/// When hours of sun are counted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SunDate {
    /// On every day of a year.
    Year,
    /// On a day: its year, if it is given, month and day.
    Day(Option<i32>, u32, u32),
}

impl std::fmt::Display for SunDate {
    /// As it is read.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Year => f.write_str("year"),
            Self::Day(Some(year), month, day) => write!(f, "{year}-{month}-{day}"),
            Self::Day(None, month, day) => write!(f, "{month}-{day}"),
        }
    }
}

impl std::str::FromStr for SunDate {
    type Err = String;

    /// `year`, `3-21` or `2026-3-21`.
    fn from_str(text: &str) -> Result<Self, String> {
        if text == "year" {
            return Ok(Self::Year);
        }
        let numbers: Option<Vec<u32>> = text.split('-').map(|word| word.parse().ok()).collect();
        let (year, month, day) = match numbers.as_deref() {
            Some(&[month, day]) => (None, month, day),
            Some(&[year, month, day]) if year < 3000 => (Some(year as i32), month, day),
            _ => (None, 0, 0),
        };
        // 2020 has a 29th of February.
        let exists = NaiveDate::from_ymd_opt(year.unwrap_or(2020), month, day).is_some();
        let wrong = || "write month and day, for instance 3-21 or 2026-3-21, or year".to_owned();
        exists
            .then_some(Self::Day(year, month, day))
            .ok_or_else(wrong)
    }
}

/// Dates of which hours of sun are summed up.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SunDates(pub Vec<SunDate>);

impl Default for SunDates {
    /// An equinox.
    fn default() -> Self {
        Self(vec![SunDate::Day(None, 3, 21)])
    }
}

impl std::fmt::Display for SunDates {
    /// As they are read.
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let dates: Vec<String> = self.0.iter().map(SunDate::to_string).collect();
        f.write_str(&dates.join(","))
    }
}

impl std::str::FromStr for SunDates {
    type Err = String;

    /// Dates, separated by commas.
    fn from_str(text: &str) -> Result<Self, String> {
        let dates: Result<Vec<SunDate>, String> = text.split(',').map(str::parse).collect();
        dates.map(Self)
    }
}

impl SunDate {
    /// The days, with `year` where the date has none; `None` if that year lacks the day.
    fn days(self, year: i32) -> Option<(String, Vec<NaiveDate>)> {
        match self {
            Self::Year => {
                let first = NaiveDate::from_yo_opt(year, 1)?;
                let days = first.iter_days().take(365).collect();
                Some(("year".to_owned(), days))
            }
            Self::Day(own, month, day) => {
                let date = NaiveDate::from_ymd_opt(own.unwrap_or(year), month, day)?;
                Some((date.to_string(), vec![date]))
            }
        }
    }
}

/// Suns of a date.
#[derive(Debug, Clone, PartialEq)]
pub struct DatedSuns {
    /// `year`, or the day.
    pub name: String,
    /// Unit vectors toward their centres, without refraction: those that are up.
    pub suns: Vec<DVec3>,
    /// What each stands for, hours.
    pub hours: f64,
}

/// Where the sun is looked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Site {
    /// Latitude and longitude.
    pub place: Place,
    /// Clock from whose midnight a day lasts to the next.
    pub zone: FixedOffset,
    /// Year of dates that have none.
    pub year: i32,
}

impl Site {
    /// Suns of a date that are above an elevation, degrees; `None` if the year lacks the day.
    ///
    /// # Errors
    /// A year that the ephemeris does not cover.
    pub fn suns(
        &self,
        date: SunDate,
        above_deg: f64,
    ) -> Result<Option<DatedSuns>, SunPositionError> {
        let step = match date {
            SunDate::Year => MINUTES_OF_YEAR,
            SunDate::Day(..) => MINUTES,
        };
        self.suns_every(date, above_deg, step)
    }

    /// The same, every so many minutes, which divide a day.
    ///
    /// # Errors
    /// See there.
    pub fn suns_every(
        &self,
        date: SunDate,
        above_deg: f64,
        step: i64,
    ) -> Result<Option<DatedSuns>, SunPositionError> {
        let Some((name, days)) = date.days(self.year) else {
            return Ok(None);
        };
        let least = above_deg.max(0.0);
        let mut suns = Vec::new();
        for day in days {
            let midnight = day.and_time(NaiveTime::MIN);
            let mut at = 0;
            while at < 24 * 60 / step {
                // The middle of the step. A fixed clock has every time once.
                let local = midnight + Duration::seconds(60 * at * step + 30 * step);
                at += 1;
                let Some(moment) = self.zone.from_local_datetime(&local).single() else {
                    continue;
                };
                let sun = spa(moment, self.place.latitude, self.place.longitude)?;
                if sun.elevation_deg > least {
                    suns.push(direction(sun.azimuth_deg, sun.elevation_deg));
                }
                // At night no sun is missed until it can be up again.
                at += (-sun.elevation_deg / (FASTEST_DEG * step as f64)).max(0.0) as i64;
            }
        }
        Ok(Some(DatedSuns {
            name,
            suns,
            hours: step as f64 / 60.0,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_are_read() {
        assert_eq!("year".parse(), Ok(SunDate::Year));
        assert_eq!("3-21".parse(), Ok(SunDate::Day(None, 3, 21)));
        assert_eq!("2026-02-01".parse(), Ok(SunDate::Day(Some(2026), 2, 1)));
        for text in ["", "2-30", "2026-2-29", "21", "march", "1-2-3-4"] {
            assert!(text.parse::<SunDate>().is_err(), "{text}");
        }
    }

    #[test]
    fn the_sun_is_up_for_half_a_day_at_the_equator() {
        let site = Site {
            place: Place {
                latitude: 0.0,
                longitude: 0.0,
            },
            zone: chrono::Offset::fix(&chrono::Utc),
            year: 2026,
        };
        let day = site.suns(SunDate::Day(None, 3, 21), 0.0).expect("a sun");
        let day = day.expect("a day");
        assert_eq!(day.name, "2026-03-21");
        assert!((day.suns.len() as f64 * day.hours - 12.0).abs() < 0.02);
        // From 60° on two hours before and after noon.
        let high = site.suns(SunDate::Day(None, 3, 21), 60.0).expect("a sun");
        assert!((high.expect("a day").suns.len() as f64 / 60.0 - 4.0).abs() < 0.05);
        let none = site.suns(SunDate::Day(None, 2, 29), 0.0).expect("a sun");
        assert_eq!(none, None);
    }
}
