//! The times of a day by the elevation of the sun: twilights, blue hour, golden hour.
//!
//! Elevations are those of the sun's centre without refraction. The sun's rise and set themselves are
//! [`super::sun_position::sun_events`].

use chrono::{DateTime, FixedOffset, NaiveDate};
use solar_positioning::Horizon;

use super::sun_position::{SunPositionError, events_at};

/// End of civil twilight, of nautical twilight and of astronomical twilight, degrees (American Meteorological Society,
/// Glossary of Meteorology).
pub const TWILIGHTS_DEG: [f64; 3] = [-6.0, -12.0, -18.0];

/// Blue hour, degrees: from the end of civil twilight to the golden hour, as photographers use the word; no standard has it.
pub const BLUE_HOUR_DEG: [f64; 2] = [-6.0, -4.0];

/// Golden hour, degrees, as photographers use the word; no standard has it.
pub const GOLDEN_HOUR_DEG: [f64; 2] = [-4.0, 6.0];

type Moment = Option<DateTime<FixedOffset>>;

/// The sun passes an elevation: upward and downward. On some days of high latitudes it does not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Passage {
    /// The elevation, degrees.
    pub elevation_deg: f64,
    /// First time upward.
    pub upward: Moment,
    /// First time downward.
    pub downward: Moment,
    /// Where the sun stays if it does not pass: above (true) or below.
    pub stays_above: Option<bool>,
}

/// A span of the morning and one of the evening.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spans {
    /// Begin and end in the morning; each `None` if the sun does not pass that elevation.
    pub morning: [Moment; 2],
    /// Begin and end in the evening.
    pub evening: [Moment; 2],
}

/// The times of one calendar day.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DayTimes {
    /// Civil, nautical and astronomical dawn and dusk: [`TWILIGHTS_DEG`].
    pub twilights: [Passage; 3],
    /// See [`BLUE_HOUR_DEG`].
    pub blue_hour: Spans,
    /// See [`GOLDEN_HOUR_DEG`].
    pub golden_hour: Spans,
}

impl DayTimes {
    /// The times of `date` at the UTC offset `offset`, by SPA.
    ///
    /// # Errors
    /// Coordinates out of range, or a year outside of [`super::sun_position::YEARS`].
    pub fn of(
        date: NaiveDate,
        offset: FixedOffset,
        latitude: f64,
        longitude: f64,
    ) -> Result<Self, SunPositionError> {
        let pass = |elevation_deg: f64| {
            let horizon = Horizon::Custom(elevation_deg);
            let day = events_at(date, offset, latitude, longitude, horizon)?;
            Ok::<_, SunPositionError>(Passage {
                elevation_deg,
                upward: day.rises.first().copied(),
                downward: day.sets.first().copied(),
                stays_above: match (day.always_above(), day.always_below()) {
                    (true, _) => Some(true),
                    (_, true) => Some(false),
                    _ => None,
                },
            })
        };
        let between = |[low, high]: [f64; 2]| {
            let (low, high) = (pass(low)?, pass(high)?);
            Ok::<_, SunPositionError>(Spans {
                morning: [low.upward, high.upward],
                evening: [high.downward, low.downward],
            })
        };
        let [civil, nautical, astronomical] = TWILIGHTS_DEG;
        Ok(Self {
            twilights: [pass(civil)?, pass(nautical)?, pass(astronomical)?],
            blue_hour: between(BLUE_HOUR_DEG)?,
            golden_hour: between(GOLDEN_HOUR_DEG)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::sun_position::{spa, sun_events};

    fn day(date: (i32, u32, u32), hours: i32, latitude: f64, longitude: f64) -> DayTimes {
        let date = NaiveDate::from_ymd_opt(date.0, date.1, date.2).unwrap();
        let offset = FixedOffset::east_opt(hours * 3600).unwrap();
        DayTimes::of(date, offset, latitude, longitude).unwrap()
    }

    #[test]
    fn every_time_has_its_elevation() {
        let (latitude, longitude) = (37.08, 15.29);
        let times = day((2026, 9, 24), 2, latitude, longitude);
        let check = |moment: Moment, elevation: f64| {
            let sun = spa(moment.unwrap(), latitude, longitude).unwrap();
            let error = sun.elevation_deg - elevation;
            assert!(error.abs() < 0.005, "{moment:?} {elevation} {error}");
        };
        for twilight in times.twilights {
            check(twilight.upward, twilight.elevation_deg);
            check(twilight.downward, twilight.elevation_deg);
        }
        for (spans, [low, high]) in [
            (times.blue_hour, BLUE_HOUR_DEG),
            (times.golden_hour, GOLDEN_HOUR_DEG),
        ] {
            check(spans.morning[0], low);
            check(spans.morning[1], high);
            check(spans.evening[0], high);
            check(spans.evening[1], low);
        }
    }

    #[test]
    fn the_times_follow_each_other() {
        let times = day((2026, 3, 20), 0, 51.48, 0.0);
        let date = NaiveDate::from_ymd_opt(2026, 3, 20).unwrap();
        let sun = sun_events(date, FixedOffset::east_opt(0).unwrap(), 51.48, 0.0).unwrap();
        let [civil, nautical, astronomical] = times.twilights;
        let morning = [
            astronomical.upward,
            nautical.upward,
            civil.upward,
            times.blue_hour.morning[1],
            sun.sunrise,
            times.golden_hour.morning[1],
            sun.noon,
            times.golden_hour.evening[0],
            sun.sunset,
            times.golden_hour.evening[1],
            civil.downward,
            nautical.downward,
            astronomical.downward,
        ];
        assert!(morning.iter().all(Option::is_some));
        assert!(morning.is_sorted(), "{morning:?}");
    }

    #[test]
    fn a_northern_summer_has_no_night_and_a_northern_winter_a_noon_twilight() {
        // Copenhagen in June: nautical dusk, no astronomical one.
        let [civil, nautical, astronomical] = day((2026, 6, 21), 2, 55.68, 12.57).twilights;
        assert!(civil.upward.is_some() && civil.stays_above.is_none());
        assert_eq!(nautical.stays_above, Some(true));
        assert_eq!(astronomical.stays_above, Some(true));
        // Longyearbyen at Christmas: the sun stays below -6°, above -12° at noon.
        let [civil, nautical, _] = day((2026, 12, 24), 1, 78.22, 15.65).twilights;
        assert_eq!((civil.upward, civil.stays_above), (None, Some(false)));
        assert!(nautical.upward.is_some());
    }
}
