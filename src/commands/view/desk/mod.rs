//! The daylight desk: metrics at the sensors of a grid, measured by other threads while one looks.
//!
//! [`tasks`] are pieces of work of about a second at first. One is done at a time; its end wakes the event loop, and [`Desk::follow`] takes
//! what it found and starts the next: all sensors roughly, then finer. What no longer holds, because surfaces or light have
//! changed, is stopped and measured anew. [`metric`] names what is shown, [`columns`] are its values.

mod columns;
pub mod metric;
mod tasks;

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use glam::Vec3;
use rayon::ThreadPool;

use crate::cli::ViewArgs;
use crate::commands::daylight::place;
use crate::commands::job::Job;
use crate::daylight::weather::Weather;
use crate::error::Result;
use crate::passes::bounces::cells::Bounces;
use crate::scene::Scene;
use crate::sensors::{
    ALL_BOUNCES, BLOCK, Planes, Reading, Sensor, SensorYear, Sheet, Year, make_grid, read_grid,
    sheets,
};

use super::background::{Background, Wake};
use metric::{Metric, Standard};
use tasks::{Found, Hours, Setup, pool};

/// Standard errors of a year, as `--error` of `skylight daylight` counts them: the first is met by the fewest paths, the last is its default.
const ERRORS: [f64; 3] = [1.0, 0.03, 0.01];

/// Relative standard errors of a moment.
const ERRORS_OF_MOMENT: [f64; 3] = [0.2, 0.05, 0.02];

/// Where the sensors are.
#[derive(Debug, Clone, PartialEq)]
pub enum Grid {
    /// In a file.
    File(PathBuf),
    /// On a plane above the floor of every room: height and largest spacing, metres.
    Plane(f64, f64),
}

impl Grid {
    /// The one that is asked for.
    pub fn asked(args: &ViewArgs) -> Option<Self> {
        let plane = args.plane.map(|height| Self::Plane(height, args.spacing));
        plane.or_else(|| args.grid.clone().map(Self::File))
    }

    fn sensors(&self, scene: &Scene) -> Result<Vec<Sensor>> {
        match self {
            Self::File(path) => Ok(read_grid(path, scene.origin)?),
            Self::Plane(height, spacing) => {
                let planes = Planes {
                    height: *height as f32,
                    spacing: *spacing as f32,
                    inset: 0.0,
                    floors: Vec::new(),
                };
                Ok(make_grid(scene, &planes)?)
            }
        }
    }
}

/// A light in which a moment was measured, by its options.
type LightKey = Vec<(String, String)>;

/// A task that another thread does.
struct Running {
    work: Background<Found>,
    stop: Arc<AtomicBool>,
    /// The block, or none.
    block: u32,
    /// Of a moment.
    light: LightKey,
}

impl Drop for Running {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Relaxed);
    }
}

/// What is left to measure of a year.
#[derive(Default)]
struct Plan {
    level: usize,
    block: u32,
}

/// Sensors, and what is known of their light.
pub struct Desk {
    pub sensors: Arc<[Sensor]>,
    /// The planes on which they lie, with the cell of each.
    pub sheets: Vec<Sheet>,
    /// What is shown.
    pub metric: Metric,
    pub standard: Standard,
    pub has_blinds: bool,
    pub is_shown: bool,
    weather: Option<Arc<Weather>>,
    pool: Option<Arc<ThreadPool>>,
    wake: Wake,
    setup: Setup,
    running: Option<Running>,
    hours: Option<Arc<Hours>>,
    plan: Plan,
    /// What the years are refined for.
    refined_for: Metric,
    /// Years of the sensors; none yet of those that are not measured.
    years: Vec<SensorYear>,
    /// Number of the level of the moment to measure next, and the light of the one that was measured.
    moment: (usize, LightKey),
    readings: Vec<Reading>,
    /// Number of changes of what is shown.
    revision: u64,
}

impl Desk {
    /// A desk for the grid of a scene.
    ///
    /// # Errors
    /// A file that cannot be read, or no place for a sensor.
    pub fn new(grid: &Grid, job: &Job, weather: Option<Arc<Weather>>, wake: &Wake) -> Result<Self> {
        let sensors: Arc<[Sensor]> = grid.sensors(&job.scene)?.into();
        let walls = |sheet: &Sheet| {
            let lines = job.scene.section(sheet.normal, sheet.offset).into_iter();
            lines.map(|ends| ends.map(|end| sheet.place(end))).collect()
        };
        let found = sheets(&sensors, walls);
        let setup = setup(job, &sensors, weather.clone(), false);
        Ok(Self {
            sheets: found.into_iter().map(|(sheet, _)| sheet).collect(),
            metric: Metric::default(),
            standard: Standard::default(),
            has_blinds: false,
            is_shown: true,
            weather,
            pool: pool(),
            wake: wake.clone(),
            setup,
            running: None,
            hours: None,
            plan: Plan::default(),
            refined_for: Metric::default(),
            years: Vec::new(),
            moment: (0, LightKey::new()),
            readings: Vec::new(),
            revision: 0,
            sensors,
        })
    }

    /// The weather file, if there is one.
    pub fn weather(&self) -> Option<&Arc<Weather>> {
        self.weather.as_ref()
    }

    /// Takes what other threads have found, and lets them go on: `record` is the hour of the weather file that is shown.
    pub fn follow(&mut self, job: &Job, record: Option<usize>) {
        let setup = setup(job, &self.sensors, self.weather.clone(), self.has_blinds);
        if setup != self.setup {
            self.running = None;
            (self.setup, self.hours, self.plan) = (setup, None, Plan::default());
            self.moment.0 = 0;
        }
        let light = job.settings.light();
        let takes_moment = self.takes_moment(record);
        if self.metric != self.refined_for {
            // What is known of the metric may be too rough, but is no worse than the first level.
            self.plan.level = self.plan.level.min(1);
            self.plan.block = 0;
            self.refined_for = self.metric;
        }
        self.take();
        if self.moment.1 != light {
            self.moment.0 = 0;
        }
        // A moment is there sooner than the year that holds it.
        let is_early = self.is_early() && self.moment.0 == 0;
        if self.running.is_none() {
            self.running = if takes_moment || is_early {
                self.next_moment(job, light)
            } else {
                self.next_of_year()
            };
        }
    }

    /// Whether the light of the moment is measured: it is none of the hours of the year.
    fn takes_moment(&self, record: Option<usize>) -> bool {
        self.metric == Metric::Now && (record.is_none() || self.weather.is_none())
    }

    /// Whether the light that is shown is wanted before all sensors have the year that holds it.
    fn is_early(&self) -> bool {
        let is_whole = self.years.iter().all(|year| year.paths > 0) && !self.years.is_empty();
        self.metric == Metric::Now && !is_whole
    }

    /// Takes what the task has found, if it is done.
    fn take(&mut self) {
        let Some(running) = &mut self.running else {
            return;
        };
        let Some(found) = running.work.result() else {
            return;
        };
        let (block, light) = (running.block, std::mem::take(&mut running.light));
        self.running = None;
        self.revision += 1;
        match found {
            Found::Hours(hours) => self.hours = Some(hours),
            Found::Block(year) => self.add(block, year),
            Found::Moment(readings) => {
                let level = if self.moment.1 == light {
                    self.moment.0 + 1
                } else {
                    1
                };
                (self.moment, self.readings) = ((level, light), readings);
            }
            Found::Nothing => {}
        }
    }

    fn add(&mut self, block: u32, year: Year) {
        self.years.resize(self.sensors.len(), SensorYear::default());
        let first = block as usize * BLOCK;
        let places = self.years.iter_mut().skip(first);
        for (place, measured) in places.zip(year.sensors) {
            *place = measured;
        }
        self.plan.block = block + 1;
        if self.plan.block >= self.setup.blocks() {
            self.plan = Plan {
                level: self.plan.level + 1,
                block: 0,
            };
        }
    }

    fn next_moment(&self, job: &Job, light: LightKey) -> Option<Running> {
        let error = *ERRORS_OF_MOMENT.get(self.moment.0)?;
        let (setup, daylight) = (self.setup.clone(), job.daylight.clone());
        Some(self.start(0, light, move |stop| setup.moment(&daylight, error, stop)))
    }

    fn next_of_year(&self) -> Option<Running> {
        let setup = self.setup.clone();
        let Some(hours) = self.hours.clone() else {
            return Some(self.start(0, LightKey::new(), move |_| setup.hours()));
        };
        let error = *ERRORS.get(self.plan.level)?;
        let block = self.plan.block;
        let wanted = self.wanted(&hours);
        let work = move |stop: &AtomicBool| setup.block(&hours, block, error, wanted, stop);
        Some(self.start(block, LightKey::new(), work))
    }

    /// Of each value of a year, whether its error counts.
    fn wanted(&self, hours: &Hours) -> Vec<bool> {
        let name = match self.metric {
            Metric::Now => Metric::Mean.column(),
            // Exact; the verdict takes autonomy.
            Metric::Ase => Metric::Da.column(),
            other => other.column(),
        };
        let mut wanted: Vec<bool> = hours.measures.names().iter().map(|n| n == name).collect();
        wanted.push(name == Metric::Df.column());
        wanted
    }

    fn start(
        &self,
        block: u32,
        light: LightKey,
        work: impl FnOnce(&AtomicBool) -> Found + Send + 'static,
    ) -> Running {
        let stop = Arc::new(AtomicBool::new(false));
        let (told, pool) = (stop.clone(), self.pool.clone());
        let work = Background::start(&self.wake, move || match &pool {
            Some(pool) => pool.install(|| work(&told)),
            None => work(&told),
        });
        Running {
            work,
            stop,
            block,
            light,
        }
    }

    /// Whether another thread is at work, so that values may change.
    pub fn is_measuring(&self) -> bool {
        self.running.is_some()
    }

    /// Corners of the cells in the scene, and the number of the sensor of each.
    pub fn cells(&self) -> impl Iterator<Item = (usize, [Vec3; 4])> {
        self.sheets.iter().flat_map(|sheet| {
            let point = |at: &glam::DVec2| {
                let at = at.as_vec2();
                sheet.right * at.x + sheet.up * at.y + sheet.normal * sheet.offset
            };
            let cells = sheet.members.iter().zip(&sheet.cells);
            cells.map(move |(sensor, cell)| (*sensor, [0, 1, 2, 3].map(|k| point(&cell[k]))))
        })
    }

    /// Position and normal of a sensor in the model's axes.
    pub fn place(&self, sensor: usize, job: &Job) -> [f64; 6] {
        place(&self.sensors[sensor], job.scene.origin)
    }

    /// Number of changes of what was measured.
    pub fn revision(&self) -> u64 {
        self.revision
    }
}

fn setup(
    job: &Job,
    sensors: &Arc<[Sensor]>,
    weather: Option<Arc<Weather>>,
    has_blinds: bool,
) -> Setup {
    Setup {
        scene: job.scene.clone(),
        sensors: sensors.clone(),
        weather,
        ground_albedo: job.settings.ground_albedo,
        bounces: match job.settings.bounces {
            Bounces::All => ALL_BOUNCES,
            Bounces::UpTo(count) => count,
        },
        seed: job.settings.seed,
        has_blinds,
    }
}
