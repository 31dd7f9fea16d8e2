//! `skylight sky`: figures of a daylight, all models beside each other, its spectra, and the convergence of irradiance methods. Needs no device.

use serde_json::json;

use super::light::Light;
use super::sky_report::SkyReport;
use super::{plot_spectrum, plot_study, sky_compare};
use crate::cli::SkyArgs;
use crate::daylight::IrradianceMethod;
use crate::daylight::convergence::{Convergence, exponent, study};
use crate::error::Result;
use crate::options::{OptionValues, name};
use crate::output::{check_writable, print, write_text};

/// Defaults to the exact irradiance, except with a preset: speed does not matter here.
pub fn exact_by_default(options: &mut OptionValues) {
    if options.get("preset").is_none() {
        options.set_default("irradiance", IrradianceMethod::Exact);
    }
}

/// Prints the figures and draws the plot if requested.
///
/// # Errors
/// Invalid options, or a file that cannot be written.
pub fn run(args: &SkyArgs, mut options: OptionValues) -> Result<()> {
    if let Some(path) = &args.plot {
        check_writable(path)?;
    }
    exact_by_default(&mut options);
    let light = Light::new(&options)?;
    super::tell_no_device("sky", &light.settings);
    super::check_strict(&light.settings, light.daylight.warnings.iter())?;
    let (text, drawing) = if args.irradiance_study {
        study_text(args, &light)
    } else if args.compare {
        (sky_compare::text(&light, args.json), None)
    } else {
        report_text(args, &light)?
    };
    if let (Some(path), Some(drawing)) = (&args.plot, drawing) {
        write_text(path, &drawing)?;
    }
    print(&format!("{}\n", text.trim_end()))
}

fn report_text(args: &SkyArgs, light: &Light) -> Result<(String, Option<String>)> {
    let report = SkyReport::new(light, &args.directions)?;
    let text = if args.json {
        format!("{:#}", json!(report))
    } else {
        report.to_string()
    };
    let drawing = args.plot.as_ref().map(|_| plot_spectrum::draw(light));
    Ok((text, drawing))
}

fn study_text(args: &SkyArgs, light: &Light) -> (String, Option<String>) {
    let rows = study(|direction| light.daylight.radiance(direction));
    let text = if args.json {
        study_json(&rows)
    } else {
        study_table(&rows)
    };
    let drawing = args.plot.as_ref().map(|_| plot_study::draw(&rows));
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

/// The table in the documentation of [`crate::daylight::irradiance`].
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
