//! Settings back to the words that give them: the reverse of reading options.

use std::borrow::Cow;
use std::path::Path;

use super::{CameraParts, Options, Settings, SettingsError, name};
use crate::error::Error;
use crate::scene::{Camera, Loaded};

/// Written even where they are the defaults: they say what one looks at, and when.
const ALWAYS: [&str; 9] = [
    "place", "when", "solar", "sun", "camera", "eye", "target", "fov", "preset",
];
/// Options that decide about each other: of such a matter all is written or nothing.
const MATTERS: [&[&str]; 2] = [
    &["exposure", "ev100", "scale"],
    &["samples", "noise", "visibility"],
];
/// Options that others replace: what lacks in the settings is not lost.
const REPLACED: [&str; 7] = [
    "place", "when", "solar", "sun", "exposure", "ev100", "scale",
];

/// The name of an option and its value; none for a flag.
type Word = (&'static str, Option<String>);

impl Settings {
    /// These settings with a camera of which nothing is left open.
    #[must_use]
    pub fn with_camera(&self, camera: &Camera) -> Self {
        let point = |p: glam::Vec3| Some(p.to_array().map(shortest));
        Self {
            camera: CameraParts {
                eye: point(camera.eye),
                target: point(camera.target),
                fov_deg: Some(shortest(camera.fov_deg)),
                name: None,
            },
            ..self.clone()
        }
    }

    /// The line `skylight render ..` that gives these settings again, quoted for a shell: what the scene and the defaults do
    /// not give by themselves, and always sun, camera and preset.
    ///
    /// `scene` is the path that was opened, and `loaded` what was found there (its options and cameras; the model is not
    /// looked at).
    ///
    /// # Errors
    /// A value of the scene that these settings lack and that no option takes back, such as a gamma; a path or name with a
    /// zero byte.
    pub fn command_line(&self, scene: Option<&Path>, loaded: &Loaded) -> Result<String, Error> {
        let by_itself = Self::resolve(
            Options {
                preset: self.preset,
                camera: self.camera.name.clone(),
                ..Options::default()
            },
            loaded,
        )?;
        let words = differences(&self.words(), &by_itself.words())?;
        let scene = scene.map(|path| {
            let text = path.to_string_lossy().into_owned();
            let looks_like_an_option = text.starts_with('-');
            if looks_like_an_option {
                format!("./{text}")
            } else {
                text
            }
        });
        let line = ["skylight".to_owned(), "render".to_owned()];
        let line: Vec<String> = line.into_iter().chain(scene).chain(words).collect();
        let quoted: Result<Vec<_>, _> = line.iter().map(|word| quoted(word)).collect();
        let quoted = quoted.map(|words| words.join(" "));
        Ok(quoted.map_err(|_| {
            SettingsError("a name holds a zero byte, which no command line can; rename it".into())
        })?)
    }

    /// Every option that gives a part of these settings.
    fn words(&self) -> Vec<Word> {
        let point = |p: [f64; 3]| format!("{},{},{}", p[0], p[1], p[2]);
        let count = |n: Option<u32>| n.map(|n| n.to_string());
        let (camera, limits) = (&self.camera, &self.limits);
        let mut words: Vec<Word> = self
            .parameters()
            .into_iter()
            .map(|(name, value)| (name, Some(value)))
            .collect();
        let optional = [
            ("preset", self.preset.map(name)),
            ("camera", camera.name.clone()),
            ("eye", camera.eye.map(point)),
            ("target", camera.target.map(point)),
            ("fov", camera.fov_deg.map(|fov| fov.to_string())),
            ("smooth", self.smooth.map(|angle| angle.to_string())),
            ("device", self.device.clone()),
            ("without", self.without.map(name)),
            ("tile", count(self.tile)),
            ("max-triangles", count(limits.max_triangles)),
            ("max-texture-edge", count(limits.max_texture_edge)),
            ("max-texture-mib", count(limits.max_texture_mib)),
            ("max-file-mib", count(limits.max_file_mib)),
        ];
        words.extend(optional.into_iter().filter(|(_, value)| value.is_some()));
        let flags = [
            ("limb-darkening", self.limb_darkening),
            ("layers", self.layers),
            ("quiet", self.quiet),
            ("validate", self.validate),
            ("allow-outside", limits.allow_outside),
        ];
        words.extend(flags.into_iter().filter(|f| f.1).map(|f| (f.0, None)));
        words
    }
}

/// What turns the settings `from` into `to`, as arguments.
fn differences(to: &[Word], from: &[Word]) -> Result<Vec<String>, SettingsError> {
    let of = |name: &str, words: &[Word]| words.iter().find(|word| word.0 == name).cloned();
    let is_lost = |word: &&Word| !REPLACED.contains(&word.0) && of(word.0, to).is_none();
    if let Some((name, _)) = from.iter().find(is_lost) {
        return Err(SettingsError(format!(
            "the scene sets {name}, and no option takes that back; change it in the scene file"
        )));
    }
    let changes = |name: &str| of(name, to) != of(name, from);
    let is_written = |word: &&Word| {
        let mut matters = MATTERS.iter().filter(|matter| matter.contains(&word.0));
        let matter_changes = matters.any(|matter| matter.iter().any(|name| changes(name)));
        ALWAYS.contains(&word.0) || changes(word.0) || matter_changes
    };
    Ok(to.iter().filter(is_written).flat_map(arguments).collect())
}

fn arguments((name, value): &Word) -> Vec<String> {
    match value {
        None => vec![format!("--{name}")],
        // Else a negative number, or a name with a dash, might be an option.
        Some(value) if value.starts_with('-') => vec![format!("--{name}={value}")],
        Some(value) => vec![format!("--{name}"), value.clone()],
    }
}

/// For a shell; a list of numbers needs no quotes.
fn quoted(word: &str) -> Result<Cow<'_, str>, shlex::QuoteError> {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-+_./:,=".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return Ok(word.into());
    }
    shlex::try_quote(word)
}

/// The number with the fewest digits that is the same in 32 bits.
fn shortest(value: f32) -> f64 {
    value.to_string().parse().unwrap_or(value.into())
}

#[cfg(test)]
#[path = "command_tests.rs"]
mod tests;
