//! The light of a year, in the form that coefficients of sensors are multiplied with.

use std::sync::OnceLock;

use glam::{DVec2, DVec3, Vec3};
use ndarray::{Array2, ArrayView2, linalg::general_mat_mul};
use rayon::prelude::*;

use super::Sensor;
use super::suns::Suns;
use super::surface::{TracedScene, before, lanes_of, lifted};
use crate::daylight::colour::luminance;
use crate::daylight::lit_hours::{LitHour, PatchedSky, lit_hours};
use crate::daylight::patches::Patches;
use crate::daylight::sunlight::on_disc;
use crate::daylight::weather::Weather;
use crate::scene::{Blocker, Bundle, LANES};

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
    ground_albedo: f64,
    /// See [`YearLight::skies`].
    skies: OnceLock<Array2<f32>>,
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
        Self {
            skies: OnceLock::new(),
            ground_albedo,
            suns,
            hours,
            patches,
        }
    }

    /// Luminances of the patches: a row for each hour, and a last one of the overcast sky of the CIE that gives open ground 100 lux. They are computed
    /// when they are first asked for.
    pub(super) fn skies(&self) -> &Array2<f32> {
        self.skies.get_or_init(|| {
            let sky = PatchedSky::new(&self.patches, self.ground_albedo);
            let count = self.patches.count();
            let mut skies = vec![0.0; (self.hours.len() + 1) * count];
            let rows = skies.par_chunks_mut(count).enumerate();
            rows.for_each(|(at, row)| {
                row.copy_from_slice(&match self.hours.get(at) {
                    Some(hour) => sky.luminances(hour),
                    None => sky.overcast(100.0),
                });
            });
            // The shape is that of the vector.
            Array2::from_shape_vec((self.hours.len() + 1, count), skies).unwrap_or_default()
        })
    }

    /// Illuminance of a sensor by the sun alone, unreflected, in each lit hour, lux: by the whole disc where an edge crosses it.
    pub(super) fn direct_sun(&self, sensor: &Sensor, scene: &TracedScene) -> Vec<f32> {
        let suns = |hour: &LitHour| hour.sun.as_vec3();
        let is_lit = |hour: &LitHour| hour.sun_lux > 0.0 && sensor.normal.dot(suns(hour)) > -0.01;
        let candidates: Vec<usize> = (0..self.hours.len())
            .filter(|at| is_lit(&self.hours[*at]))
            .collect();
        let of_disc = |at: &usize| FEW.map(|place| on_disc(suns(&self.hours[*at]), place));
        let few: Vec<Vec3> = candidates.iter().flat_map(of_disc).collect();
        let few = sunlit(sensor, scene, &few);
        let (mut whole, mut cut) = (Vec::new(), Vec::new());
        for (at, few) in candidates.iter().zip(few.chunks(FEW.len())) {
            let least = few.iter().copied().fold(f64::INFINITY, f64::min);
            let most = few.iter().copied().fold(0.0, f64::max);
            // The cosine and the glass alone change by less than this over the disc, but at grazing incidence.
            if least > 0.95 * most {
                whole.push(*at);
            } else if most > 0.0 {
                cut.push(*at);
            }
        }
        let mut lux = vec![0.0; self.hours.len()];
        let centres: Vec<Vec3> = whole.iter().map(|at| suns(&self.hours[*at])).collect();
        for (at, share) in whole.iter().zip(sunlit(sensor, scene, &centres)) {
            lux[*at] = (share * self.hours[*at].sun_lux) as f32;
        }
        for at in cut {
            let point = |i| on_disc(suns(&self.hours[at]), crate::daylight::sampling::sobol(i));
            let points: Vec<Vec3> = (0..MANY).map(point).collect();
            let sum: f64 = sunlit(sensor, scene, &points).iter().sum();
            lux[at] = (sum / f64::from(MANY) * self.hours[at].sun_lux) as f32;
        }
        lux
    }

    /// Illuminances by the sky, in all its ways, and by reflected sun, lux: a row for each of the rows of coefficients of patches and suns, a column for
    /// each lit hour and a last one for the overcast sky, in percent of its open ground.
    pub(super) fn indirect(&self, patches: &[f32], suns: &[f32]) -> Array2<f32> {
        let skies = self.skies();
        let rows = patches.len() / self.patches.count();
        let mut lux = Array2::zeros((rows, skies.nrows()));
        if let Ok(coefficients) = ArrayView2::from_shape((rows, self.patches.count()), patches) {
            general_mat_mul(1.0, &coefficients, &skies.t(), 0.0, &mut lux);
        }
        let count = self.suns.directions.len().max(1);
        for (mut row, suns) in lux.rows_mut().into_iter().zip(suns.chunks(count)) {
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

/// Illuminance of a sensor by a unit of light from each of these directions, above the horizon, as far as it arrives.
fn sunlit(sensor: &Sensor, scene: &TracedScene, directions: &[Vec3]) -> Vec<f64> {
    let from = lifted(sensor.position, sensor.normal);
    let (mut light, mut blocker) = (vec![0.0; directions.len()], Blocker::default());
    for (light, directions) in light.chunks_mut(LANES).zip(directions.chunks(LANES)) {
        let bundle = Bundle::new(directions);
        let (cosines, heights) = (bundle.dot(sensor.normal), bundle.dot(Vec3::Y));
        let lit = before(&cosines) & before(&heights) & bundle.all();
        let (open, through) = scene.passing_each(from, (&bundle, lit), &mut blocker);
        for lane in lanes_of(open) {
            light[lane] = luminance(through[lane].as_dvec3()) * f64::from(cosines[lane]);
        }
    }
    light
}

/// Luminance of weights, channel by channel: Y of linear BT.709.
pub(super) fn grey(weight: DVec3) -> f32 {
    luminance(weight) as f32
}
