//! Live chart of pass times.

use egui::{Align2, Color32, Grid, Rect, Sense, Ui, vec2};

use super::corner;
use crate::commands::view::document::Document;
use crate::commands::view::stage::Stage;
use crate::commands::view::style;
use crate::gpu::PassTime;

/// Weight of the newest frame in the running mean.
const NEWEST: f64 = 0.2;
/// Length of the longest bar, points.
const BAR: f32 = 150.0;

/// Running means of the pass times.
#[derive(Default)]
pub(super) struct TimingChart {
    pub(super) is_open: bool,
    passes: Vec<PassTime>,
    /// Device memory in use, bytes.
    device_bytes: u64,
}

impl TimingChart {
    pub(super) fn observe(&mut self, stage: &Stage) {
        self.device_bytes = stage.context.allocated_bytes();
        if !self.is_open {
            self.passes.clear();
            return;
        }
        for new in stage.timings().passes() {
            match self.passes.iter_mut().find(|p| p.name == new.name) {
                Some(mean) => {
                    mean.ms += NEWEST * (new.ms - mean.ms);
                    mean.cpu_ms += NEWEST * (new.cpu_ms - mean.cpu_ms);
                }
                None => self.passes.push(*new),
            }
        }
    }

    pub(super) fn device_bytes(&self) -> u64 {
        self.device_bytes
    }

    pub(super) fn show(&self, ui: &Ui, document: &mut Document) {
        if !self.is_open {
            return;
        }
        corner(ui, "timings", Align2::RIGHT_TOP, [-12.0, 12.0], |ui| {
            let longest = self.passes.iter().map(|p| p.ms).fold(1e-6, f64::max);
            let has_cpu = self.passes.iter().any(|p| p.cpu_ms.is_finite());
            Grid::new("timings").spacing([10.0, 2.0]).show(ui, |ui| {
                ui.strong("pass");
                ui.strong("ms");
                if has_cpu {
                    ui.strong("CPU ms");
                }
                ui.end_row();
                for pass in &self.passes {
                    line(ui, pass, longest, has_cpu);
                }
            });
            let sum: f64 = self.passes.iter().map(|p| p.ms).sum();
            ui.label(format!("sum {sum:.1} ms"));
            // Only drawn frames are timed, so restart the average.
            if ui.button("measure").clicked() {
                document.start_over();
            }
        });
    }
}

fn line(ui: &mut Ui, pass: &PassTime, longest: f64, has_cpu: bool) {
    ui.label(pass.name);
    ui.label(format!("{:.2}", pass.ms));
    if has_cpu {
        ui.label(format!("{:.2}", pass.cpu_ms));
    }
    let (rect, _) = ui.allocate_exact_size(vec2(BAR, 9.0), Sense::hover());
    let width = BAR * (pass.ms / longest) as f32;
    let bar = Rect::from_min_size(rect.min, vec2(width.max(1.0), rect.height()));
    ui.painter()
        .rect_filled(rect, 2.0, Color32::from_white_alpha(12));
    ui.painter().rect_filled(bar, 2.0, style::ACCENT);
    ui.end_row();
}
