//! Statistics of repeated timings: median, percentiles, spread.

use serde::{Deserialize, Serialize};

/// Times of one piece of work, milliseconds.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Samples {
    wall: Vec<f64>,
    cpu: Vec<f64>,
}

/// Summary of [`Samples`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Summary {
    /// Median wall time, milliseconds.
    pub median_ms: f64,
    /// 5th percentile of the wall time, milliseconds.
    pub p5_ms: f64,
    /// 95th percentile of the wall time, milliseconds.
    pub p95_ms: f64,
    /// Median CPU time of all threads, milliseconds. `None` when unknown: device timestamps do not include it.
    pub cpu_median_ms: Option<f64>,
    /// Mean wall time, milliseconds: it counts what only some frames do. `None` in files of older versions.
    #[serde(default)]
    pub mean_ms: Option<f64>,
    /// Mean CPU time of all threads, milliseconds. `None` when unknown.
    #[serde(default)]
    pub cpu_mean_ms: Option<f64>,
}

impl Samples {
    /// Adds a sample, milliseconds. An unknown CPU time is NaN.
    pub fn push(&mut self, wall: f64, cpu: f64) {
        self.wall.push(wall);
        if cpu.is_finite() {
            self.cpu.push(cpu);
        }
    }

    /// Adds two sets of times sample by sample.
    pub fn with(&self, other: &Self) -> Self {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + b).collect();
        Self {
            wall: sum(&self.wall, &other.wall),
            cpu: sum(&self.cpu, &other.cpu),
        }
    }

    /// Median and percentiles. NaN without samples.
    pub fn summary(&self) -> Summary {
        let [p5_ms, median_ms, p95_ms] = [0.05, 0.5, 0.95].map(|q| quantile(&self.wall, q));
        Summary {
            median_ms,
            p5_ms,
            p95_ms,
            cpu_median_ms: (!self.cpu.is_empty()).then(|| quantile(&self.cpu, 0.5)),
            mean_ms: mean(&self.wall),
            cpu_mean_ms: mean(&self.cpu),
        }
    }
}

impl Summary {
    /// Relative spread: half of the 5–95 % range over the median.
    pub fn spread(&self) -> f64 {
        0.5 * (self.p95_ms - self.p5_ms) / self.median_ms
    }
}

/// The arithmetic mean, if there are samples.
fn mean(samples: &[f64]) -> Option<f64> {
    (!samples.is_empty()).then(|| samples.iter().sum::<f64>() / samples.len() as f64)
}

/// The `q` quantile (0..1) by nearest rank. NaN without samples.
pub fn quantile(samples: &[f64], q: f64) -> f64 {
    let mut sorted = samples.to_vec();
    sorted.sort_by(f64::total_cmp);
    let rank = (q * sorted.len() as f64).ceil() as usize;
    sorted
        .get(rank.saturating_sub(1))
        .copied()
        .unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_are_samples() {
        let samples = [5.0, 1.0, 4.0, 2.0, 3.0];
        assert_eq!(quantile(&samples, 0.5), 3.0);
        assert_eq!(quantile(&samples, 0.05), 1.0);
        assert_eq!(quantile(&samples, 0.95), 5.0);
        assert!(quantile(&[], 0.5).is_nan());
    }

    #[test]
    fn unknown_cpu_times_are_left_out() {
        let mut samples = Samples::default();
        samples.push(2.0, f64::NAN);
        assert_eq!(samples.summary().cpu_median_ms, None);
        samples.push(4.0, 7.0);
        let summary = samples.summary();
        assert_eq!(summary.cpu_median_ms, Some(7.0));
        assert_eq!(
            (summary.mean_ms, summary.cpu_mean_ms),
            (Some(3.0), Some(7.0))
        );
        assert_eq!((summary.p5_ms, summary.p95_ms), (2.0, 4.0));
        assert_eq!(summary.spread(), 0.5);
    }
}
