//! Sunlight on surfaces, for many suns: paths that are reflected near each other share what the suns give there.
//!
//! Binder, Fricke & Keller 2019, "Massively parallel path space filtering": points are grouped by cells of space and by their normals. Here a
//! group takes the sunlight of one of its points, drawn with a probability proportional to its weight, so that the expected sum is right.
//! Cells are small beside the distance from the sensor and lie anew in every round of paths: their borders average out.

use std::collections::HashMap;

use glam::{Vec3, Vec3A};

use super::surface::TracedScene;
use super::walk::Vertex;
use crate::daylight::sampling::{rnd, tea};

/// Edge of a cell, relative to the distance from the sensor at which its size begins.
const RELATIVE_EDGE: f32 = 0.0875;

/// Distances from the sensor between which cells grow, metres, as powers of two.
const LEVELS: (f32, f32) = (0.0, 14.0);

/// Steps of the normal's coordinates in which points are told apart.
const NORMAL_STEPS: f32 = 4.0;

/// Where a point belongs: size, place and normal.
type Key = ([i32; 4], [i8; 3]);

/// Groups of vertices.
pub(super) struct SunCells {
    /// The cell of each vertex.
    pub of_vertex: Vec<u32>,
    /// The vertex that stands for each cell.
    pub stands_for: Vec<u32>,
}

impl SunCells {
    /// Groups vertices, `coarser` times as large as usual.
    pub fn new(vertices: &[Vertex], seed: u32, coarser: f32) -> Self {
        let mut state = tea::<8>(seed, 0x5c3);
        let mut random = || rnd(&mut state) as f32;
        let shift = Vec3A::new(random(), random(), random());
        let mut cells: HashMap<Key, u32> = HashMap::new();
        let (mut of_vertex, mut stands_for) = (Vec::with_capacity(vertices.len()), Vec::new());
        let mut weights: Vec<f32> = Vec::new();
        for (at, vertex) in vertices.iter().enumerate() {
            let next = stands_for.len() as u32;
            let cell = *cells.entry(key(vertex, shift, coarser)).or_insert(next);
            let weight = vertex.weight.element_sum();
            if cell == next {
                weights.push(weight);
                stands_for.push(at as u32);
            } else {
                let sum = &mut weights[cell as usize];
                *sum += weight;
                if random() * *sum < weight {
                    stands_for[cell as usize] = at as u32;
                }
            }
            of_vertex.push(cell);
        }
        Self {
            of_vertex,
            stands_for,
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

/// Illuminance of a surface by suns that give a unit at normal incidence: of each sun in turn, for one channel where `channels` is 1, for
/// R, G and B where it is 3.
pub(super) fn sunlight(
    scene: &TracedScene,
    vertex: &Vertex,
    suns: &[Vec3],
    channels: usize,
) -> Vec<f32> {
    let mut light = vec![0.0; channels * suns.len()];
    for (at, sun) in suns.iter().enumerate() {
        let cosine = vertex.normal.dot(*sun);
        if cosine > 0.0 {
            let through = scene.passing(vertex.position, *sun, f32::INFINITY) * f64::from(cosine);
            for (channel, value) in through.to_array().iter().take(channels).enumerate() {
                light[channel * suns.len() + at] = *value as f32;
            }
        }
    }
    light
}
