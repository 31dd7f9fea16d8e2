//! The scene while it is being put together.

use std::collections::HashMap;
use std::path::Path;

use crate::scene::error::{SceneError, printable};
use crate::scene::files::Files;
use crate::scene::material::Material;
use crate::scene::progress::Reporter;
use crate::scene::texture::picture::{TextureStore, Wanted};
use crate::scene::{LoadOptions, Scene};

/// Warnings beyond these are left out: a hostile file could ask for millions.
const MAX_WARNINGS: usize = 100;

/// A scene in the making, and where its files come from.
#[derive(Debug)]
pub(super) struct Builder<'p> {
    pub scene: Scene,
    pub files: Files,
    pub textures: TextureStore,
    /// Of the model that is being added.
    pub progress: Reporter<'p>,
    /// Threads to use, at least 1.
    pub threads: usize,
    materials: HashMap<String, u32>,
    allow_outside: bool,
    max_triangles: usize,
}

impl<'p> Builder<'p> {
    pub fn new(files: Files, options: &LoadOptions, progress: Reporter<'p>) -> Self {
        let threads = std::thread::available_parallelism();
        Self {
            scene: Scene::default(),
            files,
            textures: TextureStore::new(options),
            progress,
            threads: threads.map_or(1, usize::from),
            materials: HashMap::new(),
            allow_outside: options.allow_outside,
            max_triangles: options.max_triangles,
        }
    }

    /// What is read next belongs to this model: its libraries and pictures must lie in its folder tree.
    pub fn begin_model(&mut self, path: &Path) {
        if !self.allow_outside {
            self.files.confine_to(path);
        }
    }

    /// Notes something odd about a file that is no reason to stop.
    pub fn warn(&mut self, path: &Path, what: &str) {
        if self.scene.warnings.len() >= MAX_WARNINGS {
            if self.scene.warnings.len() == MAX_WARNINGS {
                let more = "more warnings are left out".to_owned();
                self.scene.warnings.push(more);
            }
            return;
        }
        let name = path
            .file_name()
            .unwrap_or(path.as_os_str())
            .to_string_lossy();
        let line = printable(&format!("{name}: {what}"));
        self.scene.warnings.push(line);
    }

    /// Notes that a file was left alone.
    pub fn warn_outside(&mut self, owner: &Path, path: &Path) {
        let what = format!(
            "{} lies outside of the model's folder and is not read; allow it with --allow-outside",
            path.display()
        );
        self.warn(owner, &what);
    }

    /// Whether this many more triangles may be added.
    ///
    /// # Errors
    /// When they are too many.
    pub fn check_room(&self, path: &Path, triangles: usize) -> Result<(), SceneError> {
        let all = self.scene.triangles().saturating_add(triangles);
        if all <= self.max_triangles && self.scene.has_room_for(triangles.saturating_mul(3)) {
            return Ok(());
        }
        Err(SceneError::TooMany {
            path: path.to_owned(),
            triangles: all,
            limit: self.max_triangles,
        })
    }

    /// Whether this many triangles may be read, drawn or not: a file may name the same ones again and again.
    ///
    /// # Errors
    /// When they are too many.
    pub fn check_read(&self, path: &Path, triangles: usize) -> Result<(), SceneError> {
        if triangles <= self.max_triangles {
            return Ok(());
        }
        Err(SceneError::TooMany {
            path: path.to_owned(),
            triangles,
            limit: self.max_triangles,
        })
    }

    /// Corners of triangles that may still be added.
    pub fn corners_left(&self) -> usize {
        let triangles = self.max_triangles.saturating_sub(self.scene.triangles());
        triangles.saturating_mul(3)
    }

    /// The number of the material in the scene; equal ones share it.
    pub fn add_material(&mut self, material: Material) -> u32 {
        let materials = &mut self.scene.materials;
        // The text of a material tells all about it, but has a hash.
        let key = format!("{material:?}");
        *self.materials.entry(key).or_insert_with(|| {
            materials.push(material);
            (materials.len() - 1) as u32
        })
    }

    /// The number of a texture in the scene, made at first use; none (and a warning) if that fails.
    pub fn texture(&mut self, owner: &Path, wanted: Wanted) -> Option<usize> {
        let textures = &mut self.scene.textures;
        match self.textures.get(&self.files, wanted, textures) {
            Ok(number) => number,
            Err(what) => {
                self.warn(owner, &what);
                None
            }
        }
    }

    /// The mean of a picture, 0..1; 1 (and a warning) if that fails.
    pub fn mean(&mut self, owner: &Path, path: &Path) -> [f32; 3] {
        let mean = self.textures.mean(&self.files, path);
        mean.unwrap_or_else(|what| {
            self.warn(owner, &what);
            [1.0; 3]
        })
    }
}
