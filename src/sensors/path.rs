//! One path: from a sensor over diffuse surfaces, with the light of sun, sky and surfaces that emit at every point of it.
//!
//! E(x) = E_sun(x) + E_sky(x) + E_emitters(x) + Σ over bounces of the product of reflectances times the same sum at each point
//! (Kajiya 1986, "The rendering equation", for Lambertian surfaces: with directions of density cos θ/π the factor of a bounce is ρ_d).

use std::f64::consts::PI;

use glam::{DVec2, DVec3};

use super::Sensor;
use super::numbers::Numbers;
use super::surface::{Met, Point, TracedScene, lifted};
use crate::daylight::sampling::cosine_hemisphere;
use crate::daylight::sky::Daylight;
use crate::daylight::sky_sampler::SkySampler;
use crate::daylight::sunlight::on_disc;
use crate::daylight::tangent_frame;

/// Bounces whose numbers come from scrambled sequences.
const SPREAD_BOUNCES: u32 = 2;

/// Bounces after which Russian roulette ends paths.
const SURE_BOUNCES: u32 = 3;

/// Bounces after which a path ends: between surfaces that reflect 95 %, less than a millionth of the light is left.
pub(super) const MAX_BOUNCES: u32 = 256;

/// Parts of an irradiance.
pub(super) const PARTS: usize = 5;

/// Sun and sky of a moment.
pub struct Lights<'a> {
    daylight: &'a Daylight,
    sampler: SkySampler,
}

impl<'a> Lights<'a> {
    /// Tabulates the sky for importance sampling.
    pub fn new(daylight: &'a Daylight) -> Self {
        Self {
            sampler: SkySampler::new(daylight),
            daylight,
        }
    }
}

/// Irradiance estimated by path `index` of a replicate after at most `bounces`, linear RGB, lux: from the sky, from the sun, of the sky and
/// of the sun by reflection, and of surfaces that emit and the ground below the horizon.
pub(super) fn trace(
    sensor: &Sensor,
    scene: &TracedScene,
    lights: &Lights,
    bounces: u32,
    [index, seed]: [u32; 2],
) -> [DVec3; PARTS] {
    let has_emitters = scene.is_emissive();
    let spread = SPREAD_BOUNCES * if has_emitters { 4 } else { 3 };
    let mut numbers = Numbers::new(index, seed, spread);
    let mut point = Point {
        position: lifted(sensor.position, sensor.normal),
        normal: sensor.normal,
        reflectance: DVec3::ONE,
        emission: DVec3::ZERO,
        emitter_density: 0.0,
    };
    let mut parts = [DVec3::ZERO; PARTS];
    let mut throughput = DVec3::ONE;
    for bounce in 0..=bounces.min(MAX_BOUNCES) {
        let from_sun = sun_at(&point, scene, lights, numbers.pair());
        let mut from_sky = sky_at(&point, scene, lights, numbers.pair());
        let mut from_surfaces = if has_emitters {
            emitter_at(&point, scene, numbers.pair())
        } else {
            DVec3::ZERO
        };
        let local = cosine_hemisphere(numbers.pair());
        let direction = tangent_frame::to_world(local, point.normal.as_dvec3());
        let met = scene.first(point.position, direction.as_vec3(), || numbers.next());
        let [seen_sky, seen_surface] = seen(&met, local.z / PI, lights);
        from_sky += met.through * seen_sky;
        from_surfaces += met.through * seen_surface;
        let first = if bounce == 0 { 0 } else { 2 };
        parts[first] += throughput * from_sky;
        parts[first + 1] += throughput * from_sun;
        parts[4] += throughput * from_surfaces;
        let Some(next) = met.point else { break };
        throughput *= met.through * next.reflectance;
        if bounce >= SURE_BOUNCES {
            let chance = throughput.max_element().min(1.0);
            if numbers.next() >= chance {
                break;
            }
            throughput /= chance;
        }
        point = next;
    }
    parts
}

/// Irradiance of what a ray in a direction of this density meets, linear RGB, lux: of the sky, of a surface that emits or the ground.
///
/// What a pane mirrors is found by these rays alone.
fn seen(met: &Met, density: f64, lights: &Lights) -> [DVec3; 2] {
    let weight = |other: f64| {
        if met.is_mirrored {
            1.0
        } else {
            density / (density + other)
        }
    };
    if let Some(next) = met.point {
        let weight = weight(next.emitter_density);
        return [DVec3::ZERO, PI * weight * next.emission];
    }
    let direction = met.direction.as_dvec3();
    if direction.y < 0.0 {
        return [DVec3::ZERO, PI * lights.daylight.ground_luminance];
    }
    let weight = weight(lights.sampler.density(direction));
    let sky = weight * PI * lights.daylight.sky_radiance(direction);
    [sky, DVec3::ZERO]
}

/// Irradiance of the sun, or of the moon at night, at a point, sampled on its disc, linear RGB, lux.
fn sun_at(point: &Point, scene: &TracedScene, lights: &Lights, xi: DVec2) -> DVec3 {
    let direct = lights.daylight.direct_light();
    let toward = on_disc(direct.direction.as_vec3(), xi).as_dvec3();
    let cosine = point.normal.as_dvec3().dot(toward);
    let is_dark = direct.illuminance == DVec3::ZERO || toward.y <= 0.0;
    if cosine <= 0.0 || is_dark {
        return DVec3::ZERO;
    }
    direct.illuminance * cosine * scene.passing(point.position, toward.as_vec3(), f32::INFINITY)
}

/// Irradiance of the sky at a point, linear RGB, lux: a direction sampled by luminance, weighted against cosine-distributed ones
/// (Veach and Guibas 1995, balance heuristic).
fn sky_at(point: &Point, scene: &TracedScene, lights: &Lights, xi: DVec2) -> DVec3 {
    let light = lights.sampler.light(lights.daylight, xi);
    let cosine = point.normal.as_dvec3().dot(light.direction);
    if cosine <= 0.0 {
        return DVec3::ZERO;
    }
    let through = scene.passing(point.position, light.direction.as_vec3(), f32::INFINITY);
    let density = lights.sampler.density(light.direction);
    let weight = density / (density + cosine / PI);
    light.illuminance * through * (cosine * weight)
}

/// Irradiance of the emitters at a point, linear RGB, lux: a point sampled by power, weighted against cosine-distributed directions.
fn emitter_at(point: &Point, scene: &TracedScene, xi: DVec2) -> DVec3 {
    let Some(emitted) = scene.emitter(point.position, xi) else {
        return DVec3::ZERO;
    };
    let cosine = point.normal.as_dvec3().dot(emitted.toward);
    if cosine <= 0.0 || emitted.density <= 0.0 {
        return DVec3::ZERO;
    }
    emitted.radiance * (cosine / (emitted.density + cosine / PI))
}
