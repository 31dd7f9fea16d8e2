//! The text of an OBJ file: cut at line ends into stretches that are read at the same time, each into a [`Soup`].
//!
//! A first look counts what each stretch holds and the state at its end (material, smoothing group), so that every
//! stretch can start as if those before it had been read.

use std::borrow::Cow;
use std::collections::HashMap;
use std::thread;

use memchr::{memchr_iter, memrchr};

use crate::scene::mesh::soup::Soup;
use crate::scene::obj::lines::{Cleared, LineError, LineReader, State};

/// Texts are cut into stretches of at least this many bytes: shorter ones are not worth a thread.
const SHORTEST: usize = 1 << 20;

/// What an OBJ file holds; materials of the triangles are numbers in `materials`.
#[derive(Debug, Default)]
pub(in crate::scene) struct ObjText {
    pub soup: Soup,
    /// The names of the `usemtl` lines that triangles use; the empty name is no material.
    pub materials: Vec<String>,
    /// The rests of the `mtllib` lines.
    pub libraries: Vec<String>,
    /// Points, lines, and faces of fewer than three corners: skipped.
    pub not_faces: usize,
    /// Faces that name normals or texture coordinates that do not exist.
    pub dangling: usize,
}

/// Numbers of `v`, `vt` and `vn` lines.
pub(in crate::scene) type Counts = [usize; 3];

/// Reads a whole file on `threads` threads.
///
/// # Errors
/// The first line that makes no sense, or a face that names a vertex that does not exist.
pub(in crate::scene) fn read(text: &str, threads: usize) -> Result<ObjText, LineError> {
    let stretches = cut(text, threads.clamp(1, 1 + text.len() / SHORTEST));
    let looks: Vec<Look> = at_once(&stretches, |text| look(text));
    let mut starts = Vec::with_capacity(stretches.len());
    let mut state = State::default();
    for look in &looks {
        starts.push(state.clone());
        look.advance(&mut state);
    }
    let total = state.seen;
    let jobs: Vec<(&str, State)> = stretches.into_iter().zip(starts).collect();
    let parts = at_once(&jobs, |(text, state)| {
        read_stretch(text, state.clone(), total)
    });
    let (mut whole, mut known) = (ObjText::default(), HashMap::new());
    for part in parts {
        whole.append(part?, &mut known);
    }
    Ok(whole)
}

/// Does the work for all items, each on a thread of its own but the first.
fn at_once<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let work = &work;
    let Some((first, rest)) = items.split_first() else {
        return Vec::new();
    };
    thread::scope(|scope| {
        let threads: Vec<_> = rest
            .iter()
            .map(|item| scope.spawn(move || work(item)))
            .collect();
        let mut results = vec![work(first)];
        for thread in threads {
            // A panic there is a panic here.
            let result = thread.join();
            results.push(result.unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
        results
    })
}

/// About equal stretches that end with whole logical lines.
fn cut(text: &str, count: usize) -> Vec<&str> {
    let mut stretches = Vec::with_capacity(count);
    let mut rest = text;
    for left in (2..=count).rev() {
        let (stretch, behind) = rest.split_at(line_end(rest, rest.len() / left));
        stretches.push(stretch);
        rest = behind;
    }
    stretches.push(rest);
    stretches
}

/// Where the first logical line ends that ends behind `from`.
fn line_end(text: &str, from: usize) -> usize {
    let bytes = text.as_bytes();
    let mut start = memrchr(b'\n', &bytes[..from]).map_or(0, |i| i + 1);
    for end in memchr_iter(b'\n', &bytes[from..]).map(|i| from + i) {
        if !bytes[start..end].trim_ascii_end().ends_with(b"\\") {
            return end + 1;
        }
        start = end + 1;
    }
    text.len()
}

/// Lines with their numbers, counted from 1; a backslash at the end continues a line.
fn logical_lines(text: &str) -> impl Iterator<Item = (usize, Cow<'_, str>)> {
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (number, line) = lines.next()?;
        let mut line = Cow::Borrowed(line);
        while line.trim_ascii_end().ends_with('\\') {
            let whole = line.to_mut();
            whole.truncate(whole.trim_ascii_end().len() - 1);
            let Some((_, next)) = lines.next() else { break };
            whole.push(' ');
            whole.push_str(next);
        }
        Some((number + 1, line))
    })
}

/// What a stretch does to the state of the reader.
#[derive(Debug, Default)]
struct Look<'t> {
    counts: Counts,
    lines: usize,
    material: Option<Cow<'t, str>>,
    smoothing: Option<u32>,
}

impl Look<'_> {
    fn advance(&self, state: &mut State) {
        for (seen, count) in state.seen.iter_mut().zip(self.counts) {
            *seen += count;
        }
        state.lines += self.lines;
        if let Some(material) = &self.material {
            material.as_ref().clone_into(&mut state.material);
        }
        state.smoothing = self.smoothing.unwrap_or(state.smoothing);
    }
}

fn look(text: &str) -> Look<'_> {
    let mut look = Look {
        lines: memchr_iter(b'\n', text.as_bytes()).count(),
        ..Look::default()
    };
    for (_, line) in logical_lines(text) {
        match Cleared::of(&line) {
            Cleared::Vertex(_) => look.counts[0] += 1,
            Cleared::Texcoord(_) => look.counts[1] += 1,
            Cleared::Normal(_) => look.counts[2] += 1,
            Cleared::Material(name) => look.material = Some(Cow::Owned(name.to_owned())),
            Cleared::Smoothing(group) => look.smoothing = Some(group),
            _ => {}
        }
    }
    look
}

fn read_stretch(text: &str, state: State, total: Counts) -> Result<ObjText, LineError> {
    let first_line = state.lines;
    let mut reader = LineReader::new(state, total);
    for (number, line) in logical_lines(text) {
        reader.line(&line).map_err(|what| LineError {
            line: first_line + number,
            what,
        })?;
    }
    Ok(reader.finish())
}

impl ObjText {
    /// Adds what the next stretch holds; `known` has the numbers of the materials so far.
    fn append(&mut self, next: Self, known: &mut HashMap<String, u32>) {
        let mut number = |name: String| {
            *known.entry(name).or_insert_with_key(|name| {
                self.materials.push(name.clone());
                (self.materials.len() - 1) as u32
            })
        };
        let numbers: Vec<u32> = next.materials.into_iter().map(&mut number).collect();
        self.libraries.extend(next.libraries);
        self.not_faces += next.not_faces;
        self.dangling += next.dangling;
        self.soup
            .append(next.soup, |material| numbers[material as usize]);
    }
}

#[cfg(test)]
#[path = "text_tests.rs"]
mod tests;
