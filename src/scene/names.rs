//! Finding the file that a name in a model means: models come from machines with other separators, cases and folders.

use std::borrow::Cow;
use std::collections::HashMap;
use std::ffi::{OsStr, OsString};
use std::path::{Component, Path, PathBuf};
use std::rc::Rc;

use percent_encoding::percent_decode_str;

use crate::scene::files::latin;

/// Components at the end of a name that are looked for in the model's own folder.
const MAX_SUFFIX: usize = 4;

/// Spellings of a name, the likeliest first: as a URI decoded first, then as it stands, with backslashes as separators, and then
/// its last components alone, for absolute paths from another machine.
pub fn spellings(name: &str, is_uri: bool) -> Vec<String> {
    let decoded = percent_decode_str(name).decode_utf8_lossy();
    // What a server would be asked for is no part of a file's name.
    let asked = name.find(['?', '#']).filter(|_| is_uri);
    let path = percent_decode_str(&name[..asked.unwrap_or(name.len())]).decode_utf8_lossy();
    let plain: [Cow<str>; 3] = if is_uri {
        [decoded, path, name.into()]
    } else {
        [name.into(), decoded, path]
    };
    let mut all: Vec<String> = Vec::new();
    let mut add = |name: String| {
        if !name.is_empty() && !all.contains(&name) {
            all.push(name);
        }
    };
    for name in &plain {
        add(name.clone().into_owned());
        add(forward(name));
    }
    for name in &plain {
        let forward = forward(name);
        let starts: Vec<usize> = forward.rmatch_indices('/').map(|(i, _)| i + 1).collect();
        // The longest first: it names the folder, too.
        for start in starts.into_iter().take(MAX_SUFFIX).rev() {
            add(forward[start..].to_owned());
        }
    }
    all
}

/// A name with `/` as separator. `\t` and the like in a JSON string are letters of a path whose backslashes were not doubled.
fn forward(name: &str) -> String {
    let letter = |c: char| match c {
        '\\' => "/".to_owned(),
        '\u{8}' => "/b".to_owned(),
        '\u{c}' => "/f".to_owned(),
        '\n' => "/n".to_owned(),
        '\r' => "/r".to_owned(),
        '\t' => "/t".to_owned(),
        c => c.to_string(),
    };
    name.chars().map(letter).collect()
}

/// Names in folders, read once: a hostile model may name a million files that are missing.
#[derive(Debug, Clone, Default)]
pub struct Listings(HashMap<PathBuf, Rc<HashMap<String, Vec<OsString>>>>);

impl Listings {
    /// The file of this name below `folder` without regard to case, accents and encoding, if there is just one.
    pub fn find(&mut self, folder: &Path, name: &str) -> Option<PathBuf> {
        let mut at = if folder.as_os_str().is_empty() {
            PathBuf::from(".")
        } else {
            folder.to_owned()
        };
        for component in Path::new(name).components() {
            match component {
                Component::CurDir => {}
                Component::ParentDir => at.push(".."),
                Component::Normal(part) => {
                    let exact = at.join(part);
                    at = if exact.exists() {
                        exact
                    } else {
                        let names = self.of(&at);
                        let [only] = &names.get(&folded(part))?[..] else {
                            return None;
                        };
                        at.join(only)
                    };
                }
                Component::RootDir | Component::Prefix(_) => return None,
            }
        }
        at.is_file().then_some(at)
    }

    fn of(&mut self, folder: &Path) -> Rc<HashMap<String, Vec<OsString>>> {
        let read = || {
            let mut names: HashMap<String, Vec<OsString>> = HashMap::new();
            let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
            for name in entries.map(|entry| entry.file_name()) {
                names.entry(folded(&name)).or_default().push(name);
            }
            Rc::new(names)
        };
        self.0.entry(folder.to_owned()).or_insert_with(read).clone()
    }
}

/// A name in small letters without accents: archives of other systems write them composed, decomposed, or in Latin-1.
fn folded(name: &OsStr) -> String {
    let text = latin(name.as_encoded_bytes());
    if text.is_ascii() {
        text.to_ascii_lowercase()
    } else {
        deunicode::deunicode(&text).to_lowercase()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_is_decoded_turned_and_shortened() {
        assert_eq!(spellings("a.png", true), ["a.png"]);
        assert_eq!(spellings("a%20b.png", true), ["a b.png", "a%20b.png"]);
        assert_eq!(spellings("a%20b.png", false), ["a%20b.png", "a b.png"]);
        assert_eq!(spellings("a.png?v=2", true), ["a.png?v=2", "a.png"]);
        let windows = spellings("C:\\x\\tex\\a.png", false);
        assert_eq!(
            windows[1..],
            ["C:/x/tex/a.png", "x/tex/a.png", "tex/a.png", "a.png"]
        );
        assert!(spellings("tex\tiles.png", true).contains(&"tex/tiles.png".to_owned()));
    }

    #[test]
    fn case_does_not_matter_if_one_file_is_meant() {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let inner = folder.path().join("Textures");
        std::fs::create_dir(&inner).expect("a folder");
        for name in ["Brick.PNG", "Wood.png", "wood.PNG", "caf\u{e9}.png"] {
            std::fs::write(inner.join(name), "").expect("a file");
        }
        let mut listings = Listings::default();
        let mut find = |name| listings.find(folder.path(), name);
        assert_eq!(find("textures/brick.png"), Some(inner.join("Brick.PNG")));
        assert_eq!(find("./textures/Wood.png"), Some(inner.join("Wood.png")));
        assert_eq!(find("textures/WOOD.png"), None, "two are meant");
        assert_eq!(find("textures/none.png"), None);
        let decomposed = find("textures/cafe\u{301}.png");
        assert_eq!(decomposed, Some(inner.join("caf\u{e9}.png")));
        assert_eq!(find("textures"), None, "a folder");
    }
}
