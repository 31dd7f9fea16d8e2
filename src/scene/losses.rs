//! Parts of a model that are not drawn as its file says, counted by kind, with the first place of each.

use crate::scene::error::printable;

/// Longest detail that is told, characters: names in files may be megabytes long.
const MAX_DETAIL: usize = 120;

/// Counts of losses, in the order in which their kinds were met.
#[derive(Debug, Default)]
pub struct Losses(Vec<Loss>);

#[derive(Debug)]
struct Loss {
    what: &'static str,
    count: usize,
    first: String,
    /// Whether triangles are lost, not only something of their look.
    of_shape: bool,
}

impl Losses {
    /// Counts a loss of the kind `what`, a plural noun with what became of it; `place` names this one.
    pub fn add(&mut self, what: &'static str, place: impl FnOnce() -> String) {
        self.add_many(what, 1, place);
    }

    /// Counts a loss of triangles: it is told of before others.
    pub fn add_shape(&mut self, what: &'static str, place: impl FnOnce() -> String) {
        self.add(what, place);
        if let Some(loss) = self.0.iter_mut().find(|loss| loss.what == what) {
            loss.of_shape = true;
        }
    }

    /// Counts several losses of a kind; `place` names the first of them.
    pub fn add_many(&mut self, what: &'static str, count: usize, place: impl FnOnce() -> String) {
        if count == 0 {
            return;
        }
        match self.0.iter_mut().find(|loss| loss.what == what) {
            Some(loss) => loss.count += count,
            None => self.0.push(Loss {
                what,
                count,
                first: shortened(&printable(&place()), MAX_DETAIL),
                of_shape: false,
            }),
        }
    }

    /// Takes over the losses of a part.
    pub fn append(&mut self, other: Self) {
        for loss in other.0 {
            match self.0.iter_mut().find(|own| own.what == loss.what) {
                Some(own) => own.count += loss.count,
                None => self.0.push(loss),
            }
        }
    }

    /// One line for each kind.
    pub fn lines(&self) -> impl Iterator<Item = String> {
        let shapes = self.0.iter().filter(|loss| loss.of_shape);
        shapes
            .chain(self.0.iter().filter(|loss| !loss.of_shape))
            .map(|loss| format!("{} {}; first: {}", loss.count, loss.what, loss.first))
    }
}

/// At most `most` characters of a text, with dots where it is cut.
pub fn shortened(text: &str, most: usize) -> String {
    match text.char_indices().nth(most) {
        None => text.to_owned(),
        Some(_) => {
            let kept: String = text.chars().take(most.saturating_sub(2)).collect();
            format!("{}..", kept.trim_end())
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn kinds_are_counted_with_their_first_place() {
        let mut losses = Losses::default();
        losses.add("lines left out", || "line 3".to_owned());
        losses.add("faces not drawn", || "é".repeat(500));
        losses.add_many("lines left out", 4, || "line 9".to_owned());
        losses.add_shape("primitives not drawn", || "meshes[0]".to_owned());
        losses.add_many("pictures", 0, || unreachable!());
        let lines: Vec<String> = losses.lines().collect();
        assert_eq!(lines[0], "1 primitives not drawn; first: meshes[0]");
        assert_eq!(lines[1], "5 lines left out; first: line 3");
        assert_eq!(lines.len(), 3);
        assert!(lines[2].chars().count() < 160 && lines[2].ends_with(".."));
    }
}
