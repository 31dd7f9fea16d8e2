//! The hourly matrix in Radiance's form: a line for each record of the weather file, month, day, hour of its middle, lux of every sensor.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use crate::daylight::weather::Weather;
use crate::error::{Error, Result};
use crate::output::write_lines;
use crate::sensors::{Shard, Year, YearLight};

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

/// The matrix of a shard: `year_3-of-12.ill` for `year.ill`.
pub(super) fn of_shard(path: &Path, shard: Shard) -> PathBuf {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
    let Shard { number, of } = shard;
    path.with_file_name(format!("{stem}_{number}-of-{of}.ill"))
}

/// Writes the matrix of all sensors from those of parts: each a file with the numbers of its sensors, together every sensor once.
///
/// # Errors
/// A part cannot be read or has another form, or the file cannot be written.
pub(super) fn merge(path: &Path, parts: &[(PathBuf, Vec<usize>)]) -> Result<()> {
    let failed = |path: &Path, reason: String| Error::Read {
        path: path.to_owned(),
        reason,
    };
    let mut files = Vec::new();
    for (path, _) in parts {
        let file = File::open(path).map_err(|e| failed(path, e.to_string()))?;
        files.push(BufReader::new(file));
    }
    let numbers = parts.iter().map(|(_, numbers)| numbers);
    let mut order: Vec<(usize, [usize; 2])> = Vec::new();
    for (part, numbers) in numbers.enumerate() {
        order.extend(numbers.iter().enumerate().map(|(at, n)| (*n, [part, at])));
    }
    order.sort_unstable();
    let mut fault = None;
    let mut texts = vec![String::new(); parts.len()];
    let lines = std::iter::from_fn(|| {
        for ((file, text), (path, _)) in files.iter_mut().zip(&mut texts).zip(parts) {
            text.clear();
            if let Err(error) = file.read_line(text) {
                fault = Some(failed(path, error.to_string()));
                return None;
            }
        }
        let line = merged(&texts, &order);
        if line.is_none() && texts.iter().any(|text| !text.is_empty()) {
            fault = Some(failed(
                &parts[0].0,
                "its hours are not those of the others".into(),
            ));
        }
        line
    });
    let written = write_lines(path, lines);
    fault.map_or(written, Err)
}

/// A line of all; `None` at the end, or if the lines do not fit together.
fn merged(texts: &[String], order: &[(usize, [usize; 2])]) -> Option<String> {
    let words: Vec<Vec<&str>> = texts
        .iter()
        .map(|text| text.trim_end().split(' ').collect())
        .collect();
    let hour = words.first()?.get(..3)?;
    let mut line = hour.join(" ");
    if words.iter().any(|own| own.get(..3) != Some(hour)) {
        return None;
    }
    for (_, [part, at]) in order {
        line.push(' ');
        line += words[*part].get(3 + at)?;
    }
    line.push('\n');
    Some(line)
}
