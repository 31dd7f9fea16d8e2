//! Options to the command line that reproduces them.

use std::borrow::Cow;
use std::path::Path;

use super::given::replaces;
use super::{OptionValues, Options, OptionsError, ResolveError, is_flag};
use crate::scene::Loaded;

/// Written even if they equal the defaults: they record what the picture shows, and when.
const ALWAYS: [&str; 9] = [
    "place", "when", "solar", "sun", "camera", "eye", "target", "fov", "preset",
];

impl Options {
    /// The `skylight render ...` line that gives these options again, quoted for a shell. It holds what differs from the scene
    /// and the defaults, and always sun, camera and preset.
    ///
    /// `scene` is the path that was opened, `loaded` is what was read from it (only its options, cameras and moments are used).
    ///
    /// # Errors
    /// The scene sets a value, such as a gamma, that these options lack and that no option can unset; the path is not UTF-8;
    /// a name contains a zero byte.
    pub fn command_line(
        &self,
        scene: Option<&Path>,
        loaded: &Loaded,
    ) -> Result<String, ResolveError> {
        let mut line = vec!["skylight".to_owned(), "render".to_owned()];
        line.extend(scene.map(scene_word).transpose()?);
        let written = self.needed(loaded)?;
        line.extend(written.iter().flat_map(arguments));
        let quoted: Result<Vec<_>, _> = line.iter().map(|word| quoted(word)).collect();
        let quoted = quoted.map(|words| words.join(" "));
        Ok(quoted.map_err(|_| {
            OptionsError("a name holds a zero byte, which no command line can; rename it".into())
        })?)
    }

    /// The values a user must give to get these options from a scene, in the order of the definition.
    fn needed(&self, loaded: &Loaded) -> Result<OptionValues, ResolveError> {
        let wanted: Vec<_> = self.values().into_pairs();
        let mut is_written: Vec<bool> = wanted
            .iter()
            .map(|(name, _)| ALWAYS.contains(&name.as_str()))
            .collect();
        loop {
            let pairs = wanted.iter().zip(&is_written);
            let written: Vec<_> = pairs.filter(|p| *p.1).map(|p| p.0.clone()).collect();
            let written = OptionValues::from(written);
            let read = Self::resolve(&written, loaded)?.values();
            let surplus = read.iter().map(|(name, _)| name.as_str());
            let surplus = surplus.filter(|name| wanted.iter().all(|(own, _)| own != name));
            let surplus: Vec<&str> = surplus.collect();
            let mut is_complete = true;
            for ((name, text), is_written) in wanted.iter().zip(&mut is_written) {
                let differs = read.get(name) != Some(text);
                let replaces = surplus.iter().any(|other| replaces(name, other));
                if (differs || replaces) && !*is_written {
                    (*is_written, is_complete) = (true, false);
                }
            }
            match surplus.first() {
                _ if !is_complete => {}
                None => return Ok(written),
                Some(name) => {
                    return Err(OptionsError(format!(
                        "the scene sets {name}, and no option takes that back; change it in the scene file"
                    ))
                    .into());
                }
            }
        }
    }
}

/// A path as a word that cannot be mistaken for an option.
fn scene_word(path: &Path) -> Result<String, OptionsError> {
    let Some(text) = path.to_str() else {
        let path = path.display();
        return Err(OptionsError(format!(
            "{path} is not UTF-8, so no command line is written for it; rename it"
        )));
    };
    Ok(if text.starts_with('-') {
        format!("./{text}")
    } else {
        text.to_owned()
    })
}

fn arguments((name, text): &(String, String)) -> Vec<String> {
    if is_flag(name) {
        return vec![format!("--{name}")];
    }
    // Otherwise a negative number, or a name that begins with a dash, would be read as an option.
    if text.starts_with('-') {
        return vec![format!("--{name}={text}")];
    }
    vec![format!("--{name}"), text.clone()]
}

/// Quotes a word for a shell; lists of numbers stay unquoted.
fn quoted(word: &str) -> Result<Cow<'_, str>, shlex::QuoteError> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-+_./:,=".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return Ok(word.into());
    }
    shlex::try_quote(word)
}
