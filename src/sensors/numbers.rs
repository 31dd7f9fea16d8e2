//! Random numbers of paths.

use glam::DVec2;

use crate::daylight::sampling::{rnd, shuffled_sobol, tea};

/// The seed of a replicate of a sensor.
pub(super) fn seed(of_grid: u32, sensor: u32, replicate: u32) -> u32 {
    tea::<8>(tea::<8>(of_grid, sensor), replicate)
}

/// Random numbers of a path: points of scrambled sequences for the first decisions, plain ones after that.
pub(super) struct Numbers {
    index: u32,
    seed: u32,
    dimension: u32,
    /// Pairs of numbers that come from scrambled sequences.
    spread: u32,
    state: u32,
}

impl Numbers {
    /// Of path `index` of a replicate with this [`seed`]; the first `spread` pairs come from scrambled sequences.
    pub(super) fn new(index: u32, seed: u32, spread: u32) -> Self {
        Self {
            index,
            seed,
            dimension: 0,
            spread,
            state: tea::<8>(index, seed),
        }
    }

    /// The next point of the unit square.
    pub(super) fn pair(&mut self) -> DVec2 {
        self.dimension += 1;
        if self.dimension <= self.spread {
            return shuffled_sobol(self.index, tea::<4>(self.seed, self.dimension));
        }
        DVec2::new(self.next(), self.next())
    }

    /// A plain number of 0..1.
    pub(super) fn next(&mut self) -> f64 {
        rnd(&mut self.state)
    }
}
