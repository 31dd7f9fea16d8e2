//! Read-out of the pixel under the pointer: its luminance, and the illuminance of its surface.

use egui::{Align2, Grid, Ui};
use glam::{DVec3, Vec2, Vec3};

use super::{air, read_out};
use crate::commands::view::document::Document;
use crate::daylight::colour::luminance;
use crate::passes::light::probe::{Reading, SurfaceReading};
use crate::passes::view::View;
use crate::scene::Scene;

/// The read-out of a pixel, and the frame it was taken from.
#[derive(Debug, Clone, Default)]
pub(super) struct Probe {
    pixel: Option<[u32; 2]>,
    frame: u64,
    reading: Option<Reading>,
    /// Surface position, metres.
    point: Option<DVec3>,
}

impl Probe {
    /// Whether the read-out is of this pixel and, once the image is at rest, of the newest frame.
    pub(super) fn is_fresh(&self, pixel: Option<[u32; 2]>, document: Option<&Document>) -> bool {
        let is_newest = document.is_none_or(|d| !d.is_at_rest() || d.frames() == self.frame);
        pixel == self.pixel && (pixel.is_none() || is_newest)
    }

    pub(super) fn set(
        &mut self,
        pixel: Option<[u32; 2]>,
        reading: Option<Reading>,
        document: Option<&Document>,
    ) {
        self.pixel = pixel;
        self.reading = reading;
        self.frame = document.map_or(0, Document::frames);
        self.point = document.and_then(|document| point(document, reading?));
    }

    pub(super) fn point(&self) -> Option<DVec3> {
        self.point
    }

    /// The point a metre along the view axis under the pointer, and the distance of the surface there, if the pointer is on the picture.
    pub(super) fn ahead(&self, document: &Document) -> Option<(Vec3, f32)> {
        let [x, y] = self.pixel?;
        let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
        let surface = self.reading.and_then(|reading| reading.surface);
        let far = surface.map_or(f32::INFINITY, |surface| surface.distance);
        Some((view(document).point(at, 1.0), far))
    }

    pub(super) fn show(&self, ui: &Ui, document: &Document) {
        let Some(reading) = &self.reading else { return };
        read_out(ui, "probe", Align2::RIGHT_BOTTOM, [-12.0, -12.0], |ui| {
            Grid::new("probe").spacing([12.0, 3.0]).show(ui, |ui| {
                picture(ui, reading);
                match &reading.surface {
                    Some(surface) => about(ui, surface, &document.job.scene),
                    None => row(ui, "surface", "none (sky or ground plane)"),
                }
            });
        });
    }
}

fn row(ui: &mut Ui, name: &str, value: impl Into<String>) {
    ui.weak(name);
    ui.label(value.into());
    ui.end_row();
}

fn rgb(c: [f32; 3], digits: usize) -> String {
    let [r, g, b] = c;
    format!("{r:.digits$}  {g:.digits$}  {b:.digits$}")
}

fn of(c: [f32; 3]) -> f64 {
    luminance(Vec3::from(c).as_dvec3())
}

fn picture(ui: &mut Ui, reading: &Reading) {
    let [x, y] = reading.pixel;
    row(ui, "pixel", format!("{x}, {y}"));
    row(
        ui,
        "luminance",
        format!("{:.1} cd/m²", of(reading.radiance)),
    );
    row(ui, "RGB", format!("{} cd/m²", rgb(reading.radiance, 1)));
}

fn about(ui: &mut Ui, surface: &SurfaceReading, scene: &Scene) {
    row(
        ui,
        "illuminance",
        air::illuminance(surface.illuminance.into()),
    );
    let material = scene.materials.get(surface.material as usize);
    let name = material.map_or("", |m| m.name.as_str());
    let name = if name.is_empty() { "unnamed" } else { name };
    row(ui, "material", name);
    row(ui, "reflectance", rgb(surface.albedo, 3));
    if surface.emission != [0.0; 3] {
        row(ui, "emission", format!("{:.1} cd/m²", of(surface.emission)));
    }
    row(ui, "normal", rgb(surface.normal, 3));
    row(ui, "depth", format!("{:.2} m", surface.distance));
}

/// Surface position of a reading, metres.
fn point(document: &Document, reading: Reading) -> Option<DVec3> {
    let surface = reading.surface?;
    let [x, y] = reading.pixel;
    let at = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
    Some(view(document).point(at, surface.distance).as_dvec3())
}

fn view(document: &Document) -> View {
    View {
        camera: document.job.camera,
        size: document.frame().settings().size,
        jitter: Vec2::ZERO,
        sharpen: 0.0,
        window: None,
    }
}
