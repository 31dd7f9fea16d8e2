//! `skylight sky`: figures of a daylight, its spectra, and the convergence of irradiance methods. Needs no device.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::light::Light;
use super::sky_report::SkyReport;
use super::{plot_spectrum, plot_study, svg_path};
use crate::daylight::IrradianceMethod;
use crate::daylight::convergence::{Convergence, exponent, study};
use crate::error::Result;
use crate::output::{check_writable, print, write_text};
use crate::settings::{Direction, Options, Preset, name};

/// Arguments of `sky`.
#[derive(Debug, Clone, Default, PartialEq, Args)]
pub struct SkyWishes {
    /// Print JSON instead of a table.
    #[arg(long)]
    pub json: bool,
    /// Also print the radiance in this direction, degrees; may be repeated.
    #[arg(long = "direction", value_name = "AZ,EL", value_parser = crate::settings::direction, allow_hyphen_values = true)]
    pub directions: Vec<Direction>,
    /// Draw the sun's spectra (or the study) to an SVG file.
    #[arg(long, value_name = "FILE.svg", value_parser = svg_path)]
    pub plot: Option<PathBuf>,
    /// Print instead the error of each irradiance method over its number of samples for this sky.
    #[arg(long)]
    pub irradiance_study: bool,
}

/// Selects the exact sum for the irradiance unless the user chose a method: speed does not matter here.
pub fn exact_by_default(options: &mut Options) {
    if options.preset != Some(Preset::Lecture) {
        options.irradiance.get_or_insert(IrradianceMethod::Exact);
    }
}

/// Prints the figures and draws the plot if requested.
///
/// # Errors
/// Invalid options, or a file that cannot be written.
pub fn run(wishes: &SkyWishes, mut options: Options) -> Result<()> {
    if let Some(path) = &wishes.plot {
        check_writable(path)?;
    }
    exact_by_default(&mut options);
    let light = Light::new(options)?;
    let (text, drawing) = if wishes.irradiance_study {
        study_text(wishes, &light)
    } else {
        report_text(wishes, &light)?
    };
    if let (Some(path), Some(drawing)) = (&wishes.plot, drawing) {
        write_text(path, &drawing)?;
    }
    print(&format!("{}\n", text.trim_end()))
}

fn report_text(wishes: &SkyWishes, light: &Light) -> Result<(String, Option<String>)> {
    let report = SkyReport::new(light, &wishes.directions)?;
    let text = if wishes.json {
        format!("{:#}", json!(report))
    } else {
        report.to_string()
    };
    let drawing = wishes.plot.as_ref().map(|_| plot_spectrum::draw(light));
    Ok((text, drawing))
}

fn study_text(wishes: &SkyWishes, light: &Light) -> (String, Option<String>) {
    let rows = study(|direction| light.daylight.radiance(direction));
    let text = if wishes.json {
        study_json(&rows)
    } else {
        study_table(&rows)
    };
    let drawing = wishes.plot.as_ref().map(|_| plot_study::draw(&rows));
    (text, drawing)
}

fn study_json(rows: &[Convergence]) -> String {
    let row =
        |r: &Convergence| json!({ "method": name(r.method), "samples": r.samples, "rms": r.rms });
    let table: Vec<_> = rows.iter().map(row).collect();
    let exponents = json!({
        "monte-carlo": exponent(rows, IrradianceMethod::MonteCarlo),
        "quasi": exponent(rows, IrradianceMethod::Quasi),
    });
    format!("{:#}", json!({ "study": table, "exponents": exponents }))
}

/// The table that the documentation of [`crate::daylight::irradiance`] holds.
fn study_table(rows: &[Convergence]) -> String {
    let mut text = String::from("| method | samples | rms error of E(up) |\n|---|---|---|\n");
    for row in rows {
        let (method, percent) = (name(row.method), 100.0 * row.rms);
        text += &format!("| {method} | {} | {percent:.4} % |\n", row.samples);
    }
    for method in [IrradianceMethod::MonteCarlo, IrradianceMethod::Quasi] {
        let power = exponent(rows, method);
        text += &format!("\n{}: error falls as samples^{power:.2}", name(method));
    }
    text
}
