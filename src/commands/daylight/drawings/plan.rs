//! False colours of a metric over the plane of its sensors: cells, contours, the model's lines, legend, north arrow, scale bar.

use glam::DVec2;

use super::super::table::{Column, place};
use super::contours::contours;
use super::panel::Panel;
use super::scale::Scale;
use super::words::{heading, is_share};
use crate::daylight::false_colour::ColourMap;
use crate::output::{Anchor, Drawing, Ink, Part, Shape, Size, Stroke, Text};
use crate::scene::Scene;
use crate::sensors::{Sensor, Sheet, sheets};

/// Most planes that are drawn.
const MOST_SHEETS: usize = 12;

/// Space at the edges, pixels.
const MARGIN: f64 = 20.0;

/// Largest edge of a panel, pixels.
const PANEL: f64 = 620.0;

/// Width of the legend's column, pixels.
const ASIDE: f64 = 150.0;

/// Height of a line of text, pixels.
const LINE: f64 = 18.0;

/// Height of the legend, pixels.
const LEGEND: f64 = 200.0;

/// Shortest contour that is labelled, pixels.
const LABELLED: f64 = 50.0;

/// Opening lines of panes, metres before and behind a level plane, and a standing one.
const PANES: [[f32; 2]; 2] = [[-2.0, 3.0], [-0.7, 0.1]];

/// Colour of the model's lines.
const MODEL: Ink = Ink([40, 40, 40]);

/// Colour of panes.
const GLASS: Ink = Ink([0, 130, 220]);

/// What a plan shows.
pub struct Plan<'a> {
    /// Where.
    pub sensors: &'a [Sensor],
    /// The model.
    pub scene: &'a Scene,
    /// The metric.
    pub column: &'a Column,
    /// The value at which a standard parts good from bad, and whose it is.
    pub limit: Option<(f64, &'static str)>,
    /// Lines below the title.
    pub notes: Vec<String>,
    /// Colours.
    pub map: ColourMap,
}

impl Plan<'_> {
    /// Draws it.
    pub fn drawing(&self) -> Drawing {
        let edges = self.scene.pane_edges();
        let found = sheets(self.sensors, |sheet| self.walls(sheet));
        let left_out = found.len().saturating_sub(MOST_SHEETS);
        let shown = &found[..found.len() - left_out];
        let scale = Scale::linear(
            &self.column.values,
            &self.column.unit,
            is_share(&self.column.name),
            self.map,
        );
        let mut notes = self.notes.clone();
        notes.insert(0, self.figures());
        notes
            .extend(self.limit.map(|(limit, whose)| {
                format!("thick line: {limit} {}, {whose}", self.column.unit)
            }));
        if left_out > 0 {
            notes.push(format!("{left_out} more planes are not drawn"));
        }
        let title = heading(&self.column.name);
        let mut drawing = Drawing::new([2.0 * MARGIN + PANEL + ASIDE, 0.0], title.clone());
        let mut right = 0.0_f64;
        let mut y = MARGIN + 14.0;
        drawing.text([MARGIN, y], Anchor::Start, Size::Large, title);
        for note in notes {
            y += LINE;
            drawing.text([MARGIN, y], Anchor::Start, Size::Small, note);
        }
        // One scale for all, which the bar tells.
        let edges_of = shown.iter().map(|(sheet, _)| Panel::edge(&sheet.cells));
        let metre = PANEL / edges_of.fold(1e-3, f64::max);
        let top = y + MARGIN + 10.0;
        y = top;
        for (sheet, walls) in shown {
            if shown.len() > 1 || !sheet.is_level() {
                drawing.text([MARGIN, y], Anchor::Start, Size::Small, self.caption(sheet));
                y += 8.0;
            }
            let panel = Panel::around(&sheet.cells, [MARGIN, y], metre);
            self.draw_sheet(&mut drawing, &panel, sheet, &scale);
            draw_model(&mut drawing, &panel, sheet, walls, &edges);
            y = panel.bottom() + MARGIN + 10.0;
            right = right.max(panel.right());
        }
        let x = right + 30.0;
        scale.draw(&mut drawing, [x, top + 10.0], LEGEND);
        let below = top + LEGEND + 40.0;
        if let Some((sheet, _)) = shown.first() {
            let panel = Panel::around(&sheet.cells, [0.0; 2], metre);
            panel.draw_bar(&mut drawing, [x, below]);
            if sheet.is_level() {
                draw_north(&mut drawing, [x + 12.0, below + 40.0]);
            }
        }
        drawing.size[1] = y.max(below + 110.0);
        drawing
    }

    /// Where the model is cut at the height of a sheet.
    fn walls(&self, sheet: &Sheet) -> Vec<[DVec2; 2]> {
        let lines = self.scene.section(sheet.normal, sheet.offset).into_iter();
        lines.map(|ends| ends.map(|end| sheet.place(end))).collect()
    }

    fn figures(&self) -> String {
        let [mean, error, least, most] = self.column.figures();
        let unit = &self.column.unit;
        format!(
            "{}: mean {mean:.2} {unit}, least {least:.2}, most {most:.2}; standard error of a sensor {error:.2}; {} sensors",
            self.column.name,
            self.sensors.len()
        )
    }

    fn caption(&self, sheet: &Sheet) -> String {
        let count = sheet.members.len();
        if sheet.is_level() {
            let origin = self.scene.origin.dot(sheet.normal.as_dvec3());
            let height = (origin + f64::from(sheet.offset)).abs();
            return format!("height {height:.2} m, {count} sensors");
        }
        let toward = f64::from(sheet.normal.x.atan2(-sheet.normal.z));
        let azimuth = toward.to_degrees().rem_euclid(360.0).round() % 360.0;
        format!("facing {azimuth}° from north, seen from before it, {count} sensors")
    }

    /// Cells and contours.
    fn draw_sheet(&self, drawing: &mut Drawing, panel: &Panel, sheet: &Sheet, scale: &Scale) {
        let values: Vec<f64> = sheet
            .members
            .iter()
            .map(|number| self.column.values[*number])
            .collect();
        for ((cell, number), value) in sheet.cells.iter().zip(&sheet.members).zip(&values) {
            let [x, y, z] = [0, 1, 2].map(|k| place(&self.sensors[*number], self.scene.origin)[k]);
            drawing.parts.push(Part::Shape(Shape {
                corners: cell.map(|corner| panel.point(corner)).to_vec(),
                ink: scale.ink(scale.share(*value)),
                title: format!(
                    "{x}, {y}, {z}: {value:.2} {}, standard error {:.2}",
                    self.column.unit, self.column.errors[*number]
                ),
                name: "cell",
            }));
        }
        let limit = self.limit.map(|(value, _)| value);
        let mut levels: Vec<(f64, String)> = scale.ticks();
        levels.retain(|(value, _)| limit != Some(*value));
        levels.extend(limit.map(|value| (value, value.to_string())));
        let mut labels: Vec<Text> = Vec::new();
        for (level, label) in levels {
            let runs = contours(&sheet.places, &values, &sheet.quads, level);
            let runs: Vec<Vec<[f64; 2]>> = runs
                .iter()
                .map(|run| run.iter().map(|point| panel.point(*point)).collect())
                .collect();
            let is_limit = limit == Some(level);
            labels.extend(labelled(&runs, &label, &labels));
            if !runs.is_empty() {
                drawing.parts.push(Part::Stroke(Stroke {
                    runs,
                    ink: Ink::BLACK,
                    width: if is_limit { 2.5 } else { 0.8 },
                    dash: 0.0,
                    name: "contour",
                }));
            }
        }
        drawing.parts.extend(labels.into_iter().map(Part::Text));
    }
}

/// The label of the longest of some lines, unless it is short or would lie on others.
fn labelled(runs: &[Vec<[f64; 2]>], words: &str, others: &[Text]) -> Option<Text> {
    let point = |p: &[f64; 2]| DVec2::from(*p);
    let length = |run: &[[f64; 2]]| -> f64 {
        run.windows(2)
            .map(|w| point(&w[0]).distance(point(&w[1])))
            .sum()
    };
    let longest = runs.iter().max_by(|a, b| length(a).total_cmp(&length(b)))?;
    let middle = longest[longest.len() / 2];
    let is_free = |other: &Text| {
        let apart = (point(&other.at) - point(&middle)).abs();
        apart.x > 36.0 || apart.y > 16.0
    };
    (length(longest) > LABELLED && others.iter().all(is_free)).then(|| Text {
        at: [middle[0], middle[1] + 4.0],
        anchor: Anchor::Middle,
        size: Size::Small,
        ink: Ink::BLACK,
        is_rimmed: true,
        words: words.to_owned(),
    })
}

/// Lines of the model where the plane cuts it, and its panes.
fn draw_model(
    drawing: &mut Drawing,
    panel: &Panel,
    sheet: &Sheet,
    walls: &[[DVec2; 2]],
    edges: &[[glam::Vec3; 2]],
) {
    let [behind, before] = PANES[usize::from(!sheet.is_level())];
    let is_near = |ends: &&[glam::Vec3; 2]| {
        ends.iter().all(|end| {
            let distance = sheet.normal.dot(*end) - sheet.offset;
            (behind..before).contains(&distance)
        })
    };
    let panes = edges.iter().filter(is_near);
    let panes = panes.map(|ends| ends.map(|end| sheet.place(end)));
    let panes: Vec<[DVec2; 2]> = panes.collect();
    for (lines, ink, width, name) in [
        (walls, MODEL, 1.8, "wall"),
        (&panes[..], GLASS, 2.2, "pane"),
    ] {
        let runs: Vec<Vec<[f64; 2]>> = lines
            .iter()
            .filter_map(|line| panel.clipped(*line))
            .collect();
        if !runs.is_empty() {
            drawing.parts.push(Part::Stroke(Stroke {
                runs,
                ink,
                width,
                dash: 0.0,
                name,
            }));
        }
    }
}

/// An arrow to the north, up, from its middle.
fn draw_north(drawing: &mut Drawing, [x, y]: [f64; 2]) {
    for (side, ink) in [(-9.0, Ink::BLACK), (9.0, Ink::GREY)] {
        drawing.parts.push(Part::Shape(Shape {
            corners: vec![[x, y], [x + side, y + 36.0], [x, y + 28.0]],
            ink,
            title: String::new(),
            name: "north",
        }));
    }
    drawing.text([x, y - 4.0], Anchor::Middle, Size::Large, "N");
}
