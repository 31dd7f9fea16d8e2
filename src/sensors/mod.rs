//! Illuminance at points of a scene, with its standard error: sun, sky, surfaces that emit and every diffuse bounce, by path tracing on
//! the CPU.
//!
//! No device is needed. [`read_grid`] reads the points, [`measure`] lights them.

mod blinds;
mod cells;
mod facade;
mod grid;
mod hemisphere;
mod made;
mod numbers;
mod panes;
mod path;
mod plane;
mod shard;
mod sheets;
mod suns;
mod surface;
mod unreflected;
mod walk;
mod year;
mod year_light;
#[cfg(test)]
mod year_tests;

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use glam::{DVec3, Vec3};

pub use self::blinds::close_blinds;
pub use self::facade::{Facades, make_facades};
pub use self::grid::{GridError, read_grid};
pub use self::path::Lights;
pub use self::plane::{Planes, make_grid};
pub use self::shard::Shard;
pub use self::sheets::{Sheet, sheets};
pub use self::surface::TracedScene;
pub use self::unreflected::{sky_components, suns_seen};
pub use self::year::{BLOCK, SensorYear, Year, YearRun, measure_year};
pub use self::year_light::YearLight;

use self::path::PARTS;
use crate::daylight::colour::luminance;

/// A point and the side from which light is counted.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sensor {
    /// Relative to the scene's origin, metres.
    pub position: Vec3,
    /// Unit vector.
    pub normal: Vec3,
}

/// Illuminance at a sensor, lux.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reading {
    /// From the sky, unreflected.
    pub sky_direct: f64,
    /// From the sun, unreflected.
    pub sun_direct: f64,
    /// From surfaces: reflected once or more by those of the scene or by the ground below the horizon, or emitted by them.
    pub reflected: f64,
    /// Of it, what the surfaces of the scene reflect of the sky.
    pub sky_reflected: f64,
    /// Of it, what they reflect of the sun.
    pub sun_reflected: f64,
    /// Standard error of the sum.
    pub standard_error: f64,
    /// Paths that were traced.
    pub paths: u32,
}

impl Reading {
    /// All of it, lux.
    pub fn total(&self) -> f64 {
        self.sky_direct + self.sun_direct + self.reflected
    }
}

/// When a sensor has been measured well enough.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Standard error relative to the total.
    pub relative_error: f64,
    /// Most paths of a sensor.
    pub max_paths: u32,
    /// Start of the sample sequences.
    pub seed: u32,
    /// Most bounces; [`ALL_BOUNCES`] is no limit that matters.
    pub bounces: u32,
}

/// Bounces after which a path ends in any case: between surfaces that reflect 95 %, less than a millionth of the light is left.
pub const ALL_BOUNCES: u32 = path::MAX_BOUNCES;

/// Independent estimates from whose spread the standard error comes: randomised quasi-Monte Carlo (Owen 1997).
const REPLICATES: u32 = 16;

/// Paths of each replicate in the first round; every round doubles them.
const FIRST_ROUND: u32 = 64;

/// Measures every sensor on all cores, in the order given; `progress` is told of each that is done. The same seed gives the
/// same numbers, whatever the number of cores.
pub fn measure(
    sensors: &[Sensor],
    scene: &TracedScene,
    lights: &Lights,
    accuracy: &Accuracy,
    progress: &(dyn Fn() + Sync),
) -> Vec<Reading> {
    measure_shard(sensors, Shard::ALL, scene, lights, accuracy, progress)
}

/// As [`measure`], of the sensors of a shard alone, each as it is measured among all.
pub fn measure_shard(
    sensors: &[Sensor],
    shard: Shard,
    scene: &TracedScene,
    lights: &Lights,
    accuracy: &Accuracy,
    progress: &(dyn Fn() + Sync),
) -> Vec<Reading> {
    let mine: Vec<usize> = (0..sensors.len()).filter(|at| shard.takes(*at)).collect();
    let next = AtomicUsize::new(0);
    let work = || {
        let mut done = Vec::new();
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(number) = mine.get(at) else {
                return done;
            };
            let sensor = &sensors[*number];
            done.push((at, read(sensor, *number as u32, scene, lights, accuracy)));
            progress();
        }
    };
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let mut readings = vec![Reading::default(); mine.len()];
    thread::scope(|scope| {
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        for worker in workers {
            // A fault of this program is one on this thread too.
            let done = worker.join();
            for (at, reading) in done.unwrap_or_else(|fault| std::panic::resume_unwind(fault)) {
                readings[at] = reading;
            }
        }
    });
    readings
}

/// One sensor, number `number` of its grid.
fn read(
    sensor: &Sensor,
    number: u32,
    scene: &TracedScene,
    lights: &Lights,
    accuracy: &Accuracy,
) -> Reading {
    let mut sums = [[DVec3::ZERO; PARTS]; REPLICATES as usize];
    let (mut traced, mut wanted) = (0, FIRST_ROUND);
    loop {
        for (replicate, sum) in sums.iter_mut().enumerate() {
            let seed = numbers::seed(accuracy.seed, number, replicate as u32);
            for index in traced..wanted {
                let parts = path::trace(sensor, scene, lights, accuracy.bounces, [index, seed]);
                sum.iter_mut().zip(parts).for_each(|(s, p)| *s += p);
            }
        }
        traced = wanted;
        let reading = reading(&sums, traced);
        let is_accurate = reading.standard_error <= accuracy.relative_error * reading.total();
        if is_accurate || traced.saturating_mul(2 * REPLICATES) > accuracy.max_paths {
            return reading;
        }
        wanted = 2 * traced;
    }
}

/// The means of all replicates of `paths` paths each, and their spread.
fn reading(sums: &[[DVec3; PARTS]; REPLICATES as usize], paths: u32) -> Reading {
    let n = f64::from(REPLICATES);
    let lux = |part: usize, replicate: usize| luminance(sums[replicate][part]) / f64::from(paths);
    let mean = |part| (0..sums.len()).map(|r| lux(part, r)).sum::<f64>() / n;
    let totals: Vec<f64> = (0..sums.len())
        .map(|r| (0..PARTS).map(|part| lux(part, r)).sum())
        .collect();
    let total = totals.iter().sum::<f64>() / n;
    let variance = totals.iter().map(|t| (t - total).powi(2)).sum::<f64>() / (n - 1.0);
    Reading {
        sky_direct: mean(0),
        sun_direct: mean(1),
        reflected: mean(2) + mean(3) + mean(4),
        sky_reflected: mean(2),
        sun_reflected: mean(3),
        standard_error: (variance / n).sqrt(),
        paths: paths * REPLICATES,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::daylight::sky::{Conditions, Daylight};
    use crate::scene::{Bounds, Material, Part, Scene};

    /// Squares, each by its corner and two edges, of reflectance 0.5.
    pub(super) fn squares(list: &[[Vec3; 3]]) -> Scene {
        let corners = |[at, u, v]: [Vec3; 3]| [at, at + u, at + u + v, at + v];
        let positions: Vec<Vec3> = list.iter().copied().flat_map(corners).collect();
        let indices: Vec<u32> = (0..list.len() as u32)
            .flat_map(|n| [0, 1, 2, 0, 2, 3].map(|i| 4 * n + i))
            .collect();
        let bounds = Bounds::of(positions.iter().copied());
        Scene {
            normals: vec![[0.0, 1.0, 0.0]; positions.len()],
            texcoords: vec![[0.0; 2]; positions.len()],
            parts: vec![Part {
                first_index: 0,
                index_count: indices.len() as u32,
                material: 0,
                has_colours: false,
                bounds,
            }],
            materials: vec![Material::default()],
            positions: positions.iter().map(Vec3::to_array).collect(),
            indices,
            bounds,
            ..Scene::default()
        }
    }

    fn day() -> Daylight {
        Daylight::new(&Conditions {
            sun_elevation_deg: 40.0,
            ground_albedo: 0.0,
            ..Conditions::default()
        })
    }

    fn reading(scene: &Scene, normal: Vec3) -> Reading {
        let daylight = day();
        let sensor = Sensor {
            position: Vec3::new(0.0, 1.0, 0.0),
            normal,
        };
        let accuracy = Accuracy {
            relative_error: 2e-3,
            max_paths: 1 << 20,
            seed: 0,
            bounces: ALL_BOUNCES,
        };
        let (scene, lights) = (TracedScene::new(scene), Lights::new(&daylight));
        measure(&[sensor], &scene, &lights, &accuracy, &|| ())[0]
    }

    /// Illuminance of sun and sky on open ground, lux.
    fn open() -> [f64; 2] {
        let day = day();
        let sun = luminance(day.sun_illuminance) * day.sun_direction.y;
        [luminance(day.sky_irradiance_up), sun]
    }

    #[test]
    fn open_ground_has_the_light_of_sun_and_sky() {
        let measured = reading(&Scene::default(), Vec3::Y);
        let [sky, sun] = open();
        println!("{measured:?}, expected {sky} and {sun}");
        assert!((measured.sky_direct / sky - 1.0).abs() < 0.005);
        assert!((measured.sun_direct / sun - 1.0).abs() < 0.005);
        assert_eq!(measured.reflected, 0.0);
    }

    #[test]
    fn a_sensor_over_a_plane_sees_what_it_reflects() {
        let size = 2e4;
        let plane = [
            Vec3::new(-0.5 * size, 0.0, -0.5 * size),
            size * Vec3::Z,
            size * Vec3::X,
        ];
        let measured = reading(&squares(&[plane]), -Vec3::Y);
        let expected = 0.5 * open().iter().sum::<f64>();
        println!("{measured:?}, expected {expected}");
        assert!((measured.reflected / expected - 1.0).abs() < 0.005);
        assert_eq!(measured.sun_direct, 0.0);
        assert!(measured.sky_direct < 1e-3 * expected);
    }

    #[test]
    fn a_closed_box_is_dark() {
        let (low, edge) = (
            Vec3::new(-2.0, 0.0, -2.0),
            [4.0 * Vec3::X, 3.0 * Vec3::Y, 4.0 * Vec3::Z],
        );
        let [x, y, z] = edge;
        let walls = [
            [low, x, z],
            [low + y, x, z],
            [low, x, y],
            [low + z, x, y],
            [low, z, y],
            [low + x, z, y],
        ];
        let measured = reading(&squares(&walls), Vec3::Y);
        assert_eq!(measured.total(), 0.0, "{measured:?}");
        assert_eq!(measured.standard_error, 0.0);
    }
}
