//! PNG files written row by row, for pictures larger than memory.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::{Path, PathBuf};

use super::png::head;
use super::{Effort, Encoding, Metadata, persist, reason, temporary, write_error};
use crate::error::Result;

/// A PNG written from the top to a temporary file beside its target, and renamed at the end.
pub struct PngRows {
    path: PathBuf,
    file: tempfile::NamedTempFile,
    rows: png::StreamWriter<'static, BufWriter<File>>,
    rgb: Vec<u8>,
}

impl PngRows {
    /// Starts a picture of `size` pixels.
    ///
    /// # Errors
    /// No file can be created in the folder of `path`.
    pub fn new(
        path: &Path,
        size: [u32; 2],
        encoding: Encoding,
        metadata: &Metadata,
    ) -> Result<Self> {
        let file = temporary(path)?;
        let handle = file.as_file().try_clone();
        let handle = handle.map_err(|e| write_error(path, reason(&e)))?;
        let rows = head(
            BufWriter::new(handle),
            size,
            (encoding, Effort::Small),
            metadata,
        )
        .and_then(png::Writer::into_stream_writer)
        .map_err(|e| write_error(path, e))?;
        Ok(Self {
            path: path.to_owned(),
            file,
            rows,
            rgb: Vec::new(),
        })
    }

    /// Appends pixels in reading order: four bytes per pixel, alpha ignored.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn push(&mut self, rgba: &[u8]) -> Result<()> {
        self.rgb.clear();
        self.rgb
            .extend(rgba.chunks_exact(4).flat_map(|p| [p[0], p[1], p[2]]));
        let written = self.rows.write_all(&self.rgb);
        written.map_err(|e| write_error(&self.path, reason(&e)))
    }

    /// Completes the file and replaces an existing one.
    ///
    /// # Errors
    /// Rows are missing or the file cannot be written; an existing file stays unchanged.
    pub fn finish(self) -> Result<()> {
        let path = self.path;
        self.rows.finish().map_err(|e| write_error(&path, e))?;
        let synced = self.file.as_file().sync_all();
        synced.map_err(|e| write_error(&path, reason(&e)))?;
        persist(&path, self.file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::output::write_png;

    fn pixels(file: &Path) -> Vec<u8> {
        let file = std::io::BufReader::new(File::open(file).expect("the file"));
        let mut reader = png::Decoder::new(file).read_info().expect("a PNG");
        let mut pixels = vec![0; reader.output_buffer_size().expect("small")];
        reader.next_frame(&mut pixels).expect("pixels");
        assert_eq!(reader.info().utf8_text[0].keyword, "turbidity");
        pixels
    }

    #[test]
    fn rows_make_the_picture_that_is_written_at_once() {
        let dir = tempfile::tempdir().expect("a folder");
        let (a, b) = (dir.path().join("a.png"), dir.path().join("b.png"));
        let metadata = vec![("turbidity".to_owned(), "3".to_owned())];
        let rgba: Vec<u8> = (0..4 * 7 * 5u32).map(|i| (i * 37) as u8).collect();
        write_png(
            &a,
            [7, 5],
            &rgba,
            (Encoding::Srgb, Effort::Small),
            &metadata,
        )
        .expect("written");
        let mut rows = PngRows::new(&b, [7, 5], Encoding::Srgb, &metadata).expect("begun");
        rows.push(&rgba[..4 * 7 * 2]).expect("two rows");
        rows.push(&rgba[4 * 7 * 2..]).expect("three rows");
        assert!(!b.exists(), "not before it is whole");
        rows.finish().expect("ended");
        assert_eq!(pixels(&a), pixels(&b));
        assert_eq!(dir.path().read_dir().expect("folder").count(), 2);
    }

    #[test]
    fn missing_rows_leave_the_old_file() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("a.png");
        std::fs::write(&path, "old").expect("written");
        let mut rows = PngRows::new(&path, [4, 4], Encoding::Srgb, &Vec::new()).expect("begun");
        rows.push(&[0; 4 * 4]).expect("one row");
        assert!(rows.finish().is_err());
        assert_eq!(std::fs::read(&path).expect("the old file"), b"old");
        assert_eq!(dir.path().read_dir().expect("folder").count(), 1);
    }
}
