//! The clock of the window: advances the time of the sun.

use chrono::{Datelike, TimeDelta};

use crate::daylight::place::Place;
use crate::daylight::sun_position::YEARS;
use crate::options::SunInput;

/// Selectable speeds, and their labels: seconds of sun time per second of real time.
pub(super) const SPEEDS: [(f64, &str); 4] = [
    (60.0, "1 min/s"),
    (600.0, "10 min/s"),
    (3600.0, "1 h/s"),
    (86_400.0, "1 day/s"),
];

/// State of the clock.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Clock {
    runs: bool,
    /// Speed, seconds of sun time per second of real time.
    pub(super) speed: f64,
}

impl Default for Clock {
    fn default() -> Self {
        Self {
            runs: false,
            speed: 600.0,
        }
    }
}

impl Clock {
    /// Starts or stops the clock.
    pub(super) fn toggle(&mut self) {
        self.runs = !self.runs;
    }

    /// Whether it runs.
    pub(super) fn is_on(&self) -> bool {
        self.runs
    }

    /// Whether it runs and moves this sun. A sun given as a direction has no time.
    pub(super) fn is_running(&self, sun: &SunInput) -> bool {
        self.runs && !matches!(sun, SunInput::Direction { .. })
    }
}

/// Shifts the time of the sun by `seconds`, within [`YEARS`]; a sun given as a direction is unchanged. If the UTC offset is that
/// of the place, it follows daylight saving time.
pub(in crate::commands::view) fn shift(sun: &mut SunInput, seconds: f64) {
    match sun {
        SunInput::Place {
            latitude,
            longitude,
            when,
        } => {
            let (latitude, longitude) = (*latitude, *longitude);
            let zone = Place {
                latitude,
                longitude,
            }
            .zone();
            let later = when.checked_add_signed(TimeDelta::milliseconds((seconds * 1e3) as i64));
            if let Some(later) = later.filter(|later| YEARS.contains(&later.year())) {
                *when = if zone.has_offset_of(*when) {
                    zone.clock(later)
                } else {
                    later
                };
            }
        }
        SunInput::Solar { day, hours, .. } => {
            let total = *hours + seconds / 3600.0;
            let days = total.div_euclid(24.0) as i64;
            *hours = total.rem_euclid(24.0);
            *day = (i64::from(*day) - 1 + days).rem_euclid(365) as u32 + 1;
        }
        SunInput::Direction { .. } => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_year_of_solar_days_has_an_end_and_a_beginning() {
        let mut sun = SunInput::Solar {
            day: 365,
            hours: 23.5,
            latitude: 50.0,
        };
        shift(&mut sun, 3600.0);
        let SunInput::Solar { day, hours, .. } = sun else {
            panic!("{sun:?}")
        };
        assert_eq!(day, 1);
        assert!((hours - 0.5).abs() < 1e-9);
        shift(&mut sun, -3600.0);
        let SunInput::Solar { day, hours, .. } = sun else {
            panic!("{sun:?}")
        };
        assert_eq!(day, 365);
        assert!((hours - 23.5).abs() < 1e-9);
    }

    #[test]
    fn the_clock_keeps_summer_time_where_it_shows_the_time_of_the_place() {
        let shifted = |when: &str, seconds: f64| {
            let mut sun = SunInput::Place {
                latitude: 55.79,
                longitude: 12.52,
                when: chrono::DateTime::parse_from_rfc3339(when).expect("a moment"),
            };
            shift(&mut sun, seconds);
            let SunInput::Place { when, .. } = sun else {
                panic!("{sun:?}")
            };
            when.to_rfc3339()
        };
        let day = 86_400.0;
        assert_eq!(
            shifted("2026-10-24T15:00:00+02:00", day),
            "2026-10-25T14:00:00+01:00"
        );
        // Any other UTC offset is kept.
        assert_eq!(
            shifted("2026-10-24T15:00:00+05:00", day),
            "2026-10-25T15:00:00+05:00"
        );
        let last = "3000-12-31T23:00:00+01:00";
        assert_eq!(shifted(last, day), last);
    }

    #[test]
    fn time_passes_only_while_the_clock_runs() {
        let when = chrono::DateTime::parse_from_rfc3339("2026-06-21T23:00:00+02:00");
        let start = SunInput::Place {
            latitude: 0.0,
            longitude: 0.0,
            when: when.expect("a moment"),
        };
        let (mut clock, mut sun) = (Clock::default(), start);
        assert!(!clock.is_running(&sun));
        clock.toggle();
        assert!(clock.is_running(&sun));
        shift(&mut sun, 12.0 * clock.speed);
        let SunInput::Place { when, .. } = sun else {
            panic!("{sun:?}")
        };
        assert_eq!(when.to_rfc3339(), "2026-06-22T01:00:00+02:00");
    }
}
