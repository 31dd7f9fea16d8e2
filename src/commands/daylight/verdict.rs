//! Whether a figure meets a limit, as far as its standard error tells.

use crate::daylight::metrics::Passing;

/// Standard errors within which a figure does not settle a limit: 95 % of a normal distribution.
const SURE: f64 = 1.96;

/// What a standard says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::commands) enum Verdict {
    Met,
    NotMet,
    /// The standard error spans the limit.
    NotSettled,
}

impl Verdict {
    /// Whether a share is at least a limit, percent.
    pub fn at_least(share: Passing, limit: f64) -> Self {
        let above = share.percent - limit;
        let unsure = SURE * share.standard_error;
        if above.abs() < unsure || (above == 0.0 && unsure > 0.0) {
            Self::NotSettled
        } else if above >= 0.0 {
            Self::Met
        } else {
            Self::NotMet
        }
    }

    /// Both of two demands.
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::NotMet, _) | (_, Self::NotMet) => Self::NotMet,
            (Self::Met, Self::Met) => Self::Met,
            _ => Self::NotSettled,
        }
    }
}

impl std::fmt::Display for Verdict {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Met => "met",
            Self::NotMet => "not met",
            Self::NotSettled => "not settled at this error",
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_that_spans_the_limit_settles_nothing() {
        let of = |percent, standard_error| {
            let share = Passing {
                percent,
                standard_error,
            };
            Verdict::at_least(share, 50.0)
        };
        assert_eq!(of(50.0, 0.0), Verdict::Met);
        assert_eq!(of(49.9, 0.0), Verdict::NotMet);
        assert_eq!(of(52.0, 1.0), Verdict::Met);
        assert_eq!(of(48.0, 1.0), Verdict::NotMet);
        for percent in [50.0, 51.9, 48.1] {
            assert_eq!(of(percent, 1.0), Verdict::NotSettled);
        }
        assert_eq!(of(51.0, 1.0).to_string(), "not settled at this error");
    }

    #[test]
    fn of_two_demands_one_that_is_not_met_is_enough() {
        use Verdict::{Met, NotMet, NotSettled};
        assert_eq!(Met.and(Met), Met);
        assert_eq!(NotSettled.and(NotMet), NotMet);
        assert_eq!(Met.and(NotSettled), NotSettled);
    }
}
