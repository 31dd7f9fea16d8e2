//! Comparison with an earlier benchmark report.

use std::fmt::Write as _;
use std::path::Path;

use super::report::{Head, Report};
use super::statistics::Summary;
use crate::error::{Error, Result};

/// Change of one timing against the baseline.
#[derive(Debug, Clone, PartialEq)]
struct Change {
    name: String,
    old_ms: f64,
    new_ms: f64,
    /// Wall time, new over old.
    ratio: f64,
    /// Ratios within 1 ± `noise` are not significant.
    noise: f64,
    /// CPU time, new over old. `None` unless both reports have it.
    cpu_ratio: Option<f64>,
}

impl Change {
    fn new(name: &str, old: &Summary, new: &Summary) -> Self {
        Self {
            name: name.to_owned(),
            old_ms: old.median_ms,
            new_ms: new.median_ms,
            ratio: new.median_ms / old.median_ms,
            noise: old.spread().hypot(new.spread()),
            cpu_ratio: new
                .cpu_median_ms
                .zip(old.cpu_median_ms)
                .map(|(new, old)| new / old),
        }
    }

    fn verdict(&self) -> &'static str {
        if self.ratio > 1.0 + self.noise {
            "slower"
        } else if self.ratio < 1.0 - self.noise {
            "faster"
        } else {
            "noise"
        }
    }

    /// Whether the slowdown exceeds both `factor` and the noise.
    fn exceeds(&self, factor: f64) -> bool {
        self.ratio > factor && self.verdict() == "slower"
    }
}

/// An earlier report.
pub struct Baseline {
    report: Report,
    file: String,
}

impl Baseline {
    /// Reads the JSON report of an earlier run.
    ///
    /// # Errors
    /// Fails when the file cannot be read or is not a benchmark report.
    pub fn read(path: &Path) -> Result<Self> {
        let error = |reason: String| Error::Read {
            path: path.to_owned(),
            reason,
        };
        let text = std::fs::read_to_string(path).map_err(|e| error(e.kind().to_string()))?;
        let report = serde_json::from_str(&text).map_err(|e| {
            error(format!(
                "{e}; it must be a file that `skylight bench --json` wrote"
            ))
        })?;
        Ok(Self {
            report,
            file: path.display().to_string(),
        })
    }

    fn changes(&self, new: &Report) -> Vec<Change> {
        let old = self.report.times();
        let new = new.times();
        let pairs = new.iter().filter_map(|(name, new)| {
            let (_, old) = old.iter().find(|(old, _)| old == name)?;
            Some(Change::new(name, old, new))
        });
        pairs.collect()
    }

    /// The comparison as a text table.
    pub fn table(&self, new: &Report) -> String {
        let mut text = format!(
            "\ncompared with {} ({})\n",
            self.file, self.report.head.commit
        );
        for difference in differences(&self.report.head, &new.head) {
            let _ = writeln!(text, "note: {difference}");
        }
        let _ = writeln!(
            text,
            "{:32} {:>9} {:>9} {:>7} {:>8} {:>7}",
            "milliseconds", "old", "new", "ratio", "noise", "CPU"
        );
        for change in self.changes(new) {
            let cpu = change.cpu_ratio;
            let _ = writeln!(
                text,
                "{:32} {:9.2} {:9.2} {:7.3} {:>8} {:>7} {}",
                change.name,
                change.old_ms,
                change.new_ms,
                change.ratio,
                format!("±{:.3}", change.noise),
                cpu.map_or("-".to_owned(), |r| format!("{r:.3}")),
                change.verdict()
            );
        }
        text
    }

    /// Fails when any timing is more than `factor` times the baseline and the change exceeds the noise.
    ///
    /// # Errors
    /// Lists the slower timings.
    pub fn check(&self, new: &Report, factor: f64) -> Result<()> {
        let slower: Vec<String> = self
            .changes(new)
            .iter()
            .filter(|change| change.exceeds(factor))
            .map(|change| format!("{} {:.2}", change.name, change.ratio))
            .collect();
        if slower.is_empty() {
            return Ok(());
        }
        Err(Error::Slower {
            factor,
            file: self.file.clone(),
            slower: slower.join("; "),
        })
    }
}

/// Differences in device, scene and settings that make the timings hard to compare.
fn differences(old: &Head, new: &Head) -> Vec<String> {
    let mut list = Vec::new();
    let mut compare = |what: &str, old: String, new: String| {
        if old != new {
            list.push(format!("{what} was {old}, is {new}"));
        }
    };
    compare("device", old.device.name.clone(), new.device.name.clone());
    compare(
        "driver",
        old.device.driver.clone(),
        new.device.driver.clone(),
    );
    compare("scene", old.scene.clone(), new.scene.clone());
    compare(
        "triangles",
        old.triangles.to_string(),
        new.triangles.to_string(),
    );
    compare("motion", old.motion.clone(), new.motion.clone());
    let none = || "not given".to_owned();
    let keys: std::collections::BTreeSet<_> =
        old.settings.keys().chain(new.settings.keys()).collect();
    for key in keys {
        let value = |head: &Head| head.settings.get(key).cloned().unwrap_or_else(none);
        compare(key, value(old), value(new));
    }
    list
}

#[cfg(test)]
mod tests {
    use super::*;

    fn summary(median_ms: f64, spread: f64) -> Summary {
        Summary {
            median_ms,
            p5_ms: median_ms * (1.0 - spread),
            p95_ms: median_ms * (1.0 + spread),
            cpu_median_ms: None,
            mean_ms: None,
            cpu_mean_ms: None,
        }
    }

    #[test]
    fn what_lies_within_the_noise_is_no_change() {
        let change = |old, new| Change::new("x", &old, &new);
        let quiet = change(summary(10.0, 0.03), summary(10.4, 0.04));
        assert!((quiet.ratio - 1.04).abs() < 1e-12);
        assert!((quiet.noise - 0.05).abs() < 1e-12, "{}", quiet.noise);
        assert_eq!(quiet.verdict(), "noise");
        let slower = change(summary(10.0, 0.03), summary(12.0, 0.04));
        assert_eq!(slower.verdict(), "slower");
        assert!(slower.exceeds(1.1) && !slower.exceeds(1.3));
        assert_eq!(
            change(summary(10.0, 0.01), summary(8.0, 0.01)).verdict(),
            "faster"
        );
        // Twice as slow, but too noisy to be significant.
        let restless = change(summary(10.0, 0.9), summary(20.0, 0.9));
        assert!(!restless.exceeds(1.5));
    }
}
