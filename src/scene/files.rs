//! Where files come from: the disk, or the ones that are built into the program.

use std::io::{ErrorKind, Read};
use std::path::{Path, PathBuf};

use super::error::SceneError;

/// A source of files.
#[derive(Debug, Clone, Copy)]
pub(super) enum Files {
    /// The file system; no file larger than this many bytes is read.
    Disk { max_bytes: u64 },
    /// Built-in files by name.
    Embedded(&'static [(&'static str, &'static [u8])]),
}

impl Files {
    /// The whole file.
    ///
    /// # Errors
    /// One that names the file when it is missing, no regular file, too large or unreadable.
    pub fn read(&self, path: &Path) -> Result<Vec<u8>, SceneError> {
        match self {
            Self::Disk { max_bytes } => read_disk(path, *max_bytes),
            Self::Embedded(files) => files
                .iter()
                .find(|(name, _)| Path::new(name) == path)
                .map(|(_, bytes)| bytes.to_vec())
                .ok_or_else(|| SceneError::Missing(path.to_owned())),
        }
    }

    /// The whole file as text; bytes that are not UTF-8 (old exporters' names) become replacement characters.
    pub fn read_text(&self, path: &Path) -> Result<String, SceneError> {
        let bytes = self.read(path)?;
        let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(&bytes);
        Ok(String::from_utf8_lossy(bytes).into_owned())
    }

    /// Only whether [`Files::read`] would find a file there.
    pub fn probe(&self, path: &Path) -> Result<(), SceneError> {
        match std::fs::metadata(path) {
            Ok(meta) if meta.is_dir() => Err(SceneError::Directory(path.to_owned())),
            Err(error) if matches!(self, Self::Disk { .. }) => Err(unreadable(path, &error)),
            _ => Ok(()),
        }
    }

    /// Whether there is such a file.
    pub fn has(&self, path: &Path) -> bool {
        match self {
            Self::Disk { .. } => path.is_file(),
            Self::Embedded(files) => files.iter().any(|(name, _)| Path::new(name) == path),
        }
    }
}

fn read_disk(path: &Path, limit: u64) -> Result<Vec<u8>, SceneError> {
    let failed = |error: std::io::Error| unreadable(path, &error);
    let meta = std::fs::metadata(path).map_err(failed)?;
    if meta.is_dir() {
        return Err(SceneError::Directory(path.to_owned()));
    }
    // A pipe or a device may never end.
    if !meta.is_file() {
        return Err(SceneError::NotAFile(path.to_owned()));
    }
    let too_large = |bytes| SceneError::TooLarge {
        path: path.to_owned(),
        bytes,
        limit,
    };
    if meta.len() > limit {
        return Err(too_large(meta.len()));
    }
    let mut bytes = Vec::new();
    let file = std::fs::File::open(path).map_err(failed)?;
    // The length above is a promise that files in /proc and growing ones do not keep.
    let read = file
        .take(limit.saturating_add(1))
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    if read as u64 > limit {
        return Err(too_large(read as u64));
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
