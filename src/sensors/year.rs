//! A year at the sensors of a grid: hourly illuminances and their metrics, with standard errors.
//!
//! E(hour) = Σ over patches of the sky of coefficient times luminance + direct sun + reflected sun (Tregenza & Waters 1983, "Daylight
//! coefficients"). Rays from the sensor give the coefficients of what it sees, and paths ([`super::walk`]) those of what is reflected: where
//! they are reflected, the light of the sky and of the suns of the year is gathered ([`super::cells`], [`super::suns`]). The direct sun is
//! that of each hour itself.
//!
//! Sensors are measured in blocks of [`BLOCK`]: the result of a block depends on nothing but its sensors, the scene, the light and the seed.

use std::f64::consts::PI;

use glam::Vec3;
use ndarray::{Array2, ArrayView2, s};
use rayon::prelude::*;

use super::cells::{CellLight, Cells, Standing};
use super::hemisphere::{Hemisphere, outside};
use super::numbers::seed;
use super::shard::Shard;
use super::surface::{TracedScene, lifted};
use super::walk::{Vertex, walk};
use super::year_light::{YearLight, grey};
use super::{Accuracy, Sensor};
use crate::daylight::colour::LUMINANCE_WEIGHTS;
use crate::daylight::metrics::Measures;
use crate::daylight::sampling::tea;
use crate::scene::Blocker;

/// Sensors of a block.
pub const BLOCK: usize = 256;

/// Independent estimates, from which standard errors come.
const REPLICATES: usize = 8;

/// Least paths of a replicate and sensor.
const LEAST_PATHS: u32 = 256;

/// Paths of a replicate and sensor that bring a room to about one point of daylight autonomy.
const PATHS_OF_A_POINT: f64 = 2048.0;

/// Rays to what the sensor sees, for each path.
const RAYS: u32 = 4;

/// Most of a round: their points are kept while the sunlight on them is found. Long rounds share the light of more points.
const MOST_ROUND: u32 = 2048;

/// Sensors whose errors tell together how many paths one of them needs, itself among them.
const NEIGHBOURS: usize = 5;

/// How many times more paths a sensor gets at once: its error after few is a guess.
const MOST_TIMES: f64 = 16.0;

/// Sensors whose sums are multiplied with the light of the year at once.
const TOGETHER: usize = 16;

/// Most numbers of sunlight that are held at a time, 4 bytes each; with more, cells are larger.
const MOST_SUNLIGHT: usize = 1 << 25;

/// What to measure.
pub struct YearRun<'a> {
    /// The model.
    pub scene: &'a TracedScene<'a>,
    /// Sun and sky.
    pub light: &'a YearLight,
    /// Metrics, thresholds and hours.
    pub measures: &'a Measures,
    /// When to stop. The error is the root mean square over the sensors of a block, of each metric: of percentages 0.01 is one point,
    /// illuminances and daylight factors have it relative to their value. Sensors that err more have more paths.
    pub accuracy: Accuracy,
    /// Of each value, whether its error counts.
    pub wanted: Vec<bool>,
    /// Whether to keep the illuminances of every hour.
    pub keeps_hours: bool,
    /// The part of the blocks to measure.
    pub shard: Shard,
    /// Told of progress: sensors that are done, and the error of the block so far.
    pub progress: &'a (dyn Fn(usize, Option<f64>) + Sync),
    /// Whether to stop with what there is.
    pub is_stopped: &'a (dyn Fn() -> bool + Sync),
}

/// A year at a sensor.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SensorYear {
    /// Values of [`Measures::names`], and last the daylight factor, percent.
    pub values: Vec<f64>,
    /// Their standard errors.
    pub errors: Vec<f64>,
    /// Hours of annual sunlight exposure: exact.
    pub exposed_hours: f64,
    /// Illuminance of each lit hour, lux, if kept.
    pub lux: Vec<f32>,
    /// Paths.
    pub paths: u32,
}

/// A year at the sensors of a grid.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Year {
    /// Of each sensor in the order of the grid; fewer where it was stopped, or of a shard.
    pub sensors: Vec<SensorYear>,
    /// Numbers of these sensors in the grid.
    pub numbers: Vec<usize>,
    /// Largest error of a block, as [`YearRun::accuracy`] counts it.
    pub error: f64,
}

/// Measures a year at all sensors. The same seed gives the same numbers, whatever the number of cores.
pub fn measure_year(sensors: &[Sensor], run: &YearRun) -> Year {
    if run.wanted.contains(&true) {
        // Here, where all cores share the work.
        run.light.skies();
    }
    let mut year = Year::default();
    let blocks = sensors.chunks(BLOCK).enumerate();
    for (number, block) in blocks.filter(|(number, _)| run.shard.takes(*number)) {
        let first = number * BLOCK;
        let Some((measured, error)) = Block::new(block, first, run).measured(year.sensors.len())
        else {
            break;
        };
        year.numbers.extend(first..first + block.len());
        year.sensors.extend(measured);
        year.error = year.error.max(error);
        (run.progress)(year.sensors.len(), None);
    }
    year
}

/// Coefficients of a sensor, summed over paths: replicate after replicate.
struct Sums {
    /// Illuminance by a luminance of 1 in each patch.
    patches: Vec<f32>,
    /// Illuminance by reflected light of a unit of each sun.
    suns: Vec<f32>,
}

/// Sensors that are measured together.
struct Block<'a> {
    sensors: &'a [Sensor],
    /// Number of the first sensor in the grid.
    first: usize,
    run: &'a YearRun<'a>,
    sums: Vec<Sums>,
    direct: Vec<Vec<f32>>,
    /// Paths of each replicate so far, of each sensor.
    traced: Vec<u32>,
    /// Rounds of paths so far.
    rounds: u32,
}

impl<'a> Block<'a> {
    fn new(sensors: &'a [Sensor], first: usize, run: &'a YearRun<'a>) -> Self {
        let light = run.light;
        let sums = || Sums {
            patches: vec![0.0; REPLICATES * light.patches.count()],
            suns: vec![0.0; REPLICATES * light.suns.directions.len()],
        };
        let direct = |sensor: &Sensor| light.direct_sun(sensor, run.scene);
        Self {
            sums: sensors.iter().map(|_| sums()).collect(),
            direct: sensors.par_iter().map(direct).collect(),
            traced: vec![0; sensors.len()],
            rounds: 0,
            sensors,
            first,
            run,
        }
    }

    /// Rounds of paths until the error is met; `None` if stopped before the first is done. Before it, `done` sensors were measured.
    ///
    /// Sensors that err more get more paths: the errors of all become alike, for as many paths as would bring the mean square down alone.
    fn measured(mut self, done: usize) -> Option<(Vec<SensorYear>, f64)> {
        let accuracy = &self.run.accuracy;
        let most = (accuracy.max_paths / REPLICATES as u32).max(LEAST_PATHS);
        let is_wanted = self.run.wanted.contains(&true);
        let first = if is_wanted {
            first_round(accuracy.relative_error).min(most)
        } else {
            0
        };
        let mut aims = vec![first; self.sensors.len()];
        loop {
            while self
                .traced
                .iter()
                .zip(&aims)
                .any(|(traced, aim)| traced < aim)
            {
                if !self.trace(&aims) {
                    return None;
                }
                if (self.run.is_stopped)() {
                    break;
                }
            }
            let measured = self.sensor_years();
            let errors = self.errors(&measured);
            let error = largest_mean(&errors);
            (self.run.progress)(done, Some(error));
            let is_met = error <= accuracy.relative_error || self.traced.iter().all(|n| *n >= most);
            if is_met || (self.run.is_stopped)() {
                return Some((measured, error));
            }
            aims = self.aims(&errors, most);
        }
    }

    /// How many paths of each sensor the next rounds are to reach.
    fn aims(&self, errors: &[Vec<f64>], most: u32) -> Vec<u32> {
        let worst = |own: &Vec<f64>| own.iter().copied().fold(0.0, f64::max);
        let worst: Vec<f64> = errors.iter().map(worst).collect();
        let worst = self.with_neighbours(&worst);
        let squares: f64 = worst.iter().map(|error| error * error).sum();
        // The error of every sensor at which the mean square that counts is that which is asked for.
        let mean = (squares / worst.len() as f64).sqrt();
        let level = self.run.accuracy.relative_error * mean / largest_mean(errors);
        let aim = |(traced, error): (&u32, &f64)| {
            // The error falls at least with the square root of the number of paths.
            let times = (error / level).powi(2).min(MOST_TIMES);
            let aim = f64::from(*traced) * if times > 1.0 { times.max(1.2) } else { 1.0 };
            aim.ceil().min(f64::from(most.max(*traced))) as u32
        };
        let mut aims: Vec<u32> = self.traced.iter().zip(&worst).map(aim).collect();
        if aims == self.traced {
            // None errs more than it may by itself: all go on.
            let more = |traced: &u32| (traced + traced / 5).min(most.max(*traced));
            aims = self.traced.iter().map(more).collect();
        }
        aims
    }

    /// Errors as root mean squares with those of the nearest sensors, which err alike: an error by eight replicates is a guess, and sensors that
    /// are thought to be right too early would stay wrong.
    fn with_neighbours(&self, errors: &[f64]) -> Vec<f64> {
        let of = |sensor: &Sensor| {
            let distance = |other: &Sensor| sensor.position.distance_squared(other.position);
            let mut near: Vec<(f32, f64)> = self
                .sensors
                .iter()
                .map(distance)
                .zip(errors.iter().copied())
                .collect();
            let count = NEIGHBOURS.min(near.len());
            near.select_nth_unstable_by(count - 1, |a, b| a.0.total_cmp(&b.0));
            let squares = near[..count].iter().map(|(_, error)| error * error);
            (squares.sum::<f64>() / count as f64).sqrt()
        };
        self.sensors.par_iter().map(of).collect()
    }

    /// One more round of paths toward these aims; false if stopped in the first.
    fn trace(&mut self, aims: &[u32]) -> bool {
        let more = |(aim, traced): (&u32, &u32)| (aim - traced.min(aim)).min(MOST_ROUND);
        let paths: Vec<u32> = aims.iter().zip(&self.traced).map(more).collect();
        for replicate in 0..REPLICATES {
            if self.rounds == 0 && (self.run.is_stopped)() {
                return false;
            }
            let vertices = self.walked(&paths, replicate);
            self.gather(&vertices, replicate);
        }
        self.traced
            .iter_mut()
            .zip(&paths)
            .for_each(|(sum, more)| *sum += more);
        self.rounds += 1;
        true
    }

    /// Traces the rays and paths of a replicate; the points of each sensor where it is reflected.
    fn walked(&mut self, paths: &[u32], replicate: usize) -> Vec<Vec<Vertex>> {
        let (run, first) = (self.run, self.first);
        let patches = run.light.patches.count();
        let range = replicate * patches..(replicate + 1) * patches;
        let sensors = self.sensors.par_iter().zip(&mut self.sums).enumerate();
        let rounds = self.traced.par_iter().zip(paths);
        let walked = sensors
            .zip(rounds)
            .map(|((at, (sensor, sums)), (traced, paths))| {
                let (from, to) = (*traced, traced + paths);
                let seed = seed(run.accuracy.seed, (first + at) as u32, replicate as u32);
                if from < to {
                    // Not the numbers of the paths.
                    let seed = tea::<8>(seed, !from);
                    see(
                        sensor,
                        run,
                        to - from,
                        seed,
                        &mut sums.patches[range.clone()],
                    );
                }
                let mut vertices = Vec::new();
                for index in from..to {
                    walk(
                        sensor,
                        run.scene,
                        run.accuracy.bounces,
                        [index, seed],
                        &mut vertices,
                    );
                }
                vertices
            });
        walked.collect()
    }

    /// Adds the light of the points of a replicate.
    fn gather(&mut self, vertices: &[Vec<Vertex>], replicate: usize) {
        let (scene, light) = (self.run.scene, self.run.light);
        let all: Vec<Vertex> = vertices.iter().flatten().copied().collect();
        let suns = light.suns.directions.len();
        let channels = if scene.is_tinted() { 3 } else { 1 };
        let accuracy = &self.run.accuracy;
        let seed = seed(
            accuracy.seed,
            tea::<8>(self.first as u32, self.rounds),
            !replicate as u32,
        );
        let most = (MOST_SUNLIGHT / (channels * suns).max(1)).max(1);
        let mut coarser = 1.0;
        let cells = loop {
            let cells = Cells::new(&all, seed, coarser);
            if cells.standing.len() <= most || coarser > 1e6 {
                break cells;
            }
            coarser *= 2.0;
        };
        let lit = |(at, standing): (usize, &Standing)| {
            let seed = tea::<8>(seed, at as u32);
            let points = standing.map(|vertex| &all[vertex as usize]);
            CellLight::new(scene, &points, light, channels, seed)
        };
        let lit: Vec<CellLight> = cells.standing.par_iter().enumerate().map(lit).collect();
        let mut starts = Vec::with_capacity(vertices.len());
        let mut start = 0;
        for list in vertices {
            starts.push(start);
            start += list.len();
        }
        let patches = light.patches.count();
        let sensors = self.sums.par_iter_mut().zip(vertices).zip(starts);
        sensors.for_each(|((sums, vertices), start)| {
            let patches = &mut sums.patches[replicate * patches..(replicate + 1) * patches];
            let suns = &mut sums.suns[replicate * suns..(replicate + 1) * suns];
            let cells = &cells.of_vertex[start..start + vertices.len()];
            for (cell, weight) in together(vertices, cells, lit.len()) {
                let light = &lit[cell];
                for (patch, share) in &light.sky {
                    patches[*patch as usize] += grey((weight * *share).as_dvec3());
                }
                add(suns, &light.suns, weight, channels);
            }
        });
    }

    /// What the paths so far tell of all sensors.
    fn sensor_years(&self) -> Vec<SensorYear> {
        let all: Vec<usize> = (0..self.sensors.len()).collect();
        let years = all.par_chunks(TOGETHER).flat_map_iter(|group| {
            let is_traced = group.iter().any(|at| self.traced[*at] > 0);
            let lux = is_traced.then(|| {
                let of = |values: fn(&Sums) -> &Vec<f32>| {
                    let values = group.iter().flat_map(move |at| values(&self.sums[*at]));
                    values.copied().collect::<Vec<f32>>()
                };
                let (patches, suns) = (of(|sums| &sums.patches), of(|sums| &sums.suns));
                self.run.light.indirect(&patches, &suns)
            });
            let of = move |(place, at): (usize, &usize)| match &lux {
                Some(lux) => {
                    let rows = REPLICATES * place..REPLICATES * (place + 1);
                    self.sensor_year(*at, lux.slice(s![rows, ..]))
                }
                None => self.untraced(*at),
            };
            group.iter().enumerate().map(of).collect::<Vec<_>>()
        });
        years.collect()
    }

    /// A sensor of which the direct sun alone is known.
    fn untraced(&self, at: usize) -> SensorYear {
        SensorYear {
            exposed_hours: self.run.measures.exposed_hours(&self.direct[at]),
            ..SensorYear::default()
        }
    }

    /// What the paths so far tell of a sensor: its sums times the light of the year, a row for each replicate.
    fn sensor_year(&self, at: usize, sums: ArrayView2<f32>) -> SensorYear {
        let (run, direct, traced) = (self.run, &self.direct[at], self.traced[at]);
        let lux = &sums / traced as f32;
        let (values, errors) = jackknife(&lux, |lux| {
            // The last column is that of the overcast sky.
            let (hours, factor) = lux.split_at(direct.len());
            let total: Vec<f32> = hours.iter().zip(direct).map(|(e, sun)| e + sun).collect();
            let mut values = run.measures.values(&total, self.first + at);
            values.push(f64::from(factor[0]));
            values
        });
        let hours = if run.keeps_hours {
            let mean = means(&lux);
            mean.iter().zip(direct).map(|(e, sun)| e + sun).collect()
        } else {
            Vec::new()
        };
        SensorYear {
            values,
            errors,
            lux: hours,
            paths: traced * REPLICATES as u32,
            ..self.untraced(at)
        }
    }

    /// The errors of the wanted values of each sensor, as [`YearRun::accuracy`] counts them.
    fn errors(&self, measured: &[SensorYear]) -> Vec<Vec<f64>> {
        let run = self.run;
        let of = |sensor: &SensorYear| {
            let wanted = (0..run.wanted.len()).filter(|value| run.wanted[*value]);
            let error = |value: usize| {
                let scale = run.measures.error_scale(value, sensor.values[value]);
                if scale > 0.0 {
                    sensor.errors[value] / scale
                } else {
                    0.0
                }
            };
            wanted.map(error).collect()
        };
        measured.iter().map(of).collect()
    }
}

/// The cells of some vertices, each once, and the sum of the weights of these.
fn together(vertices: &[Vertex], cells: &[u32], count: usize) -> Vec<(usize, Vec3)> {
    let mut weights = vec![Vec3::ZERO; count];
    for (vertex, cell) in vertices.iter().zip(cells) {
        weights[*cell as usize] += vertex.weight;
    }
    let cells = weights.into_iter().enumerate();
    cells.filter(|(_, weight)| *weight != Vec3::ZERO).collect()
}

/// Paths of a replicate and sensor in the first round toward an error: what rooms need, so that few rounds do; errors decide about more.
fn first_round(error: f64) -> u32 {
    let paths = PATHS_OF_A_POINT * (0.01 / error).powi(2);
    paths.clamp(LEAST_PATHS.into(), MOST_ROUND.into()) as u32
}

/// The largest of the root mean squares over the sensors.
fn largest_mean(errors: &[Vec<f64>]) -> f64 {
    let count = errors.first().map_or(0, Vec::len);
    let mean = |value: usize| {
        let squares = errors.iter().map(|own| own[value] * own[value]);
        (squares.sum::<f64>() / errors.len() as f64).sqrt()
    };
    (0..count).map(mean).fold(0.0, f64::max)
}

/// Adds what a sensor sees of sky and ground, for `paths` paths: by rays of its own.
fn see(sensor: &Sensor, run: &YearRun, paths: u32, seed: u32, patches: &mut [f32]) {
    let start = lifted(sensor.position, sensor.normal);
    let (mut state, mut blocker) = (seed, Blocker::default());
    let hemisphere = Hemisphere::new(sensor.normal, f64::from(RAYS * paths).sqrt() as u32);
    let weight = PI * f64::from(paths) / f64::from(hemisphere.side().pow(2));
    for tile in hemisphere.tiles() {
        let bundle = hemisphere.bundle(tile, &mut state);
        outside(
            run.scene,
            start,
            &bundle,
            (&mut state, &mut blocker),
            |direction, through| {
                let patch = run.light.patches.index(direction.as_dvec3());
                patches[patch] += grey(through.as_dvec3() * weight);
            },
        );
    }
}

/// Adds the sunlight of a point with its weight, as luminance.
fn add(sums: &mut [f32], light: &[f32], weight: Vec3, channels: usize) {
    if sums.is_empty() {
        return;
    }
    if channels == 1 {
        let weight = grey(weight.as_dvec3());
        sums.iter_mut()
            .zip(light)
            .for_each(|(sum, light)| *sum += weight * light);
        return;
    }
    let shares = LUMINANCE_WEIGHTS.as_vec3() * weight;
    for (light, share) in light.chunks(sums.len()).zip(shares.to_array()) {
        sums.iter_mut()
            .zip(light)
            .for_each(|(sum, light)| *sum += share * light);
    }
}

/// Means of the replicates, which are rows.
fn means(lux: &Array2<f32>) -> Vec<f32> {
    let count = lux.nrows() as f32;
    lux.columns()
        .into_iter()
        .map(|column| column.sum() / count)
        .collect()
}

/// Values of the mean of all replicates, and their standard errors: Quenouille & Tukey's jackknife, which leaves out one replicate after the
/// other (Efron & Stein 1981).
fn jackknife(lux: &Array2<f32>, values: impl Fn(&[f32]) -> Vec<f64>) -> (Vec<f64>, Vec<f64>) {
    let count = lux.nrows() as f32;
    let mean = means(lux);
    let without: Vec<Vec<f64>> = lux
        .rows()
        .into_iter()
        .map(|row| {
            let rest = mean
                .iter()
                .zip(row)
                .map(|(m, e)| (count * m - e) / (count - 1.0));
            values(&rest.collect::<Vec<f32>>())
        })
        .collect();
    let count = f64::from(count);
    let all = values(&mean);
    let errors = (0..all.len()).map(|value| {
        let of = || without.iter().map(|list| list[value]);
        let centre = of().sum::<f64>() / count;
        let squares: f64 = of().map(|v| (v - centre).powi(2)).sum();
        ((count - 1.0) / count * squares).sqrt()
    });
    let errors = errors.collect();
    (all, errors)
}
