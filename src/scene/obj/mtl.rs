//! MTL files: materials of OBJ models.

use std::collections::{BTreeSet, HashMap, HashSet};
use std::path::{Path, PathBuf};

use glam::Affine2;

use crate::scene::builder::Builder;
use crate::scene::files::Lookup;
use crate::scene::losses::shortened;
use crate::scene::material::Material;
use crate::scene::obj::mtl_material::Entry;
use crate::scene::obj::text::ObjText;

/// The material libraries of one OBJ file.
#[derive(Debug, Default)]
pub struct Libraries {
    entries: Vec<Entry>,
    by_name: HashMap<String, usize>,
    /// The same in small letters; `None` if several differ only in case.
    by_folded_name: HashMap<String, Option<usize>>,
}

impl Libraries {
    /// Reads the libraries listed by the `mtllib` lines. A missing library is a warning. If none is found, the one with the
    /// model's own name is read, if it exists.
    pub fn read(builder: &mut Builder, obj: &Path, folder: &Path, model: &ObjText) -> Self {
        let mut libraries = Self::default();
        let mut seen: HashSet<PathBuf> = HashSet::new();
        let mut asked: HashSet<&String> = HashSet::new();
        let mut missing = Vec::new();
        for rest in model.libraries.iter().filter(|rest| asked.insert(rest)) {
            let found = find_libraries(builder, obj, folder, rest);
            if found.is_empty() {
                missing.push(rest);
            }
            for path in found.into_iter().filter(|path| seen.insert(path.clone())) {
                libraries.add_file(builder, obj, &path);
            }
        }
        let uses_some = model.materials.iter().any(|name| !name.is_empty());
        let own = obj.with_extension("mtl");
        let own = own.file_name().filter(|_| seen.is_empty() && uses_some);
        let own = own.map(|name| builder.files.find(folder, &name.to_string_lossy()));
        let instead = match own {
            Some(Lookup::Found(path)) => {
                libraries.add_file(builder, obj, &path);
                let name = path.file_name().unwrap_or_default().to_string_lossy();
                format!("{name} is read instead")
            }
            _ => "its materials are drawn grey".to_owned(),
        };
        for rest in missing {
            let rest = shortened(rest, 80);
            let what = format!("material library \"{rest}\" is missing; {instead}");
            builder.warn(obj, &what);
        }
        libraries
    }

    fn add_file(&mut self, builder: &mut Builder, obj: &Path, path: &Path) {
        match builder.files.read_text(path) {
            Ok(text) => self.add(builder, path, &text),
            Err(error) => builder.warn(obj, &error.to_string()),
        }
    }

    pub fn add(&mut self, builder: &mut Builder, path: &Path, text: &str) {
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut bad = Vec::new();
        let mut told = BTreeSet::new();
        for (number, line) in text.lines().enumerate() {
            if !self.line(folder, line.trim(), &mut told) {
                bad.push(number + 1);
            }
        }
        if let Some(first) = bad.first() {
            let what = format!(
                "{} malformed lines ignored, the first is line {first}",
                bad.len()
            );
            builder.warn(path, &what);
        }
        if !told.is_empty() {
            let keys: Vec<&str> = told.into_iter().collect();
            builder.warn(
                path,
                &format!("{} not drawn; drawn without", keys.join(", ")),
            );
        }
    }

    /// Parses a line; false if it is malformed. Statements that are not drawn are added to `told`.
    fn line(&mut self, folder: &Path, line: &str, told: &mut BTreeSet<&'static str>) -> bool {
        let (key, rest) = line
            .split_once(|c: char| c.is_whitespace())
            .unwrap_or((line, ""));
        let rest = rest.trim();
        let key = key.to_ascii_lowercase();
        if key == "newmtl" {
            self.begin(rest);
            return true;
        }
        match self.entries.last_mut() {
            Some(entry) => entry.statement(folder, &key, rest, told),
            // Lines before the first `newmtl` are ignored.
            None => true,
        }
    }

    fn begin(&mut self, name: &str) {
        let name = if name.is_empty() { "unnamed" } else { name };
        // If two materials share a name, the first one wins, as in other readers.
        let number = self.entries.len();
        if !self.by_name.contains_key(name) {
            self.by_name.insert(name.to_owned(), number);
            let folded = self.by_folded_name.entry(name.to_lowercase());
            folded.and_modify(|n| *n = None).or_insert(Some(number));
        }
        self.entries.push(Entry::new(name));
    }

    /// The material with this name: as it is, without a comment behind it, or in another case if only one is meant.
    fn find(&self, name: &str) -> Option<&Entry> {
        let plain = name.split_once(" #").map_or(name, |(name, _)| name.trim());
        let exact = [name, plain]
            .into_iter()
            .find_map(|name| self.by_name.get(name));
        let folded = || {
            self.by_folded_name
                .get(&plain.to_lowercase())
                .copied()
                .flatten()
        };
        self.entries.get(exact.copied().or_else(folded)?)
    }

    /// Whether a material with this name exists.
    pub fn has(&self, name: &str) -> bool {
        self.find(name).is_some()
    }

    /// The material with this name, with its textures decoded, and the transform from the mesh's texture coordinates (v
    /// pointing up) to those of the textures.
    pub fn material(
        &self,
        builder: &mut Builder,
        obj: &Path,
        name: &str,
    ) -> Option<(Material, Affine2)> {
        let entry = self.find(name)?;
        Some((entry.material(builder, obj), entry.texture_from_mesh()))
    }
}

/// The libraries listed by one `mtllib` line: one file whose name contains spaces, or several files in which spaces are written
/// as `\ `.
pub fn find_libraries(
    builder: &mut Builder,
    obj: &Path,
    folder: &Path,
    rest: &str,
) -> Vec<PathBuf> {
    if let Lookup::Found(path) = builder.files.find(folder, rest.trim_matches('"')) {
        return vec![path];
    }
    // File names cannot contain NUL, so it stands in for an escaped space while the line is split.
    let escaped = rest.replace("\\ ", "\0");
    let mut found = Vec::new();
    for name in escaped.split_whitespace() {
        match builder.files.find(folder, &name.replace('\0', " ")) {
            Lookup::Found(path) => found.push(path),
            Lookup::Outside(path) => builder.warn_outside(obj, &path),
            Lookup::Missing(_) => {}
        }
    }
    found
}

#[cfg(test)]
#[path = "mtl_tests.rs"]
mod tests;
