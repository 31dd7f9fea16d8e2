//! Names of the frames of a sequence.

use std::path::{Path, PathBuf};

use crate::options::OptionsError;
use crate::sensors::Shard;

/// Most digits of a number in a name.
const MOST_DIGITS: usize = 9;

/// A file name with the place of a number, as in C: `frame_%04d.png`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct FrameNames {
    before: String,
    /// Fewest digits; 0 for as many as there are.
    digits: usize,
    after: String,
}

impl FrameNames {
    /// # Errors
    /// The name has no place for a number, or several.
    pub fn parse(path: &Path) -> Result<Self, OptionsError> {
        let wrong = || {
            let extension = path.extension().unwrap_or_default().to_string_lossy();
            OptionsError(format!(
                "-o {} has no place for the number of a frame; write it as in frame_%04d.{extension}",
                path.display()
            ))
        };
        let text = path.to_str().ok_or_else(wrong)?;
        let (folder, name) = match text.rfind('/') {
            Some(at) => text.split_at(at + 1),
            None => ("", text),
        };
        let (before, rest) = name.split_once('%').ok_or_else(wrong)?;
        let (digits, after) = rest.split_once('d').ok_or_else(wrong)?;
        let is_digits = digits.is_empty()
            || digits.starts_with('0') && digits.bytes().all(|b| b.is_ascii_digit());
        let count = if digits.is_empty() {
            Some(0)
        } else {
            digits.parse().ok()
        };
        let count = count.filter(|count| *count <= MOST_DIGITS);
        match count {
            Some(digits) if is_digits && !after.contains('%') => Ok(Self {
                before: format!("{folder}{before}"),
                digits,
                after: after.to_owned(),
            }),
            _ => Err(wrong()),
        }
    }

    /// The file of a frame.
    pub fn file(&self, number: usize) -> PathBuf {
        let Self {
            before,
            digits,
            after,
        } = self;
        format!("{before}{number:0digits$}{after}").into()
    }

    /// The file that says what a shard has drawn.
    pub fn shard_file(&self, shard: Shard) -> PathBuf {
        let Shard { number, of } = shard;
        let stem = self.before.trim_end_matches(['_', '-', '.']);
        let gap = if stem.is_empty() || stem.ends_with('/') {
            ""
        } else {
            "_"
        };
        format!("{stem}{gap}{number}-of-{of}.shard").into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_written_as_c_does() {
        let names = |text: &str| FrameNames::parse(Path::new(text));
        for (pattern, first, shard) in [
            ("frame_%04d.png", "frame_0007.png", "frame_3-of-12.shard"),
            ("a%b/%d.exr", "a%b/7.exr", "a%b/3-of-12.shard"),
            ("f-%012d.png", "", ""),
            ("%02d.png", "07.png", "3-of-12.shard"),
        ] {
            match names(pattern) {
                Ok(names) => {
                    assert_eq!(names.file(7), Path::new(first));
                    let of_shard = Shard { number: 3, of: 12 };
                    assert_eq!(names.shard_file(of_shard), Path::new(shard));
                }
                Err(_) => assert_eq!(first, "", "{pattern}"),
            }
        }
        assert_eq!(
            names("%02d.png").expect("names").file(1234),
            Path::new("1234.png")
        );
        for pattern in ["a.png", "%.png", "%s.png", "%4d.png", "%d%d.png", "%-d.png"] {
            let error = names(pattern).expect_err(pattern).to_string();
            assert!(error.contains("frame_%04d.png"), "{error}");
        }
    }
}
