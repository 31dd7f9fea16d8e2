//! Errors of loading a scene. Each is one line that names the file and the remedy.

use std::path::{Path, PathBuf};

/// Why a scene cannot be loaded. The message is one line that names the file and the remedy.
#[derive(Debug, thiserror::Error)]
pub enum SceneError {
    /// The file does not exist.
    #[error("{}: no such file; check the path", shown(.0))]
    Missing(PathBuf),
    /// The path is a directory.
    #[error("{} is a directory; name a .toml, .obj, .gltf or .glb file in it", shown(.0))]
    Directory(PathBuf),
    /// The path is a pipe, a device or a socket.
    #[error("{} is not a regular file; save it to disk first", shown(.0))]
    NotAFile(PathBuf),
    /// The file stands for one that Git LFS keeps elsewhere.
    #[error("{} is a Git LFS pointer, not the file itself; run git lfs pull", shown(.0))]
    Pointer(PathBuf),
    /// The operating system cannot read the file.
    #[error("{}: cannot be read ({reason}); check its permissions", shown(path))]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// The message of the operating system.
        reason: String,
    },
    /// The file is larger than [`LoadOptions::max_file_bytes`](crate::scene::LoadOptions::max_file_bytes).
    #[error(
        "{} has {bytes} bytes, the limit is {limit}; split it or raise --max-file-mib",
        shown(path)
    )]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// File size, bytes.
        bytes: u64,
        /// The limit, bytes.
        limit: u64,
    },
    /// The files of the scene together are larger than
    /// [`LoadOptions::max_file_bytes`](crate::scene::LoadOptions::max_file_bytes).
    #[error(
        "{}: with this file the scene exceeds {limit} bytes; use fewer files or raise --max-file-mib",
        shown(path)
    )]
    TooMuch {
        /// The file that exceeds the limit.
        path: PathBuf,
        /// The limit, bytes.
        limit: u64,
    },
    /// The scene has more triangles than [`LoadOptions::max_triangles`](crate::scene::LoadOptions::max_triangles) or 32-bit
    /// indices allow.
    #[error(
        "{}: {triangles} triangles, the limit is {limit}; simplify it or raise --max-triangles",
        shown(path)
    )]
    TooMany {
        /// The file.
        path: PathBuf,
        /// Number of triangles in the scene.
        triangles: usize,
        /// The limit.
        limit: usize,
    },
    /// The file, or a feature it uses, is not supported.
    #[error("{}: {what}", shown(path))]
    Unsupported {
        /// The file.
        path: PathBuf,
        /// What is unsupported, and the remedy.
        what: String,
    },
    /// There is nothing to draw; `why` is empty or lists in parentheses what was dropped.
    #[error("{} has no triangles{why}; export it with faces", shown(path))]
    NoTriangles {
        /// The file.
        path: PathBuf,
        /// What was dropped.
        why: String,
    },
    /// A key or value of a scene file is invalid.
    #[error("{}: {what}", shown(path))]
    SceneFile {
        /// The file.
        path: PathBuf,
        /// What is wrong, with the valid values.
        what: String,
    },
}

/// A path formatted for a message: file names may contain line breaks and control characters.
pub(crate) fn shown(path: &Path) -> String {
    printable(&path.display().to_string())
}

/// Text for one line of a terminal, with control characters escaped.
pub(crate) fn printable(text: &str) -> String {
    let letter = |c: char| {
        let escaped = c.is_control().then(|| c.escape_default());
        let plain = escaped.is_none().then_some(c);
        escaped.into_iter().flatten().chain(plain)
    };
    text.chars().flat_map(letter).collect()
}

/// A message from another crate, on one line.
pub(super) fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
