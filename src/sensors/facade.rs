//! Sensors that are made on façades: regular grids before the outer faces of upright surfaces.
//!
//! Bodies must face outward. Where no material is named, a face is an outer one where it sees enough of the sky: panes count as walls, so
//! that rooms behind glass see none.

use std::collections::BTreeMap;

use glam::{DVec2, Vec2, Vec3};
use rayon::prelude::*;

use super::Sensor;
use super::grid::GridError;
use super::made::{DIGITS, counts, unknown_material};
use crate::daylight::sampling::{cosine_hemisphere, sobol};
use crate::daylight::tangent_frame;
use crate::scene::{Bvh, Ray, Scene};

/// What to make.
#[derive(Debug, Clone, PartialEq)]
pub struct Facades {
    /// Largest distance from a sensor to the next, metres.
    pub spacing: f32,
    /// Distance of the sensors from the surface, metres.
    pub offset: f32,
    /// Names of materials; without any, outer faces are found.
    pub materials: Vec<String>,
}

/// Sine of the angle from the vertical up to which a surface is upright.
const UPRIGHT: f32 = 0.02;

/// Distance of planes that still are one, metres.
const SAME_PLANE: f32 = 0.02;

/// Directions in which a point looks for the sky, a power of two.
const LOOKS: u32 = 64;

/// Share of them, of those above the horizon, that must end in the sky.
const LEAST_SKY: f32 = 0.125;

/// Upright triangles on one plane, facing one way.
struct Wall {
    normal: Vec3,
    /// Distance of the plane from the origin along the normal, metres.
    offset: f32,
    /// Corners: to the right as seen from before the wall, and up, metres.
    triangles: Vec<[Vec2; 3]>,
}

impl Wall {
    fn right(&self) -> Vec3 {
        Vec3::Y.cross(self.normal).normalize_or(Vec3::X)
    }

    fn point(&self, place: Vec2, before: f32) -> Vec3 {
        let level = Vec3::new(self.normal.x, 0.0, self.normal.z).normalize_or(Vec3::Z);
        place.x * self.right() + place.y * Vec3::Y + (self.offset + before) * level
    }
}

/// Makes the sensors, wall after wall in the order of the model, in each from below and there from left to right as seen from before it.
///
/// # Errors
/// A name that no material has, or no place for a sensor.
pub fn make_facades(scene: &Scene, facades: &Facades) -> Result<Vec<Sensor>, GridError> {
    if let Some((name, known)) = unknown_material(scene, &facades.materials) {
        return Err(GridError::UnknownFacade { name, known });
    }
    let bvh = scene.hierarchy();
    let mut sensors = Vec::new();
    for wall in walls(scene, &facades.materials) {
        let places = grid(&wall, facades.spacing);
        let made = places.par_iter().map(|place| {
            let surface = wall.point(*place, 0.0);
            let position = wall.point(*place, facades.offset);
            let sensor = Sensor {
                position: (position * DIGITS).round() / DIGITS,
                normal: wall.normal,
            };
            // Of named ones, those below the ground or against another body see none.
            let least = if facades.materials.is_empty() {
                LEAST_SKY
            } else {
                f32::EPSILON
            };
            let is_found = is_free(&bvh, surface, &sensor) && sky_seen(&bvh, &sensor) >= least;
            is_found.then_some(sensor)
        });
        sensors.extend(made.collect::<Vec<_>>().into_iter().flatten());
    }
    if sensors.is_empty() {
        return Err(GridError::NoFacade {
            is_named: !facades.materials.is_empty(),
        });
    }
    Ok(sensors)
}

/// Upright triangles by their planes.
fn walls(scene: &Scene, names: &[String]) -> Vec<Wall> {
    let mut walls: Vec<Wall> = Vec::new();
    let mut of_direction: BTreeMap<[i32; 2], Vec<usize>> = BTreeMap::new();
    for part in &scene.parts {
        let name = &scene.materials[part.material as usize].name;
        if !names.is_empty() && !names.contains(name) {
            continue;
        }
        let first = part.first_index as usize;
        for corners in scene.indices[first..first + part.index_count as usize].chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|k| Vec3::from(scene.positions[corners[k] as usize]));
            let across = (b - a).cross(c - a);
            if across.y.abs() > UPRIGHT * across.length() || across == Vec3::ZERO {
                continue;
            }
            let normal = Vec3::new(across.x, 0.0, across.z).normalize();
            let offset = normal.dot(a);
            let key = [normal.x, normal.z].map(|v| (v * 500.0).round() as i32);
            let same = of_direction.entry(key).or_default();
            let known = same
                .iter()
                .find(|wall| (walls[**wall].offset - offset).abs() < SAME_PLANE);
            let at = known.copied().unwrap_or_else(|| {
                same.push(walls.len());
                walls.push(Wall {
                    normal,
                    offset,
                    triangles: Vec::new(),
                });
                walls.len() - 1
            });
            let right = walls[at].right();
            let triangle = [a, b, c].map(|v| Vec2::new(right.dot(v), v.y));
            walls[at].triangles.push(triangle);
        }
    }
    walls
}

/// Places on a wall: a grid that is fitted into its rectangle.
fn grid(wall: &Wall, spacing: f32) -> Vec<Vec2> {
    let corners = || wall.triangles.iter().flatten().copied();
    let least = corners().reduce(Vec2::min).unwrap_or_default();
    let most = corners().reduce(Vec2::max).unwrap_or_default();
    let counts = counts(most - least, spacing);
    let step = (most - least) / counts;
    let mut places = Vec::new();
    for row in 0..counts.y as u32 {
        for column in 0..counts.x as u32 {
            let place = least + step * (Vec2::new(column as f32, row as f32) + 0.5);
            if wall.triangles.iter().any(|triangle| holds(triangle, place)) {
                places.push(place);
            }
        }
    }
    places
}

fn holds([a, b, c]: &[Vec2; 3], place: Vec2) -> bool {
    let side = |p: &Vec2, q: &Vec2| (*q - *p).perp_dot(place - *p);
    let sides = [side(a, b), side(b, c), side(c, a)];
    sides.iter().all(|s| *s >= 0.0) || sides.iter().all(|s| *s <= 0.0)
}

/// Whether nothing lies between a surface and its sensor, such as another body against it.
fn is_free(bvh: &Bvh, surface: Vec3, sensor: &Sensor) -> bool {
    let apart = surface.distance(sensor.position);
    let ray = Ray {
        origin: sensor.position,
        direction: -sensor.normal,
    };
    // Not the surface itself.
    !bvh.any(&ray, 0.0, 0.9 * apart, |_| true)
}

/// Share of the sky before a sensor that is seen.
fn sky_seen(bvh: &Bvh, sensor: &Sensor) -> f32 {
    let frame = sensor.normal.as_dvec3();
    let (mut above, mut seen) = (0, 0);
    for look in 0..LOOKS {
        let xi: DVec2 = sobol(look);
        let direction = tangent_frame::to_world(cosine_hemisphere(xi), frame).as_vec3();
        if direction.y <= 0.0 {
            continue;
        }
        let ray = Ray {
            origin: sensor.position,
            direction,
        };
        above += 1;
        seen += u32::from(!bvh.any(&ray, 0.0, f32::INFINITY, |_| true));
    }
    seen as f32 / (above as f32).max(1.0)
}

#[cfg(test)]
mod tests {
    use super::super::plane::tests::boxes;
    use super::*;

    /// A house of 6 x 4 m, 3 m high, walls 0.2 m thick, closed, on the ground.
    fn house() -> Scene {
        boxes(&[
            ([-50.0, -1.0, -50.0], [50.0, 0.0, 50.0], "ground"),
            ([0.0, 0.0, 0.0], [6.0, 3.0, 0.2], "brick"),
            ([0.0, 0.0, 3.8], [6.0, 3.0, 4.0], "brick"),
            ([0.0, 0.0, 0.2], [0.2, 3.0, 3.8], "brick"),
            ([5.8, 0.0, 0.2], [6.0, 3.0, 3.8], "brick"),
            ([0.0, 3.0, 0.0], [6.0, 3.2, 4.0], "roof"),
        ])
    }

    fn facades(materials: &[&str]) -> Facades {
        Facades {
            spacing: 1.0,
            offset: 0.05,
            materials: materials.iter().map(ToString::to_string).collect(),
        }
    }

    #[test]
    fn outer_walls_are_covered_and_inner_ones_are_not() {
        let mut sensors = make_facades(&house(), &facades(&[])).expect("sensors");
        // The edges of the ground are upright, too.
        sensors.retain(|sensor| sensor.position.y > 0.0);
        let middle = Vec3::new(3.0, 0.0, 2.0);
        for sensor in &sensors {
            assert!(
                sensor.normal.dot(sensor.position - middle) > 1.9,
                "{sensor:?}"
            );
            assert!(sensor.normal.y.abs() < 1e-6);
        }
        let of = |normal: Vec3| {
            let facing = sensors.iter().filter(|s| s.normal.dot(normal) > 0.99);
            facing.map(|s| s.position).collect::<Vec<_>>()
        };
        // Walls of 3 m and the edge of the roof, which is one row.
        let south = of(Vec3::Z);
        assert_eq!(south.len(), 6 * 4, "{south:?}");
        assert!(south.iter().all(|p| (p.z - 4.05).abs() < 1e-4));
        assert!(
            (south[0].x - 0.5).abs() < 1e-4,
            "from the west, which is left"
        );
        let north = of(Vec3::NEG_Z);
        assert_eq!(north.len(), 6 * 4);
        assert!(
            (north[0].x - 5.5).abs() < 1e-4,
            "from the east, which is left"
        );
        assert!(of(Vec3::Y).is_empty());
    }

    #[test]
    fn named_materials_are_covered_where_they_see_the_sky() {
        let sensors = make_facades(&house(), &facades(&["roof"])).expect("sensors");
        assert!(sensors.iter().all(|s| (3.0..3.2).contains(&s.position.y)));
        let unknown = make_facades(&house(), &facades(&["stone"])).expect_err("no such wall");
        assert!(unknown.to_string().contains("brick"), "{unknown}");
        let inside = boxes(&[([0.0; 3], [1.0, 0.001, 1.0], "sheet")]);
        let none = make_facades(
            &Scene {
                parts: Vec::new(),
                ..inside
            },
            &facades(&[]),
        );
        let said = none.expect_err("nothing upright").to_string();
        assert!(said.contains("--facade="), "{said}");
    }
}
