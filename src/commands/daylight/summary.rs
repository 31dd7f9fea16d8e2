//! What the sensors of a grid say together: sDA, ASE, EN 17037.

use std::fmt::Write as _;

use serde_json::{Value, json};

use super::table::rounded;
use super::verdict::Verdict;
use crate::cli::{DaylightArgs, Metric};
use crate::daylight::metrics::{
    Blinds, EN_17037_LUX, EXPOSED_HOURS, Measures, Passing, SPATIAL_PERCENT, passing,
};
use crate::sensors::{Year, YearLight};

/// Figures of the whole grid; those that were not asked for are `None`.
pub(super) struct Summary {
    /// Share of the sensors.
    pub sda: Option<Passing>,
    /// Whether it is with blinds, as LM-83 wants.
    has_blinds: bool,
    /// Percent of the sensors.
    pub ase: Option<f64>,
    /// Both methods.
    pub en17037: Option<Provision>,
}

/// Daylight provision of EN 17037: shares of the sensors at each of [`EN_17037_LUX`].
pub(super) struct Provision {
    /// Hours of method 2.
    hours: f64,
    /// What the daylight factors are derived from.
    median_lux: f64,
    /// Daylight factors of method 1, percent.
    factors: [f64; 4],
    /// By the daylight factor.
    by_factor: [Passing; 4],
    /// By hours.
    by_hours: [Passing; 4],
}

/// A level of EN 17037, table A.1.
pub(super) struct Level {
    /// Its name.
    pub name: &'static str,
    /// Number of its target in [`EN_17037_LUX`], for half of the plane.
    pub target: usize,
    /// Number of its minimum, for 95 % of the plane.
    pub least: usize,
}

/// The levels, the lowest first.
pub(super) const LEVELS: [Level; 3] = [
    Level {
        name: "minimum",
        target: 1,
        least: 0,
    },
    Level {
        name: "medium",
        target: 2,
        least: 1,
    },
    Level {
        name: "high",
        target: 3,
        least: 2,
    },
];

/// Percent of the plane that must reach the target, and the minimum.
pub(super) const AREAS: [f64; 2] = [50.0, 95.0];

impl Summary {
    /// Of a year.
    pub fn of(args: &DaylightArgs, measures: &Measures, light: &YearLight, year: &Year) -> Self {
        let asks = |metric| args.asked_metrics().contains(&metric) && !year.sensors.is_empty();
        let exposed = || {
            let is_exposed = year
                .sensors
                .iter()
                .filter(|s| s.exposed_hours > EXPOSED_HOURS);
            100.0 * is_exposed.count() as f64 / year.sensors.len() as f64
        };
        let sda = || share(measures, year, "da300", SPATIAL_PERCENT);
        Self {
            sda: asks(Metric::Sda).then(sda),
            has_blinds: args.blinds == Blinds::Lm83,
            ase: asks(Metric::Ase).then(|| rounded(exposed())),
            en17037: asks(Metric::En17037).then(|| Provision::of(measures, light, year)),
        }
    }

    /// Daylight provision; null if it was not asked for.
    pub fn en17037_json(&self) -> Value {
        self.en17037.as_ref().map_or(Value::Null, Provision::json)
    }

    /// The share and its error, percent.
    pub fn sda_json(&self) -> Value {
        self.sda.map_or(Value::Null, |sda| {
            json!({ "percent": rounded(sda.percent), "percent_se": rounded(sda.standard_error) })
        })
    }

    /// Lines for the eye.
    pub fn text(&self) -> String {
        let mut text = "\n".to_owned();
        if let Some(sda) = self.sda {
            let _ = writeln!(
                text,
                "sDA300/50    {:.1} % of the sensors, standard error {:.1}; {}",
                sda.percent,
                sda.standard_error,
                if self.has_blinds {
                    "blinds by LM-83"
                } else {
                    "without blinds, which LM-83 wants"
                }
            );
        }
        if let Some(ase) = self.ase {
            let _ = writeln!(text, "ASE1000,250  {ase:.1} % of the sensors");
        }
        for (name, shares) in self.en17037.iter().flat_map(Provision::methods) {
            let percents = EN_17037_LUX.iter().zip(shares);
            let percents: Vec<String> = percents
                .map(|(lux, share)| format!("{lux} lux: {}", rounded(share.percent)))
                .collect();
            let _ = writeln!(
                text,
                "EN 17037     by {name}: {}; percent of the sensors with {}",
                level(shares),
                percents.join(", ")
            );
        }
        text
    }
}

impl Provision {
    fn of(measures: &Measures, light: &YearLight, year: &Year) -> Self {
        let hours = measures.en17037_hours();
        let median_lux = measures.median_diffuse_lux(&light.hours);
        let factors = EN_17037_LUX.map(|lux| 100.0 * lux / median_lux);
        let hours_of = |lux: f64| share(measures, year, &format!("en17037_hours_ge{lux}"), hours);
        Self {
            by_hours: EN_17037_LUX.map(hours_of),
            by_factor: factors.map(|factor| share(measures, year, "df", factor)),
            hours: 2.0 * hours,
            median_lux,
            factors,
        }
    }

    /// The methods by name, with their shares.
    pub fn methods(&self) -> [(&'static str, &[Passing; 4]); 2] {
        [
            ("daylight factor", &self.by_factor),
            ("hours", &self.by_hours),
        ]
    }

    /// Daylight factors of method 1, percent.
    pub fn factors(&self) -> [f64; 4] {
        self.factors
    }

    fn json(&self) -> Value {
        let factors = EN_17037_LUX.iter().zip(self.factors);
        let factors = factors.map(|(lux, f)| (lux.to_string(), rounded(f).into()));
        json!({
            "hours": self.hours,
            "median_diffuse_lux": rounded(self.median_lux),
            "daylight_factors": factors.collect::<serde_json::Map<String, Value>>(),
            "method_1": method(&self.by_factor),
            "method_2": method(&self.by_hours),
        })
    }
}

impl Level {
    /// Whether shares of the sensors reach it.
    pub fn verdict(&self, shares: &[Passing; 4]) -> Verdict {
        let target = Verdict::at_least(shares[self.target], AREAS[0]);
        target.and(Verdict::at_least(shares[self.least], AREAS[1]))
    }
}

/// Share of the sensors with at least `limit` of a value.
fn share(measures: &Measures, year: &Year, name: &str, limit: f64) -> Passing {
    let names = measures.names();
    let at = names.iter().position(|own| own == name);
    // The daylight factor follows the named ones.
    let at = at.unwrap_or(names.len());
    let values: Vec<f64> = year.sensors.iter().map(|s| s.values[at]).collect();
    let errors: Vec<f64> = year.sensors.iter().map(|s| s.errors[at]).collect();
    passing(&values, &errors, limit)
}

/// The level that shares reach.
fn level(shares: &[Passing; 4]) -> &'static str {
    let reached = LEVELS.iter().rev().find(|level| {
        shares[level.target].percent >= AREAS[0] && shares[level.least].percent >= AREAS[1]
    });
    reached.map_or("none", |level| level.name)
}

/// Shares and the level that they reach.
fn method(shares: &[Passing; 4]) -> Value {
    let object = |of: fn(&Passing) -> f64| {
        let pairs = EN_17037_LUX.iter().zip(shares);
        let pairs = pairs.map(|(lux, share)| (lux.to_string(), rounded(of(share)).into()));
        pairs.collect::<serde_json::Map<String, Value>>()
    };
    json!({
        "level": level(shares),
        "percent": object(|share| share.percent),
        "percent_se": object(|share| share.standard_error),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_level_needs_target_and_minimum() {
        let of = |percents: [f64; 4]| {
            let shares = percents.map(|percent| Passing {
                percent,
                standard_error: 0.0,
            });
            method(&shares)["level"]
                .as_str()
                .unwrap_or_default()
                .to_owned()
        };
        assert_eq!(of([100.0, 96.0, 95.0, 50.0]), "high");
        assert_eq!(of([100.0, 96.0, 94.0, 80.0]), "medium");
        assert_eq!(of([95.0, 50.0, 50.0, 50.0]), "minimum");
        assert_eq!(of([94.9, 90.0, 0.0, 0.0]), "none");
        assert_eq!(of([100.0, 49.0, 0.0, 0.0]), "none");
    }
}
