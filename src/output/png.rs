//! 8-bit PNG with parameters as text chunks.

use std::path::Path;

use super::{Metadata, write_error, write_whole};
use crate::error::Result;

/// Transfer function of the 8-bit values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Encoding {
    /// The sRGB curve.
    Srgb,
    /// A power law: value = linear^(1/γ).
    Gamma(f64),
}

/// Compression effort.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Effort {
    /// Takes a tenth of the time of [`Effort::Small`]; for pictures that are drawn quickly.
    Quick,
    /// Gives the usual file size.
    Small,
}

/// Writes `rgba` (rows from the top, four bytes per pixel, alpha ignored) as an RGB picture.
///
/// # Errors
/// The file cannot be written; an existing file stays unchanged.
pub fn write_png(
    path: &Path,
    size: [u32; 2],
    rgba: &[u8],
    (encoding, effort): (Encoding, Effort),
    metadata: &Metadata,
) -> Result<()> {
    let bytes =
        encode(size, rgba, (encoding, effort), metadata).map_err(|e| write_error(path, e))?;
    write_whole(path, &bytes)
}

fn encode(
    size: [u32; 2],
    rgba: &[u8],
    how: (Encoding, Effort),
    metadata: &Metadata,
) -> std::result::Result<Vec<u8>, png::EncodingError> {
    let mut bytes = Vec::new();
    let rgb: Vec<u8> = rgba
        .chunks_exact(4)
        .flat_map(|p| [p[0], p[1], p[2]])
        .collect();
    let mut writer = head(&mut bytes, size, how, metadata)?;
    writer.write_image_data(&rgb)?;
    writer.finish()?;
    Ok(bytes)
}

/// Writes everything that precedes the pixels.
pub(super) fn head<W: std::io::Write>(
    target: W,
    size: [u32; 2],
    (encoding, effort): (Encoding, Effort),
    metadata: &Metadata,
) -> std::result::Result<png::Writer<W>, png::EncodingError> {
    let mut encoder = png::Encoder::new(target, size[0], size[1]);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(match effort {
        Effort::Quick => png::Compression::Fast,
        Effort::Small => png::Compression::Balanced,
    });
    match encoding {
        Encoding::Srgb => encoder.set_source_srgb(png::SrgbRenderingIntent::Perceptual),
        Encoding::Gamma(gamma) => {
            encoder.set_source_gamma(png::ScaledFloat::new(gamma.recip() as f32));
        }
    }
    for (key, value) in metadata {
        // Keys are short ASCII; values (paths) may contain any Unicode.
        encoder.add_itxt_chunk(key.clone(), value.clone())?;
    }
    encoder.write_header()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_and_parameters_come_back() {
        for effort in [Effort::Quick, Effort::Small] {
            come_back(effort);
        }
    }

    fn come_back(effort: Effort) {
        let metadata = vec![("turbidity".to_owned(), "3".to_owned())];
        let rgba = [10, 20, 30, 255, 40, 50, 60, 255];
        let bytes = encode([2, 1], &rgba, (Encoding::Srgb, effort), &metadata).expect("encoded");
        let decoder = png::Decoder::new(std::io::Cursor::new(&bytes));
        let mut reader = decoder.read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
        reader.next_frame(&mut pixels).expect("pixels");
        assert_eq!(pixels, [10, 20, 30, 40, 50, 60]);
        let text = &reader.info().utf8_text;
        assert_eq!(text[0].keyword, "turbidity");
        assert_eq!(text[0].get_text().expect("text"), "3");
        assert!(reader.info().srgb.is_some());
    }
}
