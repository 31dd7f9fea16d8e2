//! Light of sun and sky on surfaces: paths that are reflected near each other share it.
//!
//! Binder, Fricke & Keller 2019, "Massively parallel path space filtering": points are grouped by cells of space and by their normals. Here a
//! group takes the light of one of its points, drawn with a probability proportional to its weight, so that the expected sum is right: of
//! every sun of the year, and of patches of the sky by rays. Cells are small beside the distance from the sensor and lie anew in every round
//! of paths: their borders average out.

use std::collections::HashMap;

use std::f64::consts::PI;

use glam::{Vec3, Vec3A};

use super::numbers::Numbers;
use super::surface::TracedScene;
use super::walk::{Vertex, outside};
use super::year_light::YearLight;
use crate::daylight::sampling::{rnd, tea};

/// Edge of a cell, relative to the distance from the sensor at which its size begins.
const RELATIVE_EDGE: f32 = 0.15;

/// Rays to the sky from the point of a cell.
const SKY_RAYS: u32 = 64;

/// Distances from the sensor between which cells grow, metres, as powers of two.
const LEVELS: (f32, f32) = (0.0, 14.0);

/// Steps of the normal's coordinates in which points are told apart.
const NORMAL_STEPS: f32 = 4.0;

/// Where a point belongs: size, place and normal.
type Key = ([i32; 4], [i8; 3]);

/// Groups of vertices.
pub(super) struct Cells {
    /// The cell of each vertex.
    pub of_vertex: Vec<u32>,
    /// The vertex that stands for each cell.
    pub stands_for: Vec<u32>,
}

impl Cells {
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

/// Light on the point of a cell.
pub(super) struct CellLight {
    /// Illuminance by suns that give a unit at normal incidence: of each sun in turn, for one channel, or for R, G and B.
    pub suns: Vec<f32>,
    /// Numbers of directions of patches that were met, and the illuminance by a luminance of 1 there, linear RGB.
    pub sky: Vec<(u32, Vec3)>,
}

impl CellLight {
    /// At a vertex: without reflection, through panes. `channels` of suns are 1 or 3.
    pub fn new(
        scene: &TracedScene,
        vertex: &Vertex,
        light: &YearLight,
        channels: usize,
        seed: u32,
    ) -> Self {
        Self {
            suns: sunlight(scene, vertex, &light.suns.directions, channels),
            sky: skylight(scene, vertex, light, seed),
        }
    }
}

/// Rays to the sky with the density cos θ/π.
fn skylight(
    scene: &TracedScene,
    vertex: &Vertex,
    light: &YearLight,
    seed: u32,
) -> Vec<(u32, Vec3)> {
    let (from, normal) = (vertex.position, vertex.normal);
    let mut found = Vec::new();
    for index in 0..SKY_RAYS {
        let mut numbers = Numbers::new(index, seed, 1);
        if let Some((direction, through)) = outside(scene, from, normal, &mut numbers) {
            let weight = through * (PI / f64::from(SKY_RAYS));
            found.push((light.patches.index(direction) as u32, weight.as_vec3()));
        }
    }
    found
}

/// See [`CellLight::suns`].
fn sunlight(scene: &TracedScene, vertex: &Vertex, suns: &[Vec3], channels: usize) -> Vec<f32> {
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
