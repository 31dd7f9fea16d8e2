//! The text of an OBJ file, split at line ends into chunks that are parsed in parallel, each into a [`Soup`].
//!
//! A prescan counts the vertices of each chunk and finds the parser state at its end (material, smoothing group), so that each
//! chunk starts in the state left by the chunks before it.

use std::borrow::Cow;
use std::collections::HashMap;
use std::thread;

use glam::DVec3;
use memchr::{memchr_iter, memrchr};

use crate::scene::losses::Losses;
use crate::scene::mesh::soup::Soup;
use crate::scene::obj::lines::{LineReader, State, Statement, numbers};

/// Minimum chunk size, bytes: a smaller chunk is not worth a thread.
const MIN_CHUNK: usize = 1 << 20;

/// The content of an OBJ file. Triangles refer to their material by index in `materials`.
#[derive(Debug, Default)]
pub struct ObjText {
    pub soup: Soup,
    /// Names of the materials used by faces; an empty name means no material.
    pub materials: Vec<String>,
    /// Arguments of the `mtllib` lines.
    pub libraries: Vec<String>,
    /// Number of skipped points, lines, and faces with fewer than three corners.
    pub not_faces: usize,
    /// Number of faces with an out-of-range normal or texture coordinate index.
    pub dangling: usize,
    /// Number of vertices with four numbers behind the position.
    pub sevens: usize,
    /// Lines that cannot be read.
    pub losses: Losses,
}

/// Numbers of `v`, `vt` and `vn` lines.
pub type Counts = [usize; 3];

/// Vertices that are looked at to find where a model lies.
const LOOKED_AT: usize = 256;

/// Positions of vertices from all over a file.
pub fn sample(text: &str) -> Vec<DVec3> {
    let step = (text.len() / LOOKED_AT).max(1);
    let mut points = Vec::new();
    let mut from = 0;
    while let Some(rest) = text.as_bytes().get(from..) {
        let Some(at) = memchr::memmem::find(rest, b"\nv ").map(|i| from + i + 1) else {
            break;
        };
        let end = text[at..].find('\n').map_or(text.len(), |i| at + i);
        let position = numbers::<3>(&text[at + 1..end], 3, "a vertex");
        points.extend(position.ok().map(DVec3::from));
        from = (at + step).max(end);
    }
    points
}

/// Parses a whole file with up to `threads` threads. Positions become relative to `origin`. A line that cannot be read is left
/// out and counted.
pub fn read(text: &str, threads: usize, origin: DVec3) -> ObjText {
    let chunks = cut(text, threads.clamp(1, 1 + text.len() / MIN_CHUNK));
    let prescans: Vec<Prescan> = in_parallel(&chunks, |text| prescan(text));
    let mut starts = Vec::with_capacity(chunks.len());
    let mut state = State::default();
    for prescan in &prescans {
        starts.push(state.clone());
        prescan.advance(&mut state);
    }
    let total = state.seen;
    let jobs: Vec<(&str, State)> = chunks.into_iter().zip(starts).collect();
    let parts = in_parallel(&jobs, |(text, state)| {
        read_chunk(text, state.clone(), total, origin)
    });
    let (mut whole, mut known) = (ObjText::default(), HashMap::new());
    for part in parts {
        whole.append(part, &mut known);
    }
    whole
}

/// Runs `work` on all items: the first on this thread, each of the others on its own thread.
fn in_parallel<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
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
            // Propagates a panic of that thread.
            let result = thread.join();
            results.push(result.unwrap_or_else(|panic| std::panic::resume_unwind(panic)));
        }
        results
    })
}

/// Splits the text into `count` chunks of similar length, each ending at the end of a logical line.
fn cut(text: &str, count: usize) -> Vec<&str> {
    let mut chunks = Vec::with_capacity(count);
    let mut rest = text;
    for left in (2..=count).rev() {
        let (chunk, behind) = rest.split_at(line_end(rest, rest.len() / left));
        chunks.push(chunk);
        rest = behind;
    }
    chunks.push(rest);
    chunks
}

/// End of the first logical line that ends after byte `from`.
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

/// Logical lines with the number of their first line, from 1. A backslash at the end of a line continues it.
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

/// How a chunk changes the parser state.
#[derive(Debug, Default)]
struct Prescan<'t> {
    counts: Counts,
    lines: usize,
    material: Option<Cow<'t, str>>,
    smoothing: Option<u32>,
}

impl Prescan<'_> {
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

fn prescan(text: &str) -> Prescan<'_> {
    let mut found = Prescan {
        lines: memchr_iter(b'\n', text.as_bytes()).count(),
        ..Prescan::default()
    };
    for (_, line) in logical_lines(text) {
        match Statement::of(&line) {
            Statement::Vertex(_) => found.counts[0] += 1,
            Statement::Texcoord(_) => found.counts[1] += 1,
            Statement::Normal(_) => found.counts[2] += 1,
            Statement::Material(name) => found.material = Some(Cow::Owned(name.to_owned())),
            Statement::Smoothing(group) => found.smoothing = Some(group),
            _ => {}
        }
    }
    found
}

fn read_chunk(text: &str, state: State, total: Counts, origin: DVec3) -> ObjText {
    let first_line = state.lines;
    let mut reader = LineReader::new(state, total, origin);
    for (number, line) in logical_lines(text) {
        reader.line(&line, first_line + number);
    }
    reader.finish()
}

impl ObjText {
    /// Appends the next chunk; `known` maps the names of the materials so far to their indices.
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
        self.sevens += next.sevens;
        self.losses.append(next.losses);
        self.soup
            .append(next.soup, |material| numbers[material as usize]);
    }
}

#[cfg(test)]
#[path = "text_tests.rs"]
mod tests;
