//! A whitewashed cottage with a veranda, and a pier with a boat.

use glam::{Affine3A, Quat, Vec2, Vec3, vec2, vec3};

use crate::mesh::{Mesh, point};

/// Parts of the cottage by material.
#[derive(Default)]
pub struct Cottage {
    pub plaster: Mesh,
    pub tiles: Mesh,
    pub timber: Mesh,
    pub paint: Mesh,
    pub glass: Mesh,
    pub stone: Mesh,
}

/// Half size of the house (x, z), and the height of its walls, metres.
const HOUSE: Vec2 = vec2(4.0, 2.6);
const WALL: f32 = 2.7;
/// Depth of the veranda to the south, metres.
const VERANDA: f32 = 2.6;

/// The floor is at y = 0, the veranda on the +z side.
pub fn cottage() -> Cottage {
    let mut c = Cottage::default();
    c.stone.cuboid(
        vec3(-HOUSE.x - 0.25, -1.2, -HOUSE.y - 0.25),
        vec3(HOUSE.x + 0.25, 0.0, HOUSE.y + VERANDA + 0.25),
    );
    walls(&mut c);
    roof(&mut c);
    veranda(&mut c);
    furniture(&mut c);
    c
}

/// Walls with openings: pairs of start and end along the south wall, with sill and head heights.
fn walls(c: &mut Cottage) {
    let (x, z, t) = (HOUSE.x, HOUSE.y, 0.3);
    let openings = [
        (-2.9, -1.7, 0.9, 2.05),
        (-0.55, 0.55, 0.0, 2.15),
        (1.7, 2.9, 0.9, 2.05),
    ];
    let mut from = -x;
    for (a, b, sill, head) in openings {
        c.plaster.cuboid(vec3(from, 0.0, z - t), vec3(a, WALL, z));
        c.plaster.cuboid(vec3(a, head, z - t), vec3(b, WALL, z));
        if sill > 0.0 {
            c.plaster.cuboid(vec3(a, 0.0, z - t), vec3(b, sill, z));
            window(c, a, b, sill, head);
        } else {
            c.paint
                .cuboid(vec3(a, 0.0, z - t + 0.05), vec3(b, head, z - t + 0.11));
        }
        from = b;
    }
    c.plaster.cuboid(vec3(from, 0.0, z - t), vec3(x, WALL, z));
    c.plaster.cuboid(vec3(-x, 0.0, -z), vec3(x, WALL, -z + t));
    for side in [-1.0f32, 1.0] {
        let (a, b) = (side * x, side * (x - t));
        c.plaster
            .cuboid(vec3(a.min(b), 0.0, -z + t), vec3(a.max(b), WALL, z - t));
        gable(&mut c.plaster, side);
    }
}

/// A window with a frame and blue shutters on both sides.
fn window(c: &mut Cottage, a: f32, b: f32, sill: f32, head: f32) {
    let z = HOUSE.y - 0.12;
    c.glass.quad([
        vec3(a, sill, z),
        vec3(b, sill, z),
        vec3(b, head, z),
        vec3(a, head, z),
    ]);
    let middle = 0.5 * (a + b);
    for x in [a, middle - 0.03, b - 0.06] {
        c.timber
            .cuboid(vec3(x, sill, z), vec3(x + 0.06, head, z + 0.05));
    }
    for (low, high) in [(a - 0.62, a - 0.03), (b + 0.03, b + 0.62)] {
        let z = HOUSE.y + 0.01;
        c.paint
            .cuboid(vec3(low, sill - 0.05, z), vec3(high, head + 0.05, z + 0.05));
        for slat in 0..9 {
            let y = sill + 0.05 + (head - sill - 0.1) * slat as f32 / 8.0;
            c.paint.cuboid(
                vec3(low + 0.06, y - 0.03, z + 0.05),
                vec3(high - 0.06, y + 0.02, z + 0.075),
            );
        }
    }
}

const RISE: f32 = 1.35;
const EAVE: f32 = 0.4;

fn gable(mesh: &mut Mesh, side: f32) {
    let (x, z) = (side * HOUSE.x, HOUSE.y);
    let apex = vec3(x, WALL + RISE, 0.0);
    let [a, b] = [vec3(x, WALL, z * side), vec3(x, WALL, -z * side)];
    mesh.quad([a, b, apex, apex]);
}

/// Two slopes of rolled tiles, and a chimney.
fn roof(c: &mut Cottage) {
    let (x, z) = (HOUSE.x + EAVE, HOUSE.y + EAVE);
    let drop = RISE * EAVE / HOUSE.y;
    for side in [-1.0f32, 1.0] {
        let eave = [
            vec3(-x * side, WALL - drop, z * side),
            vec3(x * side, WALL - drop, z * side),
        ];
        let ridge = [
            vec3(-x * side, WALL + RISE, 0.0),
            vec3(x * side, WALL + RISE, 0.0),
        ];
        tiles(&mut c.tiles, eave, ridge);
        let under = [eave[1], eave[0], ridge[0], ridge[1]].map(|p| p - vec3(0.0, 0.03, 0.0));
        c.timber.quad(under);
    }
    c.tiles.beam(
        vec3(-x, WALL + RISE + 0.07, 0.0),
        vec3(x, WALL + RISE + 0.07, 0.0),
        0.26,
        0.12,
    );
    c.plaster
        .cuboid(vec3(1.9, WALL, -1.5), vec3(2.6, WALL + RISE + 0.8, -0.9));
    c.stone.cuboid(
        vec3(1.82, WALL + RISE + 0.8, -1.58),
        vec3(2.68, WALL + RISE + 0.92, -0.82),
    );
}

/// Rolls of tiles running down a slope, in courses.
fn tiles(mesh: &mut Mesh, eave: [Vec3; 2], ridge: [Vec3; 2]) {
    let across = eave[1] - eave[0];
    let rolls = (across.length() / 0.26).round() as usize;
    let courses = 7;
    let up = across.cross(ridge[0] - eave[0]).normalize();
    let side = across.normalize();
    let columns = 4 * rolls + 1;
    for course in 0..courses {
        let ends = [course, course + 1].map(|i| i as f32 / courses as f32);
        mesh.grid(2, columns, |row, column| {
            let s = column as f32 / (columns - 1) as f32;
            let phase = std::f32::consts::TAU * rolls as f32 * s;
            let lift = 0.035 * (1.0 - phase.cos()) + 0.045 * (1 - row) as f32;
            let base = eave[0] + across * s + (ridge[0] - eave[0]) * ends[row];
            let normal = up - side * (0.8 * phase.sin());
            point(base + up * lift, normal, vec2(s * 8.0, ends[row] * 3.0))
        });
    }
}

/// Posts, a lower roof, a floor of boards, and a railing.
fn veranda(c: &mut Cottage) {
    let (x, z0, z1) = (HOUSE.x, HOUSE.y, HOUSE.y + VERANDA);
    for board in 0..11 {
        let z = z0 + 0.02 + VERANDA * board as f32 / 11.0;
        c.timber
            .cuboid(vec3(-x, 0.0, z), vec3(x, 0.05, z + VERANDA / 11.0 - 0.02));
    }
    let eave = [
        vec3(-x - 0.3, 2.12, z1 + 0.35),
        vec3(x + 0.3, 2.12, z1 + 0.35),
    ];
    let top = [vec3(-x - 0.3, 2.62, z0), vec3(x + 0.3, 2.62, z0)];
    tiles(&mut c.tiles, eave, top);
    c.timber
        .quad([eave[1], eave[0], top[0], top[1]].map(|p| p - vec3(0.0, 0.03, 0.0)));
    c.timber.beam(
        vec3(-x, 2.08, z1 - 0.1),
        vec3(x, 2.08, z1 - 0.1),
        0.14,
        0.16,
    );
    for i in 0..5 {
        let px = -x + 0.08 + (2.0 * x - 0.16) * i as f32 / 4.0;
        c.timber.cuboid(
            vec3(px - 0.07, 0.0, z1 - 0.17),
            vec3(px + 0.07, 2.02, z1 - 0.03),
        );
        c.timber.beam(
            vec3(px, 2.08, z1 - 0.1),
            vec3(px, 2.52, z0 + 0.1),
            0.08,
            0.1,
        );
        // The steps are in the middle.
        if i < 4 && i != 1 {
            rail(c, px, px + (2.0 * x - 0.16) / 4.0, z1 - 0.1);
        }
    }
    for i in 0..3 {
        let (y, z) = (-0.2 * i as f32, z1 + 0.3 * i as f32);
        c.stone
            .cuboid(vec3(-2.0, y - 0.5, z), vec3(0.0, y - 0.02, z + 0.32));
    }
}

fn rail(c: &mut Cottage, a: f32, b: f32, z: f32) {
    for y in [0.25, 0.85] {
        c.paint
            .cuboid(vec3(a, y, z - 0.03), vec3(b, y + 0.06, z + 0.03));
    }
    for i in 1..9 {
        let x = a + (b - a) * i as f32 / 9.0;
        c.paint.cuboid(
            vec3(x - 0.02, 0.25, z - 0.02),
            vec3(x + 0.02, 0.85, z + 0.02),
        );
    }
}

/// A table and two benches on the veranda.
fn furniture(c: &mut Cottage) {
    let z = HOUSE.y + 1.35;
    c.timber
        .cuboid(vec3(1.3, 0.72, z - 0.4), vec3(2.9, 0.78, z + 0.4));
    for x in [1.45, 2.65] {
        c.timber
            .cuboid(vec3(x, 0.05, z - 0.3), vec3(x + 0.09, 0.72, z + 0.3));
    }
    for side in [-1.0f32, 1.0] {
        let at = z + side * 0.72;
        c.timber
            .cuboid(vec3(1.4, 0.42, at - 0.14), vec3(2.8, 0.47, at + 0.14));
        for x in [1.5, 2.62] {
            c.timber
                .cuboid(vec3(x, 0.05, at - 0.1), vec3(x + 0.07, 0.42, at + 0.1));
        }
    }
}

/// Planks on posts from the beach into the sea; heights are above sea level.
pub fn pier(from: Vec2, to: Vec2) -> Mesh {
    let mut mesh = Mesh::default();
    let length = (to - from).length();
    let along = vec3(to.x - from.x, 0.0, to.y - from.y) / length;
    let across = vec3(-along.z, 0.0, along.x);
    let start = vec3(from.x, 0.0, from.y);
    let deck = 1.05;
    let planks = (length / 0.24) as usize;
    for i in 0..planks {
        let middle =
            start + along * (0.24 * i as f32) + Vec3::Y * (deck + 0.008 * (i * 7 % 5) as f32);
        let wide = 1.0 + 0.03 * (i * 5 % 4) as f32;
        mesh.tint(Vec3::splat(0.8 + 0.12 * (i * 11 % 5) as f32));
        mesh.beam(middle - across * wide, middle + across * wide, 0.215, 0.05);
    }
    for side in [-0.8, 0.8] {
        let at = |s: f32| start + along * s + across * side + Vec3::Y * (deck - 0.12);
        mesh.beam(at(0.0), at(length), 0.12, 0.18);
        let posts = (length / 2.6) as usize;
        for i in 0..=posts {
            let foot = start + along * (2.6 * i as f32 + 0.2) + across * (side * 1.22);
            let high = if i % 2 == 0 { deck + 0.75 } else { deck + 0.1 };
            mesh.tube(
                [foot - Vec3::Y * 3.0, foot + Vec3::Y * high],
                [0.12, 0.10],
                9,
            );
            mesh.lathe(foot, &[(0.10, high), (0.005, high + 0.03)], 9);
        }
    }
    mesh
}

/// A rowing boat: a hull of ribs from bow to stern, with thwarts.
pub fn boat() -> [Mesh; 2] {
    let (mut hull, mut wood) = (Mesh::default(), Mesh::default());
    let outline = |t: f32| {
        0.68 * (std::f32::consts::PI * t.powf(0.72))
            .sin()
            .max(0.0)
            .powf(0.6)
            * (1.0 - 0.25 * t)
            + 0.01
    };
    let at = |row: usize, column: usize, scale: f32| {
        let (t, s) = (column as f32 / 16.0, row as f32 / 8.0 * 2.0 - 1.0);
        let wide = outline(t) * scale;
        let keel = -0.32 * (1.0 - (2.0 * t - 1.0).powi(4)) * (1.0 - s * s);
        let sheer = 0.16 + 0.3 * (2.0 * t - 1.0).powi(2);
        vec3(3.4 * t - 1.7, sheer * s.abs().powf(0.6) + keel, wide * s)
    };
    for (scale, inside) in [(1.0, false), (0.94, true)] {
        hull.grid(9, 17, |row, column| {
            let row = if inside { 8 - row } else { row };
            let p = at(row, column, scale);
            let out = vec3(0.0, -0.35, p.z) * if inside { -1.0 } else { 1.0 };
            point(p, out, vec2(p.x, p.y))
        });
    }
    for x in [-0.6, 0.35, 1.0] {
        let wide = outline((x + 1.7) / 3.4) * 0.9;
        wood.cuboid(vec3(x - 0.12, 0.12, -wide), vec3(x + 0.12, 0.16, wide));
    }
    for side in [-1.0f32, 1.0] {
        let oar = Affine3A::from_rotation_translation(
            Quat::from_rotation_y(0.12 * side),
            vec3(0.1, 0.24, 0.22 * side),
        );
        wood.boxed(oar, vec3(1.2, 0.02, 0.025));
    }
    [hull, wood]
}
