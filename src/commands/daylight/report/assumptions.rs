//! On what a result rests: place, weather, sky, surfaces, sensors, settings.

use std::path::Path;

use glam::{DVec3, Vec3};

use super::super::results::Results;
use super::rows;
use crate::daylight::colour::luminance;
use crate::daylight::metrics::{BLINDS_LUX, BLINDS_SHARE, Blinds, CLOSED_BLINDS};
use crate::scene::{Reflectances, Scene};

/// Letters of a digest that are told.
const DIGEST: usize = 16;

/// A table of names and values.
pub fn assumptions(results: &Results) -> String {
    let mut lines: Vec<(&str, String)> = Vec::new();
    lines.push(("model", file(&results.args.scene)));
    of_weather(results, &mut lines);
    lines.push((
        "ground below the horizon",
        format!("reflects {} %", 100.0 * results.settings.ground_albedo),
    ));
    lines.push(("sensors", of_sensors(results)));
    lines.push((
        "occupied hours",
        format!(
            "{} every day, local standard time, no daylight saving: {} h",
            results.args.schedule,
            results.measures.occupied_hours()
        ),
    ));
    let thresholds: Vec<String> = results
        .measures
        .thresholds
        .iter()
        .map(f64::to_string)
        .collect();
    lines.push(("thresholds", format!("{} lux", thresholds.join(", "))));
    lines.push(("blinds", of_blinds(results)));
    lines.push(("bounces", results.settings.bounces.to_string()));
    lines.push(("seed", results.settings.seed.to_string()));
    lines.push((
        "paths of a sensor, mean",
        results.outcome.paths().to_string(),
    ));
    lines.push(("error", format!(
        "asked {}, reached {:.4}: largest root mean square over the sensors of a metric's standard error; 0.01 is one point of a percentage",
        results.args.error, results.year.error
    )));
    lines.push(("method", "daylight coefficients by path tracing; standard errors by eight independent repetitions (jackknife)".to_owned()));
    lines.push((
        "version",
        concat!("skylight ", env!("CARGO_PKG_VERSION")).to_owned(),
    ));
    let words = std::env::args().collect::<Vec<_>>();
    if let Ok(line) = shlex::try_join(words.iter().skip(1).map(String::as_str)) {
        lines.push(("command", format!("skylight {line}")));
    }
    let lines: Vec<Vec<String>> = lines
        .into_iter()
        .map(|(name, value)| vec![name.to_owned(), value])
        .collect();
    rows(&[], 2, &lines)
}

/// Name of a file and the start of its BLAKE3 digest.
fn file(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let Ok(bytes) = std::fs::read(path) else {
        return format!("{name}, part of skylight");
    };
    let digest = blake3::hash(&bytes).to_hex();
    format!("{name}, BLAKE3 {}", &digest[..DIGEST])
}

fn of_weather(results: &Results, lines: &mut Vec<(&str, String)>) {
    let (Some(weather), Some(path)) = (results.weather, &results.args.weather) else {
        return;
    };
    let station = &weather.station;
    lines.push((
        "place",
        format!(
            "{}; latitude {}°, longitude {}°, UTC{:+}, {} m above the sea",
            station.name,
            station.place.latitude,
            station.place.longitude,
            station.zone_hours,
            station.elevation_m
        ),
    ));
    let hours = weather.records.len() as f64 * weather.step_hours;
    lines.push(("weather file", format!("{}; {hours} h", file(path))));
    let clock = match results.clock {
        None => "not checked: the file has not all three irradiances".to_owned(),
        Some(clock) if clock.is_off() => format!(
            "off: its irradiances are those of the sun {:+} min ({:.1} W/m² rms, {:.1} without a shift); results are of the file's clock",
            clock.minutes, clock.residual_w, clock.unshifted_residual_w
        ),
        Some(clock) => format!(
            "passed: closes best at {:+} min, {:.1} W/m² rms",
            clock.minutes, clock.residual_w
        ),
    };
    lines.push(("clock of the file", clock));
    lines.push(("sky", "Perez, Seals & Michalsky 1993, efficacies of Perez et al. 1990 with the file's dew point; 2 305 patches (Reinhart MF:4)".to_owned()));
    lines.push(("sun", "SPA, in the middle of each hour; direct by rays to its disc, reflected from every eighth day".to_owned()));
}

fn of_blinds(results: &Results) -> String {
    match results.args.blinds {
        Blinds::None => "none".to_owned(),
        Blinds::Lm83 => {
            let hours = results.measures.closed_hours();
            let hours: Vec<String> = hours.iter().map(f64::to_string).collect();
            format!(
                "LM-83-12, 2.2.6: the windows of a room are one group, closed in hours in which more than {} % of its sensors have {BLINDS_LUX} lux of direct sun, {} of the occupied hours (each room); closed they leave {} % of all light; for da, cda, udi, sda",
                100.0 * BLINDS_SHARE,
                hours.join(", "),
                100.0 * CLOSED_BLINDS
            )
        }
    }
}

fn of_sensors(results: &Results) -> String {
    let (args, count) = (results.args, results.sensors.len());
    if args.facade.is_some() {
        return format!(
            "{count}, made {} m before façades, at most {} m apart",
            args.offset, args.spacing
        );
    }
    match (&args.grid, args.plane) {
        (Some(grid), _) => format!("{count}, {}", file(grid)),
        (None, Some(height)) => format!(
            "{count}, made {height} m above floors, at most {} m apart, {} m from walls",
            args.spacing, args.inset
        ),
        _ => count.to_string(),
    }
}

/// Area, reflectance and transmittance of each material.
pub fn materials(scene: &Scene) -> String {
    let means = Reflectances::new(scene);
    let mut sums = vec![[0.0_f64; 2]; scene.materials.len()];
    for (triangle, material) in scene.triangle_materials().iter().enumerate() {
        let [a, b, c] = [0, 1, 2]
            .map(|k| Vec3::from(scene.positions[scene.indices[3 * triangle + k] as usize]));
        let area = f64::from(0.5 * (b - a).cross(c - a).length());
        let sum = &mut sums[*material as usize];
        sum[0] += area;
        sum[1] += area * grey(means.of(triangle as u32).diffuse);
    }
    let lines: Vec<Vec<String>> = scene
        .materials
        .iter()
        .zip(sums)
        .filter(|(_, [area, _])| *area > 0.0)
        .map(|(material, [area, reflected])| {
            let reflectance = match material.glass {
                None => format!("{:.3}", reflected / area),
                Some(_) => "pane".to_owned(),
            };
            let through = material.glass.map(|t| format!("{:.3}", grey(t)));
            vec![
                material.name.clone(),
                format!("{area:.1}"),
                reflectance,
                through.unwrap_or_default(),
            ]
        })
        .collect();
    let head = [
        "material",
        "area, m²",
        "diffuse reflectance",
        "transmittance at normal incidence",
    ];
    rows(&head, 1, &lines)
        + "<p class=\"small\">Luminance of linear BT.709; textures by their mean over the surface. Panes: clear glass, Fresnel's formulas, both faces.</p>\n"
}

fn grey(rgb: [f32; 3]) -> f64 {
    luminance(DVec3::from(rgb.map(f64::from)))
}
