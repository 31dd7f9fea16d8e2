use super::*;
use crate::scene::{Bounds, Material, Part};

/// Boxes that face outward, each by its least and its largest corner, and the name of its material.
pub fn boxes(list: &[([f32; 3], [f32; 3], &str)]) -> Scene {
    let mut scene = Scene::default();
    for (at, (low, high, name)) in list.iter().enumerate() {
        let (low, high) = (Vec3::from(*low), Vec3::from(*high));
        for axis in 0..3 {
            for (side, base) in [(0, low), (1, high)] {
                let [mut u, mut v] = [Vec3::ZERO; 2];
                u[(axis + 1) % 3] = high[(axis + 1) % 3] - low[(axis + 1) % 3];
                v[(axis + 2) % 3] = high[(axis + 2) % 3] - low[(axis + 2) % 3];
                let corners = if side == 1 {
                    [base, base - u, base - u - v, base - v]
                } else {
                    [base, base + v, base + u + v, base + u]
                };
                let first = scene.positions.len() as u32;
                scene.positions.extend(corners.map(|p| p.to_array()));
                scene.indices.extend([0, 1, 2, 0, 2, 3].map(|k| first + k));
            }
        }
        scene.parts.push(Part {
            first_index: 36 * at as u32,
            index_count: 36,
            material: at as u32,
            has_colours: false,
            bounds: Bounds::EMPTY,
        });
        scene.materials.push(Material {
            name: (*name).to_owned(),
            ..Material::default()
        });
    }
    scene.bounds = Bounds::of(scene.positions.iter().copied().map(Vec3::from));
    scene
}

/// Two rooms of 4 x 3 m and 5 x 3 m with a wall between, on a slab below a slab, in the middle of a wide ground, before a solid block.
fn house() -> Scene {
    boxes(&[
        ([-60.0, -1.0, -60.0], [60.0, -0.3, 60.0], "ground"),
        ([-0.2, -0.3, -0.2], [9.3, 0.0, 3.2], "floor"),
        ([-0.2, 2.6, -0.2], [9.3, 2.8, 3.2], "ceiling"),
        ([-0.2, 0.0, -0.2], [9.3, 2.6, 0.0], "wall north"),
        ([-0.2, 0.0, 3.0], [9.3, 2.6, 3.2], "wall south"),
        ([-0.2, 0.0, 0.0], [0.0, 2.6, 3.0], "wall west"),
        ([9.1, 0.0, 0.0], [9.3, 2.6, 3.0], "wall east"),
        ([4.0, 0.0, 0.0], [4.1, 2.6, 3.0], "wall between"),
        // A cupboard, and a table that the plane passes above.
        ([3.4, 0.0, 2.4], [4.0, 2.0, 3.0], "cupboard"),
        ([5.0, 0.7, 1.0], [6.5, 0.74, 2.0], "table"),
        ([-20.0, -0.3, 10.0], [20.0, 9.0, 20.0], "block"),
    ])
}

fn planes(spacing: f32) -> Planes {
    Planes {
        height: 0.8,
        spacing,
        inset: 0.0,
        floors: Vec::new(),
    }
}

fn made(scene: &Scene, planes: &Planes) -> Vec<Vec3> {
    let sensors = make_grid(scene, planes).expect("sensors");
    assert!(sensors.iter().all(|sensor| sensor.normal == Vec3::Y));
    sensors.iter().map(|sensor| sensor.position).collect()
}

#[test]
fn rooms_are_filled_between_their_walls() {
    let points = made(&house(), &planes(0.5));
    let [first, second]: [Vec<Vec3>; 2] = [0.0..4.0, 4.1..9.1].map(|x: std::ops::Range<f32>| {
        points
            .iter()
            .copied()
            .filter(|p| x.contains(&p.x))
            .collect()
    });
    // 8 x 6 without the one in the cupboard, and 10 x 6.
    assert_eq!([first.len(), second.len()], [47, 60], "{points:?}");
    assert_eq!(points.len(), 107);
    let near = |p: Vec3, q: [f32; 3]| p.distance(Vec3::from(q)) < 1e-4;
    // From south to north, from west to east.
    assert!(near(first[0], [0.25, 0.8, 2.75]), "{}", first[0]);
    assert!(near(first[46], [3.75, 0.8, 0.25]), "{}", first[46]);
    assert!(near(second[0], [4.35, 0.8, 2.75]), "{}", second[0]);
}

#[test]
fn the_spacing_is_the_largest_distance() {
    let points = made(&house(), &planes(0.6));
    let row = points.iter().filter(|p| p.x > 4.1 && p.z > 2.5);
    let row: Vec<f32> = row.map(|p| p.x).collect();
    // 5 m in nine steps.
    assert_eq!(row.len(), 9, "{row:?}");
    assert!((row[1] - row[0] - 5.0 / 9.0).abs() < 1e-4, "{row:?}");
}

#[test]
fn an_inset_keeps_away_from_walls() {
    let inset = Planes {
        inset: 0.5,
        ..planes(0.25)
    };
    let points = made(&house(), &inset);
    assert!(!points.is_empty());
    for p in points.iter().filter(|p| p.x > 4.1) {
        assert!(
            (4.6..=8.6).contains(&p.x) && (0.5..=2.5).contains(&p.z),
            "{p}"
        );
    }
}

#[test]
fn named_floors_need_no_walls() {
    let named = |name: &str| Planes {
        floors: vec![name.to_owned()],
        ..planes(1.0)
    };
    let points = made(&house(), &named("table"));
    // On the table top, and in the room below it on that of its underside.
    assert!(
        points.iter().any(|p| (p.y - 1.54).abs() < 1e-4),
        "{points:?}"
    );
    let unknown = make_grid(&house(), &named("carpet")).expect_err("no such floor");
    let said = unknown.to_string();
    assert!(
        said.contains("carpet") && said.contains("wall between"),
        "{said}"
    );
}

#[test]
fn what_is_no_room_has_no_sensors() {
    // A block on the ground, and a roof without walls.
    let outdoors = boxes(&[
        ([-20.0, -1.0, -20.0], [20.0, 0.0, 20.0], "ground"),
        ([-5.0, 0.0, -5.0], [5.0, 4.0, 5.0], "block"),
        ([8.0, 3.0, -3.0], [14.0, 3.2, 3.0], "roof"),
    ]);
    let said = make_grid(&outdoors, &planes(0.5))
        .expect_err("no room")
        .to_string();
    assert!(
        said.contains("--rooms") && said.contains("--grid"),
        "{said}"
    );
}
