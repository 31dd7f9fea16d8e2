//! Hours in which blinds are closed against the sun.

use rayon::prelude::*;

use super::{Sensor, TracedScene, YearLight};
use crate::daylight::metrics::{BLINDS_LUX, BLINDS_SHARE};

/// Of each lit hour, whether more of the sensors have direct sun than blinds allow (IES LM-83-12, 2.2.6). The sun counts through open
/// blinds, unreflected; all windows are one group.
pub fn closed_hours(sensors: &[Sensor], scene: &TracedScene, light: &YearLight) -> Vec<bool> {
    let none = || vec![0_u32; light.hours.len()];
    let counts = sensors.par_iter().fold(none, |mut counts, sensor| {
        let sun = light.direct_sun(sensor, scene);
        for (count, lux) in counts.iter_mut().zip(sun) {
            *count += u32::from(f64::from(lux) >= BLINDS_LUX);
        }
        counts
    });
    let counts = counts.reduce(none, |mut sum, counts| {
        sum.iter_mut().zip(counts).for_each(|(s, c)| *s += c);
        sum
    });
    let most = BLINDS_SHARE * sensors.len() as f64;
    counts
        .iter()
        .map(|count| f64::from(*count) > most)
        .collect()
}
