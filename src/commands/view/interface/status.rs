//! The scene, the camera, and how far the picture is.

use egui::{Slider, Ui};

use super::Wish;
use super::timings::TimingChart;
use crate::commands::view::document::Document;
use crate::commands::view::keys::Action;

/// The top of the panel: what is open, and how far its picture is.
pub(super) fn header(ui: &mut Ui, document: &Document, wishes: &mut Vec<Wish>) {
    ui.horizontal(|ui| {
        ui.heading(document.title());
        if ui.small_button("?").on_hover_text("keys").clicked() {
            wishes.push(Wish::Do(Action::Help));
        }
    });
    let (done, wanted) = document.progress();
    ui.weak(if document.is_at_rest() {
        format!("{wanted} frames averaged, at rest")
    } else {
        format!("{done} of {wanted} frames averaged")
    });
    ui.add_space(4.0);
}

/// Field of view and viewpoints.
pub(super) fn view(ui: &mut Ui, document: &mut Document) {
    let mut camera = document.controls.camera();
    let slider = Slider::new(&mut camera.fov_deg, 10.0..=110.0).text("field of view");
    if ui.add(slider).changed() {
        document.set_camera(&camera);
    }
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        if ui.button("frame all").clicked() {
            document.frame_all();
        }
        if ui.button("keep viewpoint").clicked() {
            document.viewpoints.save(camera);
        }
        for (i, viewpoint) in document.viewpoints.list().iter().enumerate() {
            if ui.button(&viewpoint.name).clicked() {
                chosen = Some(i);
            }
        }
    });
    if let Some(viewpoint) = chosen.and_then(|i| document.viewpoints.choose(i)) {
        document.controls.go_to(&viewpoint.camera);
    }
    let (eye, forward) = (camera.eye, camera.forward());
    let (azimuth, elevation) = crate::daylight::sun_position::azimuth_elevation(forward.as_dvec3());
    ui.weak(format!(
        "eye {:.1} {:.1} {:.1} m, toward {azimuth:.0}°, {elevation:+.0}°",
        eye.x, eye.y, eye.z
    ));
}

/// Numbers of the scene and of the device.
pub(super) fn scene(
    ui: &mut Ui,
    document: &Document,
    wishes: &mut Vec<Wish>,
    timings: &TimingChart,
) {
    let scene = &document.job.scene;
    let extent = scene.bounds.max - scene.bounds.min;
    let mega = |bytes: u64| bytes as f64 / (1 << 20) as f64;
    ui.label(format!(
        "{} triangles, {} materials, {} textures",
        scene.triangles(),
        scene.materials.len(),
        scene.textures.len()
    ));
    ui.label(format!(
        "{:.1} x {:.1} x {:.1} m",
        extent.x, extent.y, extent.z
    ));
    ui.label(format!(
        "{:.0} MB of device memory",
        mega(timings.device_bytes())
    ));
    let mut timed = timings.is_open;
    if ui.checkbox(&mut timed, "time of every pass").changed() {
        wishes.push(Wish::Do(Action::ToggleTimings));
    }
    ui.weak("drop a model or a scene file on the window to open it");
}
