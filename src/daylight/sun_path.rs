//! Sun-path diagrams: the sun's paths across the sky of a place.
//!
//! Directions are unit vectors in world space toward the sun as an [`Observer`] sees it. Lines are clipped where the sun's centre
//! crosses the horizon: a calendar day on which the sun sets and then rises has two.

use chrono::{DateTime, Datelike, Duration, FixedOffset, NaiveDate, TimeZone, Timelike, Utc};
use glam::DVec3;

use super::sun_position::{
    Polar, SunEvents, SunPosition, SunPositionError, SunPositionMethod, YEARS, direction, spa,
    sun_events,
};

/// Time step between points of a line, minutes: at most 2.5°, where the chord deviates 0.014° from the arc.
const STEP_MINUTES: i64 = 10;
/// Bisections of a step to find the horizon crossing: to a thousandth of a second.
const HALVINGS: usize = 20;
/// Half of the interval searched for a season's start, hours around the 21st.
const SEASON_HOURS: i64 = 8 * 24;
/// Horizontal parallax of the sun, degrees: how much lower it appears from the pole than from the earth's centre.
const PARALLAX_DEG: f64 = 8.794 / 3600.0;

/// Directions along a path of the sun.
pub type Line = Vec<DVec3>;

/// A place and a method for the sun's position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Observer {
    /// Degrees, positive north, ±90.
    pub latitude: f64,
    /// Degrees, positive east, ±180.
    pub longitude: f64,
    /// Formulas of the sun's position.
    pub method: SunPositionMethod,
    /// Whether directions are apparent (with atmospheric refraction).
    pub refraction: bool,
}

impl Observer {
    /// Direction toward the sun at `when`.
    ///
    /// # Errors
    /// Coordinates out of range, or a year outside of [`YEARS`].
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

    /// The sun's path on the calendar day `date`, from midnight to midnight at the UTC offset `offset`.
    ///
    /// # Errors
    /// As [`Observer::sun`].
    pub fn day(&self, date: NaiveDate, offset: FixedOffset) -> Result<Vec<Line>, SunPositionError> {
        let midnight = at_hour(date, offset, 0)?;
        let moments = (0..=24 * 60 / STEP_MINUTES)
            .map(|step| midnight + Duration::minutes(step * STEP_MINUTES));
        self.above_horizon(moments)
    }

    /// The analemma: the sun at `hour` (0..24), at the UTC offset `offset`, on the days of `year`.
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
        // Closed: the last point is a year after the first.
        let moments = (0..=73)
            .map(|step| first + Duration::minutes((365.2422 * 1440.0 / 73.0) as i64 * step))
            .map(|moment| moment + Duration::minutes(to_the_hour(moment, hour)));
        self.above_horizon(moments)
    }

    /// The full hours of `date`, at the UTC offset `offset`, when the sun is up.
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

    /// The lines through the sun's directions at `moments`, clipped at the horizon.
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

    /// The direction at the horizon, by bisection between a moment with the sun up and one with it down.
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

/// A full hour on the sun's path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HourMark {
    /// The moment, at the UTC offset of the diagram.
    pub when: DateTime<FixedOffset>,
    /// Direction toward the sun.
    pub direction: DVec3,
}

impl HourMark {
    /// Label of the mark: the hour, 0 to 23.
    pub fn label(&self) -> String {
        self.when.hour().to_string()
    }
}

/// The contents of a place's sun-path diagram for one day.
#[derive(Clone, Debug, PartialEq)]
pub struct SunPath {
    /// The path of the day.
    pub day: Vec<Line>,
    /// The path on the June solstice of that year.
    pub june_solstice: Vec<Line>,
    /// The path on the March equinox of that year.
    pub equinox: Vec<Line>,
    /// The path on the December solstice of that year.
    pub december_solstice: Vec<Line>,
    /// The full hours of the day.
    pub hours: Vec<HourMark>,
    /// Sunrise, solar noon and sunset of the day.
    pub events: SunEvents,
    /// Polar day or night, if that day is one.
    pub polar: Option<Polar>,
}

impl SunPath {
    /// The diagram for the calendar day of `when`, at its UTC offset.
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

/// Equinox and solstices of a year, accurate to a quarter of an hour.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seasons {
    /// The sun crosses the equator northward (UTC).
    pub march_equinox: DateTime<Utc>,
    /// The sun is farthest north (UTC).
    pub june_solstice: DateTime<Utc>,
    /// The sun is farthest south (UTC).
    pub december_solstice: DateTime<Utc>,
}

impl Seasons {
    /// The seasons of a year.
    ///
    /// # Errors
    /// The year is outside [`YEARS`].
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

/// The first moment around the 21st of `month` when `over` holds, by bisection.
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

/// `hour` o'clock on a date. Checks the year, so that adding days to the result cannot overflow.
pub(super) fn at_hour(
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

/// Minutes from `moment` to the nearest time at which its clock shows `hour`.
fn to_the_hour(moment: DateTime<FixedOffset>, hour: u32) -> i64 {
    let minutes = i64::from(hour * 60) - i64::from(moment.hour() * 60 + moment.minute());
    (minutes + 720).rem_euclid(1440) - 720
}

#[cfg(test)]
mod tests {
    use super::super::sun_position::azimuth_elevation;
    use super::*;

    fn observer(latitude: f64, longitude: f64) -> Observer {
        Observer {
            latitude,
            longitude,
            method: SunPositionMethod::Spa,
            refraction: true,
        }
    }

    fn path(latitude: f64, longitude: f64, when: &str) -> SunPath {
        let when = DateTime::parse_from_rfc3339(when).unwrap();
        SunPath::new(&observer(latitude, longitude), when).unwrap()
    }

    fn azimuth(direction: DVec3) -> f64 {
        azimuth_elevation(direction).0
    }

    fn elevation(direction: DVec3) -> f64 {
        azimuth_elevation(direction).1
    }

    /// Smallest angle between a direction and a line, degrees.
    fn angle_to(lines: &[Line], direction: DVec3) -> f64 {
        let segments = lines.iter().flat_map(|line| line.windows(2));
        let distance = |ends: &[DVec3]| {
            let along = ends[1] - ends[0];
            let t = (direction - ends[0]).dot(along) / along.length_squared();
            let nearest = ends[0] + along * t.clamp(0.0, 1.0);
            nearest.angle_between(direction).to_degrees()
        };
        segments.map(distance).fold(f64::INFINITY, f64::min)
    }

    #[test]
    fn at_an_equinox_the_sun_rises_in_the_east_and_sets_in_the_west() {
        for latitude in [-60.0, -33.9, 0.0, 40.0, 55.7, 60.0] {
            let geometric = Observer {
                refraction: false,
                ..observer(latitude, 12.5)
            };
            let when = DateTime::parse_from_rfc3339("2026-06-01T12:00:00+01:00").unwrap();
            let path = SunPath::new(&geometric, when).unwrap();
            let [line] = &path.equinox[..] else {
                panic!("{latitude}: {} lines", path.equinox.len());
            };
            let (rise, set) = (line[0], line[line.len() - 1]);
            let (east, west) = (azimuth(rise), azimuth(set));
            println!("{latitude}: rises {east:.2}°, sets {west:.2}°");
            assert!((east - 90.0).abs() < 1.0 && (west - 270.0).abs() < 1.0);
            assert!(elevation(rise).abs() < 1e-4 && elevation(set).abs() < 1e-4);
            // Refraction makes the sun rise earlier, so the path is no shorter.
            let lifted = observer(latitude, 12.5).day(when.date_naive(), *when.offset());
            assert!(lifted.unwrap()[0].len() >= path.day[0].len());
        }
    }

    #[test]
    fn noon_at_the_solstices_is_the_latitude_and_the_tilt() {
        let path = path(55.68, 12.57, "2026-06-21T12:00:00+02:00");
        let highest = |lines: &[Line]| {
            let all = lines.iter().flatten().copied();
            all.map(elevation).fold(f64::NEG_INFINITY, f64::max)
        };
        let noon = |tilt: f64| SunPosition::from_true(180.0, 90.0 - 55.68 + tilt);
        for (lines, tilt) in [
            (&path.june_solstice, 23.436),
            (&path.equinox, 0.0),
            (&path.december_solstice, -23.436),
        ] {
            let expected = noon(tilt).apparent_elevation_deg;
            // The equinox is within half a day of noon: 0.2°.
            let tolerance = if tilt == 0.0 { 0.2 } else { 0.02 };
            assert!((highest(lines) - expected).abs() < tolerance, "{tilt}");
        }
        assert_eq!(path.day, path.june_solstice);
    }

    #[test]
    fn polar_day_and_polar_night() {
        let summer = path(78.22, 15.65, "2026-06-21T12:00:00+02:00");
        assert_eq!(summer.polar, Some(Polar::Day));
        assert_eq!((summer.day.len(), summer.hours.len()), (1, 24));
        let line = &summer.day[0];
        assert!(
            line[0].angle_between(line[line.len() - 1]).to_degrees() < 0.1,
            "closed"
        );
        assert!(summer.events.sunrise.is_none() && summer.events.noon.is_some());
        assert!(summer.december_solstice.is_empty());
        let winter = path(78.22, 15.65, "2026-12-21T12:00:00+01:00");
        assert_eq!(winter.polar, Some(Polar::Night));
        assert!(winter.day.is_empty() && winter.hours.is_empty());
        let temperate = path(48.0, 15.65, "2026-12-21T12:00:00+01:00");
        assert_eq!(temperate.polar, None);
    }

    #[test]
    fn a_clock_far_from_the_place_cuts_the_day_in_two() {
        let path = path(55.7, 12.5, "2026-06-21T12:00:00-12:00");
        assert_eq!(path.day.len(), 2);
        let ends: Vec<f64> = path
            .day
            .iter()
            .flat_map(|l| [l[0], l[l.len() - 1]])
            .map(elevation)
            .collect();
        // Midnight at that offset, sunset, sunrise, midnight.
        assert!(ends[0] > 40.0 && ends[1].abs() < 1e-4 && ends[2].abs() < 1e-4 && ends[3] > 40.0);
    }

    #[test]
    fn hours_are_on_the_line_of_the_day() {
        let path = path(55.68, 12.57, "2026-09-03T12:00:00+02:00");
        let labels: Vec<_> = path.hours.iter().map(HourMark::label).collect();
        assert_eq!(labels.first().map(String::as_str), Some("7"), "{labels:?}");
        assert_eq!(labels.last().map(String::as_str), Some("19"), "{labels:?}");
        for mark in &path.hours {
            let off = angle_to(&path.day, mark.direction);
            assert!(off < 0.02, "{}: {off}°", mark.label());
            assert!((mark.direction.length() - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn the_noon_of_sydney_is_in_the_north() {
        let path = path(-33.87, 151.21, "2026-12-21T12:00:00+11:00");
        let noon = path.events.noon.expect("a noon");
        let sun = observer(-33.87, 151.21).sun(noon).unwrap();
        assert!(sun.z < 0.0 && elevation(sun) > 79.0, "{sun}");
        let turn = (azimuth(sun) + 180.0).rem_euclid(360.0) - 180.0;
        assert!(turn.abs() < 0.1, "{turn}");
        assert_eq!((noon.hour(), noon.minute() / 10), (12, 5));
    }

    #[test]
    fn the_seasons_are_the_almanacs() {
        // US Naval Observatory.
        for (year, march, june, december) in [
            (
                2026,
                "2026-03-20T14:46:00Z",
                "2026-06-21T08:24:00Z",
                "2026-12-21T20:50:00Z",
            ),
            (
                2024,
                "2024-03-20T03:06:00Z",
                "2024-06-20T20:51:00Z",
                "2024-12-21T09:21:00Z",
            ),
        ] {
            let seasons = Seasons::of(year).unwrap();
            for (ours, theirs) in [
                (seasons.march_equinox, march),
                (seasons.june_solstice, june),
                (seasons.december_solstice, december),
            ] {
                let theirs = DateTime::parse_from_rfc3339(theirs).unwrap();
                let off = (ours.fixed_offset() - theirs).num_minutes();
                println!("{ours}: {off} min");
                assert!(off.abs() <= 15, "{ours}, not {theirs}");
            }
        }
    }

    #[test]
    fn an_analemma_passes_through_the_hours_of_every_day() {
        let observer = observer(55.68, 12.57);
        let offset = FixedOffset::east_opt(3600).unwrap();
        let lines = observer.analemma(2026, offset, 12).unwrap();
        assert_eq!(lines.len(), 1, "noon is above the horizon all year");
        let closed = lines[0][0].angle_between(lines[0][lines[0].len() - 1]);
        assert!(closed.to_degrees() < 0.3);
        for month in 1..=12 {
            let day = NaiveDate::from_ymd_opt(2026, month, 17).unwrap();
            let marks = observer.hours(day, offset).unwrap();
            let noon = marks.iter().find(|m| m.label() == "12").unwrap();
            assert!(angle_to(&lines, noon.direction) < 0.1, "{month}");
        }
        let morning = observer.analemma(2026, offset, 6).unwrap();
        assert!(morning.iter().flatten().all(|d| d.y > -1e-6) && !morning.is_empty());
    }

    #[test]
    fn what_the_ephemeris_does_not_cover_is_an_error() {
        let offset = FixedOffset::east_opt(0).unwrap();
        for year in [-501, 3001, 262_000, -262_000] {
            let day = NaiveDate::from_ymd_opt(year, 6, 1).unwrap();
            assert!(observer(50.0, 10.0).day(day, offset).is_err(), "{year}");
            assert!(Seasons::of(year).is_err());
        }
        let june = NaiveDate::from_ymd_opt(2026, 6, 1).unwrap();
        assert!(observer(91.0, 10.0).day(june, offset).is_err());
    }
}
