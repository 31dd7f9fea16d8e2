//! Pieces of the desk's work, each for another thread: the hours of a year, a block of sensors, a moment.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::daylight::metrics::{Measures, SPATIAL_LUX, Schedule};
use crate::daylight::sky::Daylight;
use crate::daylight::weather::Weather;
use crate::scene::Scene;
use crate::sensors::{
    Accuracy, BLOCK, Lights, Reading, Sensor, Shard, TracedScene, Year, YearLight, YearRun,
    close_blinds, measure, measure_year,
};

/// Most paths of a sensor, as `skylight daylight` has it.
const MOST_PATHS: u32 = 1 << 22;

/// What is measured, and in which light.
#[derive(Clone)]
pub(super) struct Setup {
    pub scene: Arc<Scene>,
    pub sensors: Arc<[Sensor]>,
    /// The year; without it there are the daylight factor and moments.
    pub weather: Option<Arc<Weather>>,
    /// Reflectance of the ground below the horizon.
    pub ground_albedo: f64,
    /// Most bounces.
    pub bounces: u32,
    /// Start of the sample sequences.
    pub seed: u32,
    /// Whether blinds close by LM-83.
    pub has_blinds: bool,
}

impl PartialEq for Setup {
    /// Whether what was measured with the one holds for the other.
    fn eq(&self, other: &Self) -> bool {
        let of = |s: &Self| (s.ground_albedo, s.bounces, s.seed, s.has_blinds);
        Arc::ptr_eq(&self.scene, &other.scene)
            && Arc::ptr_eq(&self.sensors, &other.sensors)
            && of(self) == of(other)
    }
}

/// The light of a year, and what is made of it.
pub(super) struct Hours {
    pub light: YearLight,
    pub measures: Measures,
    /// Of each record of the weather file the number of its hour with light.
    pub of_record: Vec<Option<usize>>,
}

/// What a task has found.
pub(super) enum Found {
    /// The hours of the year.
    Hours(Arc<Hours>),
    /// A year at the sensors of a block.
    Block(Year),
    /// A moment at all sensors.
    Moment(Vec<Reading>),
    /// Nothing: it was stopped.
    Nothing,
}

/// Half of the cores: the others draw.
pub(super) fn pool() -> Option<Arc<ThreadPool>> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let pool = ThreadPoolBuilder::new().num_threads((cores / 2).max(1));
    pool.build().ok().map(Arc::new)
}

impl Setup {
    /// The skies and suns of the year, and the hours with closed blinds.
    pub(super) fn hours(&self) -> Found {
        let Some(weather) = &self.weather else {
            return Found::Hours(Arc::new(Hours {
                light: YearLight::overcast(self.ground_albedo),
                measures: Measures::default(),
                of_record: Vec::new(),
            }));
        };
        let light = YearLight::new(weather, self.ground_albedo);
        let (schedule, thresholds) = (Schedule::default(), vec![SPATIAL_LUX]);
        // A file without hours by day has no occupied ones: none count.
        let measures = Measures::new(weather, &light.hours, schedule, thresholds);
        let mut measures = measures.unwrap_or_default();
        if self.has_blinds {
            let traced = TracedScene::new(&self.scene);
            measures.close_blinds(close_blinds(&self.sensors, &traced, &light));
        }
        let mut of_record = vec![None; weather.records.len()];
        for (at, hour) in light.hours.iter().enumerate() {
            of_record[hour.record] = Some(at);
        }
        Found::Hours(Arc::new(Hours {
            light,
            measures,
            of_record,
        }))
    }

    /// Number of blocks.
    pub(super) fn blocks(&self) -> u32 {
        self.sensors.len().div_ceil(BLOCK).max(1) as u32
    }

    /// A year at the sensors of block `number`, to a standard error of the `wanted` values.
    pub(super) fn block(
        &self,
        hours: &Hours,
        number: u32,
        error: f64,
        wanted: Vec<bool>,
        stop: &AtomicBool,
    ) -> Found {
        let run = YearRun {
            scene: &TracedScene::new(&self.scene),
            light: &hours.light,
            measures: &hours.measures,
            accuracy: self.accuracy(error),
            wanted,
            keeps_hours: true,
            shard: Shard {
                number: number + 1,
                of: self.blocks(),
            },
            progress: &|_, _| (),
            is_stopped: &|| stop.load(Ordering::Relaxed),
        };
        let year = measure_year(&self.sensors, &run);
        if stop.load(Ordering::Relaxed) {
            return Found::Nothing;
        }
        Found::Block(year)
    }

    /// All sensors in a light, to a relative standard error.
    pub(super) fn moment(&self, daylight: &Daylight, error: f64, stop: &AtomicBool) -> Found {
        let (scene, lights) = (TracedScene::new(&self.scene), Lights::new(daylight));
        let accuracy = self.accuracy(error);
        let mut readings = Vec::with_capacity(self.sensors.len());
        for block in self.sensors.chunks(BLOCK) {
            if stop.load(Ordering::Relaxed) {
                return Found::Nothing;
            }
            readings.extend(measure(block, &scene, &lights, &accuracy, &|| ()));
        }
        Found::Moment(readings)
    }

    fn accuracy(&self, relative_error: f64) -> Accuracy {
        Accuracy {
            relative_error,
            max_paths: MOST_PATHS,
            seed: self.seed,
            bounces: self.bounces,
        }
    }
}
