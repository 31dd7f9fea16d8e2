//! What the sensors of a grid say together: sDA, ASE, EN 17037.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::exact::Exact;
use super::table::{Column, rounded};
use crate::daylight::metrics::{EN_17037_LUX, EXPOSED_HOURS, Passing, SPATIAL_PERCENT, passing};

/// Figures of the whole grid that are asked for.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Asked {
    /// Spatial daylight autonomy.
    pub sda: bool,
    /// Annual sunlight exposure.
    pub ase: bool,
    /// EN 17037: half of the daylight hours, and the median of their diffuse illuminance, lux.
    pub en17037: Option<Exact>,
}

/// Figures of the whole grid; those that were not asked for are `None` or null.
pub(super) struct Summary {
    sda: Option<Passing>,
    /// Percent of the sensors.
    pub ase: Option<f64>,
    /// Both methods.
    pub en17037: Value,
}

/// Levels of EN 17037, table A.1: name, target on half of the plane, minimum on 95 % of it, as numbers of [`EN_17037_LUX`].
const LEVELS: [(&str, usize, usize); 3] = [("minimum", 1, 0), ("medium", 2, 1), ("high", 3, 2)];

/// Percent of the plane that must reach the target, and the minimum.
const AREAS: [f64; 2] = [50.0, 95.0];

impl Summary {
    /// Of the columns of the metrics.
    pub fn of(asked: &Asked, columns: &[Column]) -> Self {
        let column = |name: &str| columns.iter().find(|column| column.name == name);
        let is_empty = columns.iter().all(|column| column.values.0.is_empty());
        let share = |name: &str, limit: f64| {
            let none = Column::default();
            let column = column(name).unwrap_or(&none);
            passing(&column.values.0, &column.errors.0, limit)
        };
        let exposed = || {
            let hours = column("ase_hours").map_or(&[][..], |column| &column.values.0);
            let is_exposed = hours.iter().filter(|hours| **hours > EXPOSED_HOURS);
            100.0 * is_exposed.count() as f64 / hours.len() as f64
        };
        let en17037 = |[hours, median]: [f64; 2]| {
            let by_hours = EN_17037_LUX.map(|lux| share(&format!("en17037_hours_ge{lux}"), hours));
            let factors = EN_17037_LUX.map(|lux| 100.0 * lux / median);
            let by_factor = factors.map(|factor| share("df", factor));
            json!({
                "hours": 2.0 * hours,
                "median_diffuse_lux": rounded(median),
                "daylight_factors": EN_17037_LUX.iter().zip(factors).map(|(lux, f)| (lux.to_string(), rounded(f).into())).collect::<serde_json::Map<String, Value>>(),
                "method_1": method(&by_factor),
                "method_2": method(&by_hours),
            })
        };
        let of_hours = asked.en17037.as_ref().filter(|_| !is_empty);
        let of_hours = of_hours.and_then(|given| given.rows().first().copied());
        Self {
            sda: (asked.sda && !is_empty).then(|| share("da300", SPATIAL_PERCENT)),
            ase: (asked.ase && !is_empty).then(|| rounded(exposed())),
            en17037: of_hours.map_or(Value::Null, en17037),
        }
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
                "sDA300/50    {:.1} % of the sensors, standard error {:.1}; without blinds, which LM-83 wants",
                sda.percent, sda.standard_error
            );
        }
        if let Some(ase) = self.ase {
            let _ = writeln!(text, "ASE1000,250  {ase:.1} % of the sensors");
        }
        if !self.en17037.is_null() {
            for (name, key) in [("daylight factor", "method_1"), ("hours", "method_2")] {
                let of = &self.en17037[key];
                let shares: Vec<String> = EN_17037_LUX
                    .iter()
                    .map(|lux| format!("{lux} lux: {}", of["percent"][lux.to_string()]))
                    .collect();
                let _ = writeln!(
                    text,
                    "EN 17037     by {name}: {}; percent of the sensors with {}",
                    of["level"].as_str().unwrap_or("none"),
                    shares.join(", ")
                );
            }
        }
        text
    }
}

/// Shares and the level that they reach.
fn method(shares: &[Passing; 4]) -> Value {
    let reached = LEVELS.iter().rev().find(|(_, target, least)| {
        shares[*target].percent >= AREAS[0] && shares[*least].percent >= AREAS[1]
    });
    let object = |of: fn(&Passing) -> f64| {
        let pairs = EN_17037_LUX.iter().zip(shares);
        let pairs = pairs.map(|(lux, share)| (lux.to_string(), rounded(of(share)).into()));
        pairs.collect::<serde_json::Map<String, Value>>()
    };
    json!({
        "level": reached.map_or("none", |(name, ..)| name),
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
