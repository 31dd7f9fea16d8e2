//! The false-colour legend.

use egui::{Align2, Color32, FontId, Mesh, Rect, Sense, Ui, pos2, vec2};

use super::corner;
use crate::commands::job::Job;
use crate::daylight::false_colour::ColourMap;

/// Size of the bar, points.
const BAR: [f32; 2] = [18.0, 220.0];
/// Number of colour steps in the bar.
const STEPS: u32 = 48;

/// Shows the legend if false colours are on.
pub(super) fn show(ui: &Ui, job: &Job) {
    let Some((quantity, colours)) = job.colours(job.settings.show) else {
        return;
    };
    let ticks = colours.range.ticks().into_iter();
    let ticks = ticks.map(|tick| (tick.share, tick.label)).collect();
    let bar = Bar {
        unit: quantity.unit(),
        ticks,
        map: colours.map,
    };
    bar.show(ui, "legend", 0.0);
}

/// A bar of colours with labels at places 0..1.
pub(super) struct Bar<'a> {
    pub(super) unit: &'a str,
    pub(super) ticks: Vec<(f64, String)>,
    pub(super) map: ColourMap,
}

impl Bar<'_> {
    /// Shows it at the right edge of the picture, so many points further left.
    pub(super) fn show(&self, ui: &Ui, id: &str, left: f32) {
        let offset = [-12.0 - left, 0.0];
        corner(ui, id, Align2::RIGHT_CENTER, offset, |ui| {
            ui.strong(self.unit);
            ui.add_space(8.0);
            let (rect, _) = ui.allocate_exact_size(vec2(BAR[0] + 62.0, BAR[1]), Sense::hover());
            let bar = Rect::from_min_size(rect.min, BAR.into());
            ui.painter().add(colours(bar, self.map));
            for (share, label) in &self.ticks {
                let y = at(bar, *share);
                let text = pos2(bar.right() + 8.0, y);
                let font = FontId::proportional(12.0);
                ui.painter()
                    .hline(bar.right()..=bar.right() + 5.0, y, (1.0, Color32::WHITE));
                ui.painter()
                    .text(text, Align2::LEFT_CENTER, label, font, Color32::WHITE);
            }
            ui.add_space(8.0);
        });
    }
}

/// Window y coordinate of a fraction of the range. The largest value is at the top.
fn at(bar: Rect, share: f64) -> f32 {
    bar.bottom() - bar.height() * share as f32
}

/// The colour bar, from bottom to top.
fn colours(bar: Rect, map: ColourMap) -> Mesh {
    let mut mesh = Mesh::default();
    for step in 0..=STEPS {
        let share = f64::from(step) / f64::from(STEPS);
        let c = map.colour(share).as_vec3();
        let color = egui::Rgba::from_rgb(c.x, c.y, c.z).into();
        let y = at(bar, share);
        mesh.colored_vertex(pos2(bar.left(), y), color);
        mesh.colored_vertex(pos2(bar.right(), y), color);
        if step > 0 {
            let n = 2 * step;
            mesh.add_triangle(n - 2, n - 1, n);
            mesh.add_triangle(n - 1, n, n + 1);
        }
    }
    mesh
}
