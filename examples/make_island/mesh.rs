//! A mesh builder: grids, boxes, surfaces of revolution, tubes and cards.

use glam::{Affine3A, Mat3, Quat, Vec2, Vec3, vec2, vec3};

/// A mesh vertex.
#[derive(Clone, Copy)]
pub struct Point {
    pub position: Vec3,
    pub normal: Vec3,
    pub uv: Vec2,
    /// Linear RGB factor on the material colour.
    pub colour: Vec3,
}

/// Triangles with one material.
#[derive(Clone, Default)]
pub struct Mesh {
    pub points: Vec<Point>,
    pub indices: Vec<u32>,
    /// Colour of the vertices added next.
    tint: Option<Vec3>,
}

/// A white vertex.
pub fn point(position: Vec3, normal: Vec3, uv: Vec2) -> Point {
    Point {
        position,
        normal: normal.normalize_or(Vec3::Y),
        uv,
        colour: Vec3::ONE,
    }
}

impl Mesh {
    /// Sets the colour of vertices added from now on.
    pub fn tint(&mut self, colour: Vec3) {
        self.tint = Some(colour);
    }

    fn push(&mut self, mut point: Point) {
        if let Some(tint) = self.tint {
            point.colour *= tint;
        }
        self.points.push(point);
    }

    /// Adds a grid of `rows` x `columns` vertices. Seen from the front, rows run up and columns run right.
    pub fn grid(&mut self, rows: usize, columns: usize, at: impl Fn(usize, usize) -> Point) {
        let first = self.points.len() as u32;
        for row in 0..rows {
            for column in 0..columns {
                self.push(at(row, column));
            }
        }
        let number = |row: usize, column: usize| first + (row * columns + column) as u32;
        for row in 1..rows {
            for column in 1..columns {
                let [a, b] = [number(row - 1, column - 1), number(row - 1, column)];
                let [c, d] = [number(row, column), number(row, column - 1)];
                self.indices.extend([a, b, c, a, c, d]);
            }
        }
    }

    /// Adds a flat quad with counter-clockwise corners; texture coordinates are metres along its edges.
    pub fn quad(&mut self, corners: [Vec3; 4]) {
        let [a, b, c, d] = corners;
        let normal = (b - a).cross(d - a);
        let size = vec2((b - a).length(), (d - a).length());
        self.grid(2, 2, |row, column| {
            let position = [[a, b], [d, c]][row][column];
            let uv = size * vec2(column as f32, 1.0 - row as f32);
            point(position, normal, uv)
        });
    }

    /// Adds an axis-aligned box.
    pub fn cuboid(&mut self, low: Vec3, high: Vec3) {
        self.boxed(
            Affine3A::from_translation(0.5 * (low + high)),
            0.5 * (high - low),
        );
    }

    /// Adds a transformed box with half extents `half`, centred on the origin.
    pub fn boxed(&mut self, place: Affine3A, half: Vec3) {
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                let corner = |s: f32, t: f32| {
                    let mut p = Vec3::ZERO;
                    p[axis] = side;
                    p[u] = s * side;
                    p[v] = t;
                    place.transform_point3(p * half)
                };
                let [a, b] = [corner(-1.0, -1.0), corner(1.0, -1.0)];
                self.quad([a, b, corner(1.0, 1.0), corner(-1.0, 1.0)]);
            }
        }
    }

    /// Adds a beam from `from` to `to`, `width` wide and `height` high.
    pub fn beam(&mut self, from: Vec3, to: Vec3, width: f32, height: f32) {
        let along = (to - from).normalize();
        let side = along.cross(Vec3::Y).normalize_or(Vec3::X);
        let up = side.cross(along);
        let place =
            Affine3A::from_mat3_translation(Mat3::from_cols(along, up, side), 0.5 * (from + to));
        let half = 0.5 * vec3((to - from).length(), height, width);
        self.boxed(place, half);
    }

    /// Adds a surface of revolution about the y axis through `foot`. `profile` lists radius and height from bottom to top.
    pub fn lathe(&mut self, foot: Vec3, profile: &[(f32, f32)], sides: usize) {
        let at = |i: usize| vec2(profile[i].0, profile[i].1);
        self.grid(profile.len(), sides + 1, |row, column| {
            let (below, above) = (row.saturating_sub(1), (row + 1).min(profile.len() - 1));
            let slope = at(above) - at(below);
            let angle = -std::f32::consts::TAU * column as f32 / sides as f32;
            let (sin, cos) = angle.sin_cos();
            let out = vec3(cos, 0.0, sin);
            let normal = out * slope.y - Vec3::Y * slope.x;
            let uv = vec2(-angle * 0.5, -at(row).y);
            point(foot + out * at(row).x + Vec3::Y * at(row).y, normal, uv)
        });
    }

    /// Adds a tapering tube between two points.
    pub fn tube(&mut self, ends: [Vec3; 2], radii: [f32; 2], sides: usize) {
        let along = (ends[1] - ends[0]).normalize_or(Vec3::Y);
        let turn = Quat::from_rotation_arc(Vec3::Y, along);
        let length = (ends[1] - ends[0]).length();
        self.grid(2, sides + 1, |row, column| {
            let angle = -std::f32::consts::TAU * column as f32 / sides as f32;
            let out = turn * vec3(angle.cos(), 0.0, angle.sin());
            let uv = vec2(column as f32 / sides as f32, length * row as f32);
            point(ends[row] + out * radii[row], out, uv)
        });
    }

    /// Adds a card: a textured quad around `centre`, spanned by two half axes, with a single normal.
    pub fn card(&mut self, centre: Vec3, half: [Vec3; 2], normal: Vec3, tile: [Vec2; 2]) {
        let [right, up] = half;
        self.grid(2, 2, |row, column| {
            let [s, t] = [column as f32, row as f32];
            let position = centre + right * (2.0 * s - 1.0) + up * (2.0 * t - 1.0);
            let uv = tile[0] + tile[1] * vec2(s, 1.0 - t);
            point(position, normal, uv)
        });
    }

    /// Removes triangles with two equal corners, as at the tips of gables, surfaces of revolution and balls.
    pub fn without_degenerate(&self) -> Self {
        let at = |i: u32| self.points[i as usize].position;
        let kept = self.indices.chunks_exact(3).filter(|t| {
            let [a, b, c] = [at(t[0]), at(t[1]), at(t[2])];
            (b - a).cross(c - a).length() > 1e-7
        });
        Self {
            indices: kept.flatten().copied().collect(),
            ..self.clone()
        }
    }

    /// Appends another mesh, transformed.
    pub fn append(&mut self, other: &Mesh, place: Affine3A) {
        let first = self.points.len() as u32;
        let normals = Mat3::from(place.matrix3).inverse().transpose();
        for p in &other.points {
            self.push(Point {
                position: place.transform_point3(p.position),
                normal: (normals * p.normal).normalize_or(Vec3::Y),
                ..*p
            });
        }
        self.indices.extend(other.indices.iter().map(|i| first + i));
    }
}
