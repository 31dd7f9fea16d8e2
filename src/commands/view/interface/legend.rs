//! The false-colour legend.

use egui::{Align2, Color32, FontId, Mesh, Rect, Sense, Ui, pos2, vec2};

use super::corner;
use crate::daylight::false_colour::ColourMap;
use crate::options::Options;

/// Size of the bar, points.
const BAR: [f32; 2] = [18.0, 220.0];
/// Number of colour steps in the bar.
const STEPS: u32 = 48;

/// Shows the legend if false colours are on.
pub(super) fn show(ui: &Ui, settings: &Options) {
    let Some(quantity) = settings.false_colour.filter(|q| settings.show.holds(*q)) else {
        return;
    };
    let range = settings.false_colour_range.unwrap_or(quantity.daytime());
    corner(ui, "legend", Align2::RIGHT_CENTER, [-12.0, 0.0], |ui| {
        ui.strong(quantity.unit());
        ui.add_space(8.0);
        let (rect, _) = ui.allocate_exact_size(vec2(BAR[0] + 62.0, BAR[1]), Sense::hover());
        let bar = Rect::from_min_size(rect.min, BAR.into());
        ui.painter().add(colours(bar, settings.colour_map));
        for tick in range.ticks() {
            let y = at(bar, tick.share);
            let text = pos2(bar.right() + 8.0, y);
            let font = FontId::proportional(12.0);
            ui.painter()
                .hline(bar.right()..=bar.right() + 5.0, y, (1.0, Color32::WHITE));
            ui.painter()
                .text(text, Align2::LEFT_CENTER, &tick.label, font, Color32::WHITE);
        }
        ui.add_space(8.0);
    });
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
