//! OpenEXR: scene-linear 32-bit floats, parameters as attributes, further quantities as named layers.

use std::io::Cursor;
use std::path::Path;

use chrono::DateTime;
use exr::compression::Compression;
use exr::image::Blocks;
use exr::image::write::WritableImage as _;
use exr::math::Vec2;
use exr::meta::attribute::{AttributeValue, Chromaticities, LineOrder, Text};
use exr::prelude::{AnyChannel, AnyChannels, Encoding, FlatSamples, Image, LayerAttributes};

use super::exr_header::sort_attributes;
use super::{Metadata, write_error, write_whole};
use crate::error::Result;

/// Channels of a layer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Channels {
    /// R, G, B.
    Rgb,
    /// X, Y, Z: a vector.
    Xyz,
    /// Y: one number.
    Single,
    /// Z: a distance.
    Depth,
}

impl Channels {
    pub(super) const fn names(self) -> &'static [&'static str] {
        match self {
            Self::Rgb => &["R", "G", "B"],
            Self::Xyz => &["X", "Y", "Z"],
            Self::Single => &["Y"],
            Self::Depth => &["Z"],
        }
    }
}

/// One quantity: texels in rows from the top left, in file units.
#[derive(Debug, Clone)]
pub struct Layer {
    /// Name before the dot of its channels; empty for the picture itself.
    pub name: &'static str,
    /// Channels.
    pub channels: Channels,
    /// Texels; unused components are ignored.
    pub texels: Vec<[f32; 4]>,
}

/// Writes layers of one size. Channels are named `layer.R`, or `R` for the unnamed layer.
///
/// # Errors
/// The file cannot be written; an existing file stays unchanged.
pub fn write_exr(path: &Path, size: [u32; 2], layers: &[Layer], metadata: &Metadata) -> Result<()> {
    write_whole(path, &encode_exr(path, size, layers, metadata)?)
}

/// The bytes of [`write_exr`]; `path` is for error messages.
///
/// # Errors
/// The picture cannot be encoded, for example because it is empty.
pub fn encode_exr(
    path: &Path,
    size: [u32; 2],
    layers: &[Layer],
    metadata: &Metadata,
) -> Result<Vec<u8>> {
    encode(size, layers, metadata).map_err(|e| write_error(path, e))
}

/// The most widely supported encoding: ZIP, scan lines from the top.
pub(super) const ENCODING: Encoding = Encoding {
    compression: Compression::ZIP16,
    blocks: Blocks::ScanLines,
    line_order: LineOrder::Increasing,
};

/// Primaries and white point of BT.709.
pub(super) const BT709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

fn encode(
    size: [u32; 2],
    layers: &[Layer],
    metadata: &Metadata,
) -> std::result::Result<Vec<u8>, exr::error::Error> {
    let channels = layers
        .iter()
        .flat_map(|layer| {
            layer
                .channels
                .names()
                .iter()
                .enumerate()
                .map(|(i, channel)| {
                    let name = full_name(layer.name, channel);
                    let samples = layer.texels.iter().map(|t| t[i]).collect();
                    AnyChannel::new(name.as_str(), FlatSamples::F32(samples))
                })
        })
        .collect();
    let size = Vec2(size[0] as usize, size[1] as usize);
    let attributes = attributes(metadata);
    let layer = exr::image::Layer::new(size, attributes, ENCODING, AnyChannels::sort(channels));
    let mut image = Image::from_layer(layer);
    image.attributes.chromaticities = Some(BT709);
    let mut bytes = Cursor::new(Vec::new());
    image.write().to_buffered(&mut bytes)?;
    sort_attributes(&mut bytes)?;
    Ok(bytes.into_inner())
}

/// Name of a channel in the file.
pub(super) fn full_name(layer: &str, channel: &str) -> String {
    if layer.is_empty() {
        channel.to_owned()
    } else {
        format!("{layer}.{channel}")
    }
}

/// Names of the metadata that standard attributes are made of: degrees, a moment of RFC 3339, cd/m² of a 1.
pub const LATITUDE: &str = "latitude";
/// See [`LATITUDE`].
pub const LONGITUDE: &str = "longitude";
/// See [`LATITUDE`].
pub const MOMENT: &str = "moment of the sun";
/// See [`LATITUDE`].
pub const WHITE_LUMINANCE: &str = "white luminance";

/// The parameters, the name of the program, and what of them has a standard attribute: `latitude`, `longitude`, `capDate`, `utcOffset`,
/// `whiteLuminance`.
pub(super) fn attributes(metadata: &Metadata) -> LayerAttributes {
    let mut attributes = LayerAttributes {
        white_luminance: None,
        ..LayerAttributes::default()
    };
    attributes.software_name = Some(Text::from("skylight"));
    let value = |name: &str| {
        let pair = metadata.iter().find(|(key, _)| key == name);
        pair.map(|(_, value)| value.as_str())
    };
    let number = |name| value(name).and_then(|value| value.parse().ok());
    attributes.latitude = number(LATITUDE);
    attributes.longitude = number(LONGITUDE);
    attributes.white_luminance = number(WHITE_LUMINANCE);
    let moment = value(MOMENT).and_then(|when| DateTime::parse_from_rfc3339(when).ok());
    if let Some(moment) = moment {
        let date = moment.format("%Y:%m:%d %H:%M:%S").to_string();
        attributes.capture_date = Some(Text::from(date.as_str()));
        // What is added to the local time for universal time, seconds.
        attributes.utc_offset = Some(-(moment.offset().local_minus_utc() as f32));
    }
    for (key, value) in metadata {
        let value = AttributeValue::Text(Text::new_or_none(value).unwrap_or_default());
        // Prefixed: some option names (exposure) are standard attributes of other types.
        attributes
            .other
            .insert(Text::from(format!("skylight:{key}").as_str()), value);
    }
    attributes
}

#[cfg(test)]
mod tests {
    use exr::prelude::{ReadChannels as _, ReadLayers as _};

    use super::*;

    #[test]
    fn the_same_picture_has_the_same_bytes() {
        let layer = Layer {
            name: "",
            channels: Channels::Rgb,
            texels: vec![[0.5; 4]; 6],
        };
        let metadata: Vec<_> = (0..20)
            .map(|n| (format!("key {n}"), n.to_string()))
            .collect();
        let encoded = || encode([3, 2], std::slice::from_ref(&layer), &metadata).expect("encoded");
        let first = encoded();
        assert!((0..5).all(|_| encoded() == first));
    }

    #[test]
    fn layers_and_parameters_come_back() {
        let texels = vec![[1.5, -2.0, 1e9, 0.0]; 6];
        let layer = |name, channels| Layer {
            name,
            channels,
            texels: texels.clone(),
        };
        let layers = [layer("", Channels::Rgb), layer("depth", Channels::Depth)];
        let metadata = [
            ("turbidity", "3"),
            (LATITUDE, "55.75"),
            (LONGITUDE, "-12.5"),
            (MOMENT, "2026-06-21T15:00:30+02:00"),
            (WHITE_LUMINANCE, "1"),
        ];
        let metadata = metadata.map(|(key, value)| (key.to_owned(), value.to_owned()));
        let bytes = encode([3, 2], &layers, &metadata.to_vec()).expect("encoded");
        let image = exr::prelude::read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .from_buffered(Cursor::new(bytes))
            .expect("an EXR");
        let layer = image.layer_data;
        let names: Vec<String> = layer
            .channel_data
            .list
            .iter()
            .map(|c| c.name.to_string())
            .collect();
        assert_eq!(names, ["B", "G", "R", "depth.Z"]);
        let values: Vec<f32> = layer
            .channel_data
            .list
            .iter()
            .map(|c| c.sample_data.values_as_f32().next().expect("a sample"))
            .collect();
        assert_eq!(values, [1e9, -2.0, 1.5, 1.5]);
        let value = layer
            .attributes
            .other
            .get(&Text::from("skylight:turbidity"))
            .expect("attribute");
        assert_eq!(value, &AttributeValue::Text(Text::from("3")));
        let own = &layer.attributes;
        assert_eq!((own.latitude, own.longitude), (Some(55.75), Some(-12.5)));
        assert_eq!(own.white_luminance, Some(1.0));
        assert_eq!(own.capture_date, Some(Text::from("2026:06:21 15:00:30")));
        assert_eq!(own.utc_offset, Some(-7200.0));
        assert_eq!(image.attributes.chromaticities, Some(BT709));
    }
}
