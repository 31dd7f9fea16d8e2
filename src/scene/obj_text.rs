//! Puts the text of an OBJ file into the form that `tobj` reads without loss.
//!
//! `tobj` does not know smoothing groups, guesses where a corner names no normal, stops at colours on some vertices only,
//! at `usemtl` with a tab, and names no lines. So each line is checked here, and rewritten where needed; what `tobj`
//! would lose is collected per face. Line N of the result is line N of the file plus [`EXTRA_LINES`].

use std::borrow::Cow;
use std::collections::BTreeSet;
use std::fmt::Write;

/// Lines put before the file's own: one `mtllib`, so that materials are known wherever the file names its libraries.
pub(super) const EXTRA_LINES: usize = 1;

/// What `tobj` does not keep of a face.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct FaceInfo {
    /// The smoothing group; 0 is none.
    pub smoothing: u32,
    /// Whether every corner names a normal that exists.
    pub normals: bool,
    /// Whether every corner names a texture coordinate that exists.
    pub texcoords: bool,
}

/// The result of [`clean`].
#[derive(Debug, Default)]
pub(super) struct Cleaned {
    /// For `tobj`.
    pub text: String,
    /// One for each face of three corners and more, in the order of the file.
    pub faces: Vec<FaceInfo>,
    /// The rests of the `mtllib` lines.
    pub libraries: Vec<String>,
    /// The names of the `usemtl` lines.
    pub materials: BTreeSet<String>,
    /// Points, lines, and faces of fewer than three corners: skipped.
    pub not_faces: usize,
    /// Faces that name normals or texture coordinates that do not exist.
    pub dangling: usize,
}

/// A line that makes no sense.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct LineError {
    /// Counted from 1.
    pub line: usize,
    pub what: String,
}

/// Numbers of `v`, `vt` and `vn` lines.
#[derive(Debug, Default, Clone, Copy)]
struct Counts([usize; 3]);

/// Cleans a whole file.
///
/// # Errors
/// The first face that cannot be read, or that names a vertex that does not exist.
pub(super) fn clean(text: &str) -> Result<Cleaned, LineError> {
    let total = count(text);
    let mut cleaner = Cleaner {
        out: Cleaned {
            text: String::with_capacity(text.len() + 64),
            ..Cleaned::default()
        },
        total,
        seen: Counts::default(),
        smoothing: 0,
    };
    cleaner.out.text.push_str("mtllib *\n");
    let mut lines = text.lines().enumerate();
    while let Some((number, line)) = lines.next() {
        let mut line = Cow::Borrowed(line);
        let mut blank = 0;
        // A backslash at the end continues the line; blank lines keep the count right.
        while let Some(start) = line.trim_end().strip_suffix('\\') {
            let Some((_, next)) = lines.next() else { break };
            line = Cow::Owned(format!("{start} {next}"));
            blank += 1;
        }
        cleaner.line(&line).map_err(|what| LineError {
            line: number + 1,
            what,
        })?;
        cleaner
            .out
            .text
            .extend(std::iter::repeat_n('\n', 1 + blank));
    }
    Ok(cleaner.out)
}

fn count(text: &str) -> Counts {
    let mut counts = Counts::default();
    for line in text.lines() {
        let kind = match line.split_ascii_whitespace().next() {
            Some("v") => 0,
            Some("vt") => 1,
            Some("vn") => 2,
            _ => continue,
        };
        counts.0[kind] += 1;
    }
    counts
}

struct Cleaner {
    out: Cleaned,
    /// Of the whole file: positive numbers may point ahead.
    total: Counts,
    /// So far: negative numbers count back from here.
    seen: Counts,
    smoothing: u32,
}

impl Cleaner {
    fn line(&mut self, line: &str) -> Result<(), String> {
        let line = line.trim();
        let (key, rest) = line
            .split_once(|c: char| c.is_whitespace())
            .unwrap_or((line, ""));
        let rest = rest.trim();
        match key {
            // Only three numbers of a vertex matter here: `tobj` would divide by a fourth and stop at a fifth.
            "v" => self.numbers("v", 0, rest, 3, "a vertex position needs three numbers")?,
            "vt" => self.numbers("vt", 1, rest, 2, "a texture coordinate needs numbers")?,
            "vn" => self.numbers("vn", 2, rest, 3, "a normal needs three numbers")?,
            "f" | "fo" => self.face(rest)?,
            "l" | "p" => self.out.not_faces += 1,
            "s" => self.smoothing = rest.split_whitespace().next().map_or(0, smoothing_group),
            "o" | "g" => self.out.text.push_str("g _"),
            "usemtl" if !rest.is_empty() => {
                let _ = write!(self.out.text, "usemtl {rest}");
                if !self.out.materials.contains(rest) {
                    self.out.materials.insert(rest.to_owned());
                }
            }
            "mtllib" if !rest.is_empty() => self.out.libraries.push(rest.to_owned()),
            _ => {}
        }
        Ok(())
    }

    fn numbers(
        &mut self,
        key: &str,
        kind: usize,
        rest: &str,
        wanted: usize,
        need: &str,
    ) -> Result<(), String> {
        self.seen.0[kind] += 1;
        self.out.text.push_str(key);
        let mut found = 0;
        for word in rest.split_ascii_whitespace().take(wanted) {
            self.out.text.push(' ');
            // The C runtime of old Windows programs writes infinities and the like as 1.#INF, 1.#IND, 1.#QNAN.
            self.out
                .text
                .push_str(if word.contains('#') { "nan" } else { word });
            found += 1;
        }
        if kind == 1 && found == 1 {
            self.out.text.push_str(" 0");
            found = 2;
        }
        if found < wanted {
            return Err(need.to_owned());
        }
        Ok(())
    }

    fn face(&mut self, rest: &str) -> Result<(), String> {
        let corners = rest
            .split_ascii_whitespace()
            .filter(|word| !word.starts_with('#'));
        let corners: Vec<[Index; 3]> = corners
            .map(|word| self.corner(word))
            .collect::<Result<_, _>>()?;
        if corners.len() < 3 {
            self.out.not_faces += 1;
            return Ok(());
        }
        let every = |kind: usize| corners.iter().all(|c| matches!(c[kind], Index::At(_)));
        let info = FaceInfo {
            smoothing: self.smoothing,
            texcoords: every(1),
            normals: every(2),
        };
        self.out.dangling += usize::from(corners.iter().flatten().any(|i| *i == Index::Nowhere));
        self.out.faces.push(info);
        self.write_face(&corners, info);
        Ok(())
    }

    fn write_face(&mut self, corners: &[[Index; 3]], info: FaceInfo) {
        self.out.text.push('f');
        for [v, vt, vn] in corners {
            let text = &mut self.out.text;
            let _ = match (info.texcoords, info.normals) {
                (false, false) => write!(text, " {v}"),
                (true, false) => write!(text, " {v}/{vt}"),
                (false, true) => write!(text, " {v}//{vn}"),
                (true, true) => write!(text, " {v}/{vt}/{vn}"),
            };
        }
    }

    fn corner(&self, word: &str) -> Result<[Index; 3], String> {
        let mut corner = [Index::None; 3];
        for (kind, part) in word.split('/').enumerate() {
            let place = corner
                .get_mut(kind)
                .ok_or_else(|| format!("\"{word}\" has more than three numbers"))?;
            if !part.is_empty() {
                let value = part
                    .parse()
                    .map_err(|_| format!("\"{word}\" is not a corner of a face"))?;
                *place = resolve(value, self.seen.0[kind], self.total.0[kind]);
            }
        }
        match corner[0] {
            Index::At(_) => Ok(corner),
            Index::None => Err(format!("\"{word}\" names no vertex")),
            Index::Nowhere if word.split('/').next() == Some("0") => {
                Err(format!("\"{word}\" has number 0; OBJ counts from 1"))
            }
            Index::Nowhere => {
                let total = self.total.0[0];
                Err(format!(
                    "\"{word}\" names a vertex that does not exist (there are {total})"
                ))
            }
        }
    }
}

/// Where a number of a face points to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Index {
    /// It was left out.
    None,
    /// It exists; counted from 1.
    At(usize),
    /// It is out of range.
    Nowhere,
}

impl std::fmt::Display for Index {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::At(i) => i.fmt(f),
            Self::None | Self::Nowhere => Ok(()),
        }
    }
}

fn resolve(value: i64, seen: usize, total: usize) -> Index {
    let absolute = if value < 0 {
        (seen as i64).checked_add(value).map(|i| i + 1)
    } else {
        Some(value)
    };
    match absolute.and_then(|i| usize::try_from(i).ok()) {
        Some(i) if (1..=total).contains(&i) => Index::At(i),
        _ => Index::Nowhere,
    }
}

/// `off`, `0` and anything that is no number end smoothing.
fn smoothing_group(word: &str) -> u32 {
    if word.eq_ignore_ascii_case("on") {
        1
    } else {
        word.parse().unwrap_or(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

    fn cleaned(text: &str) -> Cleaned {
        clean(text).expect("good text")
    }

    #[test]
    fn lines_keep_their_numbers() {
        let text = format!("# c\n{TRIANGLE}\nf 1 2 \\\n 3\nusemtl\tred stone\nf 1 2 3\n");
        let out = cleaned(&text);
        let lines: Vec<_> = out.text.lines().skip(EXTRA_LINES).collect();
        assert_eq!(lines[5], "f 1 2 3");
        assert_eq!(lines[7], "usemtl red stone");
        assert_eq!(lines.len(), text.lines().count());
    }

    #[test]
    fn negative_numbers_count_back() {
        let out = cleaned(&format!("{TRIANGLE}f -3 -2 -1\nv 5 5 5\nf -4 -3 -1"));
        assert!(
            out.text.contains("f 1 2 3\n") && out.text.contains("f 1 2 4\n"),
            "{}",
            out.text
        );
    }

    #[test]
    fn groups_and_missing_normals_are_kept_per_face() {
        let text = format!(
            "{TRIANGLE}vn 0 0 1\ns 3\nf 1//1 2//1 3//1\ns off\nf 1//1 2 3//1\nf 1//9 2//9 3//9\n"
        );
        let out = cleaned(&text);
        let kept: Vec<_> = out.faces.iter().map(|f| (f.smoothing, f.normals)).collect();
        assert_eq!(kept, [(3, true), (0, false), (0, false)]);
        assert_eq!(out.dangling, 1, "only the last names what does not exist");
    }

    #[test]
    fn bad_faces_name_their_line() {
        for (face, part) in [
            ("f 1 2 9", "does not exist"),
            ("f 0 1 2", "counts from 1"),
            ("f 1 2 -4", "does not exist"),
            ("f 1 2 99999999999999999999999", "not a corner"),
            ("f -9223372036854775808 1 2", "does not exist"),
            ("f 1 2 x", "not a corner"),
            ("f 1 2 /3", "names no vertex"),
            ("f 1/1/1/1 2 3", "more than three"),
            ("v 1 2", "three numbers"),
        ] {
            let error = clean(&format!("{TRIANGLE}{face}\n")).expect_err(face);
            assert_eq!(error.line, 4, "{face}");
            assert!(error.what.contains(part), "{face}: {}", error.what);
        }
    }

    #[test]
    fn points_lines_and_colours_are_left_out() {
        let out = cleaned("v 0 0 0 1 0 0\nv 1 0 0 0.5\nv 1.#IND 1 0\nl 1 2\np 1\nf 1 2\nvt 0.5\n");
        assert_eq!(out.not_faces, 3);
        assert!(
            out.text.contains("v 0 0 0\nv 1 0 0\nv nan 1 0\n"),
            "{}",
            out.text
        );
        assert!(out.text.contains("vt 0.5 0\n"));
    }
}
