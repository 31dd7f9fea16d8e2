//! Sensors that are made: a regular grid on a plane above the floor of each room.
//!
//! A plane is sampled on a fine raster. Samples that no surface parts belong together; what they are bounded by tells whether they are a
//! room: walls around, a ceiling above, a floor below. The grid is fitted between its walls.

mod region;

use glam::{Vec2, Vec3};

use self::region::{Raster, Region};
use super::Sensor;
use super::grid::GridError;
use super::made::{DIGITS, counts, unknown_material};
use crate::scene::{Bvh, Ray, Scene};

/// What to make.
#[derive(Debug, Clone, PartialEq)]
pub struct Planes {
    /// Height above the floor, metres.
    pub height: f32,
    /// Largest distance from a sensor to the next, metres.
    pub spacing: f32,
    /// Least distance from walls, metres.
    pub inset: f32,
    /// Names of the materials of floors; without any, floors of rooms are found.
    pub floors: Vec<String>,
}

/// Cosine from the vertical of what still is a floor.
const LEVEL: f32 = 0.999;

/// Difference in height of what still is one floor, metres.
const STEP: f32 = 0.02;

/// Least area of a floor that is looked for, m².
const LEAST_AREA: f32 = 1.0;

/// Directions in which walls must be farther than the inset.
const AROUND: u32 = 16;

/// Horizontal triangles at one height.
pub(super) struct Level {
    /// Height, metres.
    y: f32,
    /// Their corners: east, south.
    triangles: Vec<[Vec2; 3]>,
}

/// Makes the sensors: room after room, the lowest first, in each from south to north and there from west to east, as Radiance's grids.
///
/// # Errors
/// A name that no material has, or no room with a place for a sensor.
pub fn make_grid(scene: &Scene, planes: &Planes) -> Result<Vec<Sensor>, GridError> {
    if let Some((name, known)) = unknown_material(scene, &planes.floors) {
        return Err(GridError::UnknownFloor { name, known });
    }
    let bvh = scene.hierarchy();
    let mut sensors = Vec::new();
    for level in levels(scene, &planes.floors) {
        let raster = Raster::new((scene, &bvh), &level, planes)?;
        for region in raster.regions() {
            if !planes.floors.is_empty() || region.is_room() {
                fill(&bvh, &raster, &region, planes, &mut sensors);
            }
        }
    }
    if sensors.is_empty() {
        return Err(GridError::NoRoom {
            is_named: !planes.floors.is_empty(),
        });
    }
    Ok(sensors)
}

/// Floors by their heights, the lowest first.
fn levels(scene: &Scene, names: &[String]) -> Vec<Level> {
    let mut flat: Vec<(f32, f32, [Vec2; 3])> = Vec::new();
    for part in &scene.parts {
        let name = &scene.materials[part.material as usize].name;
        if !names.is_empty() && !names.contains(name) {
            continue;
        }
        let first = part.first_index as usize;
        for corners in scene.indices[first..first + part.index_count as usize].chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| Vec3::from(scene.positions[corners[k] as usize]));
            let across = (b - a).cross(c - a);
            if across.y.abs() > LEVEL * across.length() {
                let plan = [a, b, c].map(|v| Vec2::new(v.x, v.z));
                flat.push(((a.y + b.y + c.y) / 3.0, 0.5 * across.length(), plan));
            }
        }
    }
    flat.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut levels = Vec::new();
    for group in flat.chunk_by(|a, b| b.0 - a.0 < STEP) {
        let area: f32 = group.iter().map(|(_, area, _)| area).sum();
        if !names.is_empty() || area >= LEAST_AREA {
            levels.push(Level {
                y: group[0].0,
                triangles: group.iter().map(|(_, _, plan)| *plan).collect(),
            });
        }
    }
    levels
}

/// Adds the sensors of a region.
fn fill(bvh: &Bvh, raster: &Raster, region: &Region, planes: &Planes, sensors: &mut Vec<Sensor>) {
    let size = region.max - region.min;
    let counts = counts(size, planes.spacing);
    let step = size / counts;
    for row in (0..counts.y as u32).rev() {
        for column in 0..counts.x as u32 {
            let at = region.min + step * (Vec2::new(column as f32, row as f32) + 0.5);
            let at = (at * DIGITS).round() / DIGITS;
            let position = Vec3::new(at.x, raster.height, at.y);
            if raster.belongs(bvh, region, position) && is_clear(bvh, position, planes.inset) {
                sensors.push(Sensor {
                    position,
                    normal: Vec3::Y,
                });
            }
        }
    }
}

/// Whether no wall is nearer than this.
fn is_clear(bvh: &Bvh, origin: Vec3, inset: f32) -> bool {
    let is_met = |k: u32| {
        let (sin, cos) = (std::f32::consts::TAU * k as f32 / AROUND as f32).sin_cos();
        let direction = Vec3::new(cos, 0.0, sin);
        bvh.any(&Ray { origin, direction }, 0.0, inset, |_| true)
    };
    inset <= 0.0 || !(0..AROUND).any(is_met)
}

#[cfg(test)]
pub(super) mod tests;
