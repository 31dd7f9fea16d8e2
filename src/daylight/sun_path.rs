//! The ways of the sun over a place: what a sun-path diagram draws on the dome of the sky.
//!
//! Directions are unit vectors of the world toward the sun as an [`Observer`] sees it. A line runs only where its centre
//! is not below the horizon, and ends on it: a day whose sun sets and rises again within the calendar day is two lines.

use chrono::{DateTime, Datelike, Duration, FixedOffset, NaiveDate, TimeZone, Timelike, Utc};
use glam::DVec3;

use super::sun_position::{
    Polar, SunEvents, SunPosition, SunPositionError, SunPositionMethod, YEARS, direction, spa,
    sun_events,
};

/// Between two points of a line, minutes: 2.5° at most, a chord 0.014° off its arc.
const STEP_MINUTES: i64 = 10;
/// Halvings of a step that look for the horizon: to a thousandth of a second.
const HALVINGS: usize = 20;
/// Hours over which the seasons are looked for, each way of their usual date.
const SEASON_HOURS: i64 = 8 * 24;
/// By how much the sun stands lower from the pole than from the middle of the earth at an equinox, degrees.
const PARALLAX_DEG: f64 = 8.794 / 3600.0;

/// Directions along a way of the sun.
pub type Line = Vec<DVec3>;

/// Who looks, and how the sun's position is computed for them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer {
    /// Degrees, positive north, ±90.
    pub latitude: f64,
    /// Degrees, positive east, ±180.
    pub longitude: f64,
    /// Formulas of the sun's position.
    pub method: SunPositionMethod,
    /// Whether the air lifts the sun.
    pub refraction: bool,
}

impl Observer {
    /// Direction toward the sun at `when`.
    ///
    /// # Errors
    /// No such place, or a moment that the ephemeris does not cover.
    pub fn sun(&self, when: DateTime<FixedOffset>) -> Result<DVec3, SunPositionError> {
        let at = self.method.position(when, self.latitude, self.longitude)?;
        Ok(self.seen(&at))
    }

    fn seen(&self, at: &SunPosition) -> DVec3 {
        if self.refraction {
            at.direction()
        } else {
            direction(at.azimuth_deg, at.elevation_deg)
        }
    }

    /// The way of the sun on the calendar day `date` of the clock `offset`, from midnight to midnight.
    ///
    /// # Errors
    /// As [`Observer::sun`].
    pub fn day(&self, date: NaiveDate, offset: FixedOffset) -> Result<Vec<Line>, SunPositionError> {
        let midnight = at_hour(date, offset, 0)?;
        let moments = (0..=24 * 60 / STEP_MINUTES)
            .map(|step| midnight + Duration::minutes(step * STEP_MINUTES));
        self.above_horizon(moments)
    }

    /// Where the sun stands at `hour` (0..24) of the clock `offset` over the days of `year`: the analemma.
    ///
    /// # Errors
    /// As [`Observer::sun`].
    pub fn analemma(
        &self,
        year: i32,
        offset: FixedOffset,
        hour: u32,
    ) -> Result<Vec<Line>, SunPositionError> {
        let first = at_hour(date(year, 1, 1)?, offset, hour)?;
        // Closed: the last is a year after the first.
        let moments = (0..=73)
            .map(|step| first + Duration::minutes((365.2422 * 1440.0 / 73.0) as i64 * step))
            .map(|moment| moment + Duration::minutes(to_the_hour(moment, hour)));
        self.above_horizon(moments)
    }

    /// The full hours of the clock `offset` on `date` at which the sun is up.
    ///
    /// # Errors
    /// As [`Observer::sun`].
    pub fn hours(
        &self,
        date: NaiveDate,
        offset: FixedOffset,
    ) -> Result<Vec<HourMark>, SunPositionError> {
        let mut marks = Vec::new();
        for hour in 0..24 {
            let when = at_hour(date, offset, hour)?;
            let direction = self.sun(when)?;
            if direction.y >= 0.0 {
                marks.push(HourMark { when, direction });
            }
        }
        Ok(marks)
    }

    /// The lines through the sun's directions at `moments`, cut at the horizon.
    fn above_horizon(
        &self,
        moments: impl Iterator<Item = DateTime<FixedOffset>>,
    ) -> Result<Vec<Line>, SunPositionError> {
        let mut lines: Vec<Line> = Vec::new();
        let mut before: Option<(DateTime<FixedOffset>, bool)> = None;
        for moment in moments {
            let at = self.sun(moment)?;
            let up = at.y >= 0.0;
            match before {
                Some((last, false)) if up => lines.push(vec![self.crossing(moment, last)?]),
                Some((last, true)) if !up => {
                    let end = self.crossing(last, moment)?;
                    lines.last_mut().into_iter().for_each(|line| line.push(end));
                }
                None if up => lines.push(Vec::new()),
                _ => {}
            }
            if up {
                lines.last_mut().into_iter().for_each(|line| line.push(at));
            }
            before = Some((moment, up));
        }
        Ok(lines)
    }

    /// The sun on the horizon between a moment when it is up and one when it is down.
    fn crossing(
        &self,
        mut up: DateTime<FixedOffset>,
        mut down: DateTime<FixedOffset>,
    ) -> Result<DVec3, SunPositionError> {
        for _ in 0..HALVINGS {
            let middle = up + (down - up) / 2;
            if self.sun(middle)?.y >= 0.0 {
                up = middle;
            } else {
                down = middle;
            }
        }
        self.sun(up)
    }
}

/// A full hour on the way of the sun.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HourMark {
    /// The moment, by the clock of the place.
    pub when: DateTime<FixedOffset>,
    /// Direction toward the sun.
    pub direction: DVec3,
}

impl HourMark {
    /// The hour by the clock, 0..24, as it is written at the mark.
    pub fn label(&self) -> String {
        self.when.hour().to_string()
    }
}

/// Everything that a sun-path diagram of a place draws, for one day.
#[derive(Clone, Debug, PartialEq)]
pub struct SunPath {
    /// The way on the day itself.
    pub day: Vec<Line>,
    /// The way on the day of the June solstice of that year.
    pub june_solstice: Vec<Line>,
    /// The way on the day of its March equinox.
    pub equinox: Vec<Line>,
    /// The way on the day of its December solstice.
    pub december_solstice: Vec<Line>,
    /// The hours of the day itself.
    pub hours: Vec<HourMark>,
    /// Sunrise, solar noon and sunset of the day itself.
    pub events: SunEvents,
    /// Whether the sun stays up, or down, all that day.
    pub polar: Option<Polar>,
}

impl SunPath {
    /// The sun-path diagram of the calendar day in which `when` falls by its own clock.
    ///
    /// # Errors
    /// As [`Observer::sun`].
    pub fn new(observer: &Observer, when: DateTime<FixedOffset>) -> Result<Self, SunPositionError> {
        let (date, offset) = (when.date_naive(), *when.offset());
        let (latitude, longitude) = (observer.latitude, observer.longitude);
        let seasons = Seasons::of(date.year())?;
        let day_of = |moment: DateTime<Utc>| {
            observer.day(moment.with_timezone(&offset).date_naive(), offset)
        };
        let events = sun_events(date, offset, latitude, longitude)?;
        Ok(Self {
            day: observer.day(date, offset)?,
            june_solstice: day_of(seasons.june_solstice)?,
            equinox: day_of(seasons.march_equinox)?,
            december_solstice: day_of(seasons.december_solstice)?,
            hours: observer.hours(date, offset)?,
            events,
            polar: events.polar(latitude, longitude),
        })
    }
}

/// When the seasons of a year begin, to a quarter of an hour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seasons {
    /// The sun crosses the equator northward.
    pub march_equinox: DateTime<Utc>,
    /// It is farthest north.
    pub june_solstice: DateTime<Utc>,
    /// It is farthest south.
    pub december_solstice: DateTime<Utc>,
}

impl Seasons {
    /// Those of `year`, −500..3000.
    ///
    /// # Errors
    /// A year that the ephemeris does not cover.
    pub fn of(year: i32) -> Result<Self, SunPositionError> {
        Ok(Self {
            march_equinox: turning(year, 3, |when| Ok(declination(when)? + PARALLAX_DEG >= 0.0))?,
            june_solstice: turning(year, 6, |when| Ok(hourly_change(when)? <= 0.0))?,
            december_solstice: turning(year, 12, |when| Ok(hourly_change(when)? >= 0.0))?,
        })
    }
}

/// Declination of the sun, degrees: its elevation as seen from the north pole.
fn declination(when: DateTime<Utc>) -> Result<f64, SunPositionError> {
    Ok(spa(when.fixed_offset(), 90.0, 0.0)?.elevation_deg)
}

fn hourly_change(when: DateTime<Utc>) -> Result<f64, SunPositionError> {
    let half = Duration::minutes(30);
    Ok(declination(when + half)? - declination(when - half)?)
}

/// The moment around the 21st of `month` from which on `over` holds.
fn turning(
    year: i32,
    month: u32,
    over: impl Fn(DateTime<Utc>) -> Result<bool, SunPositionError>,
) -> Result<DateTime<Utc>, SunPositionError> {
    let usual = date(year, month, 21)?.and_time(chrono::NaiveTime::MIN);
    let usual = usual.and_utc();
    let (mut before, mut after) = (-SEASON_HOURS * 60, SEASON_HOURS * 60);
    while after - before > 1 {
        let middle = (before + after).div_euclid(2);
        if over(usual + Duration::minutes(middle))? {
            after = middle;
        } else {
            before = middle;
        }
    }
    Ok(usual + Duration::minutes(after))
}

/// `hour` o'clock of a date; the year is checked here, so that nearby moments can be reached by addition.
fn at_hour(
    date: NaiveDate,
    offset: FixedOffset,
    hour: u32,
) -> Result<DateTime<FixedOffset>, SunPositionError> {
    let outside = || SunPositionError::Year(date.year());
    if !YEARS.contains(&date.year()) {
        return Err(outside());
    }
    let clock = date.and_hms_opt(hour, 0, 0).ok_or_else(outside)?;
    offset
        .from_local_datetime(&clock)
        .single()
        .ok_or_else(outside)
}

fn date(year: i32, month: u32, day: u32) -> Result<NaiveDate, SunPositionError> {
    NaiveDate::from_ymd_opt(year, month, day)
        .filter(|_| YEARS.contains(&year))
        .ok_or(SunPositionError::Year(year))
}

/// Minutes from `moment` to the nearest time when its clock shows `hour`.
fn to_the_hour(moment: DateTime<FixedOffset>, hour: u32) -> i64 {
    let minutes = i64::from(hour * 60) - i64::from(moment.hour() * 60 + moment.minute());
    (minutes + 720).rem_euclid(1440) - 720
}

#[cfg(test)]
#[path = "sun_path_tests.rs"]
mod tests;
