//! Sums of a weather file, month by month.

use super::Weather;
use crate::daylight::perez::AllWeather;

/// Direct irradiance from which the sun shines, W/m²: World Meteorological Organization 2021, *Guide to Instruments and Methods of
/// Observation*, chapter 8.
pub const SUNSHINE_W: f64 = 120.0;

/// Sums over a month, or a year.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Sums {
    /// Global horizontal irradiation, kWh/m².
    pub global_kwh: f64,
    /// Direct normal irradiation, kWh/m².
    pub direct_normal_kwh: f64,
    /// Diffuse horizontal irradiation, kWh/m².
    pub diffuse_kwh: f64,
    /// Time with direct irradiance of at least [`SUNSHINE_W`], hours.
    pub sunshine_hours: f64,
    /// Light of the sky on a horizontal plane by Perez' efficacies, klx h.
    pub diffuse_klxh: f64,
    /// Light of the sun at normal incidence by Perez' efficacies, while it is up, klx h.
    pub direct_normal_klxh: f64,
}

impl Sums {
    fn plus(self, other: Self) -> Self {
        Self {
            global_kwh: self.global_kwh + other.global_kwh,
            direct_normal_kwh: self.direct_normal_kwh + other.direct_normal_kwh,
            diffuse_kwh: self.diffuse_kwh + other.diffuse_kwh,
            sunshine_hours: self.sunshine_hours + other.sunshine_hours,
            diffuse_klxh: self.diffuse_klxh + other.diffuse_klxh,
            direct_normal_klxh: self.direct_normal_klxh + other.direct_normal_klxh,
        }
    }
}

/// The sums of the twelve months; zero for months that the file lacks. Missing values count as zero.
pub fn months(weather: &Weather) -> [Sums; 12] {
    let mut months = [Sums::default(); 12];
    for record in &weather.records {
        let sun = weather.sun(record);
        let light = AllWeather::new(&weather.measured(record), sun.elevation_deg);
        let hours = weather.step_hours;
        let kilo = |value: f64| value * hours * 1e-3;
        let direct = record.direct_normal_w.unwrap_or_default();
        let is_up = sun.elevation_deg > 0.0;
        let month = &mut months[record.month as usize - 1];
        *month = month.plus(Sums {
            global_kwh: kilo(record.global_w.unwrap_or_default()),
            direct_normal_kwh: kilo(direct),
            diffuse_kwh: kilo(record.diffuse_w.unwrap_or_default()),
            sunshine_hours: if direct >= SUNSHINE_W { hours } else { 0.0 },
            diffuse_klxh: kilo(light.diffuse_horizontal_lux),
            direct_normal_klxh: if is_up {
                kilo(light.direct_normal_lux)
            } else {
                0.0
            },
        });
    }
    months
}

/// The sum of all months.
pub fn year(months: &[Sums; 12]) -> Sums {
    months
        .iter()
        .fold(Sums::default(), |sum, month| sum.plus(*month))
}
