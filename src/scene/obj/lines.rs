//! Parsing of the lines of OBJ files.

use std::collections::HashMap;

use glam::{DVec3, Vec2};

use crate::scene::mesh::soup::{Corner, NONE, Triangle};
use crate::scene::number;
use crate::scene::obj::text::{Counts, ObjText};

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
            "l" | "p" | "curv" | "curv2" | "surf" => Self::Undrawn,
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
    /// Positions are relative to it.
    origin: DVec3,
    /// Index in `out` of the state's material; `None` until a face uses it.
    material: Option<u32>,
    indices: HashMap<String, u32>,
    corners: Vec<[Index; 3]>,
}

impl LineReader {
    pub fn new(state: State, total: Counts, origin: DVec3) -> Self {
        Self {
            out: ObjText::default(),
            state,
            total,
            origin,
            material: None,
            indices: HashMap::new(),
            corners: Vec::new(),
        }
    }

    pub fn finish(self) -> ObjText {
        self.out
    }

    /// Reads line number `at`. One that cannot be read costs itself alone: a vertex keeps its number, so that other faces stay.
    pub fn line(&mut self, line: &str, at: usize) {
        let (what, result) = match Statement::of(line) {
            Statement::Vertex(rest) => ("vertices that are no numbers", self.vertex(rest)),
            Statement::Texcoord(rest) => (
                "texture coordinates that are no numbers",
                self.texcoord(rest),
            ),
            Statement::Normal(rest) => ("normals that are no numbers", self.normal(rest)),
            Statement::Face(rest) => ("faces left out", self.face(rest)),
            Statement::Undrawn => {
                self.out.not_faces += 1;
                return;
            }
            Statement::Smoothing(group) => {
                self.state.smoothing = group;
                return;
            }
            Statement::Material(name) => {
                name.clone_into(&mut self.state.material);
                self.material = None;
                return;
            }
            Statement::Library(rest) => {
                self.out.libraries.push(rest.to_owned());
                return;
            }
            Statement::Other => return,
        };
        if let Err(why) = result {
            self.out
                .losses
                .add_shape(what, || format!("line {at}: {why}"));
        }
    }

    fn texcoord(&mut self, rest: &str) -> Result<(), String> {
        let uv = numbers::<2>(rest, 1, "a texture coordinate");
        let plain = uv
            .as_ref()
            .map_or(Vec2::ZERO, |[u, v]| Vec2::new(*u as f32, *v as f32));
        self.out.soup.texcoords.push(plain);
        self.state.seen[1] += 1;
        uv.map(|_| ())
    }

    fn normal(&mut self, rest: &str) -> Result<(), String> {
        let normal = numbers::<3>(rest, 3, "a normal");
        let plain = normal.as_ref().map_or(DVec3::ZERO, |n| DVec3::from(*n));
        self.out.soup.normals.push(plain.as_vec3());
        self.state.seen[2] += 1;
        normal.map(|_| ())
    }

    /// Three coordinates, then nothing, a weight (for rational curves, ignored), a colour, or four numbers whose meaning the other
    /// vertices tell.
    fn vertex(&mut self, rest: &str) -> Result<(), String> {
        let soup = &mut self.out.soup;
        let mut words = rest.split_ascii_whitespace();
        let position = numbers_of::<3>(&mut words, 3, "a vertex position");
        let position = position.or_else(|error| {
            // Commas may separate the numbers.
            let plain = rest.replace(',', " ");
            numbers_of::<3>(&mut plain.split_ascii_whitespace(), 3, "").map_err(|_| error)
        });
        let mut more = || number::parse(words.next()?).map(|v| v as f32);
        let tail: [Option<f32>; 4] = std::array::from_fn(|_| more());
        let colour = match tail {
            [Some(r), Some(g), Some(b), last] => Some([r, g, b, last.unwrap_or(1.0)]),
            _ => None,
        };
        if let Some(colour) = colour.filter(|c| c.iter().all(|v| v.is_finite())) {
            // Earlier positions had no colour: fill with white.
            soup.colours.resize(soup.positions.len(), [1.0; 4]);
            soup.colours.push(colour);
            self.out.sevens += usize::from(tail[3].is_some());
        }
        let relative = position
            .as_ref()
            .map_or(DVec3::NAN, |p| DVec3::from(*p) - self.origin);
        soup.positions.push(relative.as_vec3());
        self.state.seen[0] += 1;
        position.map(|_| ())
    }

    fn face(&mut self, rest: &str) -> Result<(), String> {
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        let mut result = Ok(());
        // A comment may follow.
        let words = rest
            .split_ascii_whitespace()
            .take_while(|word| !word.starts_with('#'));
        for word in words {
            match self.corner(word.trim_end_matches([',', ';'])) {
                Ok(corner) => corners.push(corner),
                Err(why) => {
                    result = Err(why);
                    break;
                }
            }
        }
        if result.is_ok() {
            if corners.len() < 3 {
                self.out.not_faces += 1;
            } else {
                self.push_face(&corners);
            }
        }
        self.corners = corners;
        result
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
            Index::OutOfRange if word.split('/').next() == Some("0") => Err(format!(
                "\"{}\" has index 0; OBJ indices start at 1",
                short(word)
            )),
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

/// Parses `N` numbers, of which the first `least` are required; the others default to 0.
pub fn numbers<const N: usize>(rest: &str, least: usize, what: &str) -> Result<[f64; N], String> {
    numbers_of(&mut rest.split_ascii_whitespace(), least, what)
}

fn numbers_of<'t, const N: usize>(
    words: &mut impl Iterator<Item = &'t str>,
    least: usize,
    what: &str,
) -> Result<[f64; N], String> {
    let mut values = [0.0; N];
    for (i, value) in values.iter_mut().enumerate() {
        match words.next() {
            Some(word) => match number::parse(word) {
                Some(parsed) => *value = parsed,
                None if i < least => return Err(format!("{what} is not a number")),
                None => break,
            },
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
