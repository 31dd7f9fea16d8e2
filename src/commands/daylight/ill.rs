//! The hourly matrix in Radiance's form: a line for each record of the weather file, month, day, hour of its middle, lux of every sensor.

use std::fmt::Write as _;
use std::path::Path;

use crate::daylight::weather::Weather;
use crate::error::Result;
use crate::output::write_text;
use crate::sensors::{Year, YearLight};

/// Writes the illuminances of a year that has kept them.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write(path: &Path, weather: &Weather, light: &YearLight, year: &Year) -> Result<()> {
    write_text(path, &text(weather, light, year))
}

fn text(weather: &Weather, light: &YearLight, year: &Year) -> String {
    let mut text = String::new();
    let mut lit = light.hours.iter().enumerate().peekable();
    for (number, record) in weather.records.iter().enumerate() {
        let _ = write!(text, "{} {} {}", record.month, record.day, record.hour);
        let hour = lit.next_if(|(_, hour)| hour.record == number);
        for sensor in &year.sensors {
            match hour {
                Some((at, _)) => {
                    let _ = write!(text, " {}", (sensor.lux[at] * 100.0).round() / 100.0);
                }
                None => text.push_str(" 0"),
            }
        }
        text.push('\n');
    }
    text
}
