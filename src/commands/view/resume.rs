//! Options of each scene from when its window was last closed, kept in the user's state folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::options::{OptionValues, Options};
use crate::output::write_whole;
use crate::scene::{BUNDLED, bundled_name};

use super::document::Document;

/// The state file of a scene. Unless the scene is bundled, the name includes a hash of its absolute path: scenes in different
/// folders may share a name.
fn file_of(scene: Option<&Path>) -> Option<PathBuf> {
    let folder = dirs::state_dir().or_else(dirs::data_local_dir)?;
    let bundled = scene.map_or(Some(BUNDLED[0]), bundled_name);
    let name = match (bundled, scene.unwrap_or(Path::new(""))) {
        (Some(name), _) if name == BUNDLED[0] => "bundled".to_owned(),
        (Some(name), _) => format!("bundled-{name}"),
        (None, path) => {
            let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            let hash = blake3::hash(whole.as_os_str().as_encoded_bytes()).to_hex();
            format!("{stem}-{}", &hash[..16])
        }
    };
    Some(folder.join("skylight").join(name).with_extension("toml"))
}

/// Saves the options of a document.
///
/// # Errors
/// Fails when the state folder cannot be written to.
pub(super) fn keep(document: &Document) -> Result<()> {
    let Some(file) = file_of(document.job.path.as_deref()) else {
        return Ok(());
    };
    let failed = |reason: String| Error::Write {
        path: file.clone(),
        reason,
    };
    let camera = document.controls.camera();
    let options = document
        .job
        .settings
        .with_camera(&camera, document.job.scene.origin);
    let text = to_text(&options).map_err(failed)?;
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(|e| failed(e.to_string()))?;
    }
    write_whole(&file, text.as_bytes())
}

/// Options as TOML text: a table of strings by name.
fn to_text(options: &Options) -> std::result::Result<String, String> {
    let pairs: BTreeMap<String, String> = options.values().into_pairs().into_iter().collect();
    toml::to_string(&pairs).map_err(|e| e.to_string())
}

/// The inverse of [`to_text`]. The error says what is wrong.
fn from_text(text: &str) -> std::result::Result<OptionValues, String> {
    let kept: BTreeMap<String, String> =
        toml::from_str(text).map_err(|e| e.message().to_owned())?;
    let kept = OptionValues::from(kept.into_iter().collect::<Vec<_>>());
    kept.check().map_err(|e| e.0)?;
    Ok(kept)
}

/// The user's options over those saved for the scene, if any.
///
/// # Errors
/// A damaged file; the message names the file to delete.
pub(super) fn recall(scene: Option<&Path>, user: OptionValues) -> Result<OptionValues> {
    let Some(file) = file_of(scene).filter(|file| file.exists()) else {
        return Ok(user);
    };
    let damaged = |reason: String| {
        let file = file.display();
        Error::usage(format!(
            "{file} cannot be resumed from ({reason}); delete it"
        ))
    };
    let text = std::fs::read_to_string(&file).map_err(|e| damaged(e.to_string()))?;
    let kept = from_text(&text).map_err(damaged)?;
    Ok(user.over(kept))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::options::tests::{each_set, exposed_scene};

    #[test]
    fn every_option_is_resumed() {
        let scene = exposed_scene();
        for (name, options) in each_set(&scene) {
            let text = to_text(&options).expect(&name);
            let kept = from_text(&text).expect(&name);
            let resumed = Options::resolve(&kept, &scene).expect(&name);
            assert_eq!(resumed, options, "{name}: {text}");
        }
    }

    #[test]
    fn scenes_of_one_name_have_files_of_their_own() {
        let file = |path: &str| file_of(Some(Path::new(path))).expect("a state folder");
        assert_ne!(file("/a/house.obj"), file("/b/house.obj"));
        assert_eq!(file("/a/house.obj"), file("/a/house.obj"));
    }
}
