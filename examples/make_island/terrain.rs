//! The terrain: its height function, its mesh and the surrounding sea.

use glam::{Vec2, Vec3, vec2, vec3};

use crate::mesh::{Mesh, Point, point};
use crate::noise::{fractal, noise, smoothstep, turbulence};

/// Centre of the temple floor, metres.
pub const TEMPLE: Vec3 = vec3(-24.0, 11.0, -2.0);
/// Centre of the cottage floor, metres.
pub const COTTAGE: Vec3 = vec3(17.0, 3.4, 19.0);
/// Start of the pier on the beach, and its end (x and z), metres.
pub const PIER: [Vec2; 2] = [vec2(9.0, 33.0), vec2(3.0, 56.0)];
/// Peak of the hill (x and z), metres.
const PEAK: Vec2 = vec2(26.0, -20.0);
/// Path from the cottage to the temple (x and z), metres.
const PATH: [Vec2; 7] = [
    vec2(9.0, 34.0),
    vec2(11.0, 27.0),
    vec2(10.0, 20.0),
    vec2(4.0, 13.0),
    vec2(-3.0, 8.0),
    vec2(-9.0, 3.0),
    vec2(-13.0, -2.0),
];

/// Relative distance inside the coast, about 0..1; negative in the sea.
fn inland(p: Vec2) -> f32 {
    let warp = vec2(
        fractal(p / 42.0, 4, 0, 11),
        fractal(p / 42.0 + vec2(31.0, 7.0), 4, 0, 12),
    );
    let q = p + 24.0 * warp;
    let bay = 0.55 * (-(p - vec2(2.0, 50.0)).length_squared() / 480.0).exp();
    let east = 0.5 * (-(p - vec2(70.0, 18.0)).length_squared() / 500.0).exp();
    1.0 - (q / vec2(66.0, 50.0)).length() - bay - east
}

/// Height before terraces and paths, metres above sea level.
fn wild(p: Vec2) -> f32 {
    let d = inland(p);
    if d < 0.0 {
        return (d * 11.0).max(-7.0);
    }
    let shore = 1.5 * (1.0 - (-7.3 * d).exp()) + 5.5 * smoothstep(0.14, 0.55, d);
    let rolling = 1.6 * fractal(p / 17.0, 4, 0, 21) * smoothstep(0.08, 0.4, d);
    let away = (p - PEAK) / vec2(21.0, 16.0);
    let hill = 15.0 * (-away.length_squared()).exp();
    let crags = 7.5 * turbulence(p / 15.0, 5, 0, 31) * smoothstep(2.0, 9.0, hill);
    // The temple's headland drops to the sea in cliffs.
    let cape = (p - TEMPLE.xz() - vec2(-3.0, 0.0)) / vec2(21.0, 17.0);
    let cape = 8.5
        * smoothstep(
            1.25,
            0.75,
            cape.length() + 0.25 * fractal(p / 9.0, 4, 0, 41),
        );
    let edge = smoothstep(0.0, 0.1, d);
    shore + rolling + (hill + crags + cape) * edge
}

/// Distance to the path, metres.
fn off_path(p: Vec2) -> f32 {
    let near = |s: &[Vec2]| {
        let (a, b) = (s[0], s[1]);
        let t = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
        (p - a - (b - a) * t).length()
    };
    PATH.windows(2).map(near).fold(f32::INFINITY, f32::min)
}

trait Ground {
    fn xz(self) -> Vec2;
}

impl Ground for Vec3 {
    fn xz(self) -> Vec2 {
        vec2(self.x, self.z)
    }
}

/// Distance to a rectangle centred on `middle`, metres; 0 inside.
fn outside(p: Vec2, middle: Vec3, half: Vec2) -> f32 {
    ((p - middle.xz()).abs() - half).max(Vec2::ZERO).length()
}

/// Height of the terrain, metres above sea level.
pub fn height(p: Vec2) -> f32 {
    let mut h = wild(p);
    // Terraces for the buildings.
    let temple = smoothstep(7.0, 0.5, outside(p, TEMPLE, vec2(13.5, 8.5)));
    h += (TEMPLE.y - 0.05 - h) * temple;
    // A lawn slopes from the veranda to the beach, so that the pier is visible.
    let across = smoothstep(9.0, 4.0, (p.x - 11.5).abs()) * smoothstep(19.0, 24.0, p.y);
    let lawn = 0.7 + 2.4 * ((34.0 - p.y) / 13.0).clamp(0.0, 1.0);
    h += (lawn - h).min(0.0) * across;
    let cottage = smoothstep(5.0, 0.3, outside(p, COTTAGE, vec2(5.6, 5.4)));
    h += (COTTAGE.y - 0.12 - h) * cottage;
    h - 0.12 * smoothstep(1.3, 0.4, off_path(p)) * smoothstep(0.3, 0.8, h)
}

/// Upward normal of the terrain.
pub fn slope(p: Vec2) -> Vec3 {
    let e = 0.4;
    let dx = height(p + vec2(e, 0.0)) - height(p - vec2(e, 0.0));
    let dz = height(p + vec2(0.0, e)) - height(p - vec2(0.0, e));
    vec3(-dx, 2.0 * e, -dz).normalize()
}

/// Whether a plant may stand here: away from paths, terraces, beaches and cliffs.
pub fn is_free(p: Vec2, room: f32) -> bool {
    height(p) > 1.5
        && slope(p).y > 0.72
        && off_path(p) > 1.0 + room
        && outside(p, TEMPLE, vec2(11.5, 7.5)) > room
        && outside(p, COTTAGE, vec2(4.6, 5.2)) > room
}

fn mix(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a + (b - a) * t.clamp(0.0, 1.0)
}

/// Reflectance of the ground, linear RGB.
fn ground_colour(p: Vec2, h: f32, normal: Vec3) -> Vec3 {
    let (fine, broad) = (fractal(p / 2.3, 3, 0, 51), fractal(p / 14.0, 3, 0, 52));
    let dry = vec3(0.30, 0.235, 0.095);
    let green = vec3(0.085, 0.125, 0.032);
    let grass = mix(green, dry, 0.45 + 0.9 * broad + 0.4 * fine);
    let sand = vec3(0.50, 0.40, 0.265) * (1.0 + 0.12 * fine);
    let wet = vec3(0.30, 0.24, 0.16);
    let strata = noise(vec2(h * 1.3 + 0.8 * broad, 0.3), 0, 53);
    let rock = mix(
        vec3(0.25, 0.21, 0.165),
        vec3(0.40, 0.335, 0.255),
        0.5 + 0.5 * strata + 0.5 * fine,
    );
    let shore = mix(wet, sand, (h - 0.05) / 0.5);
    let mut colour = mix(
        shore,
        grass,
        smoothstep(0.9, 2.1, h + 0.7 * fine + 0.4 * broad),
    );
    let steep = smoothstep(0.84, 0.68, normal.y + 0.07 * fine);
    colour = mix(colour, rock, steep);
    let bare = smoothstep(16.0, 21.0, h + 3.0 * fine);
    colour = mix(colour, rock, bare);
    let trodden = smoothstep(1.1, 0.45, off_path(p) + 0.4 * fine) * smoothstep(0.4, 1.0, h);
    let trodden = trodden.max(smoothstep(
        0.9,
        0.0,
        outside(p, TEMPLE, vec2(11.0, 7.0)) + fine,
    ));
    mix(colour, vec3(0.50, 0.42, 0.30), 0.85 * trodden)
}

/// The terrain as a grid, finest where it is visible.
pub fn land() -> Mesh {
    const CELLS: usize = 172;
    const HALF: Vec2 = vec2(82.0, 66.0);
    let place = |row: usize, column: usize| {
        let [s, t] = [column, row].map(|i| 2.0 * i as f32 / CELLS as f32 - 1.0);
        vec2(s, -t) * HALF
    };
    let mut mesh = Mesh::default();
    mesh.grid(CELLS + 1, CELLS + 1, |row, column| {
        let p = place(row, column);
        let h = height(p);
        let normal = slope(p);
        Point {
            colour: ground_colour(p, h, normal),
            ..point(vec3(p.x, h, p.y), normal, p / 3.1)
        }
    });
    drop_drowned(&mut mesh);
    mesh
}

/// Removes triangles far below sea level.
fn drop_drowned(mesh: &mut Mesh) {
    let points = &mesh.points;
    let kept = mesh.indices.chunks_exact(3);
    let kept = kept.filter(|t| t.iter().any(|i| points[*i as usize].position.y > -1.2));
    let kept: Vec<u32> = kept.flatten().copied().collect();
    mesh.indices = kept;
}

/// The sea: rings around the island out to the horizon, lighter in shallow water.
pub fn sea() -> Mesh {
    const RINGS: usize = 74;
    const SPOKES: usize = 180;
    let radius = |ring: usize| {
        let t = ring as f32 / (RINGS - 1) as f32;
        let near = 18.0 + 82.0 * (t / 0.7).min(1.0);
        near + 14_000.0 * ((t - 0.7).max(0.0) / 0.3).powi(4)
    };
    let mut mesh = Mesh::default();
    mesh.grid(RINGS, SPOKES + 1, |ring, spoke| {
        let angle = std::f32::consts::TAU * spoke as f32 / SPOKES as f32;
        // Inner rings first. Seen from above, columns run counter-clockwise.
        let p = vec2(angle.cos(), angle.sin()) * radius(RINGS - 1 - ring);
        Point {
            colour: sea_colour(p),
            ..point(vec3(p.x, 0.0, p.y), Vec3::Y, p / 9.0)
        }
    });
    mesh.indices.chunks_exact_mut(3).for_each(|t| t.swap(1, 2));
    mesh
}

fn sea_colour(p: Vec2) -> Vec3 {
    let depth = -height(p) * (1.0 + 0.25 * fractal(p / 11.0, 3, 0, 61));
    let lagoon = mix(
        vec3(0.17, 0.33, 0.28),
        vec3(0.035, 0.16, 0.17),
        smoothstep(0.0, 1.6, depth),
    );
    let deep = mix(
        lagoon,
        vec3(0.004, 0.030, 0.048),
        smoothstep(1.0, 5.5, depth),
    );
    let foam = smoothstep(0.22, 0.02, depth) * (0.4 + 0.6 * turbulence(p / 1.7, 3, 0, 62));
    mix(deep, vec3(0.7, 0.7, 0.68), 0.6 * foam)
}
