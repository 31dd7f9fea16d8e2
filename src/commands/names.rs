//! Names of the files of several pictures.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::options::{OptionValues, Options};
use crate::scene::Loaded;

/// The file of each picture: `pattern` with its `{camera}` and `{moment}`. That is the name of a moment, or the local time.
///
/// # Errors
/// Options that cannot be used, a placeholder without a value, or two pictures of one name.
pub(super) fn files(
    pattern: &Path,
    pictures: &[OptionValues],
    loaded: &Loaded,
) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for picture in pictures {
        let settings = Options::resolve(picture, loaded)?;
        files.push(file(pattern, picture, &settings).map_err(Error::usage)?);
    }
    let mut seen = HashSet::new();
    match files.iter().find(|file| !seen.insert(*file)) {
        None => Ok(files),
        Some(file) => Err(Error::usage(format!(
            "several pictures would be {}; tell them apart in -o, for instance -o '{{camera}}-{{moment}}.png'",
            file.display()
        ))),
    }
}

fn file(
    pattern: &Path,
    picture: &OptionValues,
    settings: &Options,
) -> std::result::Result<PathBuf, String> {
    let Some(mut text) = pattern.to_str().map(str::to_owned) else {
        return Ok(pattern.to_owned());
    };
    for (placeholder, value, what) in [
        (
            "{camera}",
            picture.get("camera").map(str::to_owned),
            "--camera",
        ),
        (
            "{moment}",
            moment(picture, settings),
            "--moment, or a place and --when",
        ),
    ] {
        if text.contains(placeholder) {
            let value = value.ok_or_else(|| format!("{placeholder} in -o needs {what}"))?;
            text = text.replace(placeholder, &plain(&value));
        }
    }
    Ok(text.into())
}

/// The name of the moment, else its local time.
fn moment(picture: &OptionValues, settings: &Options) -> Option<String> {
    let name = picture.get("moment").map(str::to_owned);
    let time = || {
        let (_, _, when) = settings.sun.place()?;
        let time = when.format("%Y-%m-%dT%H%M%S").to_string();
        // Seconds only where there are some.
        Some(time.strip_suffix("00").unwrap_or(&time).to_owned())
    };
    name.or_else(time)
}

/// A name without what has a meaning in paths.
fn plain(name: &str) -> String {
    let is_plain = |c: char| c.is_alphanumeric() || "-_.+ ".contains(c);
    let text = name.chars().map(|c| if is_plain(c) { c } else { '-' });
    text.collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::tests::scene;

    fn named(
        pattern: &str,
        pictures: &[&[(&str, &str)]],
    ) -> std::result::Result<Vec<String>, String> {
        let pictures: Vec<_> = pictures.iter().map(|p| OptionValues::from(*p)).collect();
        let files = files(Path::new(pattern), &pictures, &scene(&[]));
        let files = files.map_err(|error| error.to_string())?;
        Ok(files.iter().map(|f| f.display().to_string()).collect())
    }

    #[test]
    fn placeholders_are_filled_in() {
        let noon = ("when", "2026-06-21T12:00:00+02:00");
        let soon = ("when", "2026-06-21T12:00:01+02:00");
        assert_eq!(
            named("a/{camera}-{moment}.png", &[&[("camera", "7"), noon]]),
            Ok(vec!["a/7-2026-06-21T1200.png".to_owned()])
        );
        let both = named("{moment}.png", &[&[noon], &[soon]]).expect("two");
        assert_eq!(both, ["2026-06-21T1200.png", "2026-06-21T120001.png"]);
        assert_eq!(
            named("{moment}.png", &[&[("moment", "7"), ("camera", "7")]]),
            Ok(vec!["7.png".to_owned()])
        );
        assert_eq!(plain("../roof"), "..-roof");
    }

    #[test]
    fn names_that_do_not_tell_pictures_apart_are_wrong() {
        let noon = ("when", "2026-06-21T12:00:00+02:00");
        let late = ("when", "2026-06-21T22:00:00+02:00");
        let error = named("a.png", &[&[noon], &[late]]).expect_err("one name");
        assert!(error.contains("would be a.png; tell them apart"), "{error}");
        let error = named("{camera}.png", &[&[noon]]).expect_err("no camera");
        assert!(error.contains("{camera} in -o needs --camera"), "{error}");
        let error = named("{moment}.png", &[&[("sun", "1,2")]]).expect_err("no moment");
        assert!(error.contains("needs --moment"), "{error}");
    }
}
