//! The year of the sensor under the pointer: an hour for each hour, the day to the right, the hour up.

use std::sync::Arc;

use egui::{Align2, Color32, ColorImage, TextureHandle, TextureOptions, Ui, vec2};
use glam::Vec3;

use super::probe::Probe;
use super::read_out;
use crate::commands::daylight::Scale;
use crate::commands::view::desk::Desk;
use crate::commands::view::document::Document;
use crate::daylight::false_colour::ColourMap;
use crate::daylight::weather::Weather;

/// Size of the map, points.
const SIZE: [f32; 2] = [365.0, 96.0];

/// Hours without light.
const DARK: Color32 = Color32::from_gray(70);

/// What a map is of: the sensor, the desk's revision, the colours.
type Key = (usize, u64, ColourMap);

/// The map that was shown last.
#[derive(Default)]
pub(super) struct HeatMap {
    drawn: Option<(Key, TextureHandle, String)>,
}

impl HeatMap {
    /// Shows the map of the sensor whose cell is under the pointer.
    pub(super) fn show(&mut self, ui: &Ui, document: &Document, probe: &Probe) {
        let Some(desk) = document.desk.as_ref().filter(|desk| desk.is_shown) else {
            return;
        };
        let Some(sensor) = under_pointer(desk, document, probe) else {
            return;
        };
        let map = document.job.settings.colour_map;
        let key = (sensor, desk.revision(), map);
        if self.drawn.as_ref().is_none_or(|(of, ..)| *of != key) {
            self.drawn = drawn(ui, desk, sensor, map).map(|(texture, range)| (key, texture, range));
        }
        let value = desk.values(document.record_shown(), map);
        let value = value.and_then(|values| {
            let value = *values.column.values.get(sensor)?;
            value
                .is_finite()
                .then(|| format!("{value:.1} {}", values.column.unit))
        });
        read_out(ui, "heat map", Align2::CENTER_BOTTOM, [0.0, -12.0], |ui| {
            let [x, y, z, ..] = desk.place(sensor, &document.job);
            let value = value.unwrap_or_else(|| "not measured yet".to_owned());
            ui.label(format!("sensor {} ({x}, {y}, {z}): {value}", sensor + 1));
            if let Some((_, texture, range)) = &self.drawn {
                ui.image((texture.id(), vec2(SIZE[0], SIZE[1])));
                ui.weak(format!("January to December, 0 to 24 h; {range}"));
            }
        });
    }
}

/// The sensor whose cell the pointer is on, if no surface is before it.
fn under_pointer(desk: &Desk, document: &Document, probe: &Probe) -> Option<usize> {
    let (ahead, far) = probe.ahead(document)?;
    let camera = document.job.camera;
    let way = ahead - camera.eye;
    let mut nearest: Option<(f32, usize)> = None;
    for (sensor, corners) in desk.cells() {
        let Some(distance) = met(camera.eye, way, &corners) else {
            continue;
        };
        if distance < 1.001 * far && nearest.is_none_or(|(other, _)| distance < other) {
            nearest = Some((distance, sensor));
        }
    }
    nearest.map(|(_, sensor)| sensor)
}

/// Where a ray meets a flat quadrilateral, in lengths of `way`.
fn met(eye: Vec3, way: Vec3, corners: &[Vec3; 4]) -> Option<f32> {
    let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    let distance = normal.dot(corners[0] - eye) / normal.dot(way);
    let point = eye + distance * way;
    let is_left = |k: usize| {
        let (from, to) = (corners[k], corners[(k + 1) % 4]);
        (to - from).cross(point - from).dot(normal) >= 0.0
    };
    (distance > 0.0 && distance.is_finite() && (0..4).all(is_left)).then_some(distance)
}

/// The map of a sensor as a texture, and what its colours mean.
fn drawn(ui: &Ui, desk: &Desk, sensor: usize, map: ColourMap) -> Option<(TextureHandle, String)> {
    let (weather, hours) = (desk.weather()?, desk.hours_of(sensor)?);
    let scale = Scale::logarithmic(hours.iter().filter_map(|lux| *lux), "lux", map);
    let ticks = scale.ticks();
    let ends = [ticks.first()?, ticks.last()?].map(|(_, label)| label.clone());
    let image = image(weather, &hours, &scale);
    let texture = ui
        .ctx()
        .load_texture("heat map", image, TextureOptions::NEAREST);
    let [least, most] = ends;
    Some((texture, format!("{least} to {most} lux")))
}

fn image(weather: &Arc<Weather>, hours: &[Option<f64>], scale: &Scale) -> ColorImage {
    let of_day = (24.0 / weather.step_hours).round() as usize;
    let mut days = Vec::new();
    for record in &weather.records {
        if days.last() != Some(&(record.month, record.day)) {
            days.push((record.month, record.day));
        }
    }
    let size = [days.len(), of_day];
    let mut image = ColorImage::filled(size, DARK);
    let mut day = 0;
    for (record, lux) in weather.records.iter().zip(hours) {
        while days[day] != (record.month, record.day) {
            day += 1;
        }
        let row = (record.hour / weather.step_hours).floor() as usize;
        if let (Some(lux), true) = (lux, row < of_day) {
            let [r, g, b] = scale.ink(scale.share(*lux)).0;
            image[(day, of_day - 1 - row)] = Color32::from_rgb(r, g, b);
        }
    }
    image
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_the_cell_that_it_passes() {
        let square = [
            Vec3::ZERO,
            Vec3::X,
            Vec3::new(1.0, 0.0, -1.0),
            Vec3::new(0.0, 0.0, -1.0),
        ];
        let down = |x: f32, z: f32| met(Vec3::new(x, 2.0, z), 0.5 * Vec3::NEG_Y, &square);
        assert_eq!(down(0.5, -0.5), Some(4.0));
        assert_eq!([down(1.5, -0.5), down(0.5, 0.5)], [None, None]);
        assert_eq!(met(Vec3::Y, Vec3::Y, &square), None);
    }
}
