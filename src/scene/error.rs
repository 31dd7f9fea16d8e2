//! What can be wrong with a scene: one line each, with the thing and the remedy.

use std::path::{Path, PathBuf};

/// Why a scene cannot be shown. Its text is one line that names the file and says what to do.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// No such file.
    #[error("{}: no such file; check the path", shown(.0))]
    Missing(PathBuf),
    /// A directory where a file is needed.
    #[error("{} is a directory; name a .toml, .obj, .gltf or .glb file in it", shown(.0))]
    Directory(PathBuf),
    /// A pipe, a device, a socket.
    #[error("{} is not a regular file; save it to disk first", shown(.0))]
    NotAFile(PathBuf),
    /// The system refused to read it.
    #[error("{}: cannot be read ({reason}); check its permissions", shown(path))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The system's words.
        reason: String,
    },
    /// Larger than [`LoadOptions::max_file_bytes`](crate::scene::LoadOptions::max_file_bytes).
    #[error(
        "{} has {bytes} bytes, the limit is {limit}; split it or raise --max-file-mib",
        shown(path)
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its size, bytes.
        bytes: u64,
        /// The limit, bytes.
        limit: u64,
    },
    /// All files together are larger than [`LoadOptions::max_file_bytes`](crate::scene::LoadOptions::max_file_bytes).
    #[error(
        "{}: with it the files of the scene have more than {limit} bytes; name fewer or raise --max-file-mib",
        shown(path)
    )]
    TooMuch {
        /// The file that is too much.
        path: PathBuf,
        /// The limit, bytes.
        limit: u64,
    },
    /// More triangles than [`LoadOptions::max_triangles`](crate::scene::LoadOptions::max_triangles) or than 32-bit numbers count.
    #[error(
        "{}: {triangles} triangles, the limit is {limit}; simplify it or raise --max-triangles",
        shown(path)
    )]
    TooMany {
        /// The file.
        path: PathBuf,
        /// Of the whole scene.
        triangles: usize,
        /// The limit.
        limit: usize,
    },
    /// A kind of file that is not read (yet).
    #[error("{}: {what}", shown(path))]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// What is not supported, and what is.
        what: String,
    },
    /// A line of a model that makes no sense.
    #[error("{}, line {line}: {what}", shown(path))]
    Malformed {
        /// The file.
        path: PathBuf,
        /// Counted from 1.
        line: usize,
        /// What is wrong with it.
        what: String,
    },
    /// Nothing to draw; `why` is empty or says what was left out, in brackets.
    #[error("{} has no triangles{why}; export it with faces", shown(path))]
    NoTriangles {
        /// The file.
        path: PathBuf,
        /// What was dropped.
        why: String,
    },
    /// A key or value of a scene file that makes no sense.
    #[error("{}: {what}", shown(path))]
    SceneFile {
        /// The file.
        path: PathBuf,
        /// What is wrong, with the known words.
        what: String,
    },
}

/// A path for a message: names may hold line breaks and worse.
pub(crate) fn shown(path: &Path) -> String {
    printable(&path.display().to_string())
}

/// Text for one line of a terminal.
pub(crate) fn printable(text: &str) -> String {
    let letter = |c: char| {
        let escaped = c.is_control().then(|| c.escape_default());
        let plain = escaped.is_none().then_some(c);
        escaped.into_iter().flatten().chain(plain)
    };
    text.chars().flat_map(letter).collect()
}
