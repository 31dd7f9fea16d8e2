//! One quantity compared with its reference, and all of them as a report.

use serde_json::{Value, json};

/// How an error is measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Measure {
    /// Relative to a size that the check names.
    Relative,
    /// In the unit of the values.
    Absolute,
}

/// The largest of many differences between found values and their references. Fails above its tolerance, on what is no number, and if
/// nothing was compared.
#[derive(Debug, Clone)]
pub struct Check {
    /// What is compared.
    pub name: &'static str,
    /// With what.
    pub against: &'static str,
    /// Unit of the values; empty for none.
    pub unit: &'static str,
    /// How the errors are measured.
    pub measure: Measure,
    /// Largest error allowed.
    pub tolerance: f64,
    count: usize,
    worst: Option<Worst>,
}

#[derive(Debug, Clone)]
struct Worst {
    value: f64,
    reference: f64,
    error: f64,
    at: String,
}

impl Check {
    /// A check by relative errors; nothing is compared yet.
    pub fn relative(
        name: &'static str,
        against: &'static str,
        unit: &'static str,
        tolerance: f64,
    ) -> Self {
        Self {
            name,
            against,
            unit,
            measure: Measure::Relative,
            tolerance,
            count: 0,
            worst: None,
        }
    }

    /// A check by errors in the unit of the values.
    pub fn absolute(
        name: &'static str,
        against: &'static str,
        unit: &'static str,
        tolerance: f64,
    ) -> Self {
        Self {
            measure: Measure::Absolute,
            ..Self::relative(name, against, unit, tolerance)
        }
    }

    /// Compares a value with its reference; `scale` is what the error is relative to: 1 for errors in the unit of the values. `at` says where.
    pub fn see(&mut self, value: f64, reference: f64, scale: f64, at: impl FnOnce() -> String) {
        self.count += 1;
        let error = (value - reference).abs() / scale;
        let error = if error.is_nan() { f64::INFINITY } else { error };
        if self.worst.as_ref().is_none_or(|worst| error > worst.error) {
            self.worst = Some(Worst {
                value,
                reference,
                error,
                at: at(),
            });
        }
    }

    /// Compares the channel of a colour that is farthest from its reference.
    pub fn see_colour(
        &mut self,
        value: glam::DVec3,
        reference: glam::DVec3,
        scale: f64,
        at: impl FnOnce() -> String,
    ) {
        let difference = (value - reference).to_array();
        let size = |c: usize| {
            let size = difference[c].abs();
            if size.is_nan() { f64::INFINITY } else { size }
        };
        let channel = (1..3).fold(0, |most, c| if size(c) > size(most) { c } else { most });
        self.see(value[channel], reference[channel], scale, at);
    }

    /// Number of values compared.
    pub fn count(&self) -> usize {
        self.count
    }

    /// Largest error; infinite if nothing was compared.
    pub fn error(&self) -> f64 {
        self.worst.as_ref().map_or(f64::INFINITY, |w| w.error)
    }

    /// Whether something was compared and no error is above the tolerance.
    pub fn passed(&self) -> bool {
        self.error() <= self.tolerance
    }

    /// Where the error is largest; empty if nothing was compared.
    pub fn at(&self) -> &str {
        self.worst.as_ref().map_or("", |w| &w.at)
    }

    /// Value and reference where the error is largest.
    pub fn values(&self) -> Option<[f64; 2]> {
        self.worst.as_ref().map(|w| [w.value, w.reference])
    }

    /// For `--json`; what is no finite number is `null`.
    pub fn json(&self) -> Value {
        json!({
            "check": self.name,
            "against": self.against,
            "compared": self.count,
            "unit": self.unit,
            "value": self.values().map(|v| v[0]),
            "reference": self.values().map(|v| v[1]),
            "error": self.error(),
            "error_is": match self.measure {
                Measure::Relative => "relative",
                Measure::Absolute => "absolute",
            },
            "tolerance": self.tolerance,
            "at": self.at(),
            "passed": self.passed(),
        })
    }
}

/// Whether there are checks and all of them passed.
pub fn all_passed(checks: &[Check]) -> bool {
    !checks.is_empty() && checks.iter().all(Check::passed)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn the_largest_error_decides_and_no_number_fails() {
        let mut check = Check::relative("a", "b", "m", 0.1);
        assert!(!check.passed(), "nothing was compared");
        check.see(1.0, 1.0, 1.0, || "first".to_owned());
        check.see(2.1, 2.0, 2.0, || "second".to_owned());
        assert!(check.passed() && check.at() == "second" && check.count() == 2);
        check.see(f64::NAN, 2.0, 2.0, || "third".to_owned());
        check.see(1e9, 2.0, 2.0, || "fourth".to_owned());
        assert!(!check.passed() && check.at() == "third");
        assert!(check.json()["value"].is_null());
        let mut zero = Check::absolute("a", "b", "", 0.0);
        zero.see(3.0, 3.0, 1.0, String::new);
        assert!(zero.passed());
    }

    #[test]
    fn a_bad_channel_of_a_colour_is_seen() {
        for (channel, bad) in [(0, 2.0), (1, f64::NAN), (2, f64::INFINITY)] {
            let mut colour = DVec3::ONE;
            colour[channel] = bad;
            let mut check = Check::absolute("a", "b", "", 0.5);
            check.see_colour(colour, DVec3::ONE, 1.0, String::new);
            assert!(!check.passed(), "{colour}");
        }
    }

    #[test]
    fn no_checks_are_a_failure() {
        assert!(!all_passed(&[]));
        assert!(!all_passed(&[Check::absolute("a", "b", "", 1.0)]));
    }
}
