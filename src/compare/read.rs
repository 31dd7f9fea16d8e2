//! Reads pictures: EXR as scene-linear, other formats as sRGB.

use std::path::Path;

use exr::prelude::{ReadChannels as _, ReadLayers as _};

use super::{Picture, Referred};
use crate::error::{Error, Result};

/// Reads a picture: the channels R, G, B of an .exr (or Y, or the depth, as grey), or the sRGB values of other formats.
///
/// # Errors
/// The file is missing, not a picture, or has none of these channels.
pub fn read(path: &Path) -> Result<Picture> {
    let is_exr = path
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("exr"));
    let picture = if is_exr {
        read_exr(path)
    } else {
        read_display(path)
    };
    picture.map_err(|reason| Error::Read {
        path: path.to_owned(),
        reason,
    })
}

fn read_display(path: &Path) -> std::result::Result<Picture, String> {
    let decoded = image::ImageReader::open(path)
        .and_then(image::ImageReader::with_guessed_format)
        .map_err(|e| e.to_string())?
        .decode()
        .map_err(|e| e.to_string())?
        .to_rgb8();
    let size = [decoded.width() as usize, decoded.height() as usize];
    Ok(Picture::from_srgb8(size, decoded.as_raw()))
}

fn read_exr(path: &Path) -> std::result::Result<Picture, String> {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(path)
        .map_err(|e| e.to_string())?;
    let layer = image.layer_data;
    let channel = |name: &str| {
        let found = layer.channel_data.list.iter().find(|c| c.name.eq(name));
        found.map(|c| c.sample_data.values_as_f32().collect::<Vec<f32>>())
    };
    let planes = match (channel("R"), channel("G"), channel("B"), channel("Y")) {
        (Some(r), Some(g), Some(b), _) => [r, g, b],
        (_, _, _, Some(y)) => [y.clone(), y.clone(), y],
        _ => match ["depth.Z", "depth.T", "Z"].into_iter().find_map(channel) {
            Some(depth) => [depth.clone(), depth.clone(), depth],
            None => return Err("it has neither the channels R, G, B nor Y nor a depth".to_owned()),
        },
    };
    let [r, g, b] = &planes;
    Ok(Picture {
        size: [layer.size.0, layer.size.1],
        rgb: (0..r.len()).map(|i| [r[i], g[i], b[i]]).collect(),
        referred: Referred::Scene,
    })
}
