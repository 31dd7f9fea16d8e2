//! Lighting settings: irradiance, ambient occlusion, shadows, samples.

use egui::{ComboBox, Ui};

use super::choice;
use super::numbers::slider;
use crate::commands::light::conditions;
use crate::commands::view::document::Document;
use crate::daylight::irradiance::IrradianceMethod;
use crate::daylight::sample_count::ErrorEstimate;
use crate::daylight::sky::Conditions;
use crate::options::{Ambient, Bounces};

/// Shadow map resolutions to choose from, texels.
const SHADOW_SIZES: [u32; 4] = [1024, 2048, 4096, 8192];

/// Estimated error of the sky irradiance, cached with the conditions it was computed for.
#[derive(Default)]
pub(super) struct Readout {
    estimate: Option<(Conditions, ErrorEstimate)>,
    error: Option<(u32, f64)>,
}

impl Readout {
    pub(super) fn show(&mut self, ui: &mut Ui, document: &mut Document) {
        let settings = &mut document.job.settings;
        choice(ui, "irradiance", &mut settings.irradiance);
        if settings.irradiance.is_sampled() {
            let samples = slider(&mut settings.irradiance_samples, 16..=65_536);
            ui.add(samples.logarithmic(true).text("samples"));
        }
        let line = self.irradiance(document);
        ui.label(line);
        ui.separator();
        let settings = &mut document.job.settings;
        bounces(ui, &mut settings.bounces);
        choice(ui, "moving view", &mut settings.ambient);
        match settings.ambient {
            Ambient::Cells => {
                let paths = slider(&mut settings.refine, 0..=65_536);
                ui.add(paths.logarithmic(true).text("paths a frame"))
                    .on_hover_text("light paths that refine the cells while the view moves");
            }
            Ambient::Ssao => {
                let radius = slider(&mut settings.ao_radius, 0.0..=20.0);
                ui.add(radius.text("AO radius, m"))
                    .on_hover_text("radius of ambient occlusion; 0 turns it off");
                choice(ui, "AO resolution", &mut settings.ao_resolution);
            }
        }
        ui.separator();
        shadow_size(ui, &mut settings.shadow_size);
        let samples = slider(&mut settings.samples, 1..=1024);
        ui.add(samples.logarithmic(true).text("frames at rest"))
            .on_hover_text(
                "frames averaged when nothing moves: anti-aliasing and soft shadows of the sun's disc",
            );
        ui.add(slider(&mut settings.specular, 0.0..=4.0).text("specular"))
            .on_hover_text("scales all specular reflectances");
        ui.checkbox(&mut settings.limb_darkening, "limb darkening");
    }

    /// Progress and estimated error of the sky irradiance.
    fn irradiance(&mut self, document: &Document) -> String {
        let (done, wanted) = document.frame().irradiance_progress();
        let method = document.job.settings.irradiance;
        let error = match method {
            IrradianceMethod::Exact => "exact sum over the sky cube".to_owned(),
            IrradianceMethod::Sh => "9 spherical harmonics".to_owned(),
            IrradianceMethod::Quasi | IrradianceMethod::MonteCarlo => {
                let error = self.error(document, method, done);
                format!("{done} of {wanted} samples, ± {:.2} %", error * 100.0)
            }
        };
        format!("sky irradiance: {error}")
    }

    fn error(&mut self, document: &Document, method: IrradianceMethod, done: u32) -> f64 {
        let now = conditions(&document.job.settings, &document.job.sun);
        if self.estimate.as_ref().is_none_or(|(of, _)| *of != now) {
            let daylight = &document.job.daylight;
            let estimate = ErrorEstimate::new(|direction| daylight.radiance(direction));
            (self.estimate, self.error) = (Some((now, estimate)), None);
        }
        let (Some((_, estimate)), None) = (&self.estimate, self.error.filter(|e| e.0 == done))
        else {
            return self.error.map_or(0.0, |e| e.1);
        };
        let error = match method {
            IrradianceMethod::MonteCarlo => estimate.monte_carlo_error(done.max(1)),
            _ => estimate.quasi_error(done.max(1)),
        };
        self.error = Some((done, error));
        error
    }
}

/// Numbers of bounces to choose from.
const BOUNCES: [Bounces; 5] = [
    Bounces::All,
    Bounces::UpTo(0),
    Bounces::UpTo(1),
    Bounces::UpTo(2),
    Bounces::UpTo(4),
];

fn bounces(ui: &mut Ui, bounces: &mut Bounces) {
    ComboBox::new("bounces", "bounces")
        .selected_text(bounces.to_string())
        .show_ui(ui, |ui| {
            for count in BOUNCES {
                ui.selectable_value(bounces, count, count.to_string());
            }
        })
        .response
        .on_hover_text("how often surfaces reflect light onto others");
}

fn shadow_size(ui: &mut Ui, size: &mut u32) {
    ComboBox::new("shadow map", "shadow map, texels")
        .selected_text(size.to_string())
        .show_ui(ui, |ui| {
            for edge in SHADOW_SIZES {
                ui.selectable_value(size, edge, edge.to_string());
            }
        });
}
