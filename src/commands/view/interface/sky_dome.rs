//! Compass and sun path over the image, seen from the camera.

use chrono::{DateTime, FixedOffset, NaiveDate};
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect, Stroke, Ui, pos2, vec2};
use glam::{DVec3, Mat4, Vec3};

use crate::commands::view::document::Document;
use crate::commands::view::style;
use crate::daylight::sun_path::{Line, Observer, SunPath};
use crate::daylight::sun_position::direction;
use crate::options::Switch;

const SOLSTICE: Color32 = Color32::from_rgb(120, 190, 255);
const EQUINOX: Color32 = Color32::from_rgb(150, 230, 170);
/// Radius of the compass, points.
const COMPASS: f32 = 34.0;

/// Which overlays are shown, and the cached sun path of the day.
#[derive(Default)]
pub(super) struct SkyDome {
    compass: bool,
    sun_path: bool,
    path: Option<(NaiveDate, Observer, FixedOffset, SunPath)>,
}

impl SkyDome {
    /// Toggles both overlays.
    pub(super) fn toggle(&mut self) {
        let on = !(self.compass || self.sun_path);
        (self.compass, self.sun_path) = (on, on);
    }

    pub(super) fn switches(&mut self, ui: &mut Ui) {
        ui.horizontal(|ui| {
            ui.checkbox(&mut self.sun_path, "sun path");
            ui.checkbox(&mut self.compass, "compass");
        });
    }

    pub(super) fn show(&mut self, ui: &Ui, document: &Document) {
        let painter = ui.ctx().layer_painter(egui::LayerId::background());
        let screen = ui.ctx().content_rect();
        if self.sun_path {
            let lens = Lens::new(document, screen);
            horizon(&painter, &lens);
            if let Some(path) = self.path(document) {
                draw(&painter, &lens, path);
            }
            sun(&painter, &lens, document.job.sun.direction());
        }
        if self.compass {
            compass(&painter, screen, document);
        }
    }

    /// The sun path at the place; `None` when the sun is given without one.
    fn path(&mut self, document: &Document) -> Option<&SunPath> {
        let settings = &document.job.settings;
        let (latitude, longitude, when) = settings.sun.place()?;
        let observer = Observer {
            latitude,
            longitude,
            method: settings.sun_position,
            refraction: settings.refraction == Switch::On,
        };
        let (date, offset) = (when.date_naive(), *when.offset());
        let is_new = |p: &(NaiveDate, Observer, FixedOffset, SunPath)| {
            (p.0, p.1, p.2) != (date, observer, offset)
        };
        if self.path.as_ref().is_none_or(is_new) {
            let path = path_of(&observer, when);
            self.path = path.map(|path| (date, observer, offset, path));
        }
        self.path.as_ref().map(|p| &p.3)
    }
}

fn path_of(observer: &Observer, when: DateTime<FixedOffset>) -> Option<SunPath> {
    SunPath::new(observer, when).ok()
}

/// Projects directions (points at infinity) onto the window.
struct Lens {
    clip_from_world: Mat4,
    screen: Rect,
}

impl Lens {
    fn new(document: &Document, screen: Rect) -> Self {
        let camera = &document.job.camera;
        let aspect = screen.width() / screen.height().max(1.0);
        Self {
            clip_from_world: camera.clip_from_view(aspect) * camera.view_from_world(),
            screen,
        }
    }

    /// Window position of a direction; `None` behind the camera.
    fn project(&self, direction: Vec3) -> Option<Pos2> {
        let clip = self.clip_from_world * direction.extend(0.0);
        if clip.w <= 1e-3 {
            return None;
        }
        let at = vec2(0.5 + 0.5 * clip.x / clip.w, 0.5 + 0.5 * clip.y / clip.w);
        Some(self.screen.min + at * self.screen.size())
    }

    fn line(&self, painter: &Painter, points: &[DVec3], stroke: Stroke) {
        for pair in points.windows(2) {
            let ends = (
                self.project(pair[0].as_vec3()),
                self.project(pair[1].as_vec3()),
            );
            if let (Some(from), Some(to)) = ends {
                // A dark outline keeps the line readable on a bright sky.
                let edge = Stroke::new(stroke.width + 1.5, Color32::from_black_alpha(60));
                painter.line_segment([from, to], edge);
                painter.line_segment([from, to], stroke);
            }
        }
    }
}

fn text(painter: &Painter, at: Pos2, text: &str, color: Color32) {
    let font = FontId::proportional(13.0);
    painter.text(
        at + vec2(1.0, 1.0),
        Align2::CENTER_CENTER,
        text,
        font.clone(),
        Color32::from_black_alpha(180),
    );
    painter.text(at, Align2::CENTER_CENTER, text, font, color);
}

/// Draws the horizon with the compass points.
fn horizon(painter: &Painter, lens: &Lens) {
    let circle: Line = (0..=72)
        .map(|i| direction(f64::from(i) * 5.0, 0.0))
        .collect();
    lens.line(
        painter,
        &circle,
        Stroke::new(1.0, Color32::from_white_alpha(90)),
    );
    let names = ["N", "NE", "E", "SE", "S", "SW", "W", "NW"];
    for (i, name) in (0u32..).zip(names) {
        let toward = direction(f64::from(i) * 45.0, 1.2);
        if let Some(at) = lens.project(toward.as_vec3()) {
            text(painter, at, name, Color32::WHITE);
        }
    }
}

fn draw(painter: &Painter, lens: &Lens, path: &SunPath) {
    let arcs = [
        (&path.june_solstice, SOLSTICE, "21 June"),
        (&path.december_solstice, SOLSTICE, "21 December"),
        (&path.equinox, EQUINOX, "equinox"),
    ];
    for (lines, color, name) in arcs {
        for line in lines {
            lens.line(painter, line, Stroke::new(1.2, color));
            let middle = line
                .get(line.len() / 2)
                .and_then(|d| lens.project(d.as_vec3()));
            if let Some(at) = middle {
                text(painter, at - vec2(0.0, 10.0), name, color);
            }
        }
    }
    for line in &path.day {
        lens.line(painter, line, Stroke::new(2.0, style::ACCENT));
    }
    for hour in &path.hours {
        if let Some(at) = lens.project(hour.direction.as_vec3()) {
            painter.circle_filled(at, 3.0, style::ACCENT);
            text(painter, at + vec2(0.0, 13.0), &hour.label(), style::ACCENT);
        }
    }
}

fn sun(painter: &Painter, lens: &Lens, toward: DVec3) {
    if let Some(at) = lens.project(toward.as_vec3()) {
        painter.circle_stroke(at, 9.0, Stroke::new(2.0, style::ACCENT));
    }
}

/// Draws a compass rose at the bottom of the image. Up is the viewing direction; the dot is the sun.
fn compass(painter: &Painter, screen: Rect, document: &Document) {
    let centre = pos2(screen.center().x, screen.bottom() - COMPASS - 20.0);
    painter.circle_filled(centre, COMPASS + 12.0, Color32::from_black_alpha(110));
    painter.circle_stroke(
        centre,
        COMPASS,
        Stroke::new(1.0, Color32::from_white_alpha(120)),
    );
    let forward = document.job.camera.forward().as_dvec3();
    let (heading, _) = crate::daylight::sun_position::azimuth_elevation(forward);
    let at = |azimuth_deg: f64, radius: f32| {
        let angle = (azimuth_deg - heading).to_radians() as f32;
        centre + vec2(angle.sin(), -angle.cos()) * radius
    };
    for (azimuth, name) in [(0.0, "N"), (90.0, "E"), (180.0, "S"), (270.0, "W")] {
        let color = if name == "N" {
            style::ALARM
        } else {
            Color32::WHITE
        };
        text(painter, at(azimuth, COMPASS), name, color);
    }
    let sun = &document.job.sun;
    // The zenith is at the centre, the horizon on the ring.
    let down = (1.0 - sun.apparent_elevation_deg / 90.0).clamp(0.0, 1.0) as f32;
    let up = sun.apparent_elevation_deg > 0.0;
    let color = if up { style::ACCENT } else { Color32::GRAY };
    painter.circle_filled(at(sun.azimuth_deg, COMPASS * down), 4.5, color);
}
