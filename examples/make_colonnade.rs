//! Generates the bundled scene, a small open temple next to a pool, as `assets/colonnade.obj` and `assets/colonnade.mtl`. The
//! output is deterministic. Run with `cargo run --example make_colonnade`.
//!
//! Units are metres, +Y up, +X east, −Z north. The temple stands on the xz plane around the origin and faces south over the
//! pool.

use std::collections::HashMap;
use std::f64::consts::TAU;
use std::fmt::Write;
use std::path::Path;

/// ρ_d, ρ_s and p of each material.
const MATERIALS: &str = "\
newmtl ground
Kd 0.30 0.27 0.19
newmtl gravel
Kd 0.42 0.38 0.31
newmtl slab-light
Kd 0.55 0.50 0.42
newmtl slab-middle
Kd 0.47 0.42 0.34
newmtl slab-dark
Kd 0.40 0.35 0.28
newmtl limestone
Kd 0.62 0.55 0.43
newmtl marble
Kd 0.76 0.72 0.64
newmtl terracotta
Kd 0.46 0.19 0.11
newmtl timber
Kd 0.27 0.17 0.10
newmtl polished
Kd 0.16 0.15 0.14
Ks 0.18 0.18 0.18
Ns 400
newmtl water
Kd 0.010 0.022 0.026
Ks 0.32 0.34 0.36
Ns 1000
newmtl bronze
Kd 0.12 0.09 0.04
Ks 0.36 0.27 0.15
Ns 60
newmtl leaf
Kd 0.09 0.15 0.05
newmtl bark
Kd 0.17 0.12 0.08
";

type Point = [f64; 3];

/// The text of the model so far.
#[derive(Default)]
struct Model {
    text: String,
    vertices: HashMap<String, usize>,
    normals: HashMap<String, usize>,
}

impl Model {
    fn material(&mut self, name: &str) {
        let _ = writeln!(self.text, "usemtl {name}");
    }

    /// Writes a position with three decimals (millimetres).
    fn vertex(&mut self, p: Point) -> usize {
        let line = format!("v {} {} {}", short(p[0]), short(p[1]), short(p[2]));
        numbered(&mut self.text, &mut self.vertices, line)
    }

    fn normal(&mut self, n: Point) -> usize {
        let length = n.iter().map(|v| v * v).sum::<f64>().sqrt();
        let [x, y, z] = n.map(|v| short(v / length));
        numbered(&mut self.text, &mut self.normals, format!("vn {x} {y} {z}"))
    }

    /// Adds a flat polygon, counter-clockwise, without normals.
    fn flat(&mut self, points: &[Point]) {
        let numbers: Vec<usize> = points.iter().map(|p| self.vertex(*p)).collect();
        self.text.push('f');
        for number in numbers {
            let _ = write!(self.text, " {number}");
        }
        self.text.push('\n');
    }

    /// Adds a box between two opposite corners.
    fn cuboid(&mut self, a: Point, b: Point) {
        let at =
            |i: usize| [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { b[axis] } else { a[axis] });
        for face in [
            [0, 4, 6, 2],
            [1, 3, 7, 5],
            [0, 1, 5, 4],
            [2, 6, 7, 3],
            [0, 2, 3, 1],
            [4, 5, 7, 6],
        ] {
            self.flat(&face.map(at));
        }
    }

    /// Adds a grid of smooth quads; `at(row, column)` returns position and normal. Seen from the front, rows run up and columns
    /// run right.
    fn surface(
        &mut self,
        rows: usize,
        columns: usize,
        at: impl Fn(usize, usize) -> (Point, Point),
    ) {
        let corners: Vec<(usize, usize)> = grid(rows, columns)
            .map(|(row, column)| at(row, column))
            .map(|(point, normal)| (self.vertex(point), self.normal(normal)))
            .collect();
        for (row, column) in grid(rows - 1, columns - 1) {
            self.text.push('f');
            for (r, c) in [(0, 0), (0, 1), (1, 1), (1, 0)] {
                let (vertex, normal) = corners[(row + r) * columns + column + c];
                let _ = write!(self.text, " {vertex}//{normal}");
            }
            self.text.push('\n');
        }
    }

    /// Adds a surface of revolution around the vertical axis through `centre`. `profile` lists (radius, height) from bottom to
    /// top; a repeated point makes a sharp edge.
    fn lathe(&mut self, centre: Point, profile: &[(f64, f64)], sides: usize) {
        for piece in smooth_pieces(profile) {
            self.surface(piece.len(), sides + 1, |row, column| {
                let angle = -TAU * column as f64 / sides as f64;
                let (radius, height) = piece[row];
                let (dr, dh) = tangent(piece, row);
                let (sin, cos) = angle.sin_cos();
                let point = [
                    centre[0] + radius * cos,
                    centre[1] + height,
                    centre[2] + radius * sin,
                ];
                (point, [dh * cos, -dr, dh * sin])
            });
        }
    }
}

/// Splits a profile at repeated points.
fn smooth_pieces(profile: &[(f64, f64)]) -> Vec<&[(f64, f64)]> {
    profile
        .chunk_by(|a, b| a != b)
        .filter(|piece| piece.len() > 1)
        .collect()
}

fn tangent(profile: &[(f64, f64)], row: usize) -> (f64, f64) {
    let (below, above) = (
        profile[row.saturating_sub(1)],
        profile[(row + 1).min(profile.len() - 1)],
    );
    (above.0 - below.0, above.1 - below.1)
}

fn grid(rows: usize, columns: usize) -> impl Iterator<Item = (usize, usize)> {
    (0..rows).flat_map(move |row| (0..columns).map(move |column| (row, column)))
}

/// Rounds to three decimals, which keeps the file small.
fn short(value: f64) -> f64 {
    let rounded = (value * 1e3).round() / 1e3;
    if rounded == 0.0 { 0.0 } else { rounded }
}

/// Index (from 1) of a line, which is written on first use.
fn numbered(text: &mut String, known: &mut HashMap<String, usize>, line: String) -> usize {
    if let Some(number) = known.get(&line) {
        return *number;
    }
    text.push_str(&line);
    text.push('\n');
    known.insert(line, known.len() + 1);
    known.len()
}

/// Deterministic random numbers in −1..1: SplitMix64 of a counter.
struct Chance(u64);

impl Chance {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Top of the plinth, on which the columns stand, metres.
const FLOOR: f64 = 1.05;
/// Half the length (x) and depth (z) of the rectangle of columns, metres.
const HALF: [f64; 2] = [7.2, 4.0];
/// Number of columns along the front and along the sides.
const COLUMNS: [usize; 2] = [7, 4];
const COLUMN_HEIGHT: f64 = 5.2;
const FLUTES: usize = 20;

fn main() -> std::io::Result<()> {
    let mut model = Model::default();
    model
        .text
        .push_str("# Made by examples/make_colonnade.rs; metres, +Y up\nmtllib colonnade.mtl\n");
    ground(&mut model);
    plinth(&mut model);
    for [x, z] in column_places() {
        column(&mut model, [x, FLOOR, z]);
    }
    entablature(&mut model);
    roof(&mut model);
    pool(&mut model);
    paving(&mut model);
    stones(&mut model);
    urns(&mut model);
    for (i, [x, z, height]) in CYPRESSES.into_iter().enumerate() {
        cypress(&mut model, [x, 0.0, z], height, i as u64);
    }
    let assets = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets");
    std::fs::write(assets.join("colonnade.obj"), &model.text)?;
    std::fs::write(assets.join("colonnade.mtl"), MATERIALS)?;
    println!(
        "{} vertices, {} bytes",
        model.vertices.len(),
        model.text.len()
    );
    Ok(())
}

fn column_places() -> Vec<[f64; 2]> {
    let [nx, nz] = COLUMNS;
    let along = |i: usize, n: usize, half: f64| -half + 2.0 * half * i as f64 / (n - 1) as f64;
    grid(nz, nx)
        .filter(|(row, column)| *row == 0 || *row == nz - 1 || *column == 0 || *column == nx - 1)
        .map(|(row, column)| [along(column, nx, HALF[0]), along(row, nz, HALF[1])])
        .collect()
}

/// The ground: gravel near the temple, meadow around it; flat nearby, rolling farther away, with a hole for the pool.
fn ground(model: &mut Model) {
    model.material("ground");
    let (steps, size) = (72, 140.0);
    let place = |i: usize| {
        // Finer toward the middle.
        let t = 2.0 * i as f64 / steps as f64 - 1.0;
        size * (0.25 * t + 0.75 * t * t * t)
    };
    let height = |x: f64, z: f64| {
        let away = ((x.hypot(z) - 26.0) / 60.0).clamp(0.0, 1.0);
        let hills =
            (0.061 * x + 1.3).sin() * (0.047 * z + 0.4).cos() + 0.4 * (0.13 * x - 0.11 * z).sin();
        away * away * (3.4 * hills + 2.2) - 0.02
    };
    let at = |row: usize, column: usize| {
        let (x, z) = (place(column), place(steps - row));
        let slope = |dx: f64, dz: f64| (height(x + dx, z + dz) - height(x - dx, z - dz)) / 0.2;
        (
            [x, height(x, z), z],
            [-slope(0.1, 0.0), 1.0, -slope(0.0, 0.1)],
        )
    };
    model.surface(steps + 1, steps + 1, at);
    model.material("gravel");
    frame(
        model,
        [-21.0, -12.0],
        [21.0, 24.0],
        [POOL[0], POOL[1]],
        0.01,
    );
}

/// Rectangle of the water, metres: minimum x and z, maximum x and z.
const POOL: [[f64; 2]; 2] = [[-4.6, 10.2], [4.6, 19.2]];

/// A flat rectangle at height `y` with a rectangular hole.
fn frame(model: &mut Model, from: [f64; 2], to: [f64; 2], hole: [[f64; 2]; 2], y: f64) {
    let [[hx0, hz0], [hx1, hz1]] = hole;
    for [x0, z0, x1, z1] in [
        [from[0], from[1], to[0], hz0],
        [from[0], hz1, to[0], to[1]],
        [from[0], hz0, hx0, hz1],
        [hx1, hz0, to[0], hz1],
    ] {
        model.flat(&[[x0, y, z1], [x1, y, z1], [x1, y, z0], [x0, y, z0]]);
    }
}

/// Three steps on all sides, and a polished floor.
fn plinth(model: &mut Model) {
    model.material("limestone");
    let step = FLOOR / 3.0;
    for i in 0..3 {
        let out = 1.1 + 0.42 * (2 - i) as f64;
        let (x, z) = (HALF[0] + out, HALF[1] + out);
        // Nosing: each tread overhangs its riser and casts a line of shadow.
        let (low, high) = (step * i as f64, step * (i + 1) as f64);
        model.cuboid([-x, low, -z], [x, high - 0.06, z]);
        model.cuboid(
            [-x - 0.04, high - 0.06, -z - 0.04],
            [x + 0.04, high, z + 0.04],
        );
    }
    model.material("polished");
    let (x, z, y) = (HALF[0] - 0.75, HALF[1] - 0.75, FLOOR + 0.004);
    model.flat(&[[-x, y, z], [x, y, z], [x, y, -z], [-x, y, -z]]);
}

/// Square base, torus, fluted and tapered shaft with entasis, and Doric capital.
fn column(model: &mut Model, foot: Point) {
    let [x, y, z] = foot;
    model.material("marble");
    model.cuboid([x - 0.56, y, z - 0.56], [x + 0.56, y + 0.14, z + 0.56]);
    let torus: Vec<(f64, f64)> = (0..=6)
        .map(|i| TAU / 2.0 * f64::from(i) / 6.0)
        .map(|angle| (0.44 + 0.09 * angle.sin(), 0.23 - 0.09 * angle.cos()))
        .collect();
    model.lathe(foot, &torus, 24);
    shaft(model, foot, 0.32, COLUMN_HEIGHT - 0.52);
    let top = COLUMN_HEIGHT;
    let neck = (0.355, top - 0.52);
    let collar = [
        neck,
        (0.40, top - 0.50),
        (0.40, top - 0.50),
        (0.40, top - 0.44),
        (0.40, top - 0.44),
        (0.37, top - 0.42),
    ];
    model.lathe(foot, &collar, 24);
    let echinus = [
        (0.37, top - 0.42),
        (0.40, top - 0.34),
        (0.47, top - 0.25),
        (0.54, top - 0.18),
        (0.545, top - 0.15),
    ];
    model.lathe(foot, &echinus, 24);
    model.cuboid(
        [x - 0.6, y + top - 0.15, z - 0.6],
        [x + 0.6, y + top, z + 0.6],
    );
}

/// Flutes: shallow arcs between sharp arrises, four facets each.
fn shaft(model: &mut Model, foot: Point, from: f64, to: f64) {
    let (facets, rows) = (4, 6);
    let radius = |h: f64| {
        let t = (h - from) / (to - from);
        0.44 - 0.085 * t + 0.018 * (TAU / 2.0 * t).sin()
    };
    for flute in 0..FLUTES {
        model.surface(rows, facets + 1, |row, column| {
            let height = from + (to - from) * row as f64 / (rows - 1) as f64;
            let s = column as f64 / facets as f64;
            let angle = -TAU * (flute as f64 + s) / FLUTES as f64;
            // The flutes end short of both ends of the shaft.
            let ends = (8.0
                * (row as f64 / (rows - 1) as f64).min(1.0 - row as f64 / (rows - 1) as f64))
            .min(1.0);
            let depth = 0.036 * ends * (TAU / 2.0 * s).sin();
            let r = radius(height) - depth;
            let (sin, cos) = angle.sin_cos();
            // Tilts the normal by the slope of the arc.
            let slope =
                -0.036 * ends * (TAU / 2.0) * (TAU / 2.0 * s).cos() / (TAU / FLUTES as f64) / r;
            let normal = [cos - slope * sin, 0.02, sin + slope * cos];
            (
                [foot[0] + r * cos, foot[1] + height, foot[2] + r * sin],
                normal,
            )
        });
    }
}

/// Architrave beams on the columns, a frieze with triglyphs, and a cornice.
fn entablature(model: &mut Model) {
    model.material("limestone");
    let y = FLOOR + COLUMN_HEIGHT;
    ring(model, 0.46, 0.0, y, y + 0.62);
    ring(model, 0.52, 0.06, y + 0.62, y + 0.70);
    ring(model, 0.46, 0.06, y + 0.70, y + 1.30);
    ring(model, 0.66, 0.0, y + 1.30, y + 1.42);
    ring(model, 0.82, 0.0, y + 1.42, y + 1.56);
    model.material("marble");
    for side in [-1.0, 1.0] {
        for i in 0..=24 {
            let x = HALF[0] * (f64::from(i) / 12.0 - 1.0);
            triglyph(model, [x, y + 0.70, side * (HALF[1] + 0.46)], 0, side);
        }
        for i in 0..=14 {
            let z = HALF[1] * (f64::from(i) / 7.0 - 1.0);
            triglyph(model, [side * (HALF[0] + 0.46), y + 0.70, z], 2, side);
        }
    }
}

/// Four beams around the rectangle of columns, from 0.46 − `narrower` inside its sides to `outer` outside, metres.
fn ring(model: &mut Model, outer: f64, narrower: f64, low: f64, high: f64) {
    let inner = 0.46 - narrower;
    let [x, z] = HALF;
    for side in [-1.0f64, 1.0] {
        let (near, far) = (side * (z - inner), side * (z + outer));
        model.cuboid(
            [-x - outer, low, near.min(far)],
            [x + outer, high, near.max(far)],
        );
        let (near, far) = (side * (x - inner), side * (x + outer));
        model.cuboid(
            [near.min(far), low, -z + inner],
            [near.max(far), high, z - inner],
        );
    }
}

/// Three vertical bars on the frieze, in a row along `axis`.
fn triglyph(model: &mut Model, foot: Point, axis: usize, side: f64) {
    for bar in [-0.13, 0.0, 0.13] {
        let mut from = foot;
        let mut to = [foot[0], foot[1] + 0.56, foot[2]];
        from[axis] += bar - 0.045;
        to[axis] += bar + 0.045;
        let out = 2 - axis;
        (from[out], to[out]) = (
            foot[out].min(foot[out] + 0.05 * side),
            foot[out].max(foot[out] + 0.05 * side),
        );
        model.cuboid(from, to);
    }
}

/// A low hipped terracotta roof with an opening at the centre, through which sky light reaches the floor.
fn roof(model: &mut Model) {
    let eave = FLOOR + COLUMN_HEIGHT + 1.56;
    let (x, z) = (HALF[0] + 0.95, HALF[1] + 0.95);
    let (ox, oz, rise) = (3.3, 1.5, 1.15);
    let outer = [[-x, z], [x, z], [x, -z], [-x, -z]];
    let inner = [[-ox, oz], [ox, oz], [ox, -oz], [-ox, -oz]];
    model.material("terracotta");
    for i in 0..4 {
        let j = (i + 1) % 4;
        slope_of_tiles(
            model,
            [outer[i], outer[j], inner[j], inner[i]],
            [eave + 0.14, eave + rise],
        );
    }
    model.material("timber");
    for i in 0..4 {
        let j = (i + 1) % 4;
        let at = |p: [f64; 2], y: f64| [p[0], y, p[1]];
        let under = [
            at(outer[j], eave),
            at(outer[i], eave),
            at(inner[i], eave + rise - 0.14),
            at(inner[j], eave + rise - 0.14),
        ];
        model.flat(&under);
        let rim = [
            at(inner[j], eave + rise - 0.14),
            at(inner[i], eave + rise - 0.14),
            at(inner[i], eave + rise),
            at(inner[j], eave + rise),
        ];
        model.flat(&rim);
    }
    for i in -9..=9 {
        let at = 0.8 * f64::from(i);
        for side in [-1.0f64, 1.0] {
            let (near, far) = (side * (HALF[1] - 0.46), side * (HALF[1] - 1.1));
            model.cuboid(
                [at - 0.07, eave - 0.3, near.min(far)],
                [at + 0.07, eave - 0.12, near.max(far)],
            );
        }
    }
}

/// One roof slope with rolls of tiles. `corners` are two at the eave and two at the top; `y` holds their heights.
fn slope_of_tiles(model: &mut Model, corners: [[f64; 2]; 4], y: [f64; 2]) {
    let [a, b, c, d] = corners;
    let length = (b[0] - a[0]).hypot(b[1] - a[1]);
    let rolls = (length / 0.42).round() as usize;
    let mix =
        |p: [f64; 2], q: [f64; 2], t: f64| [p[0] + (q[0] - p[0]) * t, p[1] + (q[1] - p[1]) * t];
    let columns = 4 * rolls + 1;
    let along = [(b[0] - a[0]) / length, (b[1] - a[1]) / length];
    let outward = [-along[1], 0.0, along[0]];
    let place = |row: usize, column: usize| {
        let s = column as f64 / (columns - 1) as f64;
        (
            if row == 0 { mix(a, b, s) } else { mix(d, c, s) },
            TAU * rolls as f64 * s,
        )
    };
    let roll = |phase: f64| 0.045 * (1.0 - phase.cos());
    model.surface(2, columns, |row, column| {
        let (p, phase) = place(row, column);
        let slope = 0.045 * phase.sin() * TAU * rolls as f64 / length;
        let up = 0.16;
        (
            [p[0], y[row] + roll(phase), p[1]],
            [
                -slope * along[0] - up * along[1],
                1.0,
                -slope * along[1] + up * along[0],
            ],
        )
    });
    // The eave face follows the rolls.
    model.surface(2, columns, |row, column| {
        let (p, phase) = place(0, column);
        let height = if row == 0 {
            y[0] - 0.14
        } else {
            y[0] + roll(phase)
        };
        ([p[0], height, p[1]], outward)
    });
}

/// A marble rim around still, dark water, slightly below the rim.
fn pool(model: &mut Model) {
    let [[x0, z0], [x1, z1]] = POOL;
    model.material("water");
    model.flat(&[
        [x0, 0.06, z1],
        [x1, 0.06, z1],
        [x1, 0.06, z0],
        [x0, 0.06, z0],
    ]);
    model.material("marble");
    let (rim, top) = (0.5, 0.24);
    model.cuboid([x0 - rim, -0.3, z0 - rim], [x1 + rim, top, z0]);
    model.cuboid([x0 - rim, -0.3, z1], [x1 + rim, top, z1 + rim]);
    model.cuboid([x0 - rim, -0.3, z0], [x0, top, z1]);
    model.cuboid([x1, -0.3, z0], [x1 + rim, top, z1]);
}

/// Slabs in three tones around the pool, with gravel joints; some are missing at the edge.
fn paving(model: &mut Model) {
    let mut chance = Chance(4);
    let ([columns, rows], edge, joint) = ([18, 18], 1.0, 0.025);
    let mut slabs: [Vec<[f64; 2]>; 3] = Default::default();
    for (row, column) in grid(rows, columns) {
        let (x, z) = (column as f64 - 9.0, row as f64 + 5.95);
        let (tone, missing) = (chance.next(), chance.next());
        let inside = x + edge > POOL[0][0] - 0.5
            && x < POOL[1][0] + 0.5
            && z + edge > POOL[0][1] - 0.5
            && z < POOL[1][1] + 0.5;
        let border = (x + 0.5).abs() > 7.6 || z > 21.0;
        let left_out = inside || (border && missing > 0.1);
        let shade = usize::from(tone > -0.35) + usize::from(tone > 0.4);
        slabs[shade].extend((!left_out).then_some([x, z]));
    }
    for (material, slabs) in ["slab-light", "slab-middle", "slab-dark"].iter().zip(slabs) {
        model.material(material);
        for [x, z] in slabs {
            model.cuboid(
                [x + joint, -0.05, z + joint],
                [x + edge - joint, 0.045, z + edge - joint],
            );
        }
    }
}

/// Fallen drums and blocks in the grass, some of them rotated.
fn stones(model: &mut Model) {
    model.material("limestone");
    for (x, z, width, height, turn) in [
        (-9.6, 10.4, 1.5, 0.7, 0.3),
        (-8.3, 12.3, 0.9, 0.5, 0.9),
        (-11.0, 13.6, 1.1, 1.0, 0.1),
        (9.9, 9.6, 1.7, 0.55, -0.4),
        (10.3, 9.7, 0.8, 1.15, -0.2),
        (-10.4, 19.3, 1.2, 0.6, 0.6),
    ] {
        turned_block(model, [x, 0.0, z], [width, height, 0.62 * width], turn);
    }
    model.material("marble");
    for [x, z] in [[-12.6, 9.2], [13.8, 7.4]] {
        let side = [(0.45, 0.0), (0.43, 0.78)];
        model.lathe([x, 0.0, z], &side, 32);
        model.lathe([x, 0.0, z], &[(0.43, 0.78), (0.02, 0.78)], 32);
    }
}

fn turned_block(model: &mut Model, foot: Point, size: Point, turn: f64) {
    let (sin, cos) = turn.sin_cos();
    let at = |i: usize| {
        let [u, v, w] = [0, 1, 2].map(|axis| if i >> axis & 1 == 1 { 0.5 } else { -0.5 });
        let (x, z) = (u * size[0], w * size[2]);
        [
            foot[0] + cos * x - sin * z,
            foot[1] + (v + 0.5) * size[1] - 0.05,
            foot[2] + sin * x + cos * z,
        ]
    };
    for face in [
        [0, 4, 6, 2],
        [1, 3, 7, 5],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 2, 3, 1],
        [4, 5, 7, 6],
    ] {
        model.flat(&face.map(at));
    }
}

/// Bronze bowls on pedestals at the corners of the pool.
fn urns(model: &mut Model) {
    let bowl: Vec<(f64, f64)> = (0..=12)
        .map(|i| f64::from(i) / 12.0)
        .map(|t| {
            (
                0.12 + 0.5 * (0.5 * TAU / 2.0 * t).sin().powf(0.8),
                0.95 + 0.42 * t * t,
            )
        })
        .collect();
    let lip = [
        (0.62, 1.37),
        (0.66, 1.39),
        (0.66, 1.42),
        (0.62, 1.43),
        (0.56, 1.41),
    ];
    let inside: Vec<(f64, f64)> = (0..=8)
        .map(|i| f64::from(i) / 8.0)
        .map(|t| {
            (
                (0.56 * (1.0 - t)).max(0.02),
                1.41 - 0.25 * (1.0 - (1.0 - t).powi(2)),
            )
        })
        .collect();
    for [x, z] in [[-5.9, 9.0], [5.9, 9.0], [-5.9, 20.4], [5.9, 20.4]] {
        let foot = [x, 0.0, z];
        model.material("limestone");
        model.cuboid([x - 0.42, 0.0, z - 0.42], [x + 0.42, 0.16, z + 0.42]);
        model.cuboid([x - 0.3, 0.16, z - 0.3], [x + 0.3, 0.78, z + 0.3]);
        model.cuboid([x - 0.38, 0.78, z - 0.38], [x + 0.38, 0.92, z + 0.38]);
        model.material("bronze");
        model.lathe(foot, &[(0.22, 0.92), (0.12, 0.95)], 32);
        model.lathe(foot, &bowl, 32);
        model.lathe(foot, &lip, 32);
        model.lathe(foot, &inside, 32);
    }
}

/// x, z and height of each tree, metres.
const CYPRESSES: [[f64; 3]; 9] = [
    [-13.5, -4.0, 9.5],
    [-14.8, -8.5, 11.0],
    [-12.2, -12.5, 8.6],
    [13.4, -6.0, 10.4],
    [15.6, -10.6, 12.0],
    [-17.5, 4.5, 7.4],
    [17.2, 1.5, 8.2],
    [-3.5, -17.0, 10.8],
    [5.8, -19.0, 12.4],
];

/// A slender tree: an irregular spindle on a short trunk.
fn cypress(model: &mut Model, foot: Point, height: f64, seed: u64) {
    model.material("bark");
    model.lathe(foot, &[(0.17, -0.3), (0.13, 0.9)], 10);
    model.material("leaf");
    let (rows, sides) = (26, 18);
    let mut chance = Chance(seed * 7919 + 17);
    let lumps: Vec<f64> = (0..rows * sides).map(|_| chance.next()).collect();
    let point = |row: usize, column: usize| {
        let t = row as f64 / (rows - 1) as f64;
        let spindle = (TAU / 2.0 * t.powf(0.62)).sin().max(0.0).powf(0.75);
        let lump = 1.0 + 0.16 * lumps[row * sides + column % sides];
        let angle = -TAU * (column % sides) as f64 / sides as f64;
        let r = (0.092 * height * spindle * lump).max(0.03);
        [
            foot[0] + r * angle.cos(),
            foot[1] + 0.5 + (height - 0.5) * t,
            foot[2] + r * angle.sin(),
        ]
    };
    model.surface(rows, sides + 1, |row, column| {
        let (below, above) = (
            point(row.saturating_sub(1), column),
            point((row + 1).min(rows - 1), column),
        );
        let (left, right) = (point(row, column + sides - 1), point(row, column + 1));
        let normal = cross(sub(right, left), sub(above, below));
        let outward = sub(
            point(row, column),
            [foot[0], point(row, column)[1], foot[2]],
        );
        // At the tips all points of a row coincide, so the normal is vertical.
        let tip = if row == 0 {
            [0.0, -1.0, 0.0]
        } else {
            [0.0, 1.0, 0.0]
        };
        let flat = normal.iter().map(|v| v * v).sum::<f64>() < 1e-12
            || outward.iter().all(|v| v.abs() < 1e-9);
        (point(row, column), if flat { tip } else { normal })
    });
}

fn sub(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

fn cross(a: Point, b: Point) -> Point {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
