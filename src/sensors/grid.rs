//! Files of sensors: Radiance's `.pts` and tables in CSV.

use std::path::{Path, PathBuf};

use glam::DVec3;
use thiserror::Error;

use super::Sensor;

/// Why a file of sensors cannot be used.
#[derive(Debug, Error, PartialEq, Eq)]
pub enum GridError {
    /// It cannot be read.
    #[error("{}: {reason}", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's reason.
        reason: String,
    },
    /// A line is no sensor.
    #[error("{}, line {line}: {what}", path.display())]
    Line {
        /// The file.
        path: PathBuf,
        /// From 1.
        line: usize,
        /// What is wrong, and what belongs there.
        what: String,
    },
    /// No material has the name of a floor.
    #[error("no material \"{name}\" for --rooms; the model has {known}")]
    UnknownFloor {
        /// The name.
        name: String,
        /// Those of the model.
        known: String,
    },
    /// Nowhere is a place for a made sensor.
    #[error("{}", if *is_named { "no sensor fits above the floors of --rooms; choose a smaller --inset or another --plane" } else { "no room with a place for sensors, a level floor below a ceiling between walls; name the materials of floors with --rooms, or give --grid FILE" })]
    NoRoom {
        /// Whether floors were named.
        is_named: bool,
    },
    /// No material has the name of a façade.
    #[error("no material \"{name}\" for --facade; the model has {known}")]
    UnknownFacade {
        /// The name.
        name: String,
        /// Those of the model.
        known: String,
    },
    /// Nowhere is a place for a made sensor on a façade.
    #[error("{}", if *is_named { "no upright surface of the materials of --facade has a place for a sensor" } else { "no upright surface that faces outward and sees the sky; name the materials of façades with --facade=NAMES, or give --grid FILE" })]
    NoFacade {
        /// Whether materials were named.
        is_named: bool,
    },
    /// A floor has too many samples.
    #[error(
        "a floor of {metres} m is too large to look for rooms at this spacing; name the materials of floors with --rooms, or choose a larger --spacing"
    )]
    LargeFloor {
        /// Its length.
        metres: u32,
    },
    /// It has no sensor.
    #[error("{}: no sensors; each line is x y z, or x y z and a normal", path.display())]
    Empty {
        /// The file.
        path: PathBuf,
    },
}

/// Largest file that is read, bytes: some ten million sensors.
const MAX_BYTES: u64 = 1 << 30;

/// Reads the sensors of a file, in its order, relative to the `origin` of a scene.
///
/// A line has three numbers, a position in metres, and may have three more, a normal of any length (up without them). Numbers are
/// separated by blanks or commas; a first line of words names columns and is left out; lines after `#` are comments. A `.pts`
/// file is Radiance's, with +Z up and +Y north; any other is in the model's coordinates, with +Y up and −Z north.
///
/// # Errors
/// A file that cannot be read, a line that is no sensor, or no sensor at all.
pub fn read_grid(path: &Path, origin: DVec3) -> Result<Vec<Sensor>, GridError> {
    let unreadable = |reason: String| GridError::Unreadable {
        path: path.to_owned(),
        reason,
    };
    let size = std::fs::metadata(path).map_err(|e| unreadable(e.to_string()))?;
    if size.len() > MAX_BYTES {
        return Err(unreadable("larger than 1 GiB".to_owned()));
    }
    let bytes = std::fs::read(path).map_err(|e| unreadable(e.to_string()))?;
    let text = String::from_utf8_lossy(&bytes);
    let is_z_up = path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("pts"));
    parse(text.trim_start_matches('\u{feff}'), is_z_up, origin).map_err(|fault| match fault {
        Some((line, what)) => GridError::Line {
            path: path.to_owned(),
            line,
            what,
        },
        None => GridError::Empty {
            path: path.to_owned(),
        },
    })
}

/// Sensors of a text; of an error the line and what is wrong, or nothing where no sensor is.
fn parse(text: &str, is_z_up: bool, origin: DVec3) -> Result<Vec<Sensor>, Option<(usize, String)>> {
    let mut sensors = Vec::new();
    let mut has_header = false;
    for (at, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default();
        let words: Vec<&str> = line
            .split(|c: char| c == ',' || c == ';' || c.is_whitespace())
            .filter(|word| !word.is_empty())
            .collect();
        if words.is_empty() {
            continue;
        }
        let is_named = words.iter().all(|word| word.parse::<f32>().is_err());
        if is_named && sensors.is_empty() && !has_header {
            has_header = true;
            continue;
        }
        sensors.push(sensor(&words, is_z_up, origin).map_err(|what| Some((at + 1, what)))?);
    }
    if sensors.is_empty() {
        return Err(None);
    }
    Ok(sensors)
}

fn sensor(words: &[&str], is_z_up: bool, origin: DVec3) -> Result<Sensor, String> {
    let number = |word: &&str| match word.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err(format!("\"{word}\" is no number")),
    };
    let values: Vec<f64> = words.iter().map(number).collect::<Result<_, _>>()?;
    let (position, normal) = match values[..] {
        [x, y, z] => (DVec3::new(x, y, z), None),
        [x, y, z, a, b, c] => (DVec3::new(x, y, z), Some(DVec3::new(a, b, c))),
        _ => {
            return Err(format!(
                "{} numbers; a sensor is x y z, or x y z and a normal",
                values.len()
            ));
        }
    };
    let world = |v: DVec3| {
        if is_z_up {
            DVec3::new(v.x, v.z, -v.y)
        } else {
            v
        }
    };
    let normal = match normal {
        None => DVec3::Y,
        Some(normal) => world(normal)
            .try_normalize()
            .ok_or("a normal of no length; give a direction, or leave it out for up")?,
    };
    Ok(Sensor {
        position: (world(position) - origin).as_vec3(),
        normal: normal.as_vec3(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn points(text: &str, is_z_up: bool) -> Vec<([f32; 3], [f32; 3])> {
        let sensors = parse(text, is_z_up, DVec3::ZERO).expect("sensors");
        let plain = sensors
            .iter()
            .map(|s| (s.position.to_array(), s.normal.to_array()));
        plain.collect()
    }

    #[test]
    fn radiance_points_have_z_up_and_tables_the_models_axes() {
        let text = "1 2 3 0 0 2\n\n# a comment\n4\t5 6 0 -1 0 # facing south\r\n";
        let expected = [
            ([1.0, 3.0, -2.0], [0.0, 1.0, 0.0]),
            ([4.0, 6.0, -5.0], [0.0, 0.0, 1.0]),
        ];
        assert_eq!(points(text, true), expected);
        let table = "x,y,z,nx,ny,nz\n1, 2, 3, 0, 0, 2\n4,5,6,1,0,0\n";
        let expected = [
            ([1.0, 2.0, 3.0], [0.0, 0.0, 1.0]),
            ([4.0, 5.0, 6.0], [1.0, 0.0, 0.0]),
        ];
        assert_eq!(points(table, false), expected);
        assert_eq!(points("1 2 3", false), [([1.0, 2.0, 3.0], [0.0, 1.0, 0.0])]);
    }

    #[test]
    fn points_on_a_map_keep_their_digits() {
        let origin = DVec3::new(5e5, 0.0, -6.1e6);
        let sensors = parse("500001.125 6100002.0625 0.8", true, origin).expect("a sensor");
        assert_eq!(sensors[0].position.to_array(), [1.125, 0.8, -2.0625]);
    }

    #[test]
    fn lines_that_are_no_sensors_are_named() {
        let fault = |text| parse(text, false, DVec3::ZERO).expect_err("a fault");
        assert_eq!(fault("x y z\n# nothing\n"), None);
        let line = |text| fault(text).expect("a line");
        assert_eq!(line("1 2 3\n1 2\n").0, 2);
        assert_eq!(line("1 2 3\nx y z\n"), (2, "\"x\" is no number".to_owned()));
        assert_eq!(line("1 2 nan\n"), (1, "\"nan\" is no number".to_owned()));
        assert!(line("1 2 3 0 0 0").1.contains("no length"));
    }
}
