//! What the sensors of a grid say together: sDA, ASE, EN 17037.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::exact::Exact;
use super::table::{Column, Figure, rounded};
use super::verdict::Verdict;
use crate::daylight::metrics::{EN_17037_LUX, EXPOSED_HOURS, Passing, SPATIAL_PERCENT, passing};

/// Figures of the whole grid that are asked for.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(in crate::commands) struct Asked {
    /// Spatial daylight autonomy.
    pub sda: bool,
    /// Whether it is with blinds, as LM-83 wants.
    pub has_blinds: bool,
    /// Annual sunlight exposure.
    pub ase: bool,
    /// EN 17037: half of the daylight hours, and the median of their diffuse illuminance, lux.
    pub en17037: Option<Exact>,
}

/// Figures of the whole grid; those that were not asked for are `None`.
pub(in crate::commands) struct Summary {
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
pub(in crate::commands) struct Provision {
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
pub(in crate::commands) struct Level {
    /// Its name.
    pub name: &'static str,
    /// Number of its target in [`EN_17037_LUX`], for half of the plane.
    pub target: usize,
    /// Number of its minimum, for 95 % of the plane.
    pub least: usize,
}

/// The levels, the lowest first.
pub(in crate::commands) const LEVELS: [Level; 3] = [
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
    /// Of the columns of the metrics.
    pub fn of(asked: &Asked, columns: &[Column]) -> Self {
        let is_empty = columns.iter().all(|column| column.values.is_empty());
        let exposed = || {
            let hours = column(columns, "ase_hours").map_or(&[][..], |column| &column.values);
            let is_exposed = hours.iter().filter(|hours| **hours > EXPOSED_HOURS);
            100.0 * is_exposed.count() as f64 / hours.len() as f64
        };
        let of_hours = asked.en17037.as_ref().filter(|_| !is_empty);
        let of_hours = of_hours.and_then(|given| given.rows().first().copied());
        Self {
            sda: (asked.sda && !is_empty).then(|| share(columns, "da300", SPATIAL_PERCENT)),
            has_blinds: asked.has_blinds,
            ase: (asked.ase && !is_empty).then(|| rounded(exposed())),
            en17037: of_hours.map(|given| Provision::of(given, columns)),
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

    /// Each figure in a word, for tables of several results.
    pub(super) fn figures(&self) -> Vec<Figure> {
        let mut figures = Vec::new();
        figures.extend(self.sda.map(|sda| Figure::new("sda", sda.percent)));
        figures.extend(self.ase.map(|ase| Figure::new("ase", ase)));
        if let Some(provision) = &self.en17037 {
            let [(_, by_factor), (_, by_hours)] = provision.methods();
            figures.push(Figure::said("en17037_df", level(by_factor)));
            figures.push(Figure::said("en17037_hours", level(by_hours)));
        }
        figures
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
    /// From half of the daylight hours and the median of their diffuse illuminance, lux.
    fn of([hours, median_lux]: [f64; 2], columns: &[Column]) -> Self {
        let factors = EN_17037_LUX.map(|lux| 100.0 * lux / median_lux);
        let hours_of = |lux: f64| share(columns, &format!("en17037_hours_ge{lux}"), hours);
        Self {
            by_hours: EN_17037_LUX.map(hours_of),
            by_factor: factors.map(|factor| share(columns, "df", factor)),
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

fn column<'a>(columns: &'a [Column], name: &str) -> Option<&'a Column> {
    columns.iter().find(|column| column.name == name)
}

/// Share of the sensors with at least `limit` of a value.
fn share(columns: &[Column], name: &str, limit: f64) -> Passing {
    let none = Column::default();
    let column = column(columns, name).unwrap_or(&none);
    passing(&column.values, &column.errors, limit)
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
