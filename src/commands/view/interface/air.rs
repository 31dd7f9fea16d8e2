//! Sky model, turbidity, ground albedo, refraction.

use egui::{Slider, Ui};

use super::choice;
use crate::commands::light::air;
use crate::commands::view::document::Document;
use crate::daylight::SkyModel;
use crate::daylight::atmosphere::air::{ALTITUDE_RANGE_M, AOD_RANGE, OZONE_RANGE_DU};
use crate::daylight::sky::Conditions;
use crate::options::Options;

pub(super) fn show(ui: &mut Ui, document: &mut Document) {
    let settings = &mut document.job.settings;
    choice(ui, "sky", &mut settings.sky);
    if settings.sky == SkyModel::Atmosphere {
        atmosphere(ui, settings);
    } else {
        turbidity(ui, settings);
    }
    ui.add(Slider::new(&mut settings.ground_albedo, 0.0..=1.0).text("ground albedo"))
        .on_hover_text("reflectance of the ground below the horizon, 0 to 1");
    choice(ui, "refraction", &mut settings.refraction);
    let light = &document.job.daylight;
    let lux = crate::daylight::colour::luminance;
    let elevation = document.job.sun.apparent_elevation_deg;
    let sun = lux(light.sun_illuminance) * elevation.to_radians().sin().max(0.0);
    let sky = lux(light.sky_irradiance_up);
    ui.label(format!(
        "horizontal: sun {} + sky {}",
        illuminance(sun),
        illuminance(sky)
    ));
}

fn turbidity(ui: &mut Ui, settings: &mut Options) {
    let (least, most) = settings.sky.turbidity_range();
    let mut value = settings
        .turbidity
        .unwrap_or(Conditions::default().turbidity);
    let slider = ui
        .add(Slider::new(&mut value, least..=most).text("turbidity"))
        .on_hover_text("2 very clear, 3 clear, 6 hazy, 10 very hazy");
    if slider.changed() {
        settings.turbidity = Some(value);
        (settings.aod, settings.visual_range) = (None, None);
    }
}

/// The air of an atmosphere.
fn atmosphere(ui: &mut Ui, settings: &mut Options) {
    let mut aod = air(settings).aod;
    let slider = ui
        .add(Slider::new(&mut aod, AOD_RANGE).text("aerosol optical depth"))
        .on_hover_text("0.05 very clear, 0.1 clear, 0.2 hazy, 0.4 murky");
    if slider.changed() {
        settings.aod = Some(aod);
        (settings.turbidity, settings.visual_range) = (None, None);
    }
    ui.add(Slider::new(&mut settings.ozone, OZONE_RANGE_DU).text("ozone, DU"));
    ui.add(Slider::new(&mut settings.altitude, ALTITUDE_RANGE_M).text("altitude, m"));
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
