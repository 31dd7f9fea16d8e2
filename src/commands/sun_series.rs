//! The suns of `--show sun-hours`: those of `--sun-dates`, every `--sun-step` minutes, in an order of which any part is spread over all of them.

use chrono::{Datelike, FixedOffset};
use glam::Vec3;

use crate::daylight::false_colour::Range;
use crate::daylight::place::Place;
use crate::daylight::sun_hours::{Site, SunDates};
use crate::error::{Error, Result};
use crate::options::{Options, Show};

/// Suns, each a moment of the dates.
#[derive(Debug, Clone, PartialEq)]
pub struct SunSeries {
    key: Key,
    /// Unit vectors toward their centres, without refraction; at least one.
    directions: Vec<Vec3>,
    /// What all of them stand for, hours.
    pub hours: f64,
}

/// What the suns are of: place, clock, year, dates, step.
type Key = ([u64; 2], FixedOffset, i32, SunDates, u32);

fn key(settings: &Options) -> Result<(Key, Place)> {
    let what = "--show sun-hours needs a place; give --place instead of a direction or solar time";
    let place = settings.sun.place();
    let (latitude, longitude, when) = place.ok_or_else(|| Error::usage(what))?;
    let place = Place {
        latitude,
        longitude,
    };
    let bits = [latitude, longitude].map(f64::to_bits);
    let dates = settings.sun_dates.clone();
    let key = (bits, *when.offset(), when.year(), dates, settings.sun_step);
    Ok((key, place))
}

impl SunSeries {
    /// Those of the options; `None` if hours of sun are not shown. `before`: those of earlier options, which may be the same.
    ///
    /// # Errors
    /// No place, a date that does not exist, or dates without a sun.
    pub fn of(settings: &Options, before: Option<Self>) -> Result<Option<Self>> {
        if settings.show != Show::SunHours {
            return Ok(None);
        }
        let (key, place) = key(settings)?;
        if let Some(before) = before.filter(|before| before.key == key) {
            return Ok(Some(before));
        }
        let (_, zone, year, dates, step) = &key;
        let site = Site {
            place,
            zone: *zone,
            year: *year,
        };
        let mut suns = Vec::new();
        for date in &dates.0 {
            let of_date = site.suns_every(*date, 0.0, i64::from(*step))?;
            let of_date = of_date
                .ok_or_else(|| Error::usage(format!("--sun-dates: {year} has no {date}")))?;
            suns.extend(of_date.suns.iter().map(|sun| sun.as_vec3()));
        }
        if suns.is_empty() {
            return Err(Error::usage(format!(
                "the sun is not up on {dates}; choose other --sun-dates"
            )));
        }
        Ok(Some(Self {
            hours: suns.len() as f64 * f64::from(*step) / 60.0,
            directions: spread(&suns),
            key,
        }))
    }

    /// How many frames have each sun equally often, at least as many as `samples`.
    pub fn frames(&self, samples: u32) -> u32 {
        let count = self.directions.len() as u32;
        // The mean of a single frame would be that frame.
        samples.max(2).div_ceil(count) * count
    }

    /// The sun of frame number `index`.
    pub fn direction(&self, index: u32) -> Vec3 {
        self.directions[index as usize % self.directions.len()]
    }

    /// Range of the colours: from 0 to whole hours, and of many days to two digits.
    pub fn range(&self) -> Range {
        let digit = 10f64.powf(self.hours.log10().floor() - 1.0).max(1.0);
        Range {
            min: 0.0,
            max: (self.hours / digit).ceil() * digit,
        }
    }
}

/// Every n-th of a list, around its end, for an n near the golden section of its length that meets all.
fn spread(suns: &[Vec3]) -> Vec<Vec3> {
    let count = suns.len();
    let gcd = |mut a: usize, mut b: usize| {
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let golden = (count as f64 * 0.618_034) as usize;
    let step = (golden.max(1)..).find(|step| gcd(*step, count) == 1);
    let step = step.unwrap_or(1);
    (0..count).map(|at| suns[at * step % count]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::OptionValues;
    use crate::options::tests::scene;

    fn series(pairs: &[(&str, &str)]) -> Result<Option<SunSeries>> {
        let user = OptionValues::from(pairs);
        let settings = Options::resolve(&user, &scene(&[])).expect("options");
        SunSeries::of(&settings, None)
    }

    #[test]
    fn every_sun_is_there_once_and_early_ones_are_spread() {
        for count in [1, 2, 3, 7, 12, 144] {
            let suns: Vec<Vec3> = (0..count).map(|at| Vec3::splat(at as f32)).collect();
            let mut places: Vec<f32> = spread(&suns).iter().map(|sun| sun.x).collect();
            let first: f32 = places.iter().take(8).sum();
            if count == 144 {
                // Within a tenth of the day of its middle.
                assert!((first / 8.0 - 71.5).abs() < 14.4, "{places:?}");
            }
            places.sort_by(f32::total_cmp);
            assert!(places.iter().zip(0..).all(|(x, at)| *x == at as f32));
        }
    }

    #[test]
    fn a_day_at_the_equator_has_twelve_hours() {
        let place = ("place", "0,0");
        let shown = ("show", "sun-hours");
        let day = series(&[place, shown, ("sun-dates", "3-21")]).expect("suns");
        let day = day.expect("they are shown");
        assert!((day.hours - 12.0).abs() < 0.2, "{}", day.hours);
        assert_eq!((day.range().min, day.range().max), (0.0, day.hours.ceil()));
        let count = (day.hours * 6.0).round() as u32;
        assert_eq!((day.frames(1), day.frames(count + 1)), (count, 2 * count));
        let two = series(&[place, shown, ("sun-dates", "3-21,9-23")]).expect("suns");
        assert!((two.expect("suns").hours - 24.0).abs() < 0.4);
        assert_eq!(series(&[place]).expect("none"), None);
        let line = |pairs: &[(&str, &str)]| series(pairs).expect_err("no suns").to_string();
        let night = line(&[("place", "80,0"), shown, ("sun-dates", "12-21")]);
        assert!(night.contains("not up on 12-21"), "{night}");
        let direction = line(&[("sun", "180,40"), shown]);
        assert!(direction.contains("needs a place"), "{direction}");
        let leap = line(&[place, shown, ("sun-dates", "2-29")]);
        assert!(leap.contains("2026 has no 2-29"), "{leap}");
    }
}
