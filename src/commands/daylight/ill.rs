//! The hourly matrix in Radiance's form: a line for each record of the weather file, month, day, hour of its middle, lux of every sensor.

use std::fmt::Write as _;
use std::path::Path;

use crate::daylight::weather::Weather;
use crate::error::Result;
use crate::output::write_lines;
use crate::sensors::{Year, YearLight};

/// Writes the illuminances of a year that has kept them.
///
/// # Errors
/// The file cannot be written.
pub(super) fn write(path: &Path, weather: &Weather, light: &YearLight, year: &Year) -> Result<()> {
    let mut lit = light.hours.iter().enumerate().peekable();
    let lines = weather.records.iter().enumerate().map(|(number, record)| {
        let mut line = format!("{} {} {}", record.month, record.day, record.hour);
        let hour = lit.next_if(|(_, hour)| hour.record == number);
        for sensor in &year.sensors {
            match hour {
                Some((at, _)) => {
                    let lux = f64::from(sensor.lux[at]);
                    let _ = write!(line, " {}", (lux * 100.0).round() / 100.0);
                }
                None => line.push_str(" 0"),
            }
        }
        line.push('\n');
        line
    });
    write_lines(path, lines)
}
