//! Standard output in place of a file.

use std::io::{Seek as _, Write};
use std::path::Path;

use super::{print, reason};
use crate::error::{Error, Result};

/// The names of standard output: a picture there is a PNG, or an EXR.
pub const STDOUT: [&str; 2] = ["-", "exr:-"];

/// Whether `path` is a name of standard output.
pub fn is_stdout(path: &Path) -> bool {
    path.to_str().is_some_and(|name| STDOUT.contains(&name))
}

/// Whether a picture of this name is an EXR.
pub fn is_exr(path: &Path) -> bool {
    let extension = path.extension();
    path == Path::new(STDOUT[1]) || extension.is_some_and(|e| e.eq_ignore_ascii_case("exr"))
}

/// Prints a result beside a file: on standard output, or on standard error where the file is there.
///
/// # Errors
/// Standard output cannot be written.
pub fn print_beside(path: &Path, text: &str) -> Result<()> {
    if !is_stdout(path) {
        return print(text);
    }
    eprint!("{text}");
    Ok(())
}

/// Copies a file to standard output. A closed pipe is not an error.
pub(super) fn copy(mut file: &std::fs::File) -> Result<()> {
    let mut out = std::io::stdout().lock();
    let copied = file
        .rewind()
        .and_then(|()| std::io::copy(&mut file, &mut out))
        .and_then(|_| out.flush());
    match copied {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => Err(Error::Stdout(reason(&e))),
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_standard_output_and_of_pictures() {
        for (name, stdout, exr) in [
            ("-", true, false),
            ("exr:-", true, true),
            ("./-", false, false),
            ("-.png", false, false),
            ("a.EXR", false, true),
            ("a.png", false, false),
        ] {
            let path = Path::new(name);
            assert_eq!((is_stdout(path), is_exr(path)), (stdout, exr), "{name}");
        }
    }
}
