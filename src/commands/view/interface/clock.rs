//! The clock that advances the time of day.

use chrono::TimeDelta;

use crate::settings::SunInput;

/// Speeds to choose from: simulated seconds per second.
pub(super) const SPEEDS: [(f64, &str); 4] = [
    (60.0, "1 min/s"),
    (600.0, "10 min/s"),
    (3600.0, "1 h/s"),
    (86_400.0, "1 day/s"),
];

/// Whether and how fast the time of day advances.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Clock {
    runs: bool,
    /// Simulated seconds per second.
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

    /// Whether the clock is running.
    pub(super) fn is_on(&self) -> bool {
        self.runs
    }

    /// Whether the clock moves this sun; a direction has no time.
    pub(super) fn is_running(&self, sun: &SunInput) -> bool {
        self.runs && !matches!(sun, SunInput::Direction { .. })
    }

    /// Advances the sun's time by `seconds` of real time.
    pub(super) fn advance(&self, sun: &mut SunInput, seconds: f64) {
        if self.is_running(sun) {
            shift(sun, seconds * self.speed);
        }
    }
}

/// Shifts the sun's time by `seconds`; a direction does not change.
pub(in crate::commands::view) fn shift(sun: &mut SunInput, seconds: f64) {
    match sun {
        SunInput::Place { when, .. } => {
            let milliseconds = (seconds * 1e3) as i64;
            if let Some(later) = when.checked_add_signed(TimeDelta::milliseconds(milliseconds)) {
                *when = later;
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
    fn time_passes_only_while_the_clock_runs() {
        let when = chrono::DateTime::parse_from_rfc3339("2026-06-21T23:00:00+02:00");
        let start = SunInput::Place {
            latitude: 0.0,
            longitude: 0.0,
            when: when.expect("a moment"),
        };
        let (mut clock, mut sun) = (Clock::default(), start);
        clock.advance(&mut sun, 12.0);
        assert_eq!(sun, start);
        clock.toggle();
        clock.advance(&mut sun, 12.0);
        let SunInput::Place { when, .. } = sun else {
            panic!("{sun:?}")
        };
        assert_eq!(when.to_rfc3339(), "2026-06-22T01:00:00+02:00");
    }
}
