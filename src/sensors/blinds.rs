//! Blinds against the sun, room by room.

use std::collections::HashMap;

use glam::{IVec3, Vec3};
use rayon::prelude::*;

use super::{Sensor, TracedScene, YearLight};
use crate::daylight::metrics::{BLINDS_LUX, BLINDS_SHARE, Closings};

/// How far above sensors a way past low furniture and screens is looked for, metres.
const ABOVE: Vec3 = Vec3::new(0.0, 1.0, 0.0);

/// Edge of the boxes in which neighbours are looked for, relative to that which holds one sensor of an even plane.
const WIDER: f32 = 1.5;

/// When the blinds of each room are closed: in lit hours in which more of its sensors have direct sun than they may (IES LM-83-12, 2.2.6).
/// The sun counts through open blinds, unreflected; all windows of a room are one group.
pub fn close_blinds(sensors: &[Sensor], scene: &TracedScene, light: &YearLight) -> Closings {
    let room_of = rooms(sensors, scene);
    let count = room_of.iter().max().map_or(0, |last| last + 1);
    let mut of_room: Vec<Vec<Sensor>> = vec![Vec::new(); count];
    for (sensor, room) in sensors.iter().zip(&room_of) {
        of_room[*room].push(*sensor);
    }
    let closed = of_room.iter().map(|own| closed_hours(own, scene, light));
    Closings {
        closed: closed.collect(),
        room_of,
    }
}

/// Of each lit hour, whether the blinds of a room with these sensors are closed.
fn closed_hours(sensors: &[Sensor], scene: &TracedScene, light: &YearLight) -> Vec<bool> {
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

/// The room of each sensor, numbered from 0 in the order of their first ones: neighbours between which there is nothing, or nothing higher than
/// furniture, are in one room. Panes part rooms, too.
fn rooms(sensors: &[Sensor], scene: &TracedScene) -> Vec<usize> {
    let mut parent: Vec<usize> = (0..sensors.len()).collect();
    for [a, b] in neighbours(sensors) {
        let (a_root, b_root) = (root(&mut parent, a), root(&mut parent, b));
        if a_root != b_root && is_open(sensors[a].position, sensors[b].position, scene) {
            parent[a_root.max(b_root)] = a_root.min(b_root);
        }
    }
    // The first sensor of a room is its root.
    let mut numbers: HashMap<usize, usize> = HashMap::new();
    let number = |at| {
        let (root, next) = (root(&mut parent, at), numbers.len());
        *numbers.entry(root).or_insert(next)
    };
    (0..sensors.len()).map(number).collect()
}

fn root(parent: &mut [usize], mut at: usize) -> usize {
    while parent[at] != at {
        parent[at] = parent[parent[at]];
        at = parent[at];
    }
    at
}

/// Pairs of sensors that are near each other.
fn neighbours(sensors: &[Sensor]) -> Vec<[usize; 2]> {
    let positions = || sensors.iter().map(|sensor| sensor.position);
    let low = positions().fold(Vec3::INFINITY, Vec3::min);
    let high = positions().fold(Vec3::NEG_INFINITY, Vec3::max);
    let edge = WIDER * (high - low).length() / (sensors.len() as f32).sqrt();
    let place = |position: Vec3| ((position - low) / edge.max(1e-3)).floor().as_ivec3();
    let mut boxes: HashMap<IVec3, Vec<usize>> = HashMap::new();
    let mut pairs = Vec::new();
    for (at, position) in positions().enumerate() {
        let own = place(position);
        for step in 0..27 {
            let step = IVec3::new(step % 3, step / 3 % 3, step / 9) - 1;
            let others = boxes.get(&(own + step)).into_iter().flatten();
            pairs.extend(others.map(|other| [*other, at]));
        }
        boxes.entry(own).or_default().push(at);
    }
    pairs
}

/// Whether one sees the other, or would over what is low.
fn is_open(a: Vec3, b: Vec3, scene: &TracedScene) -> bool {
    let sees = |a: Vec3, b: Vec3| !scene.is_parted(a, b);
    sees(a, b) || (sees(a, a + ABOVE) && sees(b, b + ABOVE) && sees(a + ABOVE, b + ABOVE))
}

#[cfg(test)]
mod tests {
    use super::super::tests::squares;
    use super::*;

    fn at(x: f32, z: f32) -> Sensor {
        Sensor {
            position: Vec3::new(x, 0.8, z),
            normal: Vec3::Y,
        }
    }

    #[test]
    fn walls_part_rooms_and_screens_do_not() {
        // A wall of 3 m across z = 0, a screen of 1.2 m across x = 5.
        let wall = [Vec3::new(-50.0, 0.0, 0.0), 100.0 * Vec3::X, 3.0 * Vec3::Y];
        let screen = [Vec3::new(5.0, 0.0, -50.0), 100.0 * Vec3::Z, 1.2 * Vec3::Y];
        let scene = squares(&[wall, screen]);
        let scene = TracedScene::new(&scene);
        let mut sensors = Vec::new();
        for z in [-1.5, -0.5, 0.5, 1.5] {
            sensors.extend((0..10).map(|x| at(x as f32 + 0.5, z)));
        }
        let rooms = rooms(&sensors, &scene);
        assert_eq!(rooms, [[0; 20], [1; 20]].concat());
        assert!(super::rooms(&[], &scene).is_empty());
        assert_eq!(super::rooms(&sensors[..1], &scene), [0]);
    }
}
