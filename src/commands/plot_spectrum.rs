//! The lecture's figure "Solar radiation": a 5800 K black body and the sun's spectrum, outside the atmosphere and at the ground.

use std::error::Error;

use plotters::prelude::*;

use super::light::Light;
use crate::daylight::spectrum::planck;
use crate::daylight::sunlight::{
    SUN_RANGE_NM, SUN_SOLID_ANGLE, air_mass, extraterrestrial_radiance, transmittance,
};

/// Temperature of the lecture's black body, K.
const KELVIN: f64 = 5800.0;
/// Wavelength axis, nm. The table covers part of it.
const DRAWN_NM: std::ops::Range<f64> = 250.0..1200.0;
/// Irradiance axis, W m⁻² nm⁻¹.
const DRAWN: std::ops::Range<f64> = 0.0..2.4;

/// The figure as SVG.
pub fn draw(light: &Light) -> String {
    let mut svg = String::new();
    // Writing to a string cannot fail.
    figure(&mut svg, light).expect("drawing to memory");
    svg
}

fn figure(svg: &mut String, light: &Light) -> Result<(), Box<dyn Error>> {
    let root = SVGBackend::with_string(svg, (900, 540)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut chart = ChartBuilder::on(&root)
        .caption(
            "Irradiance of the sun at normal incidence",
            ("sans-serif", 22),
        )
        .margin(12)
        .x_label_area_size(44)
        .y_label_area_size(56)
        .build_cartesian_2d(DRAWN_NM, DRAWN)?;
    let mesh = &mut chart.configure_mesh();
    mesh.x_desc("wavelength, nm").y_desc("W m⁻² nm⁻¹").draw()?;
    for (points, label, colour) in curves(light) {
        let series = LineSeries::new(points, colour.stroke_width(2));
        let legend = move |(x, y)| PathElement::new([(x, y), (x + 24, y)], colour.stroke_width(2));
        chart.draw_series(series)?.label(label).legend(legend);
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE)
        .border_style(BLACK)
        .label_font(("sans-serif", 14))
        .draw()?;
    root.present()?;
    Ok(())
}

/// Points (nm, W m⁻² nm⁻¹), label and colour of a curve.
type Curve = (Vec<(f64, f64)>, String, RGBColor);

/// The curves of the figure.
fn curves(light: &Light) -> [Curve; 3] {
    let elevation = light.conditions.sun_elevation_deg;
    let turbidity = light.turbidity();
    let mass = air_mass(elevation);
    let table = SUN_RANGE_NM.map(f64::from);
    let body = (250..=1200).map(f64::from);
    let body = body.map(|nm| (nm, planck(KELVIN, nm) * SUN_SOLID_ANGLE));
    let outside = |nm: f64| (nm, extraterrestrial_radiance(nm) * SUN_SOLID_ANGLE);
    // With the sun below the horizon there is no direct light.
    let shines = if elevation >= 0.0 { 1.0 } else { 0.0 };
    let attenuated = |(nm, e): (f64, f64)| (nm, shines * e * transmittance(nm, mass, turbidity));
    [
        (body.collect(), format!("black body, {KELVIN} K"), BLACK),
        (
            table.clone().map(outside).collect(),
            "outside the atmosphere (Preetham's table)".to_owned(),
            RGBColor(200, 120, 0),
        ),
        (
            table.map(outside).map(attenuated).collect(),
            format!("on the ground: turbidity {turbidity}, elevation {elevation:.1}°"),
            RGBColor(0, 90, 200),
        ),
    ]
}
