//! Paths of a year: from a sensor over diffuse surfaces to the sky. What they find holds for every sky and every sun.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};

use super::Sensor;
use super::numbers::Numbers;
use super::path::MAX_BOUNCES;
use super::surface::{TracedScene, lifted};
use crate::daylight::sampling::cosine_hemisphere;
use crate::daylight::tangent_frame;

/// Directions of a path that come from scrambled sequences.
const SPREAD: u32 = 3;

/// A point where a path is reflected.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vertex {
    /// World space, metres.
    pub position: Vec3,
    /// Unit vector to the side that is lit.
    pub normal: Vec3,
    /// Distance from the sensor, metres.
    pub distance: f32,
    /// Illuminance of the sensor by a unit of illuminance here, linear RGB.
    pub weight: Vec3,
}

/// What a path finds.
pub(super) trait Finds {
    /// Sky, or ground below the horizon, in a direction: illuminance of the sensor by a luminance of 1 there, linear RGB.
    fn outside(&mut self, direction: DVec3, weight: DVec3);
    /// A surface that sun may shine on.
    fn surface(&mut self, vertex: Vertex);
}

/// Follows path `index` of a replicate over at most `bounces` surfaces.
///
/// Directions have the density cos θ/π, so that a bounce multiplies by ρ_d (see [`super::path`]). Each surface ends the path with the
/// probability 1 − ρ_d: those that go on keep their weight.
pub(super) fn walk(
    sensor: &Sensor,
    scene: &TracedScene,
    bounces: u32,
    [index, seed]: [u32; 2],
    found: &mut impl Finds,
) {
    let mut numbers = Numbers::new(index, seed, SPREAD);
    let (mut position, mut normal) = (lifted(sensor.position, sensor.normal), sensor.normal);
    let mut weight = DVec3::ONE;
    for bounce in 0..=bounces.min(MAX_BOUNCES) {
        let local = cosine_hemisphere(numbers.pair());
        let direction = tangent_frame::to_world(local, normal.as_dvec3());
        let met = scene.first(position, direction.as_vec3(), || numbers.next());
        weight *= met.through;
        let Some(point) = met.point else {
            found.outside(met.direction.as_dvec3(), PI * weight);
            return;
        };
        weight *= point.reflectance;
        if bounce == bounces || weight == DVec3::ZERO {
            return;
        }
        (position, normal) = (point.position, point.normal);
        found.surface(Vertex {
            position,
            normal,
            distance: position.distance(sensor.position),
            weight: weight.as_vec3(),
        });
        let chance = weight.max_element().min(1.0);
        if numbers.next() >= chance {
            return;
        }
        weight /= chance;
    }
}
