//! `skylight sky --compare`: every model of the sky at the same moment, beside the levels that standards publish.

use std::fmt::Write as _;

use glam::DVec3;
use serde::Serialize;
use serde_json::json;

use super::light::Light;
use super::sky_report::temperature;
use super::sky_table::number;
use crate::daylight::cie::{SkyCover, daylight_availability};
use crate::daylight::colour::{luminance, xyz_from_rgb};
use crate::daylight::sky::{Conditions, Daylight, SkyModel, twilight_illuminance};
use crate::options::{Choice, name};

/// A model at the moment.
#[derive(Debug, Serialize)]
struct Row {
    model: &'static str,
    /// By the sky on a horizontal plane, lux.
    sky_lux: f64,
    /// By the sun at normal incidence, lux.
    sun_lux: f64,
    /// By both, or by sky and moon at night, on a horizontal plane, lux.
    global_lux: f64,
    /// Luminance of the zenith, cd/m².
    zenith_luminance: f64,
    /// Correlated colour temperature of the zenith and of the light on a horizontal plane, K.
    zenith_cct_k: Option<f64>,
    sky_cct_k: Option<f64>,
}

/// A published level of the sky's illuminance of a horizontal plane.
#[derive(Debug, Serialize)]
struct Bound {
    source: &'static str,
    sky_lux: f64,
}

/// The comparison as a table or as JSON.
pub fn text(light: &Light, as_json: bool) -> String {
    let rows = rows(light);
    let bounds = bounds(light.conditions.sun_elevation_deg);
    if as_json {
        return format!("{:#}", json!({ "models": rows, "published": bounds }));
    }
    table(&rows, &bounds, needs_measurement(light))
}

fn needs_measurement(light: &Light) -> bool {
    light.settings.dni.is_none() || light.settings.dhi.is_none()
}

fn rows(light: &Light) -> Vec<Row> {
    let models = SkyModel::VALUES.iter().map(|(model, ..)| *model);
    models
        .filter(|model| *model != SkyModel::Perez || !needs_measurement(light))
        .map(|model| row(model, &light.conditions))
        .collect()
}

fn row(model: SkyModel, conditions: &Conditions) -> Row {
    let daylight = Daylight::new(&Conditions {
        model,
        ..*conditions
    });
    let (sky, zenith) = (daylight.sky_irradiance_up, daylight.radiance(DVec3::Y));
    let sun_lux = luminance(daylight.sun_illuminance);
    let cct = |rgb: DVec3| temperature(xyz_from_rgb(rgb));
    Row {
        model: name(model),
        sky_lux: luminance(sky),
        sun_lux,
        global_lux: luminance(daylight.horizontal()),
        zenith_luminance: luminance(zenith),
        zenith_cct_k: cct(zenith),
        sky_cct_k: cct(sky),
    }
}

/// By day the levels of the IES; in twilight that of the American Meteorological Society, interpolated.
fn bounds(elevation_deg: f64) -> Vec<Bound> {
    let ies = |source, cover| Bound {
        source,
        sky_lux: daylight_availability(cover, elevation_deg),
    };
    if elevation_deg >= 0.0 {
        return vec![
            ies("IES 1984, overcast", SkyCover::Overcast),
            ies("IES 1984, clear", SkyCover::Clear),
            ies("IES 1984, partly cloudy", SkyCover::PartlyCloudy),
        ];
    }
    let at_sunset = daylight_availability(SkyCover::Clear, 0.0);
    vec![Bound {
        source: "AMS Glossary, clear twilight",
        sky_lux: twilight_illuminance(elevation_deg, at_sunset),
    }]
}

fn table(rows: &[Row], bounds: &[Bound], is_unmeasured: bool) -> String {
    let kelvin = |k: Option<f64>| k.map_or_else(|| "-".to_owned(), |k| format!("{k:.0}"));
    let mut text = format!(
        "{:<12}{:>12}{:>12}{:>12}{:>14}{:>12}{:>10}\n",
        "model", "sky, lux", "sun, lux", "global, lux", "zenith, cd/m²", "zenith, K", "sky, K"
    );
    for row in rows {
        let [sky, sun, global, zenith] = [
            row.sky_lux,
            row.sun_lux,
            row.global_lux,
            row.zenith_luminance,
        ]
        .map(number);
        let (zenith_k, sky_k) = (kelvin(row.zenith_cct_k), kelvin(row.sky_cct_k));
        let _ = writeln!(
            text,
            "{:<12}{sky:>12}{sun:>12}{global:>12}{zenith:>14}{zenith_k:>12}{sky_k:>10}",
            row.model
        );
    }
    if is_unmeasured {
        text += "perez       needs --dni and --dhi\n";
    }
    text += "\npublished, sky on a horizontal plane:\n";
    for Bound { source, sky_lux } in bounds {
        let _ = writeln!(text, "{source:<32}{} lux", number(*sky_lux));
    }
    text + "\nsky and global: on a horizontal plane; sun: at normal incidence\n"
}
