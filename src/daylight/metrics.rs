//! Annual metrics of daylight from the illuminances of a sensor, hour by hour.
//!
//! Daylight autonomy DA_T: share of the occupied hours with T lux or more (Reinhart & Walkenhorst 2001). Continuous: the mean of
//! min(E/T, 1) (Rogers 2006). Useful daylight illuminance: shares below 100, from 100 to below 300, from 300 to 3000 and above 3000 lux
//! (Mardaljevic 2012). Spatial daylight autonomy sDA300/50 and annual sunlight exposure ASE1000,250: IES LM-83-12. EN 17037:2018, method 2:
//! the half of the year's hours with most diffuse light.

use std::str::FromStr;

use super::lit_hours::LitHour;
use super::weather::Weather;

/// Direct sun that annual sunlight exposure counts, lux: more than this (IES LM-83-12, 3.2.6).
pub const EXPOSED_LUX: f64 = 1000.0;
/// Hours of it in a year that a point may have (IES LM-83-12, 3.3).
pub const EXPOSED_HOURS: f64 = 250.0;
/// Threshold of spatial daylight autonomy, lux (IES LM-83-12, 2.1).
pub const SPATIAL_LUX: f64 = 300.0;
/// Daylight autonomy from which a point counts for it, percent.
pub const SPATIAL_PERCENT: f64 = 50.0;
/// Hours of EN 17037, method 2: half of a year.
pub const EN_17037_HOURS: f64 = 4380.0;
/// Illuminances that it asks for, lux: minima and targets.
pub const EN_17037_LUX: [f64; 4] = [100.0, 300.0, 500.0, 750.0];
/// Borders of useful daylight illuminance, lux.
const USEFUL_LUX: [f64; 3] = [100.0, 300.0, 3000.0];

/// Occupied hours of every day, by the clock of the weather file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Schedule {
    /// First hour, 0..24.
    pub from: f64,
    /// End, above `from`, up to 24.
    pub to: f64,
}

impl Default for Schedule {
    /// 8:00 to 18:00, every day: 3 650 hours (IES LM-83-12, 2.2.2).
    fn default() -> Self {
        Self {
            from: 8.0,
            to: 18.0,
        }
    }
}

impl Schedule {
    /// Whether an interval with this middle is occupied.
    pub fn holds(&self, middle: f64) -> bool {
        (self.from..self.to).contains(&middle)
    }
}

impl std::fmt::Display for Schedule {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}-{}", self.from, self.to)
    }
}

impl FromStr for Schedule {
    type Err = String;

    /// `8-18`, in hours.
    fn from_str(text: &str) -> Result<Self, String> {
        let (from, to) = text.split_once('-').ok_or_else(schedule_form)?;
        let hour = |word: &str| word.trim().parse::<f64>().map_err(|_| schedule_form());
        let schedule = Self {
            from: hour(from)?,
            to: hour(to)?,
        };
        let is_right = schedule.from >= 0.0 && schedule.from < schedule.to && schedule.to <= 24.0;
        is_right.then_some(schedule).ok_or_else(schedule_form)
    }
}

fn schedule_form() -> String {
    "write the first hour and the end, for instance 8-18".to_owned()
}

/// Whether blinds are closed against the sun.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Blinds {
    /// There are none.
    #[default]
    None,
    /// Those of a room are one group, closed in every hour in which more than 2 % of its points have 1000 lux of direct sun or more (IES LM-83-12,
    /// 2.2.6).
    Lm83,
}

/// When blinds are closed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Closings {
    /// Number of the room of each point.
    pub room_of: Vec<usize>,
    /// Of each room and lit hour, whether its blinds are closed.
    pub closed: Vec<Vec<bool>>,
}

/// Direct sun from which a point asks for closed blinds, lux (IES LM-83-12, 2.2.6).
pub const BLINDS_LUX: f64 = 1000.0;
/// Share of the points above which they are closed.
pub const BLINDS_SHARE: f64 = 0.02;
/// What closed blinds leave of all light: 5 %, diffuse, which LM-83-12 is said to give blinds that are not specified; honeybee-radiance-postprocess
/// takes 2 %.
pub const CLOSED_BLINDS: f64 = 0.05;

/// Which hours count, and thresholds: what turns a year of illuminances into metrics.
/// The default has no hours: no values.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Measures {
    /// Thresholds of daylight autonomy, lux.
    pub thresholds: Vec<f64>,
    /// Of each lit hour, whether it is occupied.
    occupied: Vec<bool>,
    /// Occupied intervals, dark ones too.
    occupied_count: usize,
    /// Of each lit hour, whether it is among those of EN 17037.
    brightest: Vec<bool>,
    /// Intervals of EN 17037.
    brightest_count: usize,
    /// Intervals of the file.
    count: usize,
    /// Length of an interval, hours.
    step_hours: f64,
    /// When blinds are closed; without rooms there are none.
    blinds: Closings,
}

impl Measures {
    /// For the hours `lit` of a file.
    ///
    /// # Errors
    /// A schedule in which the file has no hours.
    pub fn new(
        weather: &Weather,
        lit: &[LitHour],
        schedule: Schedule,
        thresholds: Vec<f64>,
    ) -> Result<Self, String> {
        let records = &weather.records;
        let is_occupied = |record: usize| schedule.holds(records[record].hour);
        let occupied_count = (0..records.len()).filter(|r| is_occupied(*r)).count();
        if occupied_count == 0 {
            return Err(format!("the weather file has no hours from {schedule}"));
        }
        let most = (EN_17037_HOURS / weather.step_hours).round() as usize;
        let brightest_count = most.min(records.len());
        let mut order: Vec<usize> = (0..records.len()).collect();
        let diffuse = |record: &usize| records[*record].diffuse_w.unwrap_or_default();
        // The sort is stable: of equal hours the earlier ones count.
        order.sort_by(|a, b| diffuse(b).total_cmp(&diffuse(a)));
        let mut is_bright = vec![false; records.len()];
        order[..brightest_count]
            .iter()
            .for_each(|r| is_bright[*r] = true);
        Ok(Self {
            thresholds,
            occupied: lit.iter().map(|hour| is_occupied(hour.record)).collect(),
            occupied_count,
            brightest: lit.iter().map(|hour| is_bright[hour.record]).collect(),
            brightest_count,
            count: records.len(),
            step_hours: weather.step_hours,
            blinds: Closings::default(),
        })
    }

    /// Closes blinds, for the shares of the occupied hours: DA, cDA, UDI. Not for EN 17037, means and exposure, of which no definition knows
    /// blinds.
    pub fn close_blinds(&mut self, blinds: Closings) {
        self.blinds = blinds;
    }

    /// Occupied hours with closed blinds, of each room.
    pub fn closed_hours(&self) -> Vec<f64> {
        let of_room = |closed: &Vec<bool>| {
            let both = closed.iter().zip(&self.occupied);
            let both = both.filter(|(closed, occupied)| **closed && **occupied);
            both.count() as f64 * self.step_hours
        };
        self.blinds.closed.iter().map(of_room).collect()
    }

    /// Occupied hours of the file.
    pub fn occupied_hours(&self) -> f64 {
        self.occupied_count as f64 * self.step_hours
    }

    /// Hours with the illuminance of EN 17037 from which a point has it: half of those that count.
    pub fn en17037_hours(&self) -> f64 {
        0.5 * self.brightest_count as f64 * self.step_hours
    }

    /// Median of the light of the sky on open ground in the hours of EN 17037, lux: what its daylight factors are derived from.
    pub fn median_diffuse_lux(&self, lit: &[LitHour]) -> f64 {
        let hours = lit.iter().zip(&self.brightest).filter(|(_, is)| **is);
        let mut lux: Vec<f64> = hours.map(|(hour, _)| hour.sky_lux).collect();
        // Hours without light count, too.
        lux.resize(self.brightest_count.max(1), 0.0);
        lux.sort_by(f64::total_cmp);
        0.5 * (lux[(lux.len() - 1) / 2] + lux[lux.len() / 2])
    }

    /// Names of the values of [`Measures::values`].
    pub fn names(&self) -> Vec<String> {
        if self.count == 0 {
            return Vec::new();
        }
        let autonomy = |kind: &str| {
            let names = self.thresholds.iter().map(|lux| format!("{kind}{lux}"));
            names.collect::<Vec<_>>()
        };
        let useful = ["udi_low", "udi_sup", "udi_aut", "udi_high"].map(str::to_owned);
        let hours = EN_17037_LUX.map(|lux| format!("en17037_hours_ge{lux}"));
        let mut names = [autonomy("da"), autonomy("cda")].concat();
        names.extend(useful);
        names.extend(hours);
        names.push("mean_lux".to_owned());
        names
    }

    /// The metrics of point number `at` with these illuminances in the lit hours, lux: DA and cDA at each threshold and UDI, percent of the
    /// occupied hours; hours of EN 17037; mean of all hours, lux.
    pub fn values(&self, lux: &[f32], at: usize) -> Vec<f64> {
        if self.count == 0 {
            return Vec::new();
        }
        let occupied = self.behind_blinds(lux, at);
        let percent = |sum: f64| 100.0 * sum / self.occupied_count as f64;
        let at_least = |list: &[f64], limit: f64| list.iter().filter(|e| **e >= limit).count();
        let share = |limit: f64| percent(at_least(&occupied, limit) as f64);
        let mut values: Vec<f64> = self.thresholds.iter().map(|t| share(*t)).collect();
        values.extend(
            self.thresholds.iter().map(|threshold| {
                percent(occupied.iter().map(|lux| (lux / threshold).min(1.0)).sum())
            }),
        );
        let above = occupied.iter().filter(|lux| **lux > USEFUL_LUX[2]).count();
        let (some, enough, high) = (
            share(USEFUL_LUX[0]),
            share(USEFUL_LUX[1]),
            percent(above as f64),
        );
        values.extend([100.0 - some, some - enough, enough - high, high]);
        let bright = self.counted(&self.brightest, lux);
        values.extend(EN_17037_LUX.map(|t| at_least(&bright, t) as f64 * self.step_hours));
        values.push(lux.iter().map(|e| f64::from(*e)).sum::<f64>() / self.count as f64);
        values
    }

    /// What the standard error of a value is relative to: 100 for percentages, all hours for hours, the value itself for illuminances and for
    /// the daylight factor, which follows the values, but at least 10 lux and 0.1 %.
    pub fn error_scale(&self, number: usize, value: f64) -> f64 {
        if self.count == 0 {
            return value.max(0.1);
        }
        let percentages = 2 * self.thresholds.len() + 4;
        match number.checked_sub(percentages) {
            None => 100.0,
            Some(0..4) => self.brightest_count as f64 * self.step_hours,
            Some(4) => value.max(10.0),
            Some(_) => value.max(0.1),
        }
    }

    /// Hours with more than [`EXPOSED_LUX`] of direct sun.
    pub fn exposed_hours(&self, sun_lux: &[f32]) -> f64 {
        let occupied = self.counted(&self.occupied, sun_lux);
        let exposed = occupied.iter().filter(|lux| **lux > EXPOSED_LUX);
        exposed.count() as f64 * self.step_hours
    }

    /// The illuminances of the occupied hours at a point, through closed blinds where they are.
    fn behind_blinds(&self, lux: &[f32], at: usize) -> Vec<f64> {
        let Some(room) = self.blinds.room_of.get(at) else {
            return self.counted(&self.occupied, lux);
        };
        let shaded = lux
            .iter()
            .zip(&self.blinds.closed[*room])
            .map(|(lux, closed)| {
                let left = if *closed { CLOSED_BLINDS } else { 1.0 };
                (f64::from(*lux) * left) as f32
            });
        self.counted(&self.occupied, &shaded.collect::<Vec<f32>>())
    }

    /// The illuminances of the hours that count.
    fn counted(&self, counts: &[bool], lux: &[f32]) -> Vec<f64> {
        let hours = lux.iter().zip(counts).filter(|(_, counts)| **counts);
        hours.map(|(lux, _)| f64::from(*lux)).collect()
    }
}

/// Percent of points that pass, and its standard error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Passing {
    /// Percent of the points.
    pub percent: f64,
    /// Its standard error, in points: of points whose values err independently, normally distributed.
    pub standard_error: f64,
}

/// How many of the `values`, with their standard errors, are at least `limit`.
pub fn passing(values: &[f64], errors: &[f64], limit: f64) -> Passing {
    let count = values.len().max(1) as f64;
    let reached = values.iter().filter(|value| **value >= limit).count();
    let variance = |(value, error): (&f64, &f64)| {
        if *error <= 0.0 {
            return 0.0;
        }
        let chance = normal((value - limit) / error);
        chance * (1.0 - chance)
    };
    let variance: f64 = values.iter().zip(errors).map(variance).sum();
    Passing {
        percent: 100.0 * reached as f64 / count,
        standard_error: 100.0 * variance.sqrt() / count,
    }
}

/// Bowling, Khasawneh, Kaewkuekool & Cho 2009, "A logistic approximation to the cumulative normal distribution": within 1.4e-4.
fn normal(z: f64) -> f64 {
    1.0 / (1.0 + (-0.07056 * z.powi(3) - 1.5976 * z).exp())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two days, hour by hour; the sky of hour n gives n W/m² from 6 to 20 h.
    fn weather() -> Weather {
        let mut text = "LOCATION,Havnby,-,DNK,made,0,55.1,8.6,1.0,4.0\nDATA PERIODS,1,1,Data,Sunday, 6/20, 6/21\n".to_owned();
        for at in 0..48 {
            let (day, hour) = (20 + at / 24, at % 24 + 1);
            let diffuse = if (6..20).contains(&(at % 24)) {
                hour
            } else {
                0
            };
            text += &format!(
                "2001,6,{day},{hour},0,?,15,9,70,101300,0,0,300,9999,0,{diffuse},0,0,0,0,0,0,0,0,20\n"
            );
        }
        Weather::parse(&text, false).expect("a file")
    }

    fn measures(schedule: &str) -> (Measures, usize) {
        let weather = weather();
        let lit = super::super::lit_hours::lit_hours(&weather);
        let schedule = schedule.parse().expect("a schedule");
        let measures = Measures::new(&weather, &lit, schedule, vec![300.0, 500.0]);
        (measures.expect("hours"), lit.len())
    }

    #[test]
    fn shares_are_of_all_occupied_hours() {
        // 0 to 8: two lit hours a day of eight.
        let (measures, lit) = measures("0-8");
        assert_eq!((lit, measures.occupied_hours()), (28, 16.0));
        let values = measures.values(&vec![400.0; lit], 0);
        let of = |name: &str| values[measures.names().iter().position(|n| n == name).expect(name)];
        assert_eq!((of("da300"), of("da500")), (25.0, 0.0));
        assert!((of("cda500") - 20.0).abs() < 1e-12);
        assert_eq!((of("udi_low"), of("udi_aut")), (75.0, 25.0));
        assert!((of("mean_lux") - 400.0 * 28.0 / 48.0).abs() < 1e-9);
    }

    #[test]
    fn borders_are_as_defined() {
        let (measures, lit) = measures("8-18");
        let mut lux = vec![0.0; lit];
        // Occupied hours of the first day are the lit hours 2 to 11.
        lux[2..12].copy_from_slice(&[
            99.9, 100.0, 299.9, 300.0, 3000.0, 3000.1, 1000.0, 1000.1, 0.0, 0.0,
        ]);
        let values = measures.values(&lux, 0);
        let of = |name: &str| values[measures.names().iter().position(|n| n == name).expect(name)];
        assert_eq!(of("da300"), 25.0);
        assert_eq!(of("udi_low"), 65.0);
        assert_eq!(of("udi_sup"), 10.0);
        assert_eq!(of("udi_aut"), 20.0);
        assert_eq!(of("udi_high"), 5.0);
        assert_eq!(measures.exposed_hours(&lux), 3.0);
    }

    #[test]
    fn closed_blinds_leave_a_twentieth_to_the_occupied_hours() {
        let (mut measures, lit) = measures("8-18");
        let lux = vec![6200.0; lit];
        // Every second hour of 28: ten of twenty occupied ones.
        let every_second = (0..lit).map(|at| at % 2 == 0).collect();
        measures.close_blinds(Closings {
            room_of: vec![1, 0],
            closed: vec![vec![false; lit], every_second],
        });
        assert_eq!(measures.closed_hours(), [0.0, 10.0]);
        let open = measures.values(&lux, 1);
        assert_eq!(open[..2], [100.0, 100.0], "another room");
        let values = measures.values(&lux, 0);
        let of = |name: &str| values[measures.names().iter().position(|n| n == name).expect(name)];
        // 310 and 6200 lux.
        assert_eq!((of("da300"), of("da500")), (100.0, 50.0));
        assert_eq!((of("udi_aut"), of("udi_high")), (50.0, 50.0));
        assert_eq!(of("en17037_hours_ge750"), 28.0);
        assert!((of("mean_lux") - 6200.0 * 28.0 / 48.0).abs() < 1e-9);
        assert_eq!(measures.exposed_hours(&lux), 20.0);
    }

    #[test]
    fn the_brightest_hours_are_those_of_most_diffuse_light() {
        let weather = weather();
        let lit = super::super::lit_hours::lit_hours(&weather);
        let mut measures =
            Measures::new(&weather, &lit, Schedule::default(), vec![]).expect("hours");
        // A file of two days has fewer hours than 4 380: all count.
        assert_eq!(measures.en17037_hours(), 24.0);
        assert!(measures.brightest.iter().all(|is| *is));
        measures.brightest.fill(false);
        assert_eq!(measures.values(&vec![900.0; lit.len()], 0)[4], 0.0);
    }

    #[test]
    fn points_near_the_limit_make_a_share_uncertain() {
        let sure = passing(&[60.0, 40.0, 50.0, 90.0], &[0.0; 4], 50.0);
        assert_eq!((sure.percent, sure.standard_error), (75.0, 0.0));
        // One point at the limit: half of the time it passes.
        let unsure = passing(&[60.0, 40.0, 50.0, 90.0], &[1.0; 4], 50.0);
        assert!((unsure.standard_error - 12.5).abs() < 1e-6, "{unsure:?}");
    }

    #[test]
    fn schedules_are_read() {
        assert_eq!("8-18".parse(), Ok(Schedule::default()));
        assert_eq!(Schedule::default().to_string(), "8-18");
        assert!(Schedule::default().holds(8.5) && !Schedule::default().holds(18.0));
        for text in ["8", "18-8", "8-25", "a-b", "8-8", "-3-4"] {
            assert!(text.parse::<Schedule>().is_err(), "{text}");
        }
        assert!(measures("2-3").0.occupied_hours() == 2.0);
    }
}
