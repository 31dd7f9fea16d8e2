//! Radiance HDR: the three channels share an exponent, so the error is at most 1/256 of the largest channel.

use std::path::Path;

use image::Rgb;
use image::codecs::hdr::HdrEncoder;

use super::write_error;
use crate::error::Result;

/// The bytes of a picture, rows from the top; the fourth component of a texel is ignored. `path` is for error messages.
///
/// # Errors
/// The picture cannot be encoded, for example because it is empty.
pub fn encode_hdr(path: &Path, size: [u32; 2], texels: &[[f32; 4]]) -> Result<Vec<u8>> {
    let rgb: Vec<Rgb<f32>> = texels.iter().map(|t| Rgb([t[0], t[1], t[2]])).collect();
    let mut bytes = Vec::new();
    HdrEncoder::new(&mut bytes)
        .encode(&rgb, size[0] as usize, size[1] as usize)
        .map_err(|e| write_error(path, e))?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_come_back_within_the_precision_of_the_format() {
        let texels = [[1e9, 5e8, 1.0, 0.0], [2.5e-4, 2.5e-4, 0.0, 0.0]];
        let bytes = encode_hdr(Path::new("a.hdr"), [2, 1], &texels).expect("encoded");
        let format = image::ImageFormat::Hdr;
        let read = image::load_from_memory_with_format(&bytes, format).expect("an HDR");
        for (found, texel) in read.to_rgb32f().pixels().zip(texels) {
            let largest = texel[0];
            for (f, e) in found.0.iter().zip(texel) {
                assert!((f - e).abs() <= largest / 128.0, "{f} {e}");
            }
        }
    }
}
