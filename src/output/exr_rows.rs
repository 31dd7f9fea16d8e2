//! OpenEXR files written in bands, for pictures larger than memory; the files equal those of [`super::write_exr`].

use std::io::BufWriter;
use std::path::Path;

use exr::block::writer::{ChunkWriter, SequentialBlocksCompressor};
use exr::block::{BlockIndex, UncompressedBlock};
use exr::math::Vec2;
use exr::meta::BlockDescription;
use exr::meta::attribute::{ChannelDescription, SampleType, Text};
use exr::meta::header::Header;

use super::exr::{BT709, ENCODING, attributes, full_name};
use super::exr_header::sort_attributes;
use super::{Channels, Metadata, persist, reason, temporary, write_error};
use crate::error::{Error, Result};

/// Rows per block of the file. The rows of each band except the last must be a multiple of it.
pub const BLOCK_ROWS: usize = 16;

/// A layer: its name (empty for the picture itself) and its channels.
pub type LayerKind = (&'static str, Channels);

/// A channel: its name in the file, its layer, and the component of the texels.
type Channel = (String, usize, usize);

/// Writes layers of one size. `band` returns the texels of each layer for the next rows, any multiple of the 16 rows of a
/// compressed block; it is called until all `size[1]` rows are written.
///
/// # Errors
/// The error of `band`, or the file cannot be written; an existing file stays unchanged.
pub fn write_exr_rows(
    path: &Path,
    size: [u32; 2],
    layers: &[LayerKind],
    metadata: &Metadata,
    mut band: impl FnMut() -> Result<Vec<Vec<[f32; 4]>>>,
) -> Result<()> {
    let channels = sorted(layers);
    let header = header(size, &channels, metadata);
    let mut file = temporary(path)?;
    let handle = file.as_file().try_clone();
    let handle = handle.map_err(|e| write_error(path, reason(&e)))?;
    // The library's error type cannot hold this error.
    let mut failed: Option<Error> = None;
    let written = exr::block::writer::write_chunks_with(
        BufWriter::new(handle),
        [header].into_iter().collect(),
        true,
        |meta, writer| {
            let mut bands = Bands {
                compressor: SequentialBlocksCompressor::new(&meta, writer),
                width: size[0] as usize,
                channels: &channels,
                row: 0,
            };
            while bands.row < size[1] as usize {
                let texels = band().map_err(|error| {
                    failed = Some(error);
                    exr::error::Error::Aborted
                })?;
                bands.push(&texels)?;
            }
            Ok(())
        },
    );
    match (failed, written) {
        (Some(error), _) => return Err(error),
        (None, written) => written.map_err(|e| write_error(path, e))?,
    }
    let sorted = sort_attributes(file.as_file_mut());
    sorted.map_err(|e| write_error(path, reason(&e)))?;
    let synced = file.as_file().sync_all();
    synced.map_err(|e| write_error(path, reason(&e)))?;
    persist(path, file)
}

/// The channels in file order: sorted by name.
fn sorted(layers: &[LayerKind]) -> Vec<Channel> {
    let channels = layers.iter().enumerate().flat_map(|(i, (name, kind))| {
        let names = kind.names().iter().enumerate();
        names.map(move |(component, channel)| (full_name(name, channel), i, component))
    });
    let mut channels: Vec<Channel> = channels.collect();
    channels.sort();
    channels
}

fn header(size: [u32; 2], channels: &[Channel], metadata: &Metadata) -> Header {
    let description =
        |(name, ..): &Channel| ChannelDescription::named(name.as_str(), SampleType::F32);
    let size = Vec2(size[0] as usize, size[1] as usize);
    let described = channels.iter().map(description).collect();
    let mut header = Header::new(Text::default(), size, described)
        .with_encoding(
            ENCODING.compression,
            BlockDescription::ScanLines,
            ENCODING.line_order,
        )
        .with_attributes(attributes(metadata));
    header.shared_attributes.chromaticities = Some(BT709);
    header
}

/// Writes bands from the top down.
struct Bands<'w, W> {
    compressor: SequentialBlocksCompressor<'w, W>,
    width: usize,
    channels: &'w [Channel],
    /// Rows written so far.
    row: usize,
}

impl<W: std::io::Write + std::io::Seek> Bands<'_, ChunkWriter<W>> {
    fn push(&mut self, texels: &[Vec<[f32; 4]>]) -> exr::error::UnitResult {
        let rows = texels.first().map_or(0, |layer| layer.len() / self.width);
        if rows == 0 {
            return Err(exr::error::Error::Invalid("rows are missing".into()));
        }
        for first in (0..rows).step_by(BLOCK_ROWS) {
            let count = BLOCK_ROWS.min(rows - first);
            let block = UncompressedBlock {
                index: BlockIndex {
                    layer: 0,
                    pixel_position: Vec2(0, self.row),
                    pixel_size: Vec2(self.width, count),
                    level: Vec2(0, 0),
                },
                data: self.block(texels, first..first + count),
            };
            self.compressor
                .compress_block(self.row / BLOCK_ROWS, block)?;
            self.row += count;
        }
        Ok(())
    }

    /// The bytes of a block: for each row, all values of each channel.
    fn block(&self, texels: &[Vec<[f32; 4]>], rows: std::ops::Range<usize>) -> Vec<u8> {
        let mut data = Vec::with_capacity(rows.len() * self.width * self.channels.len() * 4);
        for row in rows {
            for (_, layer, component) in self.channels {
                let row = &texels[*layer][row * self.width..][..self.width];
                data.extend(row.iter().flat_map(|t| t[*component].to_ne_bytes()));
            }
        }
        data
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::{Layer, write_exr};

    fn values(path: &Path) -> Vec<(String, Vec<f32>)> {
        let image = exr::prelude::read_all_flat_layers_from_file(path).expect("an EXR");
        assert!(image.attributes.chromaticities.is_some());
        let layer = &image.layer_data[0];
        assert_eq!(layer.attributes.other.len(), 1);
        let values = |c: &exr::image::AnyChannel<exr::image::FlatSamples>| {
            c.sample_data.values_as_f32().collect()
        };
        let channels = layer.channel_data.list.iter();
        channels.map(|c| (c.name.to_string(), values(c))).collect()
    }

    #[test]
    fn bands_make_the_picture_that_is_written_at_once() {
        let dir = tempfile::tempdir().expect("a folder");
        let (a, b) = (dir.path().join("a.exr"), dir.path().join("b.exr"));
        let metadata = vec![("turbidity".to_owned(), "3".to_owned())];
        let size = [5, 41];
        let texels = |factor: f32| -> Vec<[f32; 4]> {
            (0..5 * 41u16)
                .map(|i| [0.0, 1.0, 2.0, 3.0].map(|c| factor * (f32::from(i) + 0.1 * c)))
                .collect()
        };
        let kinds = [
            ("", Channels::Rgb),
            ("depth", Channels::Depth),
            ("normal", Channels::Xyz),
        ];
        let layers: Vec<Layer> = (1u8..)
            .zip(kinds)
            .map(|(i, (name, channels))| Layer {
                name,
                channels,
                texels: texels(f32::from(i)),
            })
            .collect();
        write_exr(&a, size, &layers, &metadata).expect("written");
        let mut rows = [0..32, 32..41].into_iter();
        write_exr_rows(&b, size, &kinds, &metadata, || {
            let rows = rows.next().expect("no more than there are");
            Ok(layers
                .iter()
                .map(|l| l.texels[rows.start * 5..rows.end * 5].to_vec())
                .collect())
        })
        .expect("written");
        assert_eq!(values(&a), values(&b));
    }

    #[test]
    fn a_band_that_fails_leaves_the_old_file() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("a.exr");
        std::fs::write(&path, "old").expect("written");
        let fails = || Err(Error::Compare("no band".to_owned()));
        let result = write_exr_rows(&path, [4, 4], &[("", Channels::Rgb)], &Vec::new(), fails);
        assert!(result.expect_err("no band").to_string().contains("no band"));
        assert_eq!(std::fs::read(&path).expect("the old file"), b"old");
        assert_eq!(dir.path().read_dir().expect("folder").count(), 1);
    }
}
