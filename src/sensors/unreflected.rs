//! Light that reaches sensors without reflection: vertical sky component and hours of sun.

use std::f64::consts::PI;

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use super::Sensor;
use super::numbers::{Numbers, seed};
use super::surface::{TracedScene, lifted};
use super::walk::outside;
use crate::daylight::colour::luminance;

/// Independent estimates, from which the standard error comes.
const REPLICATES: u32 = 8;

/// Rays of each in the first round; every round doubles them.
const FIRST_ROUND: u32 = 1024;

/// Most rays of each.
const MOST: u32 = 1 << 16;

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
        let from = lifted(sensor.position, sensor.normal);
        let mut sums = [0.0; REPLICATES as usize];
        let (mut traced, mut until) = (0, FIRST_ROUND);
        loop {
            for (replicate, sum) in sums.iter_mut().enumerate() {
                let seed = seed(of_grid, *number as u32, replicate as u32);
                for index in traced..until {
                    let mut numbers = Numbers::new(index, seed, 1);
                    let seen = outside(scene, from, sensor.normal, &mut numbers);
                    *sum += seen.map_or(0.0, |(direction, through)| {
                        overcast(direction) * luminance(through)
                    });
                }
            }
            traced = until;
            let estimate = mean_and_error(&sums.map(|sum| sum / f64::from(traced)));
            if estimate[1] <= PRECISE || traced >= MOST {
                return estimate;
            }
            until = 2 * traced;
        }
    };
    sensors.par_iter().map(component).collect()
}

/// Moon & Spencer 1942: π times the luminance of the overcast sky that gives open ground 100; 0 below the horizon.
fn overcast(direction: DVec3) -> f64 {
    if direction.y < 0.0 {
        return 0.0;
    }
    PI * 100.0 * (1.0 + 2.0 * direction.y) * 3.0 / (7.0 * PI)
}

fn mean_and_error(values: &[f64]) -> [f64; 2] {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let squares: f64 = values.iter().map(|v| (v - mean).powi(2)).sum();
    [mean, (squares / (count - 1.0) / count).sqrt()]
}

/// How many of these suns shine on each sensor: their centres above the horizon, in front of it and hidden by nothing opaque.
pub fn suns_seen(sensors: &[(usize, Sensor)], scene: &TracedScene, suns: &[Vec3]) -> Vec<usize> {
    let seen = |(_, sensor): &(usize, Sensor)| {
        let from = lifted(sensor.position, sensor.normal);
        let shines = |sun: &&Vec3| {
            let is_before = sun.y > 0.0 && sensor.normal.dot(**sun) > 0.0;
            is_before && scene.passing(from, **sun, f32::INFINITY) != DVec3::ZERO
        };
        suns.iter().filter(shines).count()
    };
    sensors.par_iter().map(seen).collect()
}
