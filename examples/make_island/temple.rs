//! A Doric temple with fluted columns, partly in ruins.

use glam::{Affine3A, Vec2, Vec3, vec2, vec3};

use crate::mesh::{Mesh, point};

/// Number of columns along the front and the flank.
const COLUMNS: [usize; 2] = [6, 10];
/// Half the distance between the axes of the outer columns, metres; x is along the flank.
const HALF: Vec2 = vec2(8.7, 4.8);
/// Height of a column including its capital, metres.
pub const COLUMN: f32 = 5.0;
/// Height of the top step above the ground, metres.
pub const FLOOR: f32 = 0.9;
const FLUTES: usize = 20;

/// A column at the origin.
pub fn column() -> Mesh {
    let mut mesh = Mesh::default();
    shaft(&mut mesh, COLUMN - 0.5, 1.0);
    let top = COLUMN - 0.5;
    let echinus = [
        (0.385, top - 0.02),
        (0.41, top + 0.03),
        (0.50, top + 0.15),
        (0.565, top + 0.24),
        (0.56, top + 0.28),
    ];
    mesh.lathe(Vec3::ZERO, &echinus, 24);
    mesh.cuboid(vec3(-0.6, top + 0.28, -0.6), vec3(0.6, COLUMN, 0.6));
    mesh
}

/// A broken column or a drum: a shaft that ends early.
pub fn stump(height: f32) -> Mesh {
    let mut mesh = Mesh::default();
    shaft(&mut mesh, height, 0.0);
    mesh.grid(2, FLUTES + 1, |row, i| {
        let angle = -std::f32::consts::TAU * i as f32 / FLUTES as f32;
        let r = if row == 0 { radius(height) * 0.97 } else { 0.0 };
        let p = vec3(r * angle.cos(), height, r * angle.sin());
        point(p, Vec3::Y, vec2(p.x, p.z))
    });
    mesh
}

/// Shaft radius at a height; the shaft tapers with entasis.
fn radius(h: f32) -> f32 {
    let t = h / (COLUMN - 0.5);
    0.48 - 0.10 * t + 0.018 * (std::f32::consts::PI * t).sin()
}

/// Flutes: shallow arcs between sharp arrises.
fn shaft(mesh: &mut Mesh, height: f32, runs_out: f32) {
    let (facets, rows) = (3, 5);
    for flute in 0..FLUTES {
        mesh.grid(rows, facets + 1, |row, column| {
            let t = row as f32 / (rows - 1) as f32;
            let s = column as f32 / facets as f32;
            let angle = -std::f32::consts::TAU * (flute as f32 + s) / FLUTES as f32;
            let ends = 1.0 - runs_out * t.powi(12);
            let arc = (std::f32::consts::PI * s).sin();
            let r = radius(height * t) - 0.038 * ends * arc;
            let slope = -0.038 * ends * std::f32::consts::PI * (std::f32::consts::PI * s).cos();
            let slope = slope / (std::f32::consts::TAU / FLUTES as f32) / r;
            let (sin, cos) = angle.sin_cos();
            let normal = vec3(cos - slope * sin, 0.02, sin + slope * cos);
            let uv = vec2(-angle * 0.48, -height * t);
            point(vec3(r * cos, height * t, r * sin), normal, uv)
        });
    }
}

/// Column positions relative to the centre of the floor, and the heights of broken columns.
pub fn places() -> Vec<(Vec3, Option<f32>)> {
    let [across, along] = COLUMNS;
    let mut places = Vec::new();
    for i in 0..along {
        for j in 0..across {
            if i > 0 && i < along - 1 && j > 0 && j < across - 1 {
                continue;
            }
            let s = 2.0 * i as f32 / (along - 1) as f32 - 1.0;
            let t = 2.0 * j as f32 / (across - 1) as f32 - 1.0;
            // The west end is in ruins.
            let broken = match (i, j) {
                (0, 0) => Some(1.7),
                (0, 1) => Some(0.8),
                (0, 4) => Some(3.1),
                (1, 0) => Some(2.6),
                _ => None,
            };
            places.push((vec3(s * HALF.x, FLOOR, t * HALF.y), broken));
        }
    }
    places
}

/// Steps, inner hall, beams and gable.
pub fn building() -> Mesh {
    let mut mesh = Mesh::default();
    for step in 0..3 {
        let out = 1.0 + 0.42 * (2 - step) as f32;
        let (low, high) = (
            0.3 * step as f32 - if step == 0 { 1.5 } else { 0.0 },
            0.3 * (step + 1) as f32,
        );
        let half = HALF + out;
        mesh.cuboid(vec3(-half.x, low, -half.y), vec3(half.x, high, half.y));
    }
    hall(&mut mesh);
    entablature(&mut mesh);
    gable(&mut mesh);
    mesh
}

/// The walls of the cella, with a door to the east; the west wall is half as high.
fn hall(mesh: &mut Mesh) {
    let (x0, x1, z, wall) = (-5.6, 5.4, 2.6, 0.55);
    let (low, high) = (FLOOR, FLOOR + COLUMN);
    for side in [-1.0f32, 1.0] {
        let (a, b) = (side * z, side * (z - wall));
        // Stone courses, each slightly narrower than the one below.
        for course in 0..8 {
            let t = [course, course + 1].map(|i| low + (high - low) * i as f32 / 8.0);
            let inset = 0.012 * (course % 2) as f32;
            let start =
                x0 + if course > 5 { 1.7 } else { 0.0 } + if course > 6 { 1.3 } else { 0.0 };
            mesh.cuboid(
                vec3(start, t[0], a.min(b) + inset),
                vec3(x1, t[1], a.max(b) - inset),
            );
        }
        mesh.cuboid(
            vec3(
                x1 - wall,
                low,
                side * 1.05_f32.min(z) - if side < 0.0 { z - 1.05 - wall } else { 0.0 },
            ),
            vec3(
                x1,
                high - 0.9,
                side * 1.05 + if side > 0.0 { z - 1.05 - wall } else { 0.0 },
            ),
        );
    }
    mesh.cuboid(
        vec3(x1 - wall, high - 0.9, -z + wall),
        vec3(x1, high, z - wall),
    );
    mesh.cuboid(
        vec3(x0, low, -z + wall),
        vec3(x0 + wall, low + 2.2, z - wall),
    );
}

/// Beams on the standing columns, a frieze with triglyphs, and a cornice.
fn entablature(mesh: &mut Mesh) {
    let base = FLOOR + COLUMN;
    let west = -HALF.x + 2.0 * HALF.x / 9.0 * 1.72;
    let layers = [
        (0.50, 0.0, 0.62),
        (0.55, 0.62, 0.70),
        (0.48, 0.70, 1.28),
        (0.72, 1.28, 1.40),
        (0.86, 1.40, 1.54),
    ];
    for (out, low, high) in layers {
        for side in [-1.0f32, 1.0] {
            let (a, b) = (side * (HALF.y - 0.46), side * (HALF.y + out));
            mesh.cuboid(
                vec3(west, base + low, a.min(b)),
                vec3(HALF.x + out, base + high, a.max(b)),
            );
        }
        mesh.cuboid(
            vec3(HALF.x - 0.46, base + low, -HALF.y + 0.4),
            vec3(HALF.x + out, base + high, HALF.y - 0.4),
        );
    }
    triglyphs(mesh, base + 0.70, west);
}

fn triglyphs(mesh: &mut Mesh, low: f32, west: f32) {
    let mut bar = |at: Vec3, half: Vec3| {
        mesh.boxed(Affine3A::from_translation(at), half);
    };
    let y = low + 0.28;
    for i in 0..=18 {
        let x = HALF.x * (i as f32 / 9.0 - 1.0);
        for (side, k) in [-1.0f32, 1.0]
            .into_iter()
            .flat_map(|s| [-1.0f32, 0.0, 1.0].map(|k| (s, k)))
        {
            if x > west + 0.4 {
                bar(
                    vec3(x + 0.14 * k, y, side * (HALF.y + 0.50)),
                    vec3(0.045, 0.27, 0.03),
                );
            }
        }
    }
    for i in 0..=10 {
        let z = HALF.y * (i as f32 / 5.0 - 1.0);
        for k in [-1.0f32, 0.0, 1.0] {
            bar(
                vec3(HALF.x + 0.50, y, z + 0.14 * k),
                vec3(0.03, 0.27, 0.045),
            );
        }
    }
}

/// The east gable, still standing, with its raking cornice.
fn gable(mesh: &mut Mesh) {
    let (y, x) = (FLOOR + COLUMN + 1.54, HALF.x);
    let (half, rise) = (HALF.y + 0.86, 1.55);
    let apex = |x: f32| vec3(x, y + rise, 0.0);
    for (x, turned) in [(x + 0.42, false), (x - 0.30, true)] {
        let [a, b] = [vec3(x, y, half), vec3(x, y, -half)];
        let corners = if turned {
            [b, a, apex(x), apex(x)]
        } else {
            [a, b, apex(x), apex(x)]
        };
        mesh.quad(corners);
    }
    for side in [-1.0f32, 1.0] {
        let eave = vec3(0.0, y + 0.08, side * half);
        let ridge = vec3(0.0, y + rise + 0.10, 0.0);
        let normal = vec3(0.0, half, side * rise).normalize() * 0.11;
        let out = |p: Vec3, dx: f32| p + vec3(x + dx, 0.0, 0.0);
        let [a, b] = [out(eave, -0.75), out(eave, 0.95)];
        let [c, d] = [out(ridge, 0.95), out(ridge, -0.75)];
        let mut slab = |q: [Vec3; 4]| {
            if side > 0.0 {
                mesh.quad(q)
            } else {
                mesh.quad([q[1], q[0], q[3], q[2]])
            }
        };
        slab([a + normal, b + normal, c + normal, d + normal]);
        slab([b - normal, a - normal, d - normal, c - normal]);
        slab([b - normal, c - normal, c + normal, b + normal]);
        slab([a + normal, a - normal, b - normal, b + normal]);
    }
}
