//! Whether the clock of a weather file is that of its irradiances.
//!
//! Global, direct and diffuse irradiance close: GHI − DHI = DNI sin h with the elevation h of the sun in the middle of the interval. Where
//! another time closes better, the file's clock is off: many files have the sun of half an hour earlier or later.

use super::Weather;
use crate::daylight::sun_position::direction;

/// Most that a clock is looked for to be off, minutes.
const MOST_MINUTES: i32 = 90;
/// From here on a clock is called off, minutes. Interpolated files are off by some minutes.
const OFF_MINUTES: i32 = 10;
/// The best time must close better than the file's by this factor.
const BETTER: f64 = 0.6;
/// Irradiances that close nowhere better than this are no measurement of one place and time, W/m².
const MOST_RESIDUAL_W: f64 = 15.0;
/// Elevation below which a sun that shines is an error of the file, degrees.
const BELOW_HORIZON_DEG: f64 = -0.3;
/// Fewest hours that tell a clock.
const FEWEST_HOURS: usize = 20;

/// What the irradiances tell of the clock.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClockCheck {
    /// Shift of the sun's time that closes best, minutes: −30 when the irradiances are those of the sun half an hour before the middle of
    /// the interval.
    pub minutes: i32,
    /// Root mean square of GHI − DHI − DNI sin h with that shift, W/m².
    pub residual_w: f64,
    /// The same without a shift, W/m².
    pub unshifted_residual_w: f64,
    /// Hours that were compared.
    pub hours: usize,
    /// Hours with direct irradiance while the sun is below −0.3°.
    pub sunny_hours_at_night: usize,
}

impl ClockCheck {
    /// Compares the irradiances of all hours that have all three; `None` with too few of them, as in `.wea` files.
    pub fn of(weather: &Weather) -> Option<Self> {
        let hours: Vec<Closure> = weather
            .records
            .iter()
            .filter_map(|record| {
                let direct = record.direct_normal_w?;
                let beam = record.global_w? - record.diffuse_w?;
                let is_day = record.diffuse_w? > 0.0;
                let sun = weather.sun(record);
                is_day.then(|| Closure {
                    beam,
                    direct,
                    sun: direction(sun.azimuth_deg, sun.elevation_deg).to_array(),
                })
            })
            .collect();
        if hours.len() < FEWEST_HOURS {
            return None;
        }
        let latitude = weather.station.place.latitude.to_radians();
        let residual = |minutes: i32| {
            let sum: f64 = hours.iter().map(|h| h.squared(minutes, latitude)).sum();
            (sum / hours.len() as f64).sqrt()
        };
        let all = (-MOST_MINUTES..=MOST_MINUTES).map(|minutes| (minutes, residual(minutes)));
        // The least shift of those that close equally well.
        let (minutes, residual_w) =
            all.min_by(|a, b| a.1.total_cmp(&b.1).then(a.0.abs().cmp(&b.0.abs())))?;
        let limit = BELOW_HORIZON_DEG.to_radians().sin();
        let at_night = hours.iter().filter(|h| h.direct > 0.0 && h.sun[1] < limit);
        Some(Self {
            minutes,
            residual_w,
            unshifted_residual_w: residual(0),
            hours: hours.len(),
            sunny_hours_at_night: at_night.count(),
        })
    }

    /// Whether the clock is off.
    pub fn is_off(&self) -> bool {
        self.minutes.abs() >= OFF_MINUTES && self.residual_w < BETTER * self.unshifted_residual_w
    }

    /// One line if the clock is off, or if there is no time at which the irradiances close.
    pub fn warning(&self) -> Option<String> {
        let (minutes, residual) = (self.minutes, self.residual_w);
        if self.is_off() {
            let when = if minutes < 0 { "before" } else { "after" };
            return Some(format!(
                "the clock is off: the irradiances are those of the sun {} minutes {when} the middle of each hour (residual {residual:.1} W/m², \
                 {:.1} without the shift)",
                minutes.abs(),
                self.unshifted_residual_w
            ));
        }
        (residual > MOST_RESIDUAL_W).then(|| {
            format!(
                "global, direct and diffuse irradiance do not fit each other at any time: {residual:.1} W/m² are left over at best"
            )
        })
    }
}

/// One hour.
struct Closure {
    /// GHI − DHI, W/m².
    beam: f64,
    /// DNI, W/m².
    direct: f64,
    /// Toward the sun: east, up, south.
    sun: [f64; 3],
}

impl Closure {
    /// The square of what is left over when the sun is where it is some minutes later. Its declination hardly changes in that time: it
    /// turns about the axis of the earth by a quarter of a degree a minute, toward the west.
    fn squared(&self, minutes: i32, latitude: f64) -> f64 {
        let (sin, cos) = (-f64::from(minutes) * 0.25).to_radians().sin_cos();
        let [x, y, z] = self.sun;
        // The axis points up and north.
        let (up, north) = latitude.sin_cos();
        let along = up * y - north * z;
        // Rodrigues' formula about (0, up, -north).
        let height = y * cos - north * x * sin + up * along * (1.0 - cos);
        let left = self.beam - self.direct * height.max(0.0);
        left * left
    }
}
