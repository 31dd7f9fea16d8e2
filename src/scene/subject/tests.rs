//! Generated scenes with a known subject.

use glam::Vec3;

use super::Subject;
use crate::scene::{Bounds, Camera, Scene};

/// A scene of quads, each given by a corner and two edges; the front is on the side of `u` x `v`.
fn scene(quads: &[[Vec3; 3]]) -> Scene {
    let mut scene = Scene::default();
    for &[corner, u, v] in quads {
        let first = scene.positions.len() as u32;
        let corners = [corner, corner + u, corner + u + v, corner + v];
        scene.positions.extend(corners.map(|p| p.to_array()));
        scene.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
    }
    scene.into_one_part()
}

/// The sides of a box, with the fronts outward.
fn solid(min: Vec3, max: Vec3) -> Vec<[Vec3; 3]> {
    let e = max - min;
    let [x, y, z] = [Vec3::X * e.x, Vec3::Y * e.y, Vec3::Z * e.z];
    vec![
        [min, y, x],
        [min, z, y],
        [min, x, z],
        [max, -x, -y],
        [max, -y, -z],
        [max, -z, -x],
    ]
}

/// A room with the fronts of its walls inward. `open` is the number of the wall that is left out.
fn room(size: Vec3, open: Option<usize>) -> Vec<[Vec3; 3]> {
    let mut walls = solid(Vec3::ZERO, size);
    for [_, u, v] in &mut walls {
        (*u, *v) = (*v, *u);
    }
    if let Some(open) = open {
        walls.remove(open);
    }
    walls
}

fn ground(half: f32, y: f32) -> [Vec3; 3] {
    let corner = Vec3::new(-half, y, -half);
    [corner, Vec3::Z * (2.0 * half), Vec3::X * (2.0 * half)]
}

fn view(scene: &mut Scene) -> (Subject, Camera) {
    let subject = Subject::of(scene).entered(scene);
    (subject, Camera::from_parts(None, None, None, &subject, 1.6))
}

#[test]
fn a_ground_does_not_make_a_house_a_dot() {
    for half in [20.0, 200.0, 5000.0] {
        let house = Bounds {
            min: Vec3::new(3.0, 0.0, 2.0),
            max: Vec3::new(13.0, 6.0, 10.0),
        };
        let mut quads = solid(house.min, house.max);
        quads.push(ground(half, 0.0));
        let (subject, _) = view(&mut scene(&quads));
        assert_eq!(subject.bounds, house, "ground of {half} m");
        assert_eq!(subject.inside, None, "a solid is looked at from outside");
    }
    // A slab has sides that stand, but hardly.
    let mut quads = solid(Vec3::ZERO, Vec3::new(10.0, 6.0, 8.0));
    quads.extend(solid(
        Vec3::new(-200.0, -0.5, -200.0),
        Vec3::new(200.0, 0.0, 200.0),
    ));
    let (subject, _) = view(&mut scene(&quads));
    assert_eq!(subject.bounds.max, Vec3::new(10.0, 6.0, 8.0));
}

#[test]
fn what_lies_far_off_is_left_out_and_a_second_house_is_not() {
    let house = solid(Vec3::ZERO, Vec3::new(10.0, 6.0, 8.0));
    for far in [60.0, 900.0, 1e5] {
        for side in [Vec3::X, Vec3::NEG_Z, Vec3::new(1.0, 1.0, 1.0)] {
            let at = side * far;
            let mut quads = house.clone();
            quads.extend(solid(at, at + 0.5));
            let (subject, _) = view(&mut scene(&quads));
            assert_eq!(subject.bounds.max, Vec3::new(10.0, 6.0, 8.0), "{at}");
        }
    }
    let mut quads = house;
    quads.extend(solid(Vec3::X * 80.0, Vec3::new(90.0, 6.0, 8.0)));
    let two = scene(&quads);
    assert_eq!(Subject::of(&two).bounds, two.bounds);
}

#[test]
fn flat_and_empty_scenes_are_seen_whole() {
    let flat = scene(&[ground(30.0, 0.0)]);
    assert_eq!(Subject::of(&flat).bounds, flat.bounds);
    let empty = Scene::default();
    assert_eq!(Subject::of(&empty).bounds, empty.bounds);
}

#[test]
fn a_room_is_entered_and_looked_at_toward_its_window() {
    for (open, toward) in [
        (0, Vec3::NEG_Z),
        (3, Vec3::Z),
        (1, Vec3::NEG_X),
        (4, Vec3::X),
    ] {
        let size = Vec3::new(6.0, 2.8, 6.5);
        // Half of one wall is a window.
        let mut quads = room(size, Some(open));
        let mut wall = room(size, None)[open];
        // The quad spans the height by one of its edges: halve that.
        let height = if wall[1].y == 0.0 { 2 } else { 1 };
        wall[height] *= 0.5;
        quads.push(wall);
        quads.push(ground(200.0, -0.3));
        let (subject, camera) = view(&mut scene(&quads));
        assert!(subject.inside.is_some(), "window in wall {open}");
        let e = camera.eye;
        let is_within = e.cmpgt(Vec3::ZERO).all() && e.cmplt(size).all();
        assert!(is_within, "the eye at {e} is not in the room");
        assert!((e.y - 1.6).abs() < 0.01, "the eye is {} m high", e.y);
        assert!(
            camera.forward().dot(toward) > 0.5,
            "{} to {toward}",
            camera.forward()
        );
    }
}

#[test]
fn a_house_of_many_rooms_and_a_court_are_seen_from_outside() {
    let mut house = Vec::new();
    for i in 0..6 {
        let at = Vec3::new(5.0 * (i % 3) as f32, 0.0, 5.0 * (i / 3) as f32);
        let walls = room(Vec3::new(5.0, 2.7, 5.0), None);
        house.extend(walls.into_iter().map(|[c, u, v]| [c + at, u, v]));
    }
    assert_eq!(view(&mut scene(&house)).0.inside, None);
    let court: Vec<_> = room(Vec3::new(9.0, 3.0, 9.0), None)
        .into_iter()
        .filter(|[_, u, v]| u.y != 0.0 || v.y != 0.0)
        .collect();
    assert_eq!(view(&mut scene(&court)).0.inside, None);
}
