//! KTX2 (Khronos 2.0): a cube map with its mip levels in 16-bit floats or BC6H, parameters as key/value data.
//!
//! The crate `ktx2` has the header, the level index and the data format descriptor; the order of the parts is here.

use std::path::Path;

use ::ktx2::dfd::{Basic, Block};
use ::ktx2::{Format, Header, Index, LevelIndex};
use block_compression::encode::compress_rgba16;
use block_compression::{BC6HSettings, CompressionVariant};
use half::f16;

use super::{Metadata, write_error};
use crate::error::Result;

/// One mip level: RGB, and 1, of all texels, face by face (+X −X +Y −Y +Z −Z) and row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct CubeLevel {
    /// Texels along an edge.
    pub edge: u32,
    /// The 6 `edge`² texels.
    pub texels: Vec<[f32; 4]>,
}

/// How the texels of a cube are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TexelFormat {
    /// R16G16B16A16_SFLOAT, 8 bytes a texel.
    Half,
    /// BC6H_UFLOAT_BLOCK, 1 byte a texel.
    Bc6h,
}

/// The crate's middle effort.
const BC6H: CompressionVariant = CompressionVariant::BC6H(BC6HSettings::basic());

/// Edge of a block of BC6H, texels.
const BLOCK: u32 = 4;

/// Largest half float.
const MOST: f32 = 65504.0;

impl TexelFormat {
    const fn format(self) -> Format {
        match self {
            Self::Half => Format::R16G16B16A16_SFLOAT,
            Self::Bc6h => Format::BC6H_UFLOAT_BLOCK,
        }
    }

    /// Alignment of a level, bytes: that of a texel or a block.
    const fn alignment(self) -> usize {
        match self {
            Self::Half => 8,
            Self::Bc6h => 16,
        }
    }
}

/// What a stored 1 stands for: 1 while the largest value is from 1 to 65 504, so that daylight is stored as it is; else the power of two
/// with which the largest is in 16 384..32 768. 5 · 10⁸ times less still has all the digits of a half float then.
pub fn scale(levels: &[CubeLevel]) -> f32 {
    let channels = levels
        .iter()
        .flat_map(|level| &level.texels)
        .flat_map(|t| &t[..3]);
    let largest = channels.fold(0f32, |most, value| most.max(*value));
    if largest == 0.0 || (1.0..=MOST).contains(&largest) {
        1.0
    } else {
        (largest.log2().floor() - 14.0).exp2()
    }
}

/// The bytes of a cube map. Its first level is the largest; each has half the edge of the one before. Texels are divided by `scale`.
/// `path` is for error messages.
///
/// # Errors
/// The cube cannot be encoded.
pub fn encode_ktx2(
    path: &Path,
    levels: &[CubeLevel],
    texels: TexelFormat,
    scale: f32,
    metadata: &Metadata,
) -> Result<Vec<u8>> {
    let (basic, type_size) =
        Basic::from_format(texels.format()).map_err(|e| write_error(path, format!("{e:?}")))?;
    let block = Block::Basic(basic).to_vec();
    let mut descriptor = (block.len() as u32 + 4).to_le_bytes().to_vec();
    descriptor.extend(block);
    let pairs = key_values(metadata);
    let data: Vec<Vec<u8>> = levels
        .iter()
        .map(|level| encode(level, texels, scale))
        .collect();

    let start = Header::LENGTH + levels.len() * LevelIndex::LENGTH;
    let header = Header {
        format: Some(texels.format()),
        type_size,
        pixel_width: levels.first().map_or(0, |level| level.edge),
        pixel_height: levels.first().map_or(0, |level| level.edge),
        pixel_depth: 0,
        layer_count: 0,
        face_count: 6,
        level_count: levels.len() as u32,
        supercompression_scheme: None,
        index: Index {
            dfd_byte_offset: start as u32,
            dfd_byte_length: descriptor.len() as u32,
            kvd_byte_offset: (start + descriptor.len()) as u32,
            kvd_byte_length: pairs.len() as u32,
            sgd_byte_offset: 0,
            sgd_byte_length: 0,
        },
    };
    let (index, body) = level_index(
        start + descriptor.len() + pairs.len(),
        &data,
        texels.alignment(),
    );
    let mut bytes = header.as_bytes().to_vec();
    for entry in &index {
        bytes.extend(entry.as_bytes());
    }
    bytes.extend(descriptor);
    bytes.extend(pairs);
    bytes.extend(body);
    Ok(bytes)
}

/// Where each level is in the file, and the bytes from `start` on: the smallest level first, as the specification wants it.
fn level_index(start: usize, data: &[Vec<u8>], alignment: usize) -> (Vec<LevelIndex>, Vec<u8>) {
    let mut body = Vec::new();
    let mut index: Vec<LevelIndex> = Vec::new();
    for level in data.iter().rev() {
        let offset = (start + body.len()).next_multiple_of(alignment);
        body.resize(offset - start, 0);
        body.extend(level);
        index.push(LevelIndex {
            byte_offset: offset as u64,
            byte_length: level.len() as u64,
            uncompressed_byte_length: level.len() as u64,
        });
    }
    index.reverse();
    (index, body)
}

/// Sorted by key, values as text with a final 0, padded to four bytes.
fn key_values(metadata: &Metadata) -> Vec<u8> {
    let own = [
        // s to the right, t downward: the only orientation that cubes may have.
        ("KTXorientation".to_owned(), "rd".to_owned()),
        (
            "KTXwriter".to_owned(),
            concat!("skylight ", env!("CARGO_PKG_VERSION")).to_owned(),
        ),
    ];
    let named = metadata
        .iter()
        .map(|(key, value)| (format!("skylight:{key}"), value.clone()));
    let mut pairs: Vec<(String, String)> = own.into_iter().chain(named).collect();
    pairs.sort();
    let mut bytes = Vec::new();
    for (key, value) in pairs {
        let pair = format!("{key}\0{value}\0");
        bytes.extend((pair.len() as u32).to_le_bytes());
        bytes.extend(pair.as_bytes());
        bytes.resize(bytes.len().next_multiple_of(4), 0);
    }
    bytes
}

fn encode(level: &CubeLevel, texels: TexelFormat, scale: f32) -> Vec<u8> {
    let half = |value: f32| f16::from_f32((value / scale).clamp(0.0, MOST));
    let halves = |t: &[f32; 4]| [half(t[0]), half(t[1]), half(t[2]), f16::ONE];
    let all: Vec<[f16; 4]> = level.texels.iter().map(halves).collect();
    match texels {
        TexelFormat::Half => all.iter().flatten().flat_map(|v| v.to_le_bytes()).collect(),
        TexelFormat::Bc6h => {
            let face = (level.edge * level.edge) as usize;
            all.chunks(face)
                .flat_map(|face| compress(face, level.edge))
                .collect()
        }
    }
}

/// One face in blocks; the last texels of a row or column are repeated to fill a block.
fn compress(face: &[[f16; 4]], edge: u32) -> Vec<u8> {
    let width = edge.next_multiple_of(BLOCK);
    let at = |k: u32| k.min(edge - 1);
    let padded: Vec<f16> = (0..width * width)
        .flat_map(|k| face[(at(k / width) * edge + at(k % width)) as usize])
        .collect();
    let mut blocks = vec![0; BC6H.blocks_byte_size(width, width)];
    compress_rgba16(BC6H, &padded, &mut blocks, width, width, 4 * width);
    blocks
}

#[cfg(test)]
mod tests {
    use block_compression::decode::decode_block_bc6h;

    use super::*;

    fn level(edge: u32, value: f32) -> CubeLevel {
        let texel = |k: u32| [value * (1.0 + k as f32), 0.5 * value, 0.0, 1.0];
        let texels = (0..6 * edge * edge).map(texel).collect();
        CubeLevel { edge, texels }
    }

    fn cube(value: f32) -> Vec<CubeLevel> {
        [8, 4, 2, 1].map(|edge| level(edge, value)).to_vec()
    }

    fn encoded(levels: &[CubeLevel], texels: TexelFormat, scale: f32) -> ktx2::Reader<Vec<u8>> {
        let metadata = vec![
            ("unit".to_owned(), "lux".to_owned()),
            ("aod".to_owned(), "0.1".to_owned()),
        ];
        let bytes =
            encode_ktx2(Path::new("a.ktx2"), levels, texels, scale, &metadata).expect("encoded");
        ktx2::Reader::new(bytes).expect("a KTX2")
    }

    #[test]
    fn a_reader_finds_what_was_written() {
        let levels = cube(0.25);
        let reader = encoded(&levels, TexelFormat::Half, 1.0);
        let header = reader.header();
        assert_eq!(header.format, Some(Format::R16G16B16A16_SFLOAT));
        assert_eq!(
            (header.type_size, header.pixel_width, header.pixel_height),
            (2, 8, 8)
        );
        assert_eq!((header.pixel_depth, header.layer_count), (0, 0));
        assert_eq!((header.face_count, header.level_count), (6, 4));
        assert_eq!(header.supercompression_scheme, None);
        assert_eq!(reader.color_primaries(), Some(ktx2::ColorPrimaries::BT709));
        assert_eq!(
            reader.transfer_function(),
            Some(ktx2::TransferFunction::Linear)
        );
        assert_eq!(reader.color_model(), Some(ktx2::ColorModel::RGBSDA));
        let pairs: Vec<(&str, &[u8])> = reader.key_value_data().collect();
        let writer = concat!("skylight ", env!("CARGO_PKG_VERSION"), "\0").as_bytes();
        let expected: [(&str, &[u8]); 4] = [
            ("KTXorientation", b"rd\0"),
            ("KTXwriter", writer),
            ("skylight:aod", b"0.1\0"),
            ("skylight:unit", b"lux\0"),
        ];
        assert_eq!(pairs, expected);
        for (found, level) in reader.levels().zip(&levels) {
            let values = found
                .data
                .chunks_exact(2)
                .map(|b| f16::from_le_bytes([b[0], b[1]]).to_f32());
            assert!(
                values.eq(level.texels.iter().flatten().copied()),
                "{}",
                level.edge
            );
        }
    }

    #[test]
    fn levels_lie_aligned_and_the_smallest_first() {
        for texels in [TexelFormat::Half, TexelFormat::Bc6h] {
            let reader = encoded(&cube(1.0), texels, 1.0);
            let start = reader.data().as_ptr().addr();
            let offsets: Vec<usize> = reader
                .levels()
                .map(|l| l.data.as_ptr().addr() - start)
                .collect();
            assert!(offsets.is_sorted_by(|a, b| a > b), "{offsets:?}");
            assert!(
                offsets.iter().all(|o| o % texels.alignment() == 0),
                "{offsets:?}"
            );
        }
    }

    #[test]
    fn blocks_decode_to_the_texels() {
        let levels: Vec<CubeLevel> = cube(100.0).into_iter().map(smooth).collect();
        let reader = encoded(&levels, TexelFormat::Bc6h, 0.5);
        assert_eq!(reader.color_model(), Some(ktx2::ColorModel::BC6H));
        for (found, level) in reader.levels().zip(&levels) {
            let (edge, width) = (level.edge, level.edge.next_multiple_of(4));
            let blocks = BC6H.blocks_byte_size(width, width);
            assert_eq!(found.data.len(), 6 * blocks);
            for (k, block) in found.data.chunks_exact(16).enumerate() {
                let mut values = [f16::ZERO; 48];
                decode_block_bc6h(block, &mut values, 12, false);
                let (face, at) = (k / (blocks / 16), k % (blocks / 16));
                let (x, y) = (4 * (at as u32 % (width / 4)), 4 * (at as u32 / (width / 4)));
                for (i, j) in (0..edge.min(4)).flat_map(|i| (0..edge.min(4)).map(move |j| (i, j))) {
                    let texel =
                        level.texels[((face as u32 * edge + y + j) * edge + x + i) as usize];
                    let read = 0.5 * values[(12 * j + 3 * i) as usize].to_f32();
                    assert!(
                        (read / texel[0] - 1.0).abs() < 0.01,
                        "{edge} {read} {texel:?}"
                    );
                }
            }
        }
    }

    /// A gradient, as skies have them: blocks of noise would lose more.
    fn smooth(level: CubeLevel) -> CubeLevel {
        let value = |k: usize| 100.0 + k as f32 / level.texels.len() as f32;
        let texels = (0..level.texels.len())
            .map(|k| [value(k), value(k), value(k), 1.0])
            .collect();
        CubeLevel { texels, ..level }
    }

    #[test]
    fn the_scale_is_one_by_day_and_a_power_of_two_otherwise() {
        let of = |value: f32| scale(&[level(1, value / 6.0)]);
        assert_eq!([0.0, 1.001, 3e4, 65504.0].map(of), [1.0; 4]);
        for largest in [1e-6, 3e-4, 0.9, 7e4, 1e9] {
            let scale = of(largest);
            assert_eq!(scale.log2().fract(), 0.0, "{largest}");
            assert!(
                (16383.9..32768.0).contains(&(largest / scale)),
                "{largest} {scale}"
            );
        }
    }
}
