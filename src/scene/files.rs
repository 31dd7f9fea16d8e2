//! File sources: the disk, or files compiled into the program.

use std::cell::{Cell, RefCell};
use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use memchr::memchr_iter;
use serde::{Deserialize, Serialize};

use crate::scene::error::SceneError;
use crate::scene::names::{Listings, spellings};

/// BLAKE3 hash of a file.
pub(super) type Digest = [u8; 32];

pub(super) fn digest(bytes: &[u8]) -> Digest {
    *blake3::hash(bytes).as_bytes()
}

/// A file that was read, with its hash.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct ReadFile {
    pub path: PathBuf,
    digest: Digest,
}

impl ReadFile {
    /// Whether the file still has the same content.
    pub fn is_unchanged(&self) -> bool {
        std::fs::read(&self.path).is_ok_and(|bytes| digest(&bytes) == self.digest)
    }
}

/// Start of the file that stands for a file kept elsewhere (Git LFS, specification 1).
const LFS_POINTER: &[u8] = b"version https://git-lfs.github.com/spec/";

/// A source of files.
#[derive(Debug, Clone)]
pub(super) struct Files {
    source: Source,
    /// Files read since [`Files::start_record`].
    record: Option<RefCell<Vec<ReadFile>>>,
    /// Bytes that may still be read. Limits the work for a scene that names its files many times.
    left: Cell<u64>,
    /// Folder that must contain the files of a model, at any depth; `None` for no restriction.
    confined_to: Option<PathBuf>,
    listings: RefCell<Listings>,
}

#[derive(Debug, Clone, Copy)]
enum Source {
    /// The file system, with a limit on file size.
    Disk { max_bytes: u64 },
    /// Embedded files by name.
    Embedded(&'static [(&'static str, &'static [u8])]),
}

/// The file that a name in a model refers to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Lookup {
    Found(PathBuf),
    Missing(PathBuf),
    /// The file exists outside the model's folder and may not be read.
    Outside(PathBuf),
}

impl Files {
    /// The file system. At most `max_bytes` are read, per file and in total.
    pub fn disk(max_bytes: u64) -> Self {
        Self {
            source: Source::Disk { max_bytes },
            record: None,
            left: Cell::new(max_bytes),
            confined_to: None,
            listings: RefCell::default(),
        }
    }

    /// Embedded files by name.
    pub fn embedded(files: &'static [(&'static str, &'static [u8])]) -> Self {
        Self {
            source: Source::Embedded(files),
            record: None,
            left: Cell::new(u64::MAX),
            confined_to: None,
            listings: RefCell::default(),
        }
    }

    /// Starts recording which files are read.
    pub fn start_record(&mut self) {
        self.record = Some(RefCell::default());
    }

    /// The files read since [`Files::start_record`].
    pub fn take_record(&mut self) -> Vec<ReadFile> {
        self.record
            .take()
            .map(RefCell::into_inner)
            .unwrap_or_default()
    }

    /// Restricts [`Files::find`] to the folder of `model` and its subfolders.
    pub fn confine_to(&mut self, model: &Path) {
        let folder = model.parent().unwrap_or(Path::new(""));
        let folder = if folder.as_os_str().is_empty() {
            Path::new(".")
        } else {
            folder
        };
        self.confined_to = folder.canonicalize().ok();
    }

    /// Looks up a file named in a model, relative to the model's folder, by all its [`spellings`]: first as they are, then without
    /// regard to case if that means one file.
    pub fn find(&self, folder: &Path, name: &str) -> Lookup {
        self.find_any(folder, &spellings(name, false))
    }

    /// The same for a URI, whose percent-encoding is decoded first.
    pub fn find_uri(&self, folder: &Path, uri: &str) -> Lookup {
        self.find_any(folder, &spellings(uri, true))
    }

    fn find_any(&self, folder: &Path, names: &[String]) -> Lookup {
        let mut outside = None;
        for path in names.iter().map(|name| folder.join(name)) {
            if self.has(&path) {
                if self.is_inside(&path) {
                    return Lookup::Found(self.canonical_name(&path));
                }
                outside.get_or_insert(path);
            }
        }
        if let Source::Disk { .. } = self.source {
            let mut listings = self.listings.borrow_mut();
            let mut folded = names.iter().filter_map(|name| listings.find(folder, name));
            if let Some(path) = folded.find(|path| self.is_inside(path)) {
                return Lookup::Found(self.canonical_name(&path));
            }
        }
        match outside {
            Some(path) => Lookup::Outside(path),
            None => Lookup::Missing(folder.join(names.first().map_or("", String::as_str))),
        }
    }

    /// A canonical path, so that a malicious model cannot have the same file read once per spelling.
    fn canonical_name(&self, path: &Path) -> PathBuf {
        // Removes doubled separators and single dots.
        let plain: PathBuf = path.components().collect();
        let Source::Disk { .. } = self.source else {
            return plain;
        };
        match (plain.canonicalize(), std::path::absolute(&plain)) {
            (Ok(real), Ok(absolute)) if real != absolute => real,
            _ => plain,
        }
    }

    /// Follows symbolic links: a link to a file outside the folder is outside.
    fn is_inside(&self, path: &Path) -> bool {
        let Some(root) = &self.confined_to else {
            return true;
        };
        match self.source {
            Source::Disk { .. } => path.canonicalize().is_ok_and(|path| path.starts_with(root)),
            Source::Embedded(_) => true,
        }
    }

    /// Reads a file.
    ///
    /// # Errors
    /// When the file is missing, not regular, too large or unreadable.
    pub fn read(&self, path: &Path) -> Result<Vec<u8>, SceneError> {
        match self.source {
            Source::Disk { max_bytes } => {
                let bytes = read_disk(path, max_bytes)?;
                if bytes.starts_with(LFS_POINTER) {
                    return Err(SceneError::Pointer(path.to_owned()));
                }
                let left = self.left.get().checked_sub(bytes.len() as u64);
                self.left.set(left.ok_or_else(|| SceneError::TooMuch {
                    path: path.to_owned(),
                    limit: max_bytes,
                })?);
                if let Some(record) = &self.record {
                    record.borrow_mut().push(ReadFile {
                        path: path.to_owned(),
                        digest: digest(&bytes),
                    });
                }
                Ok(bytes)
            }
            Source::Embedded(files) => files
                .iter()
                .find(|(name, _)| Path::new(name) == path)
                .map(|(_, bytes)| bytes.to_vec())
                .ok_or_else(|| SceneError::Missing(path.to_owned())),
        }
    }

    /// BLAKE3 hash of a file, without keeping the content in memory.
    ///
    /// # Errors
    /// As [`Files::read`].
    pub fn digest(&self, path: &Path) -> Result<Digest, SceneError> {
        match self.source {
            Source::Disk { max_bytes } => digest_disk(path, max_bytes),
            Source::Embedded(_) => self.read(path).map(|bytes| digest(&bytes)),
        }
    }

    /// Reads a file as text with `\n` or `\r\n` as line ends.
    pub fn read_text(&self, path: &Path) -> Result<String, SceneError> {
        let mut bytes = self.read(path)?;
        end_lines(&mut bytes);
        if bytes.starts_with(&[0xEF, 0xBB, 0xBF]) || utf16(&bytes).is_some() {
            return Ok(text_of(&bytes));
        }
        // Valid UTF-8 is not copied, because models are large.
        Ok(String::from_utf8(bytes).unwrap_or_else(|error| latin(error.as_bytes())))
    }

    /// Whether [`Files::read`] would find a file, without reading it.
    pub fn probe(&self, path: &Path) -> Result<(), SceneError> {
        match std::fs::metadata(path) {
            Ok(meta) if meta.is_dir() => Err(SceneError::Directory(path.to_owned())),
            Err(error) if matches!(self.source, Source::Disk { .. }) => {
                Err(unreadable(path, &error))
            }
            _ => Ok(()),
        }
    }

    /// Whether the file exists.
    pub fn has(&self, path: &Path) -> bool {
        match self.source {
            Source::Disk { .. } => path.is_file(),
            Source::Embedded(files) => files.iter().any(|(name, _)| Path::new(name) == path),
        }
    }
}

/// The text of a file, without a byte order mark: UTF-8 or UTF-16, and Latin-1 where it is neither (names from old exporters).
pub(super) fn text_of(bytes: &[u8]) -> String {
    let plain = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
    utf16(bytes).unwrap_or_else(|| latin(plain))
}

/// UTF-8, with the bytes that are not as letters of Latin-1.
pub(super) fn latin(bytes: &[u8]) -> String {
    let mut text = String::with_capacity(bytes.len());
    for chunk in bytes.utf8_chunks() {
        text.push_str(chunk.valid());
        text.extend(chunk.invalid().iter().map(|byte| char::from(*byte)));
    }
    text
}

/// UTF-16 with a byte order mark, as some shells of Windows write it.
fn utf16(bytes: &[u8]) -> Option<String> {
    let read: fn([u8; 2]) -> u16 = match bytes {
        [0xFF, 0xFE, ..] => u16::from_le_bytes,
        [0xFE, 0xFF, ..] => u16::from_be_bytes,
        _ => return None,
    };
    let units: Vec<u16> = bytes[2..]
        .chunks_exact(2)
        .map(|pair| read([pair[0], pair[1]]))
        .collect();
    Some(String::from_utf16_lossy(&units))
}

/// Makes `\n` of each `\r` that ends a line alone, as on old Macs.
fn end_lines(bytes: &mut [u8]) {
    let alone = |i: &usize| bytes.get(i + 1).is_none_or(|next| *next != b'\n');
    let ends: Vec<usize> = memchr_iter(b'\r', bytes).filter(alone).collect();
    // In UTF-16, the byte after it is the other half of the character.
    if utf16(&bytes[..bytes.len().min(4)]).is_none() {
        ends.into_iter().for_each(|i| bytes[i] = b'\n');
    }
}

/// Opens a file of at most `limit` bytes; also returns its length, bytes.
fn open_disk(path: &Path, limit: u64) -> Result<(std::fs::File, u64), SceneError> {
    let failed = |error: std::io::Error| unreadable(path, &error);
    let meta = std::fs::metadata(path).map_err(failed)?;
    if meta.is_dir() {
        return Err(SceneError::Directory(path.to_owned()));
    }
    // Reading a pipe or a device may never end.
    if !meta.is_file() {
        return Err(SceneError::NotAFile(path.to_owned()));
    }
    if meta.len() > limit {
        return Err(too_large(path, meta.len(), limit));
    }
    let file = std::fs::File::open(path).map_err(failed)?;
    Ok((file, meta.len()))
}

fn too_large(path: &Path, bytes: u64, limit: u64) -> SceneError {
    SceneError::TooLarge {
        path: path.to_owned(),
        bytes,
        limit,
    }
}

fn digest_disk(path: &Path, limit: u64) -> Result<Digest, SceneError> {
    let (file, _) = open_disk(path, limit)?;
    let mut hasher = blake3::Hasher::new();
    let hashed = hasher.update_reader(file.take(limit));
    hashed.map_err(|error| unreadable(path, &error))?;
    Ok(*hasher.finalize().as_bytes())
}

fn read_disk(path: &Path, limit: u64) -> Result<Vec<u8>, SceneError> {
    let failed = |error: std::io::Error| unreadable(path, &error);
    let (file, length) = open_disk(path, limit)?;
    let mut bytes = Vec::new();
    bytes
        .try_reserve_exact(length as usize)
        .map_err(|error| failed(error.into()))?;
    // The length above is wrong for files in /proc and for files that are still growing.
    let read = file
        .take(limit.saturating_add(1))
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    if read as u64 > limit {
        return Err(too_large(path, read as u64, limit));
    }
    Ok(bytes)
}

fn unreadable(path: &Path, error: &std::io::Error) -> SceneError {
    let path = PathBuf::from(path);
    match error.kind() {
        ErrorKind::NotFound | ErrorKind::NotADirectory => SceneError::Missing(path),
        ErrorKind::IsADirectory => SceneError::Directory(path),
        _ => SceneError::Unreadable {
            path,
            reason: error.to_string(),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_of_any_encoding_and_line_end() {
        let read = |bytes: &'static [u8]| {
            let files = Files::embedded(vec![("a", bytes)].leak());
            files.read_text(Path::new("a")).expect("embedded")
        };
        assert_eq!(read(b"v 1\rv 2\r"), "v 1\nv 2\n");
        assert_eq!(read(b"v 1\r\nv 2\r\n"), "v 1\r\nv 2\r\n");
        assert_eq!(read(b"\xEF\xBB\xBFv 1"), "v 1");
        assert_eq!(read(b"\xFF\xFEv\0 \x001\0\n\0"), "v 1\n");
        assert_eq!(read(b"\xFE\xFF\0v\0 \x001"), "v 1");
        assert_eq!(read(b"caf\xE9\r"), "café\n");
    }
}
