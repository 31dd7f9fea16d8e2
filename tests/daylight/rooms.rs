//! Sensors in rooms: light that enters is absorbed or leaves, walls of two sides let none through, and no direction is special.

use std::f32::consts::PI;

use glam::{Quat, Vec3};
use skylight::daylight::{Conditions, Daylight, SkyModel};
use skylight::scene::Scene;
use skylight::sensors::{Reading, Sensor};

use crate::bounces::{mean, readings, spread};
use crate::model::{Model, clear_day, matt};

/// CIE overcast sky over ground that reflects 0.2.
fn overcast() -> Daylight {
    Daylight::new(&Conditions {
        model: SkyModel::Overcast,
        ..Conditions::default()
    })
}

/// Inner edges of a room, metres.
const ROOM: Vec3 = Vec3::new(4.0, 3.0, 5.0);

/// A side of a room: a corner, two edges, the normal into the room, reflectance.
type Side = ([Vec3; 3], Vec3, f32);

/// The surfaces of a room without thickness and its window in the wall to +z.
fn sides() -> (Vec<Side>, [Vec3; 3]) {
    let [x, y, z] = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| axis * ROOM);
    let mut sides = vec![
        ([Vec3::ZERO, z, x], Vec3::Y, 0.3),
        ([y, x, z], -Vec3::Y, 0.8),
        ([Vec3::ZERO, y, z], Vec3::X, 0.5),
        ([x, z, y], -Vec3::X, 0.5),
        ([Vec3::ZERO, x, y], Vec3::Z, 0.6),
    ];
    let (left, right, sill, head) = (0.4, 3.7, 0.5, 2.6);
    let piece = |x0: f32, x1: f32, y0: f32, y1: f32| {
        let corner = Vec3::new(x0, y0, ROOM.z);
        [corner, (y1 - y0) * Vec3::Y, (x1 - x0) * Vec3::X]
    };
    for wall in [
        piece(0.0, left, 0.0, ROOM.y),
        piece(right, ROOM.x, 0.0, ROOM.y),
        piece(left, right, 0.0, sill),
        piece(left, right, head, ROOM.y),
    ] {
        sides.push((wall, -Vec3::Z, 0.5));
    }
    (sides, piece(left, right, sill, head))
}

/// One sensor in each of `n` x `n` cells of about 0.2 m of a side, and the area of a cell, m².
fn cells(side: [Vec3; 3], normal: Vec3) -> (Vec<Sensor>, f64) {
    let area = f64::from(side[1].cross(side[2]).length());
    let n = (area.sqrt() / 0.2).ceil() as u32;
    let sensor = |position| Sensor { position, normal };
    let sensors = spread(side, n).into_iter().map(sensor).collect();
    (sensors, area / f64::from(n * n))
}

#[test]
fn the_light_that_enters_a_room_is_absorbed_or_leaves() {
    let (sides, window) = sides();
    let model = Model::default();
    let scene = sides.iter().fold(model, |model, ([c, u, v], _, rho)| {
        model.quad(c.to_array(), u.to_array(), v.to_array(), &matt(*rho))
    });
    let (scene, sky) = (scene.build(), overcast());
    // What is measured, and the share of it that counts: light that enters, that leaves, and that the sides absorb.
    let mut measured = vec![(window, Vec3::Z, 1.0), (window, -Vec3::Z, 1.0)];
    measured.extend(sides.iter().map(|(side, n, rho)| (*side, *n, 1.0 - rho)));
    let (mut sensors, mut shares) = (Vec::new(), Vec::new());
    for (at, (side, normal, share)) in measured.into_iter().enumerate() {
        let (list, area) = cells(side, normal);
        shares.extend(list.iter().map(|_| (at, f64::from(share) * area)));
        sensors.extend(list);
    }
    // One call for all, so that no two sensors share their random numbers.
    let readings = readings(&scene, &sky, &sensors, 0.0, 1024);
    let [mut enters, mut leaves, mut absorbed, mut square] = [0.0; 4];
    for (reading, (at, share)) in readings.iter().zip(shares) {
        let sum = [&mut enters, &mut leaves, &mut absorbed];
        *sum[at.min(2)] += share * reading.total();
        square += (share * reading.standard_error).powi(2);
    }
    let (balance, error) = ((absorbed + leaves) / enters - 1.0, square.sqrt() / enters);
    println!(
        "{enters:.0} lm enter, {absorbed:.0} are absorbed, {leaves:.0} leave: {:+.3} %, standard error {:.3} %",
        100.0 * balance,
        100.0 * error
    );
    assert!(leaves > 0.05 * enters && absorbed > 0.5 * enters);
    assert!(error < 0.005 / 3.0, "{error}");
    assert!(balance.abs() < 0.005, "{balance}");
}

/// A room of slabs of 0.1 m on round coordinates, turned about +Y by `turn`, with or without a window to +z.
fn slabs(turn: f32, has_window: bool) -> Scene {
    let (x, y, z, d) = (ROOM.x, ROOM.y, ROOM.z, 0.1);
    let mut list = vec![
        ([-d, -d, -d], [x + d, 0.0, z + d], 0.3),
        ([-d, y, -d], [x + d, y + d, z + d], 0.8),
        ([-d, 0.0, -d], [0.0, y, z + d], 0.5),
        ([x, 0.0, -d], [x + d, y, z + d], 0.5),
        ([0.0, 0.0, -d], [x, y, 0.0], 0.5),
    ];
    let (left, right, sill, head) = if has_window {
        (0.5, 3.5, 1.0, 2.5)
    } else {
        (2.0, 2.0, 1.5, 1.5)
    };
    list.extend([
        ([0.0, 0.0, z], [left, y, z + d], 0.5),
        ([right, 0.0, z], [x, y, z + d], 0.5),
    ]);
    if has_window {
        list.extend([
            ([left, 0.0, z], [right, sill, z + d], 0.5),
            ([left, head, z], [right, y, z + d], 0.5),
        ]);
    }
    let model = Model::default();
    let add = |model: Model, (low, high, rho): ([f32; 3], [f32; 3], f32)| {
        model.slab(low, high, turn, &matt(rho))
    };
    list.into_iter().fold(model, add).build()
}

/// Sensors of a room that is turned with them.
fn turned(turn: f32, sensors: impl IntoIterator<Item = Sensor>) -> Vec<Sensor> {
    let turn = Quat::from_rotation_y(turn);
    let sensor = |s: Sensor| Sensor {
        position: turn * s.position,
        normal: turn * s.normal,
    };
    sensors.into_iter().map(sensor).collect()
}

/// 30°.
const TURN: f32 = PI / 6.0;

#[test]
fn no_light_comes_through_double_walls_in_any_direction() {
    let sky = clear_day(155.0, 35.0);
    // A millimetre from walls, edges and corners, toward and away from them.
    let inset = |v: f32, edge: f32| 1e-3 + v * (edge - 2e-3);
    let shares = [0.0, 0.25, 1.0];
    let points = shares.into_iter().flat_map(|a| {
        let rows = shares
            .into_iter()
            .flat_map(move |b| shares.map(|c| [a, b, c]));
        rows.map(|[a, b, c]| Vec3::new(inset(a, ROOM.x), inset(b, ROOM.y), inset(c, ROOM.z)))
    });
    let sensors: Vec<Sensor> = points
        .enumerate()
        .map(|(i, position)| Sensor {
            position,
            normal: [Vec3::Y, -Vec3::Z, Vec3::X, -Vec3::Y, Vec3::Z, -Vec3::X][i % 6],
        })
        .collect();
    for turn in [0.0, TURN] {
        let scene = slabs(turn, false);
        let sensors = turned(turn, sensors.iter().copied());
        let lit: Vec<Reading> = readings(&scene, &sky, &sensors, 0.0, 4096)
            .into_iter()
            .filter(|r| r.total() > 0.0)
            .collect();
        println!(
            "turned by {turn:.2}: {} of {} sensors are lit",
            lit.len(),
            sensors.len()
        );
        assert!(lit.is_empty(), "{lit:?}");
    }
}

#[test]
fn a_room_that_is_turned_under_an_overcast_sky_keeps_its_light() {
    let sky = overcast();
    let floor = [Vec3::new(0.25, 0.8, 0.5), 3.5 * Vec3::X, 4.0 * Vec3::Z];
    let sensors = spread(floor, 8).into_iter().map(|position| Sensor {
        position,
        normal: Vec3::Y,
    });
    let sensors: Vec<Sensor> = sensors.collect();
    let [(lux, error), (lux_turned, error_turned)] = [0.0, TURN].map(|turn| {
        let sensors = turned(turn, sensors.iter().copied());
        mean(&readings(&slabs(turn, true), &sky, &sensors, 0.0, 8192))
    });
    let difference = lux_turned / lux - 1.0;
    let error = error.hypot(error_turned) / lux;
    println!(
        "{lux:.1} lux, turned {lux_turned:.1}: {:+.3} %, standard error {:.3} %",
        100.0 * difference,
        100.0 * error
    );
    assert!(error < 0.01 / 3.0, "{error}");
    assert!(difference.abs() < 0.01, "{difference}");
}
