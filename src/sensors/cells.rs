//! Light of sun and sky on surfaces: paths that are reflected near each other share it.
//!
//! Binder, Fricke & Keller 2019, "Massively parallel path space filtering": points are grouped by cells of space and by their normals. Here a
//! group takes the light of some of its points, drawn with a probability proportional to their weight, so that the expected sum is right: of
//! every sun of the year, and of patches of the sky by rays. Rays are traced eight at a time, each bundle from another of these points. Cells are small beside the distance from the sensor and lie anew in every round
//! of paths: their borders average out.

use std::collections::HashMap;
use std::f32::consts::PI;

use glam::{Vec3, Vec3A};

use super::hemisphere::{Hemisphere, outside};
use super::suns::Suns;
use super::surface::{TracedScene, before, lanes_of};
use super::walk::Vertex;
use super::year_light::YearLight;
use crate::daylight::sampling::{rnd, tea};
use crate::scene::{Blocker, LANES};

/// Edge of a cell, relative to the distance from the sensor at which its size begins.
const RELATIVE_EDGE: f32 = 0.2;

/// Rays to the sky from the points of a cell: the square of this.
const SKY_SIDE: u32 = 8;

/// Points that stand for a cell: bundles of rays begin at one after the other.
const POINTS: usize = 16;

/// Distances from the sensor between which cells grow, metres, as powers of two.
const LEVELS: (f32, f32) = (0.0, 14.0);

/// Steps of the normal's coordinates in which points are told apart.
const NORMAL_STEPS: f32 = 4.0;

/// Where a point belongs: size, place and normal.
type Key = ([i32; 4], [i8; 3]);

/// Vertices that stand for a cell.
pub(super) type Standing = [u32; POINTS];

/// Groups of vertices.
pub(super) struct Cells {
    /// The cell of each vertex.
    pub of_vertex: Vec<u32>,
    /// The vertices that stand for each cell, some of them more than once.
    pub standing: Vec<Standing>,
}

impl Cells {
    /// Groups vertices, `coarser` times as large as usual.
    pub fn new(vertices: &[Vertex], seed: u32, coarser: f32) -> Self {
        let mut state = tea::<8>(seed, 0x5c3);
        let mut random = || rnd(&mut state) as f32;
        let shift = Vec3A::new(random(), random(), random());
        let mut cells: HashMap<Key, u32> = HashMap::new();
        let mut of_vertex = Vec::with_capacity(vertices.len());
        let mut weights: Vec<f32> = Vec::new();
        for vertex in vertices {
            let next = weights.len() as u32;
            let cell = *cells.entry(key(vertex, shift, coarser)).or_insert(next);
            if cell == next {
                weights.push(0.0);
            }
            weights[cell as usize] += vertex.weight.element_sum();
            of_vertex.push(cell);
        }
        // Systematic sampling: the points of a cell are where its running sum of weights passes equal steps from a random start.
        let mut places: Vec<(f32, usize)> = weights.iter().map(|_| (-random(), 0)).collect();
        let mut standing = vec![[0; POINTS]; weights.len()];
        for (at, (vertex, cell)) in vertices.iter().zip(&of_vertex).enumerate() {
            let cell = *cell as usize;
            let (place, drawn) = &mut places[cell];
            *place += POINTS as f32 * vertex.weight.element_sum() / weights[cell];
            while *drawn < POINTS && *place > *drawn as f32 {
                standing[cell][*drawn] = at as u32;
                *drawn += 1;
            }
        }
        for (standing, (_, drawn)) in standing.iter_mut().zip(places) {
            // Rounding may leave out the last one.
            let last = standing[drawn.max(1) - 1];
            standing[drawn..].fill(last);
            // A bundle begins at each of them with the same probability.
            standing.rotate_left((POINTS as f32 * random()) as usize % POINTS);
        }
        Self {
            of_vertex,
            standing,
        }
    }
}

fn key(vertex: &Vertex, shift: Vec3A, coarser: f32) -> Key {
    let level = vertex.distance.log2().floor().clamp(LEVELS.0, LEVELS.1);
    let edge = RELATIVE_EDGE * coarser * level.exp2();
    let place = (Vec3A::from(vertex.position) / edge + shift).floor();
    let [x, y, z] = place.to_array().map(|v| v as i32);
    let normal = (vertex.normal * NORMAL_STEPS).round();
    ([level as i32, x, y, z], normal.to_array().map(|v| v as i8))
}

/// Light on the points of a cell.
pub(super) struct CellLight {
    /// Illuminance by suns that give a unit at normal incidence: of each sun in turn, for one channel, or for R, G and B.
    pub suns: Vec<f32>,
    /// Numbers of directions of patches that were met, and the illuminance by a luminance of 1 there, linear RGB.
    pub sky: Vec<(u32, Vec3)>,
}

impl CellLight {
    /// At the vertices that stand for a cell: without reflection, through panes. `channels` of suns are 1 or 3.
    pub fn new(
        scene: &TracedScene,
        points: &[&Vertex; POINTS],
        light: &YearLight,
        channels: usize,
        seed: u32,
    ) -> Self {
        Self {
            suns: sunlight(scene, points, &light.suns, channels),
            sky: skylight(scene, points, light, seed),
        }
    }
}

/// Rays to the sky with the density cos θ/π.
fn skylight(
    scene: &TracedScene,
    points: &[&Vertex; POINTS],
    light: &YearLight,
    seed: u32,
) -> Vec<(u32, Vec3)> {
    let mut found = Vec::new();
    let (mut state, mut blocker) = (seed, Blocker::default());
    let mut hemisphere = Hemisphere::new(points[0].normal, SKY_SIDE);
    let share = PI / hemisphere.side().pow(2) as f32;
    for (at, tile) in hemisphere.tiles().enumerate() {
        let point = points[2 * at % POINTS];
        hemisphere.turn(point.normal);
        let bundle = hemisphere.bundle(tile, &mut state);
        let random = (&mut state, &mut blocker);
        outside(
            scene,
            point.position,
            &bundle,
            random,
            |direction, through| {
                let patch = light.patches.index(direction.as_dvec3());
                found.push((patch as u32, share * through));
            },
        );
    }
    found
}

/// See [`CellLight::suns`].
fn sunlight(
    scene: &TracedScene,
    points: &[&Vertex; POINTS],
    suns: &Suns,
    channels: usize,
) -> Vec<f32> {
    let (count, mut blocker) = (suns.directions.len(), Blocker::default());
    let mut light = vec![0.0; channels * count];
    for (at, bundle) in suns.bundles.iter().enumerate() {
        let point = points[at % POINTS];
        let cosines = bundle.dot(point.normal);
        let lit = before(&cosines) & bundle.all();
        if lit == 0 {
            continue;
        }
        let (open, through) = scene.passing_each(point.position, (bundle, lit), &mut blocker);
        for lane in lanes_of(open) {
            let values = cosines[lane] * through[lane];
            for (channel, value) in values.to_array().iter().take(channels).enumerate() {
                light[channel * count + LANES * at + lane] = *value;
            }
        }
    }
    light
}
