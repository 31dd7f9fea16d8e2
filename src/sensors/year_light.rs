//! The light of a year, in the form that coefficients of sensors are multiplied with.

use glam::{DVec2, DVec3, Vec3};
use ndarray::{Array2, ArrayView2, linalg::general_mat_mul};
use rayon::prelude::*;

use super::Sensor;
use super::suns::Suns;
use super::surface::{TracedScene, lifted};
use crate::daylight::colour::luminance;
use crate::daylight::lit_hours::{LitHour, PatchedSky, lit_hours};
use crate::daylight::patches::Patches;
use crate::daylight::sunlight::on_disc;
use crate::daylight::weather::Weather;

/// Reinhart's subdivision of the sky: patches of 3°. The luminance of Perez' sky changes by less than 1 % of its mean within one.
const MULTIPLIER: usize = 4;

/// Points of the sun's disc that tell whether an edge crosses it: at 0.8 of its radius.
const FEW: [DVec2; 3] = [
    DVec2::new(0.64, 0.0),
    DVec2::new(0.64, 1.0 / 3.0),
    DVec2::new(0.64, 2.0 / 3.0),
];

/// Points of the disc where one does, a power of two.
const MANY: u32 = 32;

/// Sun and sky of all lit hours of a weather file.
#[derive(Debug, Clone)]
pub struct YearLight {
    /// The hours.
    pub hours: Vec<LitHour>,
    pub(super) patches: Patches,
    pub(super) suns: Suns,
    /// Luminances of the patches: a row for each hour, and a last one of the overcast sky of the CIE that gives open ground 100 lux.
    skies: Array2<f32>,
}

impl YearLight {
    /// Of a file, over ground below the horizon that reflects `ground_albedo`.
    pub fn new(weather: &Weather, ground_albedo: f64) -> Self {
        let hours = lit_hours(weather);
        let suns = Suns::new(weather, &hours);
        Self::of(hours, suns, ground_albedo)
    }

    /// The overcast sky alone: no hours.
    pub fn overcast(ground_albedo: f64) -> Self {
        Self::of(Vec::new(), Suns::default(), ground_albedo)
    }

    fn of(hours: Vec<LitHour>, suns: Suns, ground_albedo: f64) -> Self {
        let patches = Patches::new(MULTIPLIER);
        let sky = PatchedSky::new(&patches, ground_albedo);
        let count = patches.count();
        let mut skies = vec![0.0; (hours.len() + 1) * count];
        let rows = skies.par_chunks_mut(count).enumerate();
        rows.for_each(|(at, row)| {
            row.copy_from_slice(&match hours.get(at) {
                Some(hour) => sky.luminances(hour),
                None => sky.overcast(100.0),
            });
        });
        Self {
            // The shape is that of the vector.
            skies: Array2::from_shape_vec((hours.len() + 1, count), skies).unwrap_or_default(),
            suns,
            hours,
            patches,
        }
    }

    /// Illuminance of a sensor by the sun alone, unreflected, in each lit hour, lux: by the whole disc where an edge crosses it.
    pub(super) fn direct_sun(&self, sensor: &Sensor, scene: &TracedScene) -> Vec<f32> {
        let from = lifted(sensor.position, sensor.normal);
        let one = |toward: Vec3| -> f64 {
            let cosine = sensor.normal.dot(toward);
            if cosine <= 0.0 || toward.y <= 0.0 {
                return 0.0;
            }
            let through = scene.passing(from, toward, f32::INFINITY);
            luminance(through) * f64::from(cosine)
        };
        let of = |hour: &LitHour| {
            let centre = hour.sun.as_vec3();
            let is_lit = hour.sun_lux > 0.0 && sensor.normal.dot(centre) > -0.01;
            if !is_lit {
                return 0.0;
            }
            let few = FEW.map(|at| one(on_disc(centre, at)));
            let (least, most) = (
                few[0].min(few[1]).min(few[2]),
                few[0].max(few[1]).max(few[2]),
            );
            if most == 0.0 {
                return 0.0;
            }
            // The cosine and the glass alone change by less than this over the disc, but at grazing incidence.
            let is_whole = least > 0.95 * most;
            let share = if is_whole {
                one(centre)
            } else {
                let sum: f64 = (0..MANY)
                    .map(|i| one(on_disc(centre, crate::daylight::sampling::sobol(i))))
                    .sum();
                sum / f64::from(MANY)
            };
            (share * hour.sun_lux) as f32
        };
        self.hours.iter().map(of).collect()
    }

    /// Illuminances by the sky, in all its ways, and by reflected sun, lux: a row for each replicate, a column for each lit hour and a last
    /// one for the overcast sky, in percent of its open ground.
    pub(super) fn indirect(&self, patches: &[f32], suns: &[f32], replicates: usize) -> Array2<f32> {
        let mut lux = Array2::zeros((replicates, self.skies.nrows()));
        let shape = (replicates, self.patches.count());
        if let Ok(coefficients) = ArrayView2::from_shape(shape, patches) {
            general_mat_mul(1.0, &coefficients, &self.skies.t(), 0.0, &mut lux);
        }
        let count = suns.len() / replicates;
        for (mut row, suns) in lux.rows_mut().into_iter().zip(suns.chunks(count.max(1))) {
            for ((hour, of), lux) in self.hours.iter().zip(&self.suns.of_hour).zip(&mut row) {
                if let Some(([before, after], share)) = of {
                    let mean = suns[*before] + share * (suns[*after] - suns[*before]);
                    *lux += mean * hour.sun_lux as f32;
                }
            }
        }
        lux
    }
}

/// Luminance of weights, channel by channel: Y of linear BT.709.
pub(super) fn grey(weight: DVec3) -> f32 {
    luminance(weight) as f32
}
