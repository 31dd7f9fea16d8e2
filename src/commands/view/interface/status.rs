//! Panel sections for scene, camera and progress.

use egui::Ui;

use super::UiRequest;
use super::numbers::slider;
use super::timings::TimingChart;
use crate::commands::view::document::Document;
use crate::commands::view::keys::Action;

/// Top of the panel: scene name and progress.
pub(super) fn header(ui: &mut Ui, document: &Document, requests: &mut Vec<UiRequest>) {
    ui.horizontal(|ui| {
        ui.heading(document.title());
        if ui
            .small_button("?")
            .on_hover_text("keys and mouse")
            .clicked()
        {
            requests.push(UiRequest::Do(Action::Help));
        }
    });
    let (done, wanted) = document.progress();
    ui.weak(if document.is_behind() {
        "preparing the change".to_owned()
    } else if document.is_at_rest() {
        format!("{wanted} frames averaged, done")
    } else {
        format!("{done} of {wanted} frames averaged")
    });
    ui.add_space(4.0);
}

/// Field of view and viewpoints.
pub(super) fn view(ui: &mut Ui, document: &mut Document) {
    let mut camera = document.controls.camera();
    let slider = slider(&mut camera.fov_deg, 10.0..=110.0)
        .suffix("°")
        .text("field of view");
    if ui.add(slider).changed() {
        document.set_camera(&camera);
    }
    let mut chosen = None;
    ui.horizontal_wrapped(|ui| {
        if ui.button("frame all").clicked() {
            document.frame_all();
        }
        if ui.button("save viewpoint").clicked() {
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
    let eye = document.job.scene.origin + camera.eye.as_dvec3();
    let forward = camera.forward();
    let (azimuth, elevation) = crate::daylight::sun_position::azimuth_elevation(forward.as_dvec3());
    ui.weak(format!(
        "eye {:.1}, {:.1}, {:.1} m; azimuth {azimuth:.0}°, elevation {elevation:+.0}°",
        eye.x, eye.y, eye.z
    ));
}

/// Statistics of the scene and the device.
pub(super) fn scene(
    ui: &mut Ui,
    document: &Document,
    requests: &mut Vec<UiRequest>,
    timings: &TimingChart,
) {
    let scene = &document.job.scene;
    let extent = scene.bounds.max - scene.bounds.min;
    let mebibytes = |bytes: u64| bytes as f64 / (1 << 20) as f64;
    ui.label(format!(
        "{} triangles, {} materials, {} textures",
        scene.triangles(),
        scene.materials.len(),
        scene.textures.len()
    ));
    ui.label(format!(
        "{:.1} × {:.1} × {:.1} m",
        extent.x, extent.y, extent.z
    ));
    ui.label(format!(
        "{:.0} MiB of device memory",
        mebibytes(timings.device_bytes())
    ));
    let mut timed = timings.is_open;
    if ui.checkbox(&mut timed, "time of each pass").changed() {
        requests.push(UiRequest::Do(Action::ToggleTimings));
    }
    ui.weak("drop a model or a scene file on the window to open it");
}
