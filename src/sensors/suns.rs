//! Suns of a year that stand for all: the exact suns of every hour of the clock on each eighth day.
//!
//! What a sun gives by reflection changes smoothly from day to day: the sun of an hour moves by at most 0.4° a day. Between two of these
//! days it is interpolated linearly.

use std::collections::BTreeMap;

use chrono::{Datelike, Duration, NaiveDate};
use glam::Vec3;

use crate::daylight::lit_hours::LitHour;
use crate::daylight::sun_position::direction;
use crate::daylight::weather::Weather;
use crate::scene::{Bundle, LANES};

/// Days from one of the suns to the next of the same hour.
const DAYS: u32 = 8;

/// Least elevation of these suns, degrees: of one below the horizon the neighbours need the limit at the horizon.
const LOWEST_DEG: f64 = 0.1;

/// Suns of a year.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Suns {
    /// Unit vectors toward them.
    pub directions: Vec<Vec3>,
    /// The same, eight neighbours at a time.
    pub bundles: Vec<Bundle>,
    /// Of each lit hour with sun the two suns between which it lies, and the share of the second.
    pub of_hour: Vec<Option<([usize; 2], f32)>>,
}

impl Suns {
    /// Those that the hours of a file need.
    pub fn new(weather: &Weather, lit: &[LitHour]) -> Self {
        let mut numbers: BTreeMap<(i64, u32), usize> = BTreeMap::new();
        let mut directions = Vec::new();
        let first = NaiveDate::from_ymd_opt(weather.year(), 1, 1).unwrap_or_default();
        let mut sun = |hour: f64, step: u32| {
            // The same times of day differ by rounding at most.
            let key = ((hour * 3600.0).round() as i64, step);
            *numbers.entry(key).or_insert_with(|| {
                let date = first + Duration::days(i64::from(step * DAYS));
                let at = weather.sun_at(weather.moment_on(date, hour));
                let toward = direction(at.azimuth_deg, at.elevation_deg.max(LOWEST_DEG));
                directions.push(toward.as_vec3());
                directions.len() - 1
            })
        };
        let of_hour = lit.iter().map(|lit| {
            let record = &weather.records[lit.record];
            let day = weather.moment_on(first, 12.0).with_month(record.month);
            let day = day.and_then(|day| day.with_day(record.day));
            let day = day.map_or(0, |day| day.ordinal0());
            (lit.sun_lux > 0.0).then(|| {
                let step = day / DAYS;
                let share = (day % DAYS) as f32 / DAYS as f32;
                let before = sun(record.hour, step);
                // On the day itself no second sun is needed.
                let after = if share > 0.0 {
                    sun(record.hour, step + 1)
                } else {
                    before
                };
                ([before, after], share)
            })
        });
        let mut suns = Self {
            of_hour: of_hour.collect(),
            directions,
            bundles: Vec::new(),
        };
        suns.order(numbers);
        suns
    }

    /// Puts them into bundles of neighbours: by the hour of the clock, then by elevation.
    fn order(&mut self, numbers: BTreeMap<(i64, u32), usize>) {
        let height = |number: usize| self.directions[number].y;
        let mut order: Vec<(i64, usize)> = numbers
            .into_iter()
            .map(|((hour, _), number)| (hour, number))
            .collect();
        order.sort_by(|a, b| a.0.cmp(&b.0).then(height(a.1).total_cmp(&height(b.1))));
        let mut place = vec![0; order.len()];
        for (at, (_, number)) in order.iter().enumerate() {
            place[*number] = at;
        }
        let ordered = order.iter().map(|(_, number)| self.directions[*number]);
        self.directions = ordered.collect();
        self.bundles = self.directions.chunks(LANES).map(Bundle::new).collect();
        let hours = self.of_hour.iter_mut().flatten();
        hours.for_each(|(suns, _)| *suns = suns.map(|sun| place[sun]));
    }
}
