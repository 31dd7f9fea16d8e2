//! The desk's panel: what is shown at the sensors, figures, the verdict of a standard; and the legend.

use egui::Ui;

use super::choice;
use super::legend::Bar;
use crate::commands::daylight::{
    Asked, Column, Exact, LEED_EXPOSED, LEED_PERCENT, LEVELS, Summary, Verdict,
};
use crate::commands::view::desk::Desk;
use crate::commands::view::desk::metric::{Metric, Standard};
use crate::commands::view::document::Document;
use crate::options::Choice as _;

/// Width of a legend, points: how far left one beside it stands.
const LEGEND: f32 = 112.0;

/// Chooses what is shown, and tells how far it is.
pub(super) fn show(ui: &mut Ui, document: &mut Document) {
    let (record, map) = (document.record_shown(), document.job.settings.colour_map);
    let Some(desk) = &mut document.desk else {
        return;
    };
    ui.checkbox(&mut desk.is_shown, "cells in the picture");
    let has_year = desk.weather().is_some();
    egui::ComboBox::new("metric", "metric")
        .selected_text(crate::options::name(desk.metric))
        .show_ui(ui, |ui| {
            for (metric, name, help) in Metric::VALUES {
                if has_year || !metric.needs_hours() {
                    let line = ui.selectable_value(&mut desk.metric, *metric, *name);
                    line.on_hover_text(*help);
                }
            }
        });
    if let Some(values) = desk.values(record, map) {
        figures(ui, &values.column);
    }
    ui.weak(if desk.is_measuring() {
        format!("{} sensors, measuring", desk.sensors.len())
    } else {
        format!("{} sensors, done", desk.sensors.len())
    });
    if !has_year {
        ui.weak("metrics of the year need --weather FILE");
        return;
    }
    ui.checkbox(&mut desk.has_blinds, "blinds by LM-83")
        .on_hover_text(
            "closed in hours in which more than 2 % of the sensors have 1 000 lux of direct sun",
        );
    choice(ui, "standard", &mut desk.standard);
    for (text, verdict) in verdicts(desk) {
        match verdict {
            Some(verdict) => ui.label(format!("{text}: {verdict}")),
            None => ui.label(text),
        };
    }
}

fn figures(ui: &mut Ui, column: &Column) {
    let known = column.values.iter().copied().filter(|v| v.is_finite());
    let (mut sum, mut count) = (0.0, 0.0);
    let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
    for value in known {
        (sum, count) = (sum + value, count + 1.0);
        (least, most) = (least.min(value), most.max(value));
    }
    let unit = &column.unit;
    let mean = sum / count;
    ui.label(format!("mean {mean:.1} {unit}, {least:.1} to {most:.1}"));
    let squares: f64 = column.errors.iter().map(|e| e * e).sum();
    let error = (squares / column.errors.len().max(1) as f64).sqrt();
    if error > 0.0 {
        ui.weak(format!("standard error of a sensor {error:.2} {unit}"));
    }
}

/// What the standard says of the values so far; nothing before all sensors are measured.
fn verdicts(desk: &Desk) -> Vec<(String, Option<Verdict>)> {
    let is_whole = |column: &Column| column.values.iter().all(|value| value.is_finite());
    let column = |name: &str, unit: &str| desk.named(name, unit).filter(is_whole);
    let summary = |asked: Asked, names: &[(&str, &str)]| {
        let columns: Option<Vec<Column>> = names.iter().map(|(n, unit)| column(n, unit)).collect();
        columns.map(|columns| Summary::of(&asked, &columns))
    };
    let none = Asked {
        sda: false,
        has_blinds: desk.has_blinds,
        ase: false,
        en17037: None,
    };
    match desk.standard {
        Standard::En17037 => {
            let names = [
                ("en17037_hours_ge100", "h"),
                ("en17037_hours_ge300", "h"),
                ("en17037_hours_ge500", "h"),
                ("en17037_hours_ge750", "h"),
                ("df", "%"),
            ];
            let asked = Asked {
                en17037: desk.en17037().map(|both| Exact(both.to_vec())),
                ..none
            };
            summary(asked, &names).map_or(Vec::new(), |summary| of_en17037(&summary))
        }
        Standard::Lm83 => {
            let asked = Asked {
                sda: true,
                ase: true,
                ..none
            };
            let names = [("da300", "%"), ("ase_hours", "h")];
            let summary = summary(asked, &names);
            summary.map_or(Vec::new(), |summary| of_lm83(&summary, desk.has_blinds))
        }
    }
}

/// The levels by both methods.
fn of_en17037(summary: &Summary) -> Vec<(String, Option<Verdict>)> {
    let methods = summary.en17037.iter().flat_map(|p| p.methods());
    let lines = methods.flat_map(|(method, shares)| {
        LEVELS.iter().map(move |level| {
            let text = format!("{} by {method}", level.name);
            (text, Some(level.verdict(shares)))
        })
    });
    lines.collect()
}

/// sDA and ASE; without blinds sDA has no verdict.
fn of_lm83(summary: &Summary, has_blinds: bool) -> Vec<(String, Option<Verdict>)> {
    let mut lines = Vec::new();
    if let Some(sda) = summary.sda {
        let found = format!("sDA300/50 {:.1} ± {:.1} %", sda.percent, sda.standard_error);
        if has_blinds {
            for (percent, points) in LEED_PERCENT.into_iter().zip(1..) {
                let text = format!("{found}, {points} of LEED's points from {percent} %");
                lines.push((text, Some(Verdict::at_least(sda, percent))));
            }
        } else {
            lines.push((format!("{found}: no verdict without blinds"), None));
        }
    }
    if let Some(ase) = summary.ase {
        let verdict = if ase <= LEED_EXPOSED {
            Verdict::Met
        } else {
            Verdict::NotMet
        };
        let text = format!("ASE1000,250 {ase:.1} %, at most {LEED_EXPOSED} %");
        lines.push((text, Some(verdict)));
    }
    lines
}

/// The legend of the cells.
pub(super) fn legend(ui: &Ui, document: &Document) {
    let settings = &document.job.settings;
    let desk = document.desk.as_ref().filter(|desk| desk.is_shown);
    let record = document.record_shown();
    let Some(values) = desk.and_then(|desk| desk.values(record, settings.colour_map)) else {
        return;
    };
    let scale = values.scale;
    let ticks = scale.ticks().into_iter();
    let bar = Bar {
        unit: &scale.unit,
        ticks: ticks
            .map(|(value, label)| (scale.share(value), label))
            .collect(),
        map: settings.colour_map,
    };
    let left = if settings.false_colour.is_some() {
        LEGEND
    } else {
        0.0
    };
    bar.show(ui, "legend of the cells", left);
}
