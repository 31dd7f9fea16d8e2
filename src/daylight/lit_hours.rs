//! The light of every hour of a weather file that has any: Perez' sky over patches, and the sun.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use wide::f32x8;

use super::grey_sky::Distribution;
use super::patches::Patches;
use super::perez::AllWeather;
use super::sun_position::direction;
use super::weather::Weather;

/// Largest elevation of the sun in Perez' sky, degrees: see [`AllWeather::new`].
const HIGHEST_SUN_DEG: f64 = 87.0;

/// The light of an hour.
#[derive(Debug, Clone, PartialEq)]
pub struct LitHour {
    /// Number of its record in the weather file.
    pub record: usize,
    /// Unit vector toward the sun's centre, without refraction.
    pub sun: DVec3,
    /// Illuminance of a horizontal plane by the sky, lux; above 0.
    pub sky_lux: f64,
    /// Illuminance by the sun at normal incidence, lux; 0 while its centre is below the horizon.
    pub sun_lux: f64,
    distribution: Distribution,
    /// The sun of the distribution, from the horizon to 3° from the zenith.
    sky_sun: DVec3,
}

/// All hours in which the sky gives light, in the order of the file. Missing irradiances are none.
pub fn lit_hours(weather: &Weather) -> Vec<LitHour> {
    let hour = |(record, of): (usize, &_)| {
        let sun = weather.sun(of);
        let light = AllWeather::new(&weather.measured(of), sun.elevation_deg);
        let is_up = sun.elevation_deg > 0.0;
        (light.diffuse_horizontal_lux > 0.0).then(|| LitHour {
            record,
            sun: direction(sun.azimuth_deg, sun.elevation_deg),
            sky_lux: light.diffuse_horizontal_lux,
            sun_lux: if is_up { light.direct_normal_lux } else { 0.0 },
            distribution: light.distribution,
            sky_sun: direction(
                sun.azimuth_deg,
                sun.elevation_deg.clamp(0.0, HIGHEST_SUN_DEG),
            ),
        })
    };
    weather
        .records
        .iter()
        .enumerate()
        .filter_map(hour)
        .collect()
}

impl LitHour {
    /// Illuminance of open ground by sun and sky, lux.
    pub fn global_lux(&self) -> f64 {
        self.sky_lux + self.sun_lux * self.sun.y.max(0.0)
    }
}

/// What turns an hour into luminances of patches.
#[derive(Debug, Clone)]
pub struct PatchedSky {
    /// Middles of the patches above the horizon, eight at a time; the last ones are repeated.
    centres: Vec<[f32x8; 3]>,
    /// Weights of these patches in the illuminance of a horizontal plane, sr.
    weights: Vec<f64>,
    ground_albedo: f64,
}

impl PatchedSky {
    /// For these patches, over ground that reflects `ground_albedo`, 0..=1.
    pub fn new(patches: &Patches, ground_albedo: f64) -> Self {
        let centres = &patches.centres()[1..];
        let eight = |first: usize| {
            let of = |lane: usize| centres[(first + lane).min(centres.len() - 1)].as_vec3();
            let lanes: [Vec3; 8] = std::array::from_fn(of);
            [0, 1, 2].map(|axis| f32x8::new(lanes.map(|centre| centre[axis])))
        };
        Self {
            centres: (0..centres.len()).step_by(8).map(eight).collect(),
            weights: patches.horizontal_weights()[1..].to_vec(),
            ground_albedo,
        }
    }

    /// Luminance of every patch, cd/m²: that of its middle, all scaled so that together they give a horizontal plane the light of the sky;
    /// of patch 0 that of the ground below the horizon.
    pub fn luminances(&self, hour: &LitHour) -> Vec<f32> {
        let sun = hour.sky_sun.as_vec3();
        let Distribution {
            gradation,
            indicatrix,
            least_cosine,
        } = hour.distribution;
        let ([a, b, g], [k, c, d, e]) = (gradation.map(|v| v as f32), indicatrix.map(|v| v as f32));
        let form = |[x, y, z]: [f32x8; 3]| {
            let fall = (b / y.max(f32x8::splat(least_cosine as f32))).exp() * a;
            let cosine = x * sun.x + y * sun.y + z * sun.z;
            let [u, v, w] = [x - sun.x, y - sun.y, z - sun.z];
            // From the chord: the arc cosine has few digits near the sun.
            let chord = (u * u + v * v + w * w).sqrt();
            let chi = (0.5 * chord).min(f32x8::ONE).asin() * 2.0;
            let indicatrix = (chi * d).exp() * c + cosine * cosine * e + k;
            ((fall + y * g + 1.0) * indicatrix).max(f32x8::ZERO)
        };
        self.scaled(form, hour.sky_lux, hour.global_lux())
    }

    /// The same for the overcast sky of the CIE that gives open ground `lux`.
    pub fn overcast(&self, lux: f64) -> Vec<f32> {
        self.scaled(|[_, y, _]| y * 2.0 + 1.0, lux, lux)
    }

    fn scaled(
        &self,
        form: impl Fn([f32x8; 3]) -> f32x8,
        sky_lux: f64,
        global_lux: f64,
    ) -> Vec<f32> {
        let ground = self.ground_albedo * global_lux / PI;
        let mut luminances = vec![ground as f32];
        let formed = self
            .centres
            .iter()
            .flat_map(|lanes| form(*lanes).to_array());
        luminances.extend(formed.take(self.weights.len()));
        let values = &mut luminances[1..];
        let weighted = values.iter().zip(&self.weights);
        let sum: f64 = weighted.map(|(v, w)| f64::from(*v) * w).sum();
        if sum > 0.0 {
            let scale = (sky_lux / sum) as f32;
            values.iter_mut().for_each(|value| *value *= scale);
        } else {
            // A formula that is nowhere positive: a uniform sky.
            values.fill((sky_lux / PI) as f32);
        }
        luminances
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_patches_give_open_ground_the_light_of_the_sky() {
        let patches = Patches::new(4);
        let sky = PatchedSky::new(&patches, 0.3);
        let luminances = sky.overcast(10_000.0);
        let lux: f64 = patches
            .horizontal_weights()
            .iter()
            .zip(&luminances)
            .map(|(w, l)| w * f64::from(*l))
            .sum();
        assert!((lux / 10_000.0 - 1.0).abs() < 1e-6, "{lux}");
        assert!((f64::from(luminances[0]) / (0.3 * 10_000.0 / PI) - 1.0).abs() < 1e-6);
        // Moon and Spencer: 9 E/(7 π) at the zenith.
        let zenith = f64::from(luminances[patches.count() - 1]);
        assert!(
            (zenith / (90_000.0 / (7.0 * PI)) - 1.0).abs() < 1e-3,
            "{zenith}"
        );
    }

    #[test]
    fn eight_patches_at_once_have_the_luminances_of_the_formula() {
        let weather =
            Weather::parse(crate::daylight::weather::BUNDLED[0].1, false).expect("a year");
        let patches = Patches::new(4);
        let (centres, weights) = (patches.centres(), patches.horizontal_weights());
        let sky = PatchedSky::new(&patches, 0.2);
        let mut worst = 0.0_f64;
        for hour in lit_hours(&weather).iter().step_by(37) {
            let form = |centre: &DVec3| {
                let chi = centre.dot(hour.sky_sun).clamp(-1.0, 1.0).acos();
                let of = &hour.distribution;
                (of.gradation(centre.y) * of.indicatrix(chi)).max(0.0)
            };
            let form: Vec<f64> = centres[1..].iter().map(form).collect();
            let sum: f64 = form.iter().zip(&weights[1..]).map(|(v, w)| v * w).sum();
            let mean = hour.sky_lux / PI;
            for (found, form) in sky.luminances(hour)[1..].iter().zip(&form) {
                let off = f64::from(*found) - form * hour.sky_lux / sum;
                worst = worst.max(off.abs() / mean);
            }
        }
        println!("largest difference, of the sky's mean: {worst:.1e}");
        assert!(worst < 1e-4, "{worst}");
    }
}
