//! Paths of a year: from a sensor over diffuse surfaces. What they find holds for every sky and every sun.

use glam::{DVec3, Vec3};

use super::Sensor;
use super::numbers::Numbers;
use super::path::MAX_BOUNCES;
use super::surface::{Met, TracedScene, lifted};
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

/// What a ray of density cos θ/π meets.
fn met(scene: &TracedScene, from: Vec3, normal: Vec3, numbers: &mut Numbers) -> Met {
    let local = cosine_hemisphere(numbers.pair());
    let direction = tangent_frame::to_world(local, normal.as_dvec3());
    scene.first(from, direction.as_vec3(), || numbers.next())
}

/// Follows path `index` of a replicate over at most `bounces` surfaces and gives the points where it is reflected.
///
/// With directions of the density cos θ/π a bounce multiplies by ρ_d (see [`super::path`]). Each surface ends the path with the probability
/// 1 − ρ_d: those that go on keep their weight.
pub(super) fn walk(
    sensor: &Sensor,
    scene: &TracedScene,
    bounces: u32,
    [index, seed]: [u32; 2],
    found: &mut Vec<Vertex>,
) {
    let mut numbers = Numbers::new(index, seed, SPREAD);
    let (mut position, mut normal) = (lifted(sensor.position, sensor.normal), sensor.normal);
    let mut weight = DVec3::ONE;
    for _ in 0..bounces.min(MAX_BOUNCES) {
        let met = met(scene, position, normal, &mut numbers);
        let Some(point) = met.point else { return };
        weight *= met.through * point.reflectance;
        let chance = weight.max_element().min(1.0);
        if chance <= 0.0 {
            return;
        }
        (position, normal) = (point.position, point.normal);
        found.push(Vertex {
            position,
            normal,
            distance: position.distance(sensor.position),
            weight: weight.as_vec3(),
        });
        if numbers.next() >= chance {
            return;
        }
        weight /= chance;
    }
}
