//! Sunlight and sheets without thickness that meet at edges: none in a sealed room, all of it on what faces the sun.

use std::f32::consts::TAU;

use crate::gpu::{Device, Model, Picture, camera, clear_day, matt, settings};
use glam::{Quat, Vec3};
use skylight::frame::{FrameSettings, Visibility};
use skylight::passes::light::lighting::Show;
use skylight::scene::{Camera, Scene};

/// Azimuth and elevation, degrees: along walls and across them, low and high.
const SUNS: [(f64, f64); 5] = [
    (180.0, 12.0),
    (90.0, 50.0),
    (137.0, 25.0),
    (246.0, 50.0),
    (310.0, 78.0),
];

/// Pixels of a corner in the sun that may be dark: the map has nothing but the wall in the texels around one, where the wall is 10
/// degrees from the light.
const AT_CORNER: usize = 1;

fn visibility() -> FrameSettings {
    let mut set = crate::gpu::showing(Show::Visibility, settings(240, 180));
    set.shadow_resolution = 1024;
    set
}

/// The shape of a room.
#[derive(Debug, Clone, Copy)]
enum Shape {
    /// An upright prism with a flat roof; the number of walls.
    Prism(usize),
    /// Four walls under a ridged roof.
    Gable,
    /// Sloping walls that meet at the top.
    Tent,
}

/// Polygons of a room without its floor, and its floor: `size` metres wide, turned by an angle about the vertical through `at`.
fn room(shape: Shape, size: f32, turn: f32, at: Vec3) -> (Vec<Vec<Vec3>>, Vec<Vec3>) {
    let corners = if let Shape::Prism(n) = shape { n } else { 4 };
    let high = if matches!(shape, Shape::Tent) {
        0.3
    } else {
        0.4
    } * size;
    let around = |k: usize, y: f32| {
        let angle = TAU * (k % corners) as f32 / corners as f32 + turn;
        at + Vec3::new(0.5 * size * angle.cos(), y, 0.5 * size * angle.sin())
    };
    let top = at + Vec3::Y * (1.4 * high);
    let ridge = [1, 3].map(|k| top + 0.5 * (around(k, 0.0) + around(k - 1, 0.0) - 2.0 * at));
    let mut sheets: Vec<Vec<Vec3>> = match shape {
        Shape::Tent => {
            let side = |k| vec![around(k, 0.0), around(k + 1, 0.0), top];
            return ((0..corners).map(side).collect(), floor(&around, corners));
        }
        _ => (0..corners)
            .map(|k| {
                let foot = [around(k, 0.0), around(k + 1, 0.0)];
                vec![foot[0], foot[1], around(k + 1, high), around(k, high)]
            })
            .collect(),
    };
    if matches!(shape, Shape::Gable) {
        let eaves = |k: usize| around(k, high);
        sheets.push(vec![eaves(0), eaves(1), ridge[0]]);
        sheets.push(vec![eaves(2), eaves(3), ridge[1]]);
        sheets.push(vec![eaves(1), eaves(2), ridge[1], ridge[0]]);
        sheets.push(vec![eaves(3), eaves(0), ridge[0], ridge[1]]);
    } else {
        sheets.push((0..corners).map(|k| around(k, high)).collect());
    }
    (sheets, floor(&around, corners))
}

fn floor(around: &impl Fn(usize, f32) -> Vec3, corners: usize) -> Vec<Vec3> {
    (0..corners).map(|k| around(k, 0.0)).collect()
}

/// Convex polygons as triangles.
fn scene(polygons: &[Vec<Vec3>]) -> Scene {
    let fan = |p: &Vec<Vec3>| -> Vec<[Vec3; 3]> {
        let (first, rest) = (p[0], &p[1..]);
        rest.windows(2).map(|w| [first, w[0], w[1]]).collect()
    };
    let triangles: Vec<[Vec3; 3]> = polygons.iter().flat_map(fan).collect();
    Model::default().triangles(&triangles, &matt(0.5)).build()
}

fn lit(picture: &Picture) -> usize {
    picture.pixels().filter(|(_, v)| v.x > 1e-6).count()
}

/// A view from within a room.
fn within(at: Vec3, size: f32, turn: f32) -> Camera {
    let eye = at + 0.12 * size * Vec3::Y;
    let toward = Quat::from_rotation_y(turn) * Vec3::new(1.0, 0.1, 0.3);
    Camera {
        fov_deg: 95.0,
        ..camera(eye.to_array(), (eye + toward).to_array())
    }
}

/// The rooms, each with its place, its size and the outside: half of them stand on open ground that goes through them.
fn rooms() -> impl Iterator<Item = (Scene, Vec3, f32, String)> {
    let shapes = [
        (Shape::Prism(4), 3.0, TAU / 8.0),
        (Shape::Prism(4), 20.0, 0.9),
        (Shape::Prism(7), 8.0, 0.2),
        (Shape::Gable, 12.0, TAU / 8.0),
        (Shape::Tent, 5.0, 0.4),
        (Shape::Tent, 24.0, 0.0),
    ];
    shapes
        .into_iter()
        .enumerate()
        .map(|(i, (shape, size, turn))| {
            let at = Vec3::new(7.0, 0.0, -3.0);
            let (mut sheets, floor) = room(shape, size, turn, at);
            let corner = |x, z| at + 2.0 * size * Vec3::new(x, 0.0, z);
            sheets.push(if i % 2 == 0 {
                floor
            } else {
                [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)]
                    .map(|(x, z)| corner(x, z))
                    .to_vec()
            });
            (scene(&sheets), at, size, format!("{shape:?} of {size} m"))
        })
}

/// Fails with each view of a sealed room in which a pixel is lit.
fn expect_dark(set: FrameSettings, suns: &[(f64, f64)]) {
    let mut device = Device::new();
    let mut bright = Vec::new();
    for (scene, at, size, name) in rooms() {
        let first = clear_day(suns[0].0, suns[0].1);
        let mut frame = device.frame(&scene, set, &first, &within(at, size, 0.0));
        for (i, (azimuth, elevation)) in suns.iter().enumerate() {
            let (day, view) = (
                clear_day(*azimuth, *elevation),
                within(at, size, i as f32 * 1.3),
            );
            device.draw(&mut frame, &day, &view);
            let count = lit(&device.picture_of(&frame));
            if count > 0 {
                bright.push(format!("{name}, sun {azimuth} {elevation}: {count} pixels"));
            }
        }
    }
    assert!(bright.is_empty(), "the sun in sealed rooms: {bright:#?}");
}

#[test]
fn no_pixel_of_a_sealed_room_of_sheets_is_in_the_sun() {
    expect_dark(visibility(), &SUNS);
}

#[test]
fn no_pixel_is_with_penumbrae() {
    let mut set = visibility();
    set.lighting.shadows.penumbrae = true;
    expect_dark(set, &SUNS[2..4]);
}

#[test]
fn no_pixel_is_in_the_mean_of_converging_frames() {
    let mut set = visibility();
    (set.sampling.visibility, set.samples) = (Visibility::Dome, 4);
    expect_dark(set, &SUNS[1..4]);
}

#[test]
fn the_sun_enters_where_a_wall_is_missing() {
    let at = Vec3::ZERO;
    let (mut sheets, floor) = room(Shape::Prism(4), 8.0, TAU / 8.0, at);
    sheets.push(floor);
    // The roof.
    sheets.remove(4);
    let mut device = Device::new();
    let view = within(at, 8.0, 0.0);
    let picture = device.picture(
        &scene(&sheets),
        visibility(),
        &clear_day(246.0, 50.0),
        &view,
    );
    assert!(lit(&picture) > 1000, "{}", lit(&picture));
}

#[test]
fn sheets_that_face_the_sun_are_lit_up_to_their_edges() {
    let grey = matt(0.5);
    let mut device = Device::new();
    let mut dark = Vec::new();
    for size in [1.5_f32, 8.0, 40.0] {
        // A floor and a wall that meet at a corner, both in the sun.
        let wide = 2.0 * size;
        let scene = Model::default()
            .ground(size, &grey)
            .quad(
                [-size, 0.0, -size],
                [wide, 0.0, 0.0],
                [0.0, size, 0.0],
                &grey,
            )
            .build();
        let eye = [0.4 * size, 1.1 * size, 2.0 * size];
        let view = camera(eye, [0.0, 0.2 * size, -0.5 * size]);
        for (azimuth, elevation) in [(180.0, 15.0), (150.0, 45.0), (225.0, 60.0), (190.0, 80.0)] {
            let day = clear_day(azimuth, elevation);
            let mut frame = device.frame(&scene, visibility(), &day, &view);
            let seen = device.picture_of(&frame);
            frame.show(Show::Depth).expect("shown");
            device.draw(&mut frame, &day, &view);
            let depth = device.picture_of(&frame);
            let surfaces = depth.pixels().filter(|(_, d)| d.x > 0.0);
            let unlit = surfaces.filter(|([x, y], _)| seen.at(*x, *y).x < 1.0 - 1e-6);
            let count = unlit.count();
            if count > AT_CORNER {
                dark.push(format!(
                    "{size} m, sun {azimuth} {elevation}: {count} pixels"
                ));
            }
        }
    }
    assert!(
        dark.is_empty(),
        "sheets in the sun that are not lit: {dark:#?}"
    );
}
