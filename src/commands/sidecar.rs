//! `--sidecar`: a JSON file beside pictures, films and sheets that tells how they were made.

use std::path::{Path, PathBuf};

use serde_json::{Map, Value, json};

use super::job::Job;
use crate::error::{Error, Result};
use crate::gpu::Context;
use crate::output::{Metadata, is_stdout, write_text};

/// Fails if there is no file to be beside of.
///
/// # Errors
/// The picture goes to standard output.
pub fn check(output: &Path) -> Result<()> {
    if is_stdout(output) {
        let what = "--sidecar writes a file beside the picture, and standard output has none; name a file with -o";
        return Err(Error::usage(what));
    }
    Ok(())
}

/// `picture.png.json` for `picture.png`.
pub fn beside(picture: &Path) -> PathBuf {
    let mut name = picture.as_os_str().to_owned();
    name.push(".json");
    name.into()
}

/// Writes a sidecar beside its picture.
///
/// # Errors
/// The file cannot be written.
pub fn write(picture: &Path, report: &Value) -> Result<()> {
    write_text(&beside(picture), &format!("{report:#}\n"))
}

/// The sidecar of a file that holds several pictures: theirs, as a list with this name.
pub fn of_several(file: &Path, name: &str, reports: &[Value]) -> Value {
    json!({ "file": file_name(file), name: reports })
}

fn file_name(file: &Path) -> Option<String> {
    Some(file.file_name()?.to_string_lossy().into_owned())
}

/// How a picture with these parameters was made. The same picture has the same one: no date, no duration.
pub fn report(job: &Job, context: &Context, picture: &Path, metadata: &Metadata) -> Value {
    let text = |name: &str| {
        let found = metadata.iter().find(|(own, _)| own == name);
        found.map(|(_, text)| text.as_str())
    };
    let number = |name: &str| text(name).and_then(|text| text.parse::<f64>().ok());
    let options = job.options_in_view().values().into_pairs().into_iter();
    let options: Map<String, Value> = options.map(|(name, text)| (name, text.into())).collect();
    let place = job.settings.sun.place().map(|(latitude, longitude, when)| {
        json!({ "latitude": latitude, "longitude": longitude, "when": when.to_rfc3339() })
    });
    let rgb = |v: glam::DVec3| v.to_array();
    let device = context.summary();
    json!({
        "file": file_name(picture),
        "version": env!("CARGO_PKG_VERSION"),
        "device": { "name": device.name, "driver": device.driver, "vulkan": device.api },
        "command": text("command"),
        "scene": job.name,
        "place": place,
        "sun": {
            "azimuth_deg": job.sun.azimuth_deg,
            "elevation_deg": job.sun.apparent_elevation_deg,
            "illuminance_rgb_lux": rgb(job.daylight.sun_illuminance),
        },
        "sky_illuminance_rgb_lux": rgb(job.daylight.sky_irradiance_up),
        "size": [job.settings.size.width, job.settings.size.height],
        "ev100": number("ev100 used"),
        "false_colour_range": text("false-colour-range used"),
        "samples": number("samples drawn").unwrap_or(job.settings.samples.into()) as u32,
        "noise": number("noise estimated"),
        "interrupted": text("interrupted"),
        "options": options,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sidecar_has_the_name_of_its_picture() {
        assert_eq!(beside(Path::new("a/b.png")), Path::new("a/b.png.json"));
        assert!(check(Path::new("-")).is_err() && check(Path::new("b.exr")).is_ok());
    }
}
