//! Sensors under a uniform sky against closed forms: an open sphere, pairs of plates, white surfaces.

use std::f64::consts::PI;

use glam::{DVec3, Quat, Vec3};
use skylight::daylight::Daylight;
use skylight::daylight::sampling::r2;
use skylight::scene::{LoadOptions, Scene, load_with_progress};
use skylight::sensors::{ALL_BOUNCES, Accuracy, Lights, Reading, Sensor, TracedScene, measure};

use crate::model::{Model, constant_sky, matt};

/// Luminance of the sky and of the ground, cd/m².
const SKY: f64 = 1000.0;

/// Readings of `paths` paths a sensor.
pub fn readings(
    scene: &Scene,
    sky: &Daylight,
    sensors: &[Sensor],
    relative_error: f64,
    paths: u32,
) -> Vec<Reading> {
    let accuracy = Accuracy {
        relative_error,
        max_paths: paths,
        seed: 1,
        bounces: ALL_BOUNCES,
    };
    let (scene, lights) = (TracedScene::new(scene), Lights::new(sky));
    measure(sensors, &scene, &lights, &accuracy, &|| ())
}

/// Mean of the totals of some readings and its standard error, lux.
pub fn mean(readings: &[Reading]) -> (f64, f64) {
    let n = readings.len() as f64;
    let total: f64 = readings.iter().map(Reading::total).sum();
    let square: f64 = readings.iter().map(|r| r.standard_error.powi(2)).sum();
    (total / n, square.sqrt() / n)
}

/// Compares the mean of some sensors with a closed form: within 0.5 %, and with a standard error below a third of that.
fn check(what: &str, scene: &Scene, sensors: &[Sensor], paths: u32, expected: f64) {
    let sky = constant_sky(SKY);
    let (lux, error) = mean(&readings(scene, &sky, sensors, 0.0, paths));
    let (difference, error) = (lux / expected - 1.0, error / expected);
    println!(
        "{what}: {lux:.2} lux, expected {expected:.2}: {:+.3} %, standard error {:.3} %",
        100.0 * difference,
        100.0 * error
    );
    assert!(error < 0.005 / 3.0, "{what}: {error}");
    assert!(difference.abs() < 0.005, "{what}: {difference}");
}

/// A point in each of `n` x `n` cells of a parallelogram, at pseudo-random places of the cells.
pub fn spread([corner, u, v]: [Vec3; 3], n: u32) -> Vec<Vec3> {
    let at = |k: u32| {
        let within = r2(k).as_vec2();
        let (s, t) = ((k / n) as f32 + within.x, (k % n) as f32 + within.y);
        corner + (s * u + t * v) / n as f32
    };
    (0..n * n).map(at).collect()
}

pub fn facing(normal: Vec3, points: Vec<Vec3>) -> Vec<Sensor> {
    let sensor = |position| Sensor { position, normal };
    points.into_iter().map(sensor).collect()
}

/// A sphere of radius 2 m in `rings` rings, without the first `open` around its pole: the rim of the opening is a regular polygon.
fn open_sphere(rings: u32, open: u32) -> Vec<[Vec3; 3]> {
    let tilt = Quat::from_rotation_z(0.9);
    let at = |ring: u32, column: u32| {
        let (sin_theta, cos_theta) = (ring as f32 / rings as f32 * PI as f32).sin_cos();
        let turn = (column % (2 * rings)) as f32 / rings as f32 * PI as f32;
        let (sin_phi, cos_phi) = turn.sin_cos();
        // The poles are points, not rings of rounding errors.
        let sin_theta = if ring == rings { 0.0 } else { sin_theta };
        tilt * (2.0 * Vec3::new(sin_theta * cos_phi, cos_theta, sin_theta * sin_phi))
    };
    let facets = (open..rings).flat_map(|ring| (0..2 * rings).map(move |column| (ring, column)));
    let halves = facets.flat_map(|(ring, column)| {
        let [a, b] = [0, 1].map(|i| at(ring, column + i));
        let [c, d] = [0, 1].map(|i| at(ring + 1, column + i));
        [[a, b, c], [b, d, c]]
    });
    halves.filter(|t| area(t) > 0.0).collect()
}

fn area([a, b, c]: &[Vec3; 3]) -> f64 {
    0.5 * f64::from((b - a).cross(c - a).length())
}

/// `count` sensors on triangles, on equal shares of their area, that look to the origin.
fn on_triangles(triangles: &[[Vec3; 3]], count: u32) -> Vec<Sensor> {
    let whole: f64 = triangles.iter().map(area).sum();
    let mut list = Vec::new();
    let mut before = 0.0;
    for triangle @ [a, b, c] in triangles {
        before += area(triangle) / whole * f64::from(count);
        while (list.len() as f64) + 0.5 < before {
            let point = r2(list.len() as u32).as_vec2();
            let (u, v) = (point.x, point.y);
            let (u, v) = if u + v > 1.0 {
                (1.0 - u, 1.0 - v)
            } else {
                (u, v)
            };
            let normal = (b - a).cross(c - a).normalize();
            list.push(Sensor {
                position: a + u * (b - a) + v * (c - a),
                normal: if normal.dot(*a) > 0.0 {
                    -normal
                } else {
                    normal
                },
            });
        }
    }
    list
}

/// The wall of a sphere sees equal areas of the sphere under equal factors, so that E = πLf/(1 − ρ(1 − f)) on all of it.
///
/// f is the area of the opening's plane over that of the wall. By reciprocity that is the mean factor from a wall of any shape to
/// a plane opening, so that the closed form holds for the mean over a wall of facets. It neglects only how E and the factor vary
/// together over a facet, which is of fourth order in its size.
#[test]
fn the_wall_of_a_sphere_with_an_opening_has_the_light_of_all_bounces() {
    const RINGS: u32 = 64;
    for (open, rho) in [(16, 0.5), (24, 0.7)] {
        let wall = open_sphere(RINGS, open);
        let radius = 2.0 * (f64::from(open) / f64::from(RINGS) * PI).sin();
        let sides = f64::from(2 * RINGS);
        let opening = 0.5 * sides * radius.powi(2) * (2.0 * PI / sides).sin();
        let f = opening / wall.iter().map(area).sum::<f64>();
        let reflectance = f64::from(rho);
        let expected = PI * SKY * f / (1.0 - reflectance * (1.0 - f));
        let scene = Model::default().triangles(&wall, &matt(rho)).build();
        let what = format!("sphere, f {f:.4}, rho {rho}");
        check(&what, &scene, &on_triangles(&wall, 256), 1024, expected);
    }
}

/// Factor from an element at `p` with the unit normal `n` to a parallelogram in front of it (Lambert 1760; Howell, A Catalog of
/// Radiation Heat Transfer Configuration Factors, method of contour integration).
fn factor(p: DVec3, n: DVec3, [corner, u, v]: [DVec3; 3]) -> f64 {
    let corners = [corner, corner + u, corner + u + v, corner + v].map(|c| (c - p).normalize());
    let side = |i: usize| {
        let (a, b) = (corners[i], corners[(i + 1) % 4]);
        let across = a.cross(b);
        a.angle_between(b) * across.normalize_or_zero().dot(n)
    };
    (0..4).map(side).sum::<f64>().abs() / (2.0 * PI)
}

/// Two equal rectangles: a corner, two edges and the normal toward the other. A mirror maps each to the other.
struct Plates {
    sides: [[Vec3; 3]; 2],
    normals: [Vec3; 2],
}

impl Plates {
    /// Patches along each edge.
    const PATCHES: u32 = 20;

    /// Squares of 2 m, `distance` metres apart, one above the other.
    fn parallel(distance: f32) -> Self {
        let square = |y: f32| [Vec3::new(-1.0, y, -1.0), 2.0 * Vec3::X, 2.0 * Vec3::Z];
        Self {
            sides: [square(0.0), square(distance)],
            normals: [Vec3::Y, -Vec3::Y],
        }
    }

    /// A floor and a wall, 2 m long and `width` metres wide, that share an edge.
    fn perpendicular(width: f32) -> Self {
        let (at, along) = (Vec3::new(0.5, 1.0, -1.0), 2.0 * Vec3::Z);
        Self {
            sides: [[at, width * Vec3::X, along], [at, width * Vec3::Y, along]],
            normals: [Vec3::Y, Vec3::X],
        }
    }

    fn patches(&self, side: usize) -> Vec<[DVec3; 3]> {
        let n = Self::PATCHES;
        let [corner, u, v] = self.sides[side].map(|p| p.as_dvec3());
        let (u, v) = (u / f64::from(n), v / f64::from(n));
        let patch = |k: u32| {
            let corner = corner + f64::from(k / n) * u + f64::from(k % n) * v;
            [corner, u, v]
        };
        (0..n * n).map(patch).collect()
    }

    /// Mean factor from one to the other, and mean irradiance of their inner sides under a uniform sky, lux: the radiosity equation
    /// E = πL(1 − F) + ρ Σ F_ij E_j with the factors of patches, whose E is taken as uniform. By symmetry both have the same E.
    fn solved(&self, rho: f64) -> (f64, f64) {
        let patches = self.patches(1);
        let normal = self.normals[0].as_dvec3();
        let of = |[corner, u, v]: &[DVec3; 3]| {
            let centre = *corner + 0.5 * (*u + *v);
            let seen = patches.iter().map(|patch| factor(centre, normal, *patch));
            seen.collect::<Vec<f64>>()
        };
        let factors: Vec<Vec<f64>> = self.patches(0).iter().map(of).collect();
        let seen: Vec<f64> = factors.iter().map(|row| row.iter().sum()).collect();
        let mut lux = vec![0.0; seen.len()];
        for _ in 0..60 {
            let reflected = |row: &Vec<f64>| row.iter().zip(&lux).map(|(f, e)| f * e).sum::<f64>();
            let sum = |(row, f): (&Vec<f64>, &f64)| PI * SKY * (1.0 - f) + rho * reflected(row);
            lux = factors.iter().zip(&seen).map(sum).collect();
        }
        let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
        (mean(&seen), mean(&lux))
    }

    /// With one plate alone its irradiance is πL, so that a sensor in place of the other has πL(1 − (1 − ρ)F) in the mean; with
    /// both, the reflections between them come to it.
    fn check(&self, what: &str, closed: f64, rho: f32) {
        let reflectance = f64::from(rho);
        let (numerical, coupled) = self.solved(reflectance);
        assert!(
            (numerical / closed - 1.0).abs() < 2e-3,
            "{numerical} {closed}"
        );
        let plate = |model: Model, side: usize| {
            let [corner, u, v] = self.sides[side].map(|p| p.to_array());
            model.quad(corner, u, v, &matt(rho))
        };
        let sensors = facing(self.normals[1], spread(self.sides[1], 16));
        let alone = plate(Model::default(), 0).build();
        let expected = PI * SKY * (1.0 - (1.0 - reflectance) * closed);
        check(
            &format!("{what}, one, rho {rho}"),
            &alone,
            &sensors,
            1024,
            expected,
        );
        let both = plate(plate(Model::default(), 0), 1).build();
        check(
            &format!("{what}, both, rho {rho}"),
            &both,
            &sensors,
            2048,
            coupled,
        );
    }
}

/// Howell, A Catalog of Radiation Heat Transfer Configuration Factors, C-11: identical, parallel, directly opposed rectangles; here
/// squares, with `x` their edge over their distance.
fn parallel_squares(x: f64) -> f64 {
    let root = (1.0 + x * x).sqrt();
    let log = ((1.0 + x * x).powi(2) / (1.0 + 2.0 * x * x)).sqrt().ln();
    2.0 / (PI * x * x) * (log + 2.0 * x * root * (x / root).atan() - 2.0 * x * x.atan())
}

/// Howell, C-14: two rectangles of equal length with one common edge, at an angle of 90°; here of equal width, with `w` their width
/// over their length.
fn perpendicular_plates(w: f64) -> f64 {
    let (s, d) = (w * w, 2.0 * w * w);
    let diagonal = d.sqrt();
    let angles = 2.0 * w * w.recip().atan() - diagonal * diagonal.recip().atan();
    let log = ((1.0 + s).powi(2) / (1.0 + d)).ln() + d * (s * (1.0 + d) / ((1.0 + s) * d)).ln();
    (angles + 0.25 * log) / (PI * w)
}

#[test]
fn parallel_plates_light_each_other_by_their_form_factor() {
    assert!((parallel_squares(1.0) - 0.199_825).abs() < 1e-6);
    Plates::parallel(2.0).check("parallel, a/c 1", parallel_squares(1.0), 0.2);
    Plates::parallel(0.5).check("parallel, a/c 4", parallel_squares(4.0), 0.7);
}

#[test]
fn plates_with_a_common_edge_light_each_other_by_their_form_factor() {
    assert!((perpendicular_plates(1.0) - 0.200_044).abs() < 1e-6);
    Plates::perpendicular(2.0).check("perpendicular, w/l 1", perpendicular_plates(1.0), 0.2);
    Plates::perpendicular(0.6).check("perpendicular, w/l 0.3", perpendicular_plates(0.3), 0.8);
}

/// White furnace: where nothing absorbs and all the environment has one luminance L, all light is lost and found again: E = πL.
#[test]
fn white_surfaces_in_a_uniform_environment_have_its_light_everywhere() {
    let options = LoadOptions::default();
    let path = std::path::Path::new("colonnade");
    let mut scene = load_with_progress(Some(path), &options, &|_, _| ())
        .expect("a bundled scene")
        .scene;
    for material in &mut scene.materials {
        (material.diffuse, material.diffuse_texture) = ([1.0; 3], None);
    }
    scene.colours.clear();
    let (centre, extent) = (scene.bounds.centre(), scene.bounds.extent());
    let sensor = |i: u32| {
        let at = r2(i).as_vec2();
        let place = Vec3::new(at.x - 0.5, 0.0, at.y - 0.5) * 0.1 * extent;
        Sensor {
            position: centre + place,
            normal: Quat::from_rotation_y(i as f32)
                * Vec3::new(0.6, [-0.8, 0.8][i as usize % 2], 0.0),
        }
    };
    let sensors: Vec<Sensor> = (0..16).map(sensor).collect();
    check("white colonnade", &scene, &sensors, 4096, PI * SKY);
}
