//! What the standards say of the result, each with its clause.

use std::fmt::Write as _;

use super::super::results::Results;
use super::super::summary::{AREAS, LEVELS, Provision};
use super::super::verdict::Verdict;
use crate::daylight::metrics::{Blinds, EN_17037_LUX, Passing};
use crate::output::escaped;

/// LEED v4.1, EQ credit Daylight, option 1: percent of the area for 1, 2, 3 points.
pub(in crate::commands) const LEED_PERCENT: [f64; 3] = [40.0, 55.0, 75.0];

/// Annual sunlight exposure above which LEED v4.1 asks how glare is dealt with, percent.
pub(in crate::commands) const LEED_EXPOSED: f64 = 10.0;

/// Tables of verdicts, or a line that none was asked for.
pub fn verdicts(results: &Results) -> String {
    let mut text = String::new();
    if let Some(provision) = &results.outcome.summary().en17037 {
        text += &of_en17037(provision);
    }
    text += &of_lm83(results);
    if text.is_empty() {
        return "<p>No metric of a standard was measured; add en17037, sda or ase to --metrics.</p>\n".to_owned();
    }
    text + "<p class=\"small\">A figure settles a limit if it is 1.96 standard errors or more away from it (95 %). Not assessed: EN 17037 view out (5.2), exposure to sunlight (5.3), protection from glare (5.4).</p>\n"
}

const HEAD: &str = "<table>\n<thead><tr><th>demand</th><th>clause</th><th class=\"n\">found</th><th>verdict</th></tr></thead>\n<tbody>\n";
const END: &str = "</tbody>\n</table>\n";

fn row(demand: &str, clause: &str, found: &str, verdict: &str, class: &str) -> String {
    format!(
        "<tr><td>{}</td><td>{}</td><td class=\"n\">{}</td><td class=\"{class}\">{}</td></tr>\n",
        escaped(demand),
        escaped(clause),
        escaped(found),
        escaped(verdict)
    )
}

fn class(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Met => "met",
        Verdict::NotMet => "not-met",
        Verdict::NotSettled => "open",
    }
}

fn shown(share: Passing) -> String {
    format!("{:.1} ± {:.1} %", share.percent, share.standard_error)
}

/// Targets and minima of each level, by both methods.
fn of_en17037(provision: &Provision) -> String {
    let mut text = String::new();
    for (number, (method, shares)) in provision.methods().into_iter().enumerate() {
        let _ = writeln!(
            text,
            "<h3>EN 17037:2018, daylight provision, method {} ({method})</h3>",
            number + 1
        );
        text += HEAD;
        for level in &LEVELS {
            for (at, percent, kind) in [
                (level.target, AREAS[0], "target"),
                (level.least, AREAS[1], "minimum"),
            ] {
                let what = match number {
                    0 => format!("daylight factor of {:.2} %", provision.factors()[at]),
                    _ => format!("{} lux in half of the daylight hours", EN_17037_LUX[at]),
                };
                let demand = format!("{}: {what} on {percent} % of the plane", level.name);
                let verdict = Verdict::at_least(shares[at], percent);
                let clause = format!("5.1, table A.1, {kind}");
                let found = shown(shares[at]);
                text += &row(
                    &demand,
                    &clause,
                    &found,
                    &verdict.to_string(),
                    class(verdict),
                );
            }
            let verdict = level.verdict(shares);
            let demand = format!("level {}", level.name);
            text += &row(&demand, "both", "", &verdict.to_string(), class(verdict));
        }
        text += END;
    }
    text
}

/// Spatial daylight autonomy. Without blinds it is none of LM-83.
fn of_autonomy(sda: Passing, blinds: Blinds) -> String {
    let clause = "LM-83-12, 2.1, 2.2.6; LEED v4.1 EQ Daylight, option 1";
    if blinds == Blinds::None {
        return row(
            "sDA300/50 of 40, 55, 75 %: 1, 2, 3 points",
            clause,
            &shown(sda),
            "no verdict: LM-83 wants blinds; add --blinds lm83",
            "open",
        );
    }
    let level = |(points, percent)| {
        let verdict = Verdict::at_least(sda, percent);
        let demand = format!("sDA300/50 of {percent} %: LEED points, {points}");
        row(
            &demand,
            clause,
            &shown(sda),
            &verdict.to_string(),
            class(verdict),
        )
    };
    (1..).zip(LEED_PERCENT).map(level).collect()
}

/// Figures of LM-83, and what LEED makes of them.
fn of_lm83(results: &Results) -> String {
    let summary = &results.outcome.summary();
    if summary.sda.is_none() && summary.ase.is_none() {
        return String::new();
    }
    let mut text = format!("<h3>IES LM-83-12, LEED v4.1</h3>\n{HEAD}");
    if let Some(sda) = summary.sda {
        text += &of_autonomy(sda, results.args.blinds);
    }
    if let Some(ase) = summary.ase {
        let verdict = if ase <= LEED_EXPOSED {
            Verdict::Met
        } else {
            Verdict::NotMet
        };
        text += &row(
            &format!(
                "ASE1000,250 of at most {LEED_EXPOSED} %, else the design tells how glare is dealt with"
            ),
            "LM-83-12, 3.2.6, 3.3; LEED v4.1 EQ Daylight, option 1",
            &format!("{ase:.1} %"),
            &verdict.to_string(),
            class(verdict),
        );
    }
    text + END
}
