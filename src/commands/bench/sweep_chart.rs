//! Cost against size on logarithmic axes, as SVG.

use std::error::Error;

use plotters::prelude::*;

use super::sweep::{Curve, SweepReport};

/// Curves that never reach this share of the costliest are left out of the picture.
const LEAST: f64 = 0.01;

/// The figure as SVG.
pub fn draw(report: &SweepReport) -> String {
    let mut svg = String::new();
    // Nothing is written but the string, so that only a mistake in `figure` could fail.
    figure(&mut svg, report).expect("drawing to memory");
    svg
}

fn figure(svg: &mut String, report: &SweepReport) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::with_string(svg, (1100, 620)).into_drawing_area();
    root.fill(&WHITE)?;
    let largest = |row: &Curve| row.times.iter().map(|t| t.median_ms).fold(0.0, f64::max);
    let end = report.rows.iter().map(largest).fold(1e-3, f64::max);
    let shown: Vec<&Curve> = report
        .rows
        .iter()
        .filter(|row| largest(row) >= LEAST * end)
        .collect();
    let least = shown
        .iter()
        .flat_map(|row| row.times.iter().map(|t| t.median_ms))
        .fold(end, f64::min)
        .max(1e-4);
    let (first, last) = (report.sizes.first(), report.sizes.last());
    let sizes = (0.9 * first.unwrap_or(&1.0), 1.1 * last.unwrap_or(&10.0));
    let (title, device) = (&report.sweep, &report.head.device.name);
    let mut chart = ChartBuilder::on(&root)
        .caption(
            format!("{}: cost against {title}, {device}", report.head.scene),
            ("sans-serif", 20),
        )
        .margin(12)
        .margin_right(330)
        .x_label_area_size(44)
        .y_label_area_size(64)
        .build_cartesian_2d(
            (sizes.0..sizes.1).log_scale(),
            (0.7 * least..1.4 * end).log_scale(),
        )?;
    chart
        .configure_mesh()
        .x_desc(report.unit.as_str())
        .y_desc("milliseconds (median)")
        .x_label_formatter(&|v| format!("{v}"))
        .y_label_formatter(&|v| format!("{v}"))
        .draw()?;
    for (i, row) in shown.into_iter().enumerate() {
        let colour = Palette99::pick(i).to_rgba();
        let times = row.times.iter().map(|t| t.median_ms);
        let points: Vec<(f64, f64)> = report.sizes.iter().copied().zip(times).collect();
        chart.draw_series(points.iter().map(|p| Circle::new(*p, 3, colour.filled())))?;
        let line = LineSeries::new(points, colour.stroke_width(2));
        chart.draw_series(line)?;
        let y = 60 + 22 * i as i32;
        root.draw(&Circle::new((790, y + 7), 5, colour.filled()))?;
        let text = format!("{}: size^{:.2}", row.name, row.exponent);
        root.draw(&Text::new(text, (804, y), ("sans-serif", 15)))?;
    }
    root.present()?;
    Ok(())
}
