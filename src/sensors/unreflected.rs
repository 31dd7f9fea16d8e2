//! Light that reaches sensors without reflection: vertical sky component and hours of sun.

use glam::Vec3;
use rayon::prelude::*;

use super::Sensor;
use super::hemisphere::Hemisphere;
use super::numbers::seed;
use super::surface::{TracedScene, before, lanes_of, lifted};
use crate::daylight::colour::luminance;
use crate::scene::{Blocker, Bundle, LANES};

/// Independent estimates, from which the standard error comes.
const REPLICATES: usize = 8;

/// Cells along a side of the hemisphere in the first round; every round doubles them.
const FIRST_SIDE: u32 = 64;

/// Most cells along a side.
const MOST_SIDE: u32 = 256;

/// How many times finer cells are at borders between what is seen of the sky and what hides it.
const FINER: u32 = 4;

/// Share of the light of the sky by which neighbours differ at such a border.
const BORDER: f32 = 0.1;

/// Standard error at which to stop, percent.
const PRECISE: f64 = 0.01;

/// Light of the overcast sky of the CIE at each sensor without reflection, percent of that of open ground, and its standard error: on a
/// façade the vertical sky component (Littlefair 2022, BR 209). Each sensor comes with its number in the grid.
pub fn sky_components(
    sensors: &[(usize, Sensor)],
    scene: &TracedScene,
    of_grid: u32,
) -> Vec<[f64; 2]> {
    let component = |(number, sensor): &(usize, Sensor)| {
        let mut side = FIRST_SIDE;
        loop {
            let of = |replicate: usize| {
                let mut state = seed(of_grid, *number as u32, replicate as u32) ^ side;
                component(sensor, scene, side, &mut state)
            };
            let estimate = mean_and_error(&std::array::from_fn::<f64, REPLICATES, _>(of));
            if estimate[1] <= PRECISE || side >= MOST_SIDE {
                return estimate;
            }
            side *= 2;
        }
    };
    sensors.par_iter().map(component).collect()
}

/// What a ray finds of the sky.
#[derive(Clone, Copy, Default)]
struct Seen {
    /// Share of its light that arrives.
    share: f32,
    /// That light, percent of open ground per share of cos θ/π.
    light: f32,
}

/// An estimate of the component: one ray in each cell of the hemisphere, more in those whose neighbours differ. What is known of a cell itself
/// does not decide, so the expectation is right.
fn component(sensor: &Sensor, scene: &TracedScene, side: u32, state: &mut u32) -> f64 {
    let coarse = Hemisphere::new(sensor.normal, side);
    let fine = Hemisphere::new(sensor.normal, FINER * side);
    let from = lifted(sensor.position, sensor.normal);
    let mut blocker = Blocker::default();
    let mut seen = |bundle: &Bundle| seen(scene, from, bundle, &mut blocker);
    let side = side as usize;
    let mut cells = vec![Seen::default(); side * side];
    for tile in coarse.tiles() {
        let seen = seen(&coarse.bundle(tile, state));
        for (lane, seen) in seen.into_iter().enumerate() {
            let [row, column] = Hemisphere::cell(tile, lane).map(|at| at as usize);
            cells[row * side + column] = seen;
        }
    }
    let mut sum = 0.0;
    for row in 0..side {
        for column in 0..side {
            if !is_border(&cells, side, [row, column]) {
                sum += f64::from(cells[row * side + column].light);
                continue;
            }
            let [row, column] = [row, column].map(|at| at as u32 * FINER);
            let tiles = [column, column + FINER / 2].map(|column| [row, column]);
            let seen = tiles.map(|tile| seen(&fine.bundle(tile, state)));
            let light: f32 = seen.iter().flatten().map(|seen| seen.light).sum();
            sum += f64::from(light) / f64::from(FINER * FINER);
        }
    }
    sum / (side * side) as f64
}

/// Whether the neighbours of a cell differ.
fn is_border(cells: &[Seen], side: usize, [row, column]: [usize; 2]) -> bool {
    let (mut least, mut most) = (f32::INFINITY, 0.0_f32);
    for near in row.saturating_sub(1)..(row + 2).min(side) {
        for step in [side - 1, 0, 1] {
            if near == row && step == 0 {
                continue;
            }
            let share = cells[near * side + (column + step) % side].share;
            (least, most) = (least.min(share), most.max(share));
        }
    }
    most - least > BORDER
}

/// What the rays of a bundle see of the sky, straight on.
fn seen(scene: &TracedScene, from: Vec3, bundle: &Bundle, blocker: &mut Blocker) -> [Seen; LANES] {
    let heights = bundle.dot(Vec3::Y);
    let (open, through) = scene.passing_each(from, (bundle, before(&heights)), blocker);
    let mut seen = [Seen::default(); LANES];
    for lane in lanes_of(open) {
        let share = luminance(through[lane].as_dvec3()) as f32;
        let light = share * overcast(heights[lane]);
        seen[lane] = Seen { share, light };
    }
    seen
}

/// Moon & Spencer 1942: π times the luminance of the overcast sky that gives open ground 100, by the sine of the elevation.
fn overcast(height: f32) -> f32 {
    100.0 * (1.0 + 2.0 * height) * 3.0 / 7.0
}

fn mean_and_error(values: &[f64]) -> [f64; 2] {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    [mean, (squares / (count - 1.0) / count).sqrt()]
}

/// How many of these suns shine on each sensor: their centres above the horizon, in front of it and hidden by nothing opaque.
pub fn suns_seen(sensors: &[(usize, Sensor)], scene: &TracedScene, suns: &[Vec3]) -> Vec<usize> {
    let bundles: Vec<Bundle> = suns.chunks(LANES).map(Bundle::new).collect();
    let seen = |(_, sensor): &(usize, Sensor)| {
        let from = lifted(sensor.position, sensor.normal);
        let mut blocker = Blocker::default();
        let of = |bundle: &Bundle| {
            let up = before(&bundle.dot(Vec3::Y)) & before(&bundle.dot(sensor.normal));
            let (open, through) =
                scene.passing_each(from, (bundle, up & bundle.all()), &mut blocker);
            lanes_of(open)
                .filter(|lane| through[*lane] != Vec3::ZERO)
                .count()
        };
        bundles.iter().map(of).sum()
    };
    sensors.par_iter().map(seen).collect()
}
