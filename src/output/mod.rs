//! Output files, written atomically; or standard output, written when the whole is there.

mod canvas;
mod drawing;
mod exr;
mod exr_header;
mod exr_rows;
mod hdr;
mod ktx2;
mod legend;
pub mod message;
mod png;
mod rows;
mod sheet;
mod stream;

use std::io::Write as _;
use std::path::{Path, PathBuf};

pub(crate) use self::drawing::escaped;
pub use self::drawing::{Anchor, Drawing, Fill, Ink, Part, Shape, Size, Stroke, Text};
pub use self::exr::{
    Channels, LATITUDE, LONGITUDE, Layer, MOMENT, WHITE_LUMINANCE, encode_exr, write_exr,
};
pub use self::exr_rows::{LayerKind, write_exr_rows};
pub use self::hdr::encode_hdr;
pub use self::ktx2::{CubeLevel, TexelFormat, encode_ktx2, scale};
pub use self::legend::draw_legend;
pub use self::png::{Effort, Encoding, write_png};
pub use self::rows::PngRows;
pub use self::sheet::{Cell, SheetLayout, SheetPixels, compose};
pub use self::stream::{STDOUT, is_exr, is_stdout, print_beside};

use crate::error::{Error, Result};

/// Parameters of a picture by option name, sufficient to render it again.
pub type Metadata = Vec<(String, String)>;

fn write_error(path: &Path, reason: impl ToString) -> Error {
    Error::Write {
        path: path.to_owned(),
        reason: reason.to_string(),
    }
}

fn folder(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

/// Checks, before the work begins, that a file can be written.
///
/// # Errors
/// The folder is missing or not writable, or `path` is a folder.
pub fn check_writable(path: &Path) -> Result<()> {
    if is_stdout(path) {
        return Ok(());
    }
    let folder = folder(path);
    if !folder.is_dir() {
        let reason = format!(
            "the folder {} does not exist; create it first",
            folder.display()
        );
        return Err(write_error(path, reason));
    }
    if path.is_dir() {
        return Err(write_error(path, "it is a folder; give a file name"));
    }
    temporary(path).map(|_| ())
}

fn temporary(path: &Path) -> Result<tempfile::NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".skylight-");
    // Temporary files are private by default; pictures should get the permissions of the umask.
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt as _;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let file = if is_stdout(path) {
        builder.tempfile()
    } else {
        builder.tempfile_in(folder(path))
    };
    file.map_err(|e| write_error(path, reason(&e)))
}

fn reason(error: &std::io::Error) -> String {
    match error.kind() {
        // The folder exists, but some file systems (/proc) do not allow new files.
        std::io::ErrorKind::PermissionDenied | std::io::ErrorKind::NotFound => {
            "its folder does not accept new files; choose another".to_owned()
        }
        std::io::ErrorKind::StorageFull => "the disk is full; free some space".to_owned(),
        // The message omits the error number and the name of the temporary file.
        _ => {
            let text = error.to_string();
            text.split(" (os error").next().unwrap_or(&text).to_owned()
        }
    }
}

/// Writes a temporary file beside the target, then renames it.
///
/// # Errors
/// The file cannot be written; an existing file stays unchanged.
pub fn write_whole(path: &Path, bytes: &[u8]) -> Result<()> {
    write_set(&[(path.to_owned(), bytes.to_vec())])
}

/// Writes several files; none is renamed to its target until all are written.
///
/// # Errors
/// One of them cannot be written; existing files stay unchanged.
pub fn write_set(files: &[(PathBuf, Vec<u8>)]) -> Result<()> {
    let whole = files.iter().map(|(path, bytes)| {
        let mut file = temporary(path)?;
        let written = file
            .write_all(bytes)
            .and_then(|()| file.as_file().sync_all());
        written.map_err(|e| write_error(path, reason(&e)))?;
        Ok((path, file))
    });
    for (path, file) in whole.collect::<Result<Vec<_>>>()? {
        persist(path, file)?;
    }
    Ok(())
}

fn persist(path: &Path, file: tempfile::NamedTempFile) -> Result<()> {
    if is_stdout(path) {
        return stream::copy(file.as_file());
    }
    let renamed = file.persist(path);
    renamed.map_err(|e| write_error(path, reason(&e.error)))?;
    Ok(())
}

/// Writes a text file piece by piece, for texts larger than memory.
///
/// # Errors
/// The file cannot be written; an existing file stays unchanged.
pub fn write_lines(path: &Path, lines: impl Iterator<Item = String>) -> Result<()> {
    let failed = |e: std::io::Error| write_error(path, reason(&e));
    let mut file = std::io::BufWriter::new(temporary(path)?);
    for line in lines {
        file.write_all(line.as_bytes()).map_err(failed)?;
    }
    let file = file.into_inner().map_err(|e| failed(e.into_error()))?;
    file.as_file().sync_all().map_err(failed)?;
    persist(path, file)
}

/// Prints to standard output. A closed pipe (`| head`) is not an error.
///
/// # Errors
/// Standard output cannot be written.
pub fn print(text: &str) -> Result<()> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(Error::Stdout(reason(&e))),
        _ => Ok(()),
    }
}

/// Writes a text file.
///
/// # Errors
/// The file cannot be written; an existing file stays unchanged.
pub fn write_text(path: &Path, text: &str) -> Result<()> {
    write_whole(path, text.as_bytes())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn folders_that_cannot_take_a_file_are_named() {
        let dir = tempfile::tempdir().expect("a folder");
        let inside = dir.path().join("no/such/a.png");
        let text = check_writable(&inside).expect_err("missing").to_string();
        assert!(text.contains("does not exist"), "{text}");
        let text = check_writable(dir.path()).expect_err("folder").to_string();
        assert!(text.contains("is a folder"), "{text}");
        check_writable(&dir.path().join("a.png")).expect("good");
        assert_eq!(
            dir.path().read_dir().expect("folder").count(),
            0,
            "nothing is left behind"
        );
    }

    #[test]
    fn of_a_set_all_or_none_is_written() {
        let dir = tempfile::tempdir().expect("a folder");
        let (good, bad) = (dir.path().join("a"), dir.path().join("no/such/b"));
        let set = |second| [(good.clone(), vec![1]), (second, vec![2])];
        assert!(write_set(&set(bad)).is_err());
        assert_eq!(dir.path().read_dir().expect("folder").count(), 0);
        write_set(&set(dir.path().join("b"))).expect("written");
        assert_eq!(dir.path().read_dir().expect("folder").count(), 2);
    }

    #[test]
    fn an_old_file_is_replaced_whole() {
        let dir = tempfile::tempdir().expect("a folder");
        let path = dir.path().join("a.bin");
        write_whole(&path, b"old").expect("written");
        write_whole(&path, b"new one").expect("written");
        assert_eq!(std::fs::read(&path).expect("read"), b"new one");
        assert_eq!(dir.path().read_dir().expect("folder").count(), 1);
    }
}
