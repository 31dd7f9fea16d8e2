//! Sky model, its measured irradiances or clouds, turbidity, ground albedo, refraction.

use egui::Ui;
use glam::DVec3;

use super::choice;
use super::numbers::slider;
use crate::commands::light::{self, air};
use crate::commands::view::document::Document;
use crate::daylight::atmosphere::air::{ALTITUDE_RANGE_M, AOD_RANGE, OZONE_RANGE_DU};
use crate::daylight::colour::luminance;
use crate::daylight::perez::MOST_IRRADIANCE_W;
use crate::daylight::sky::SkyModel;
use crate::options::Options;

pub(super) fn show(ui: &mut Ui, document: &mut Document) {
    let [sun, sky] = horizontal(document);
    let settings = &mut document.job.settings;
    choice(ui, "sky", &mut settings.sky);
    if settings.sky == SkyModel::Perez {
        // A sky that is measured from now on begins with about the light that was there.
        let start = [sun, sky].map(|lux| (lux / 110.0).round().clamp(0.0, 1000.0));
        let watts = |name| move |value| slider(value, 0.0..=MOST_IRRADIANCE_W).text(name);
        ui.add(watts("sun, W/m²")(settings.dni.get_or_insert(start[0])))
            .on_hover_text("measured irradiance by the sun at normal incidence");
        ui.add(watts("sky, W/m²")(settings.dhi.get_or_insert(start[1])))
            .on_hover_text("measured irradiance by the sky on a horizontal plane");
    }
    if settings.sky.is_clear() {
        ui.add(slider(&mut settings.cloud_cover, 0.0..=1.0).text("cloud cover"))
            .on_hover_text("share of the sky: dims the sun and evens out the sky, as in the mean of many hours");
    }
    if settings.sky == SkyModel::Atmosphere {
        atmosphere(ui, settings);
    } else {
        turbidity(ui, settings);
    }
    ui.add(slider(&mut settings.ground_albedo, 0.0..=1.0).text("ground albedo"))
        .on_hover_text("reflectance of the ground below the horizon, 0 to 1");
    choice(ui, "refraction", &mut settings.refraction);
    choice(ui, "moon", &mut settings.moon);
    if settings.sky == SkyModel::Atmosphere {
        choice(ui, "stars", &mut settings.stars);
    }
    let is_moonlit = document.job.daylight.moon.is_some()
        && document.job.daylight.sun_illuminance == DVec3::ZERO;
    let source = if is_moonlit { "moon" } else { "sun" };
    ui.label(format!(
        "horizontal: {source} {} + sky {}",
        illuminance(sun),
        illuminance(sky)
    ));
}

fn turbidity(ui: &mut Ui, settings: &mut Options) {
    let (least, most) = settings.sky.turbidity_range();
    let mut value = light::turbidity(settings);
    let response = ui
        .add(slider(&mut value, least..=most).text("turbidity"))
        .on_hover_text("2 very clear, 3 clear, 6 hazy, 10 very hazy");
    if response.changed() {
        settings.turbidity = Some(value);
        (settings.aod, settings.visual_range) = (None, None);
    }
}

/// The air of an atmosphere.
fn atmosphere(ui: &mut Ui, settings: &mut Options) {
    let mut aod = air(settings).aod;
    let response = ui
        .add(slider(&mut aod, AOD_RANGE).text("aerosol optical depth"))
        .on_hover_text("0.05 very clear, 0.1 clear, 0.2 hazy, 0.4 murky");
    if response.changed() {
        settings.aod = Some(aod);
        (settings.turbidity, settings.visual_range) = (None, None);
    }
    ui.add(slider(&mut settings.ozone, OZONE_RANGE_DU).text("ozone, DU"));
    ui.add(slider(&mut settings.altitude, ALTITUDE_RANGE_M).text("altitude, m"));
    let aerial = settings.aerial.get_or_insert_default();
    choice(ui, "air before surfaces", aerial);
}

/// Illuminances of a horizontal plane by sun (or moon) and sky, lux.
fn horizontal(document: &Document) -> [f64; 2] {
    let light = &document.job.daylight;
    let sky = luminance(light.sky_irradiance_up);
    [luminance(light.horizontal()) - sky, sky]
}

/// Formats an illuminance, lux: `12.3 klx`, `0.25 lx`.
pub(super) fn illuminance(lux: f64) -> String {
    if lux >= 1000.0 {
        format!("{:.1} klx", lux * 1e-3)
    } else {
        let digits = if lux >= 10.0 { 0 } else { 2 };
        format!("{lux:.digits$} lx")
    }
}

#[cfg(test)]
mod tests {
    use super::illuminance;

    #[test]
    fn illuminances_have_three_digits_or_so() {
        assert_eq!(illuminance(98_765.0), "98.8 klx");
        assert_eq!(illuminance(123.4), "123 lx");
        assert_eq!(illuminance(0.254), "0.25 lx");
    }
}
