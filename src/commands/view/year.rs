//! The hours of a weather file in the window: which one is shown, and steps through them.

use std::ops::Range;
use std::sync::Arc;

use chrono::{Datelike as _, Timelike as _};

use crate::commands::hour::HourLight;
use crate::daylight::place::Place;
use crate::daylight::sky::SkyModel;
use crate::daylight::weather::{Record, Weather};
use crate::options::{Options, SunInput};

use super::keys::Steps;

/// The hours of a weather file.
pub(super) struct Year {
    pub(super) weather: Arc<Weather>,
    /// Records of each day.
    days: Vec<Range<usize>>,
    /// Number of the record that was shown last.
    last: usize,
    /// Time of the sun that has passed in it, seconds.
    passed: f64,
}

impl Year {
    /// Of a file; the options are those that a window opens with.
    pub(super) fn new(weather: Arc<Weather>, settings: &Options) -> Self {
        let date = |record: &Record| (record.month, record.day);
        let mut days: Vec<Range<usize>> = Vec::new();
        for (at, record) in weather.records.iter().enumerate() {
            match days.last_mut() {
                Some(day) if date(&weather.records[day.start]) == date(record) => day.end = at + 1,
                _ => days.push(at..at + 1),
            }
        }
        let mut year = Self {
            weather,
            days,
            last: 0,
            passed: 0.0,
        };
        year.last = year.shown(settings).unwrap_or_default();
        year
    }

    /// Whether place, sun and sky are those of an hour of the file.
    pub(super) fn is_shown(&self, settings: &Options) -> bool {
        self.shown(settings).is_some()
    }

    /// Number of the record whose place, sun and sky the options have.
    pub(super) fn shown(&self, settings: &Options) -> Option<usize> {
        let (latitude, longitude, when) = settings.sun.place()?;
        let is_of = |record: &Record| {
            HourLight::of(&self.weather, record).is_some_and(|light| {
                light.place
                    == Place {
                        latitude,
                        longitude,
                    }
                    && light.when == when
                    && settings.sky == SkyModel::Perez
                    && settings.dni == Some(light.dni)
                    && settings.dhi == Some(light.dhi)
                    && settings.dew_point == light.dew_point
            })
        };
        // Most often the same as before; else the only one at that time.
        let records = &self.weather.records;
        if records.get(self.last).is_some_and(is_of) {
            return Some(self.last);
        }
        let local = when.with_timezone(self.weather.moment(records.first()?).offset());
        let hour = f64::from(local.num_seconds_from_midnight()) / 3600.0;
        let is_then = |r: &Record| {
            (r.month, r.day) == (local.month(), local.day()) && (r.hour - hour).abs() < 1e-3
        };
        let at = records.iter().position(is_then)?;
        is_of(&records[at]).then_some(at)
    }

    /// Number of the record that was shown last.
    pub(super) fn last(&self) -> usize {
        self.last
    }

    /// The days, by their records.
    pub(super) fn days(&self) -> &[Range<usize>] {
        &self.days
    }

    /// Number of the day of a record.
    pub(super) fn day_of(&self, record: usize) -> usize {
        self.days.partition_point(|day| day.end <= record)
    }

    /// Shows a record; whether it has the irradiances for that.
    pub(super) fn show(&mut self, settings: &mut Options, record: usize) -> bool {
        let light = self.weather.records.get(record);
        let Some(light) = light.and_then(|record| HourLight::of(&self.weather, record)) else {
            return false;
        };
        settings.sun = SunInput::Place {
            latitude: light.place.latitude,
            longitude: light.place.longitude,
            when: light.when,
        };
        settings.sky = SkyModel::Perez;
        settings.dni = Some(light.dni);
        settings.dhi = Some(light.dhi);
        settings.dew_point = light.dew_point;
        (self.last, self.passed) = (record, 0.0);
        true
    }

    /// Steps from the record that is shown, around the end of the year. Hours without irradiances are passed over.
    pub(super) fn step(&mut self, settings: &mut Options, steps: Steps) {
        let count = self.weather.records.len() as i64;
        let from = self.shown(settings).unwrap_or(self.last) as i64;
        let mut by = match steps {
            Steps::Hours(hours) => hours,
            Steps::Days(days) => days * (24.0 / self.weather.step_hours).round() as i64,
        };
        for _ in 0..count {
            if self.show(settings, (from + by).rem_euclid(count) as usize) {
                return;
            }
            by += by.signum();
        }
    }

    /// Lets `seconds` of the sun's time pass, less than a year: the next records follow when theirs have.
    pub(super) fn advance(&mut self, settings: &mut Options, seconds: f64) {
        let step = self.weather.step_hours * 3600.0;
        let passed = self.passed + seconds;
        let steps = (passed / step).floor();
        if steps > 0.0 {
            self.step(settings, Steps::Hours(steps as i64));
        }
        self.passed = passed - steps * step;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::OptionValues;
    use crate::options::tests::scene;

    /// Three days, hour by hour; the irradiances of the second noon are missing.
    fn year() -> (Year, Options) {
        let mut text = "LOCATION,Havnby,-,DNK,made,0,55.1,8.6,1.0,4.0\nDATA PERIODS,1,1,Data,Sunday, 6/20, 6/22\n".to_owned();
        for at in 0..72 {
            let (day, hour) = (20 + at / 24, at % 24 + 1);
            let diffuse = if at == 36 { 9999 } else { 100 + at };
            text += &format!(
                "2001,6,{day},{hour},0,?,15,9,70,101300,0,0,300,9999,0,{diffuse},0,0,0,0,0,0,0,0,20\n"
            );
        }
        let weather = Arc::new(Weather::parse(&text, false).expect("a file"));
        let settings = Options::resolve(&OptionValues::default(), &scene(&[])).expect("options");
        (Year::new(weather, &settings), settings)
    }

    #[test]
    fn a_record_is_shown_until_something_else_is_asked_for() {
        let (mut year, mut settings) = year();
        assert!(!year.is_shown(&settings));
        assert!(year.show(&mut settings, 12) && !year.show(&mut settings, 36));
        assert_eq!(year.shown(&settings), Some(12));
        assert_eq!((settings.dni, settings.dhi), (Some(0.0), Some(112.0)));
        let (_, _, when) = settings.sun.place().expect("a place");
        assert_eq!(when.to_rfc3339(), "2019-06-20T12:30:00+01:00");
        settings.dhi = Some(50.0);
        assert!(!year.is_shown(&settings));
    }

    #[test]
    fn steps_pass_over_what_is_missing_and_around_the_end() {
        let (mut year, mut settings) = year();
        let mut after = |from, steps| {
            year.show(&mut settings, from);
            year.step(&mut settings, steps);
            year.shown(&settings)
        };
        assert_eq!(after(12, Steps::Hours(1)), Some(13));
        assert_eq!(after(12, Steps::Days(1)), Some(37));
        assert_eq!(after(60, Steps::Days(-1)), Some(35));
        assert_eq!(after(71, Steps::Hours(1)), Some(0));
        assert_eq!(year.days().len(), 3);
        assert_eq!(
            [0, 23, 24, 71].map(|record| year.day_of(record)),
            [0, 0, 1, 2]
        );
    }

    #[test]
    fn an_hour_is_shown_until_it_has_passed() {
        let (mut year, mut settings) = year();
        year.show(&mut settings, 5);
        for _ in 0..3 {
            year.advance(&mut settings, 1000.0);
        }
        assert_eq!(year.shown(&settings), Some(5));
        year.advance(&mut settings, 1000.0);
        assert_eq!(year.shown(&settings), Some(6));
        year.advance(&mut settings, 7200.0);
        assert_eq!(year.shown(&settings), Some(8));
    }
}
