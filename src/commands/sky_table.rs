//! The daylight report as a text table.

use std::fmt::{self, Display, Formatter};

use super::sky_report::{AXES, MeasuredPart, SkyPart, SkyReport, SunReport};
use crate::daylight::colour::luminance;

impl Display for SkyReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        for (name, value) in &self.inputs {
            line(f, name, value)?;
        }
        writeln!(f)?;
        self.sun.fmt(f)?;
        if let Some(almanac) = &self.almanac {
            almanac.fmt(f)?;
        }
        writeln!(f)?;
        self.sky.fmt(f)?;
        let total = self.global_horizontal_lux;
        line(f, "all light, horizontal", with_unit(total, "lux"))?;
        line(f, "ground", with_unit(self.ground.luminance, "cd/m²"))?;
        if !self.sky.samples.is_empty() {
            writeln!(f)?;
        }
        for sample in &self.sky.samples {
            let at = format!("toward {},{}", sample.azimuth_deg, sample.elevation_deg);
            line(f, &at, colour(sample.rgb, "cd/m²"))?;
        }
        for warning in &self.warnings {
            write!(f, "\nwarning: {warning}")?;
        }
        Ok(())
    }
}

impl Display for SunReport {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let (seen, truth) = (self.apparent_elevation_deg, self.elevation_deg);
        let [x, y, z] = self.direction;
        line(f, "sun's azimuth", format!("{:.3}°", self.azimuth_deg))?;
        line(
            f,
            "sun's elevation",
            format!("{seen:.3}° (true {truth:.3}°)"),
        )?;
        line(
            f,
            "direction",
            format!("{x:.5}, {y:.5}, {z:.5} (east, up, south)"),
        )?;
        line(f, "air mass", format!("{:.3}", self.air_mass))?;
        line(
            f,
            "sun, normal incidence",
            colour(self.illuminance_rgb, "lux"),
        )?;
        line(
            f,
            "sun, horizontal",
            with_unit(self.direct_horizontal_lux, "lux"),
        )?;
        line(f, "sun's disc", colour(self.luminance_rgb, "cd/m²"))?;
        line(
            f,
            "sun's temperature",
            kelvin(self.cct_k, "none: the sun gives no light"),
        )?;
        self.events(f)
    }
}

impl SunReport {
    fn events(&self, f: &mut Formatter<'_>) -> fmt::Result {
        if self.solar_noon.is_none() && self.sunrise.is_none() && self.sunset.is_none() {
            return Ok(());
        }
        let none = match self.polar {
            Some("day") => "none: polar day",
            Some(_) => "none: polar night",
            None => "none on this date",
        };
        let events = [
            ("sunrise", &self.sunrise),
            ("solar noon", &self.solar_noon),
            ("sunset", &self.sunset),
        ];
        for (name, moment) in events {
            line(f, name, moment.as_deref().unwrap_or(none))?;
        }
        Ok(())
    }
}

impl Display for SkyPart {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let [x, y] = self.zenith_chromaticity;
        let blue = "none: bluer than any black body";
        if let Some(measured) = &self.measured {
            measured.fmt(f)?;
        }
        line(f, "zenith", colour(self.zenith_rgb, "cd/m²"))?;
        line(
            f,
            "zenith's chromaticity",
            format!("{x:.4}, {y:.4} (CIE 1931 x, y)"),
        )?;
        line(f, "zenith's temperature", kelvin(self.zenith_cct_k, blue))?;
        line(f, "sky's temperature", kelvin(self.cct_k, blue))?;
        line(
            f,
            "sky, horizontal",
            colour(self.diffuse_horizontal_rgb, "lux"),
        )?;
        for (axis, name, _) in AXES {
            let e = self.irradiance[axis];
            line(
                f,
                &format!("sky and ground, {axis} {name}"),
                colour(e, "lux"),
            )?;
        }
        Ok(())
    }
}

impl Display for MeasuredPart {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        line(f, "clearness ε", format!("{:.3}", self.clearness))?;
        line(f, "brightness Δ", format!("{:.4}", self.brightness))?;
        line(f, "water in the air", format!("{:.2} cm", self.water_cm))?;
        let (sky, sun) = (self.diffuse_efficacy, self.direct_efficacy);
        let both = format!("{sky:.1} lm/W (sky), {sun:.1} lm/W (sun)");
        line(f, "luminous efficacies", both)
    }
}

pub(super) fn line(f: &mut Formatter<'_>, name: &str, value: impl Display) -> fmt::Result {
    writeln!(f, "{name:<26}{value}")
}

fn colour(rgb: [f64; 3], unit: &str) -> String {
    let total = luminance(rgb.into());
    let [r, g, b] = rgb.map(number);
    format!("{:<18} RGB {r} {g} {b}", with_unit(total, unit))
}

pub(super) fn with_unit(value: f64, unit: &str) -> String {
    format!("{} {unit}", number(value))
}

fn kelvin(value: Option<f64>, none: &str) -> String {
    value.map_or_else(|| none.to_owned(), |k| format!("{k:.0} K"))
}

/// Formats with four significant digits, or with all integer digits if there are more (below 10⁷).
pub(super) fn number(value: f64) -> String {
    let digits = 3 - value.abs().max(1e-300).log10().floor() as i32;
    match digits {
        _ if value == 0.0 => "0".to_owned(),
        ..=0 if value.abs() < 1e7 => format!("{value:.0}"),
        ..=0 | 9.. => format!("{value:.3e}"),
        digits => format!("{value:.*}", digits as usize),
    }
}

#[cfg(test)]
mod tests {
    use super::number;

    #[test]
    fn numbers_have_four_digits() {
        for (value, text) in [
            (0.0, "0"),
            (24_423.4, "24423"),
            (12.3456, "12.35"),
            (0.000_252, "0.0002520"),
            (1.882e9, "1.882e9"),
            (1e-9, "1.000e-9"),
        ] {
            assert_eq!(number(value), text);
        }
    }
}
