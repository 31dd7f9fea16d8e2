//! Parsing of the lines of OBJ files.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use crate::scene::mesh::soup::{Corner, NONE, Triangle};
use crate::scene::obj::text::{Counts, ObjText};

/// A malformed line.
#[derive(Debug, PartialEq, Eq)]
pub struct LineError {
    /// Line number, from 1.
    pub line: usize,
    pub what: String,
}

/// Parser state left by the preceding lines.
#[derive(Debug, Default, Clone)]
pub struct State {
    /// Number of `v`, `vt` and `vn` lines so far; negative indices count back from here.
    pub seen: Counts,
    /// Number of lines so far.
    pub lines: usize,
    /// Name of the current material; empty for none.
    pub material: String,
    /// Current smoothing group; 0 for none.
    pub smoothing: u32,
}

/// A line by keyword, with its arguments.
#[derive(Debug, PartialEq, Eq)]
pub enum Statement<'t> {
    Vertex(&'t str),
    Texcoord(&'t str),
    Normal(&'t str),
    Face(&'t str),
    /// A point or a line element, which is not drawn.
    Undrawn,
    Smoothing(u32),
    Material(&'t str),
    Library(&'t str),
    Other,
}

impl<'t> Statement<'t> {
    pub fn of(line: &'t str) -> Self {
        let line = line.trim();
        let end = line.find(|c: char| c.is_whitespace());
        let (key, rest) = line.split_at(end.unwrap_or(line.len()));
        let rest = rest.trim_start();
        match key {
            "v" => Self::Vertex(rest),
            "vt" => Self::Texcoord(rest),
            "vn" => Self::Normal(rest),
            "f" | "fo" => Self::Face(rest),
            "l" | "p" => Self::Undrawn,
            "s" => Self::Smoothing(rest.split_whitespace().next().map_or(0, smoothing_group)),
            "usemtl" if !rest.is_empty() => Self::Material(rest),
            "mtllib" if !rest.is_empty() => Self::Library(rest),
            _ => Self::Other,
        }
    }
}

/// `off`, `0` and anything that is not a number turn smoothing off.
fn smoothing_group(word: &str) -> u32 {
    if word.eq_ignore_ascii_case("on") {
        1
    } else {
        word.parse().unwrap_or(0)
    }
}

/// Parses lines into an [`ObjText`].
pub struct LineReader {
    out: ObjText,
    state: State,
    /// Totals of the whole file: positive indices may refer to later lines.
    total: Counts,
    /// Index in `out` of the state's material; `None` until a face uses it.
    material: Option<u32>,
    indices: HashMap<String, u32>,
    corners: Vec<[Index; 3]>,
}

impl LineReader {
    pub fn new(state: State, total: Counts) -> Self {
        Self {
            out: ObjText::default(),
            state,
            total,
            material: None,
            indices: HashMap::new(),
            corners: Vec::new(),
        }
    }

    pub fn finish(self) -> ObjText {
        self.out
    }

    pub fn line(&mut self, line: &str) -> Result<(), String> {
        match Statement::of(line) {
            Statement::Vertex(rest) => self.vertex(rest)?,
            Statement::Texcoord(rest) => {
                let uv = numbers::<2>(rest, 1, "a texture coordinate")?;
                self.out.soup.texcoords.push(Vec2::from(uv));
                self.state.seen[1] += 1;
            }
            Statement::Normal(rest) => {
                let normal = numbers::<3>(rest, 3, "a normal")?;
                self.out.soup.normals.push(Vec3::from(normal));
                self.state.seen[2] += 1;
            }
            Statement::Face(rest) => self.face(rest)?,
            Statement::Undrawn => self.out.not_faces += 1,
            Statement::Smoothing(group) => self.state.smoothing = group,
            Statement::Material(name) => {
                name.clone_into(&mut self.state.material);
                self.material = None;
            }
            Statement::Library(rest) => self.out.libraries.push(rest.to_owned()),
            Statement::Other => {}
        }
        Ok(())
    }

    /// Three coordinates, an ignored weight (for rational curves), and a colour.
    fn vertex(&mut self, rest: &str) -> Result<(), String> {
        let soup = &mut self.out.soup;
        let mut words = rest.split_ascii_whitespace();
        let position = numbers_of::<3>(&mut words, 3, "a vertex position")?;
        let tail: [Option<f32>; 4] = std::array::from_fn(|_| words.next()?.parse().ok());
        let colour = match tail {
            [Some(r), Some(g), Some(b), None] => Some([r, g, b]),
            [_, Some(r), Some(g), Some(b)] => Some([r, g, b]),
            _ => None,
        };
        if let Some(colour) = colour.filter(|rgb| rgb.iter().all(|v| v.is_finite())) {
            // Earlier positions had no colour: fill with white.
            soup.colours.resize(soup.positions.len(), [1.0; 4]);
            let [r, g, b] = colour;
            soup.colours.push([r, g, b, 1.0]);
        }
        soup.positions.push(Vec3::from(position));
        self.state.seen[0] += 1;
        Ok(())
    }

    fn face(&mut self, rest: &str) -> Result<(), String> {
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        for word in rest.split_ascii_whitespace() {
            // A trailing comment.
            if word.starts_with('#') {
                continue;
            }
            corners.push(self.corner(word)?);
        }
        if corners.len() < 3 {
            self.out.not_faces += 1;
        } else {
            self.push_face(&corners);
        }
        self.corners = corners;
        Ok(())
    }

    fn push_face(&mut self, corners: &[[Index; 3]]) {
        // An attribute counts only if all corners have it.
        let every = |kind: usize| corners.iter().all(|c| matches!(c[kind], Index::At(_)));
        let (texcoords, normals) = (every(1), every(2));
        let is_dangling = corners.iter().flatten().any(|i| *i == Index::OutOfRange);
        self.out.dangling += usize::from(is_dangling);
        let material = self.material_index();
        let corner = |c: &[Index; 3]| Corner {
            position: c[0].number(true),
            texcoord: c[1].number(texcoords),
            normal: c[2].number(normals),
        };
        let smoothing = self.state.smoothing;
        let soup = &mut self.out.soup;
        if let [a, b, c] = corners {
            soup.triangles.push(Triangle {
                corners: [a, b, c].map(corner),
                material,
                smoothing,
            });
        } else {
            soup.push_polygon(corners.iter().map(corner), material, smoothing);
        }
    }

    fn material_index(&mut self) -> u32 {
        if let Some(number) = self.material {
            return number;
        }
        let name = &self.state.material;
        let number = self.indices.get(name).copied().unwrap_or_else(|| {
            let number = self.out.materials.len() as u32;
            self.out.materials.push(name.clone());
            self.indices.insert(name.clone(), number);
            number
        });
        self.material = Some(number);
        number
    }

    fn corner(&self, word: &str) -> Result<[Index; 3], String> {
        let mut corner = [Index::None; 3];
        for (kind, part) in word.split('/').enumerate() {
            let place = corner
                .get_mut(kind)
                .ok_or_else(|| format!("\"{}\" has more than three indices", short(word)))?;
            if !part.is_empty() {
                let value = part
                    .parse()
                    .map_err(|_| format!("\"{}\" is not a corner of a face", short(word)))?;
                *place = resolve(value, self.state.seen[kind], self.total[kind]);
            }
        }
        match corner[0] {
            Index::At(_) => Ok(corner),
            Index::None => Err(format!("\"{}\" has no vertex index", short(word))),
            Index::OutOfRange if word.split('/').next() == Some("0") => {
                Err(format!("\"{word}\" has index 0; OBJ indices start at 1"))
            }
            Index::OutOfRange => Err(format!(
                "\"{}\" refers to a vertex that does not exist (there are {})",
                short(word),
                self.total[0]
            )),
        }
    }
}

/// The first 40 characters of a word, for messages: malicious words may be megabytes long.
fn short(word: &str) -> &str {
    let end = word.char_indices().nth(40).map_or(word.len(), |(i, _)| i);
    &word[..end]
}

fn numbers<const N: usize>(rest: &str, least: usize, what: &str) -> Result<[f32; N], String> {
    numbers_of(&mut rest.split_ascii_whitespace(), least, what)
}

/// Parses `N` numbers, of which the first `least` are required; the others default to 0.
fn numbers_of<'t, const N: usize>(
    words: &mut impl Iterator<Item = &'t str>,
    least: usize,
    what: &str,
) -> Result<[f32; N], String> {
    let mut values = [0.0; N];
    for (i, value) in values.iter_mut().enumerate() {
        match words.next() {
            // The C runtime of old Windows programs prints 1.#INF, 1.#IND and 1.#QNAN.
            Some(word) if word.contains('#') && i < least => *value = f32::NAN,
            Some(word) => {
                let parsed = word.parse().map_err(|_| format!("{what} is not a number"));
                *value = if i < least {
                    parsed?
                } else {
                    parsed.unwrap_or(0.0)
                };
            }
            None if i < least => {
                let need = if least == 3 {
                    "three numbers"
                } else {
                    "numbers"
                };
                return Err(format!("{what} needs {need}"));
            }
            None => break,
        }
    }
    Ok(values)
}

/// An index of a face corner.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Index {
    /// Not given.
    None,
    /// In range, zero-based.
    At(u32),
    /// Out of range.
    OutOfRange,
}

impl Index {
    fn number(self, wanted: bool) -> u32 {
        match self {
            Self::At(i) if wanted => i,
            _ => NONE,
        }
    }
}

fn resolve(value: i64, seen: usize, total: usize) -> Index {
    let absolute = if value < 0 {
        (seen as i64).checked_add(value)
    } else {
        value.checked_sub(1)
    };
    match absolute.and_then(|i| u32::try_from(i).ok()) {
        Some(i) if (i as usize) < total && i != NONE => Index::At(i),
        _ => Index::OutOfRange,
    }
}
