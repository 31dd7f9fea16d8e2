//! Bars of the passes' times as SVG.

use std::error::Error;

use plotters::coord::Shift;
use plotters::prelude::*;

use super::report::Report;
use super::statistics::Summary;

/// Height of a bar with its gap, pixels.
const ROW: u32 = 30;
/// Space for names, pixels.
const NAMES: i32 = 250;

/// The figure as SVG.
pub fn draw(report: &Report) -> String {
    let mut svg = String::new();
    // Nothing is written but the string, so that only a mistake in `figure` could fail.
    figure(&mut svg, report).expect("drawing to memory");
    svg
}

fn figure(svg: &mut String, report: &Report) -> Result<(), Box<dyn Error>> {
    let times = report.times();
    let height = ROW * times.len() as u32 + 130;
    let root = SVGBackend::with_string(svg, (960, height)).into_drawing_area();
    root.fill(&WHITE)?;
    let head = &report.head;
    let [width, rows] = head.size;
    let caption = format!(
        "{}, {} triangles, {width}x{rows}: median of {} frames",
        head.scene, head.triangles, head.frames
    );
    root.draw(&Text::new(caption, (16, 14), ("sans-serif", 20)))?;
    let below = format!("{}, {}; lines: 5 % to 95 %", head.device.name, head.commit);
    root.draw(&Text::new(below, (16, 40), ("sans-serif", 14)))?;
    let end = times.iter().map(|(_, t)| t.p95_ms).fold(0.0, f64::max);
    // One at least, so that an axis can be drawn.
    let end = if end > 0.0 { 1.08 * end } else { 1.0 };
    bars(&root.margin(64, 8, 0, 16), &times, end)?;
    root.present()?;
    Ok(())
}

fn bars(
    area: &DrawingArea<SVGBackend<'_>, Shift>,
    times: &[(&str, &Summary)],
    end: f64,
) -> Result<(), Box<dyn Error>> {
    let count = times.len();
    let mut chart = ChartBuilder::on(area)
        .x_label_area_size(40)
        .y_label_area_size(NAMES)
        .build_cartesian_2d(0.0..end, 0.0..count as f64)?;
    chart
        .configure_mesh()
        .disable_y_mesh()
        .disable_y_axis()
        .x_desc("milliseconds")
        .draw()?;
    for (i, (name, time)) in times.iter().enumerate() {
        // The first row is on top.
        let middle = (count - i) as f64 - 0.5;
        let whole = name.starts_with("whole");
        let colour = if whole {
            RGBColor(110, 110, 110)
        } else {
            RGBColor(70, 130, 200)
        };
        let corners = [(0.0, middle - 0.35), (time.median_ms, middle + 0.35)];
        chart.draw_series([Rectangle::new(corners, colour.filled())])?;
        let range = [(time.p5_ms, middle), (time.p95_ms, middle)];
        chart.draw_series([PathElement::new(range, BLACK.stroke_width(2))])?;
        let (_, y) = chart.backend_coord(&(0.0, middle));
        let (_, top) = area.get_base_pixel();
        let text = format!("{name}  {:.2}", time.median_ms);
        let style = ("sans-serif", 15)
            .into_text_style(area)
            .pos(right_aligned());
        area.draw(&Text::new(text, (NAMES - 8, y - top), style))?;
    }
    Ok(())
}

fn right_aligned() -> plotters::style::text_anchor::Pos {
    use plotters::style::text_anchor::{HPos, Pos, VPos};
    Pos::new(HPos::Right, VPos::Center)
}
