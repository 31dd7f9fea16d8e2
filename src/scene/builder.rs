//! The scene while it is being put together.

use std::path::Path;

use super::files::Files;
use super::material::Material;
use super::progress::Reporter;
use super::texture::TextureStore;
use super::{LoadOptions, Scene};

/// A scene in the making, and where its files come from.
#[derive(Debug)]
pub(super) struct Builder<'p> {
    pub scene: Scene,
    pub files: Files,
    pub textures: TextureStore,
    /// Of the model that is being added.
    pub progress: Reporter<'p>,
}

impl<'p> Builder<'p> {
    pub fn new(files: Files, options: &LoadOptions, progress: Reporter<'p>) -> Self {
        Self {
            scene: Scene::default(),
            files,
            textures: TextureStore::new(options),
            progress,
        }
    }

    /// Notes something odd about a file that is no reason to stop.
    pub fn warn(&mut self, path: &Path, what: &str) {
        let name = path
            .file_name()
            .unwrap_or(path.as_os_str())
            .to_string_lossy();
        self.scene.warnings.push(format!("{name}: {what}"));
    }

    /// The number of the material in the scene; equal ones share it.
    pub fn add_material(&mut self, material: Material) -> u32 {
        let materials = &mut self.scene.materials;
        let number = materials
            .iter()
            .position(|m| *m == material)
            .unwrap_or_else(|| {
                materials.push(material);
                materials.len() - 1
            });
        number as u32
    }

    /// The number of a texture in the scene, decoded at first use; none (and a warning) if that fails.
    pub fn texture(&mut self, owner: &Path, path: &Path) -> Option<usize> {
        match self
            .textures
            .get(&self.files, path, &mut self.scene.textures)
        {
            Ok(number) => number,
            Err(what) => {
                self.warn(owner, &what);
                None
            }
        }
    }
}
