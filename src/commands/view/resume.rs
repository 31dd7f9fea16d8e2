//! The settings of each scene when its window was last closed, kept in the user's state folder.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};
use crate::output::write_whole;
use crate::scene::{BUNDLED, bundled_name};
use crate::settings::{Options, SettingsError};

use super::document::Document;

/// The file of a scene: its name for people, and the whole path as a number so that two of a name do not meet.
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

/// Keeps the settings of a document, by option name.
///
/// # Errors
/// When the state folder cannot be written to.
pub(super) fn keep(document: &Document) -> Result<()> {
    let Some(file) = file_of(document.job.path.as_deref()) else {
        return Ok(());
    };
    let failed = |reason: String| Error::Write {
        path: file.clone(),
        reason,
    };
    let point = |p: glam::Vec3| format!("{},{},{}", p.x, p.y, p.z);
    let camera = document.controls.camera();
    let mut options: BTreeMap<&str, String> =
        document.job.settings.parameters().into_iter().collect();
    options.insert("eye", point(camera.eye));
    options.insert("target", point(camera.target));
    options.insert("fov", camera.fov_deg.to_string());
    let text = toml::to_string(&options).map_err(|e| failed(e.to_string()))?;
    if let Some(folder) = file.parent() {
        std::fs::create_dir_all(folder).map_err(|e| failed(e.to_string()))?;
    }
    write_whole(&file, text.as_bytes())
}

/// What was kept of a scene, below what the user asks for now. Nothing kept is nothing wrong.
///
/// # Errors
/// A file that is damaged: it names the file to delete.
pub(super) fn recall(scene: Option<&Path>, options: Options) -> Result<Options> {
    let Some(file) = file_of(scene).filter(|file| file.exists()) else {
        return Ok(options);
    };
    let damaged = |reason: String| {
        let file = file.display();
        Error::from(SettingsError(format!(
            "{file} cannot be resumed from ({reason}); delete it"
        )))
    };
    let text = std::fs::read_to_string(&file).map_err(|e| damaged(e.to_string()))?;
    let kept: BTreeMap<String, String> =
        toml::from_str(&text).map_err(|e| damaged(e.message().to_owned()))?;
    let pairs: Vec<(String, String)> = kept.into_iter().collect();
    let kept = Options::from_pairs(&pairs).map_err(|e| damaged(e.0))?;
    Ok(options.over(kept))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_of_one_name_have_files_of_their_own() {
        let file = |path: &str| file_of(Some(Path::new(path))).expect("a state folder");
        assert_ne!(file("/a/house.obj"), file("/b/house.obj"));
        assert_eq!(file("/a/house.obj"), file("/a/house.obj"));
    }
}
