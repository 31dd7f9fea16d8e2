//! Plot of error against samples for each irradiance method, with logarithmic axes.

use std::error::Error;

use plotters::prelude::*;

use crate::daylight::IrradianceMethod;
use crate::daylight::convergence::Convergence;
use crate::options::name;

/// The figure as SVG.
pub fn draw(rows: &[Convergence]) -> String {
    let mut svg = String::new();
    // Writing to a string cannot fail.
    figure(&mut svg, rows).expect("drawing to memory");
    svg
}

fn figure(svg: &mut String, rows: &[Convergence]) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::with_string(svg, (900, 540)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(
            "Error of the sky's irradiance, rms over 26 normals",
            ("sans-serif", 22),
        )
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d((10f64..40_000.0).log_scale(), (1e-3..100.0).log_scale())?;
    let percent = |v: &f64| format!("{v}");
    chart
        .configure_mesh()
        .x_desc("radiances evaluated: directions for each normal, or texels for all")
        .y_desc("error, % of E(up)")
        .y_label_formatter(&percent)
        .draw()?;
    let curves = [
        (IrradianceMethod::MonteCarlo, BLACK),
        (IrradianceMethod::Quasi, RGBColor(0, 90, 200)),
        (IrradianceMethod::Exact, RGBColor(0, 140, 60)),
        (IrradianceMethod::Sh, RGBColor(200, 40, 40)),
    ];
    for (method, colour) in curves {
        let of_method = rows.iter().filter(|row| row.method == method);
        let points: Vec<(f64, f64)> = of_method
            .map(|row| (f64::from(row.samples), 100.0 * row.rms))
            .collect();
        let dots = points.iter().map(|p| Circle::new(*p, 4, colour.filled()));
        let label = name(method);
        chart
            .draw_series(dots)?
            .label(label)
            .legend(move |(x, y)| Circle::new((x + 12, y), 4, colour.filled()));
        chart.draw_series(LineSeries::new(points, colour.stroke_width(2)))?;
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::LowerLeft)
        .background_style(WHITE)
        .border_style(BLACK)
        .label_font(("sans-serif", 14))
        .draw()?;
    root.present()?;
    Ok(())
}
