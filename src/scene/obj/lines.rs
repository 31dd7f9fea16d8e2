//! The lines of an OBJ file.

use std::collections::HashMap;

use glam::{Vec2, Vec3};

use crate::scene::mesh::soup::{Corner, NONE, Triangle};
use crate::scene::obj::text::{Counts, ObjText};

/// A line that makes no sense.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::scene) struct LineError {
    /// Counted from 1.
    pub line: usize,
    pub what: String,
}

/// What lines before may have said.
#[derive(Debug, Default, Clone)]
pub(in crate::scene) struct State {
    /// Numbers of `v`, `vt` and `vn` lines so far: negative numbers count back from here.
    pub seen: Counts,
    /// Lines so far.
    pub lines: usize,
    /// Name of the material; empty is none.
    pub material: String,
    /// The smoothing group; 0 is none.
    pub smoothing: u32,
}

/// A line by its key word, with its rest.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::scene) enum Cleared<'t> {
    Vertex(&'t str),
    Texcoord(&'t str),
    Normal(&'t str),
    Face(&'t str),
    /// A point or a line: not drawn.
    Undrawn,
    Smoothing(u32),
    Material(&'t str),
    Library(&'t str),
    Other,
}

impl<'t> Cleared<'t> {
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

/// `off`, `0` and anything that is no number end smoothing.
fn smoothing_group(word: &str) -> u32 {
    if word.eq_ignore_ascii_case("on") {
        1
    } else {
        word.parse().unwrap_or(0)
    }
}

/// Reads line after line into an [`ObjText`].
pub(in crate::scene) struct LineReader {
    out: ObjText,
    state: State,
    /// Of the whole file: positive numbers may point ahead.
    total: Counts,
    /// Number of the state's material in `out`; none until a face uses it.
    material: Option<u32>,
    numbers: HashMap<String, u32>,
    corners: Vec<[Index; 3]>,
}

impl LineReader {
    pub fn new(state: State, total: Counts) -> Self {
        Self {
            out: ObjText::default(),
            state,
            total,
            material: None,
            numbers: HashMap::new(),
            corners: Vec::new(),
        }
    }

    pub fn finish(self) -> ObjText {
        self.out
    }

    pub fn line(&mut self, line: &str) -> Result<(), String> {
        match Cleared::of(line) {
            Cleared::Vertex(rest) => self.vertex(rest)?,
            Cleared::Texcoord(rest) => {
                let uv = numbers::<2>(rest, 1, "a texture coordinate")?;
                self.out.soup.texcoords.push(Vec2::from(uv));
                self.state.seen[1] += 1;
            }
            Cleared::Normal(rest) => {
                let normal = numbers::<3>(rest, 3, "a normal")?;
                self.out.soup.normals.push(Vec3::from(normal));
                self.state.seen[2] += 1;
            }
            Cleared::Face(rest) => self.face(rest)?,
            Cleared::Undrawn => self.out.not_faces += 1,
            Cleared::Smoothing(group) => self.state.smoothing = group,
            Cleared::Material(name) => {
                name.clone_into(&mut self.state.material);
                self.material = None;
            }
            Cleared::Library(rest) => self.out.libraries.push(rest.to_owned()),
            Cleared::Other => {}
        }
        Ok(())
    }

    /// Three numbers; a fourth is a weight and left out; six or more end with a colour.
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
            // Those before it had none.
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
            // A comment behind the face.
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
        // A corner without normal or texture takes them from all.
        let every = |kind: usize| corners.iter().all(|c| matches!(c[kind], Index::At(_)));
        let (texcoords, normals) = (every(1), every(2));
        let nowhere = corners.iter().flatten().any(|i| *i == Index::Nowhere);
        self.out.dangling += usize::from(nowhere);
        let material = self.material_number();
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

    fn material_number(&mut self) -> u32 {
        if let Some(number) = self.material {
            return number;
        }
        let name = &self.state.material;
        let number = self.numbers.get(name).copied().unwrap_or_else(|| {
            let number = self.out.materials.len() as u32;
            self.out.materials.push(name.clone());
            self.numbers.insert(name.clone(), number);
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
                .ok_or_else(|| format!("\"{}\" has more than three numbers", short(word)))?;
            if !part.is_empty() {
                let value = part
                    .parse()
                    .map_err(|_| format!("\"{}\" is not a corner of a face", short(word)))?;
                *place = resolve(value, self.state.seen[kind], self.total[kind]);
            }
        }
        match corner[0] {
            Index::At(_) => Ok(corner),
            Index::None => Err(format!("\"{}\" names no vertex", short(word))),
            Index::Nowhere if word.split('/').next() == Some("0") => {
                Err(format!("\"{word}\" has number 0; OBJ counts from 1"))
            }
            Index::Nowhere => Err(format!(
                "\"{}\" names a vertex that does not exist (there are {})",
                short(word),
                self.total[0]
            )),
        }
    }
}

/// A word for a message: hostile ones may be megabytes long.
fn short(word: &str) -> &str {
    let end = word.char_indices().nth(40).map_or(word.len(), |(i, _)| i);
    &word[..end]
}

fn numbers<const N: usize>(rest: &str, least: usize, what: &str) -> Result<[f32; N], String> {
    numbers_of(&mut rest.split_ascii_whitespace(), least, what)
}

/// `N` numbers, of which at least `least` must be there; the others are 0.
fn numbers_of<'t, const N: usize>(
    words: &mut impl Iterator<Item = &'t str>,
    least: usize,
    what: &str,
) -> Result<[f32; N], String> {
    let mut values = [0.0; N];
    for (i, value) in values.iter_mut().enumerate() {
        match words.next() {
            // The C runtime of old Windows programs writes infinities and the like as 1.#INF, 1.#IND, 1.#QNAN.
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

/// Where a number of a face points to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Index {
    /// It was left out.
    None,
    /// It exists; counted from 0.
    At(u32),
    /// It is out of range.
    Nowhere,
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
        _ => Index::Nowhere,
    }
}
