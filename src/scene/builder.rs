//! A scene under construction.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use glam::{Affine3A, DAffine3, DVec3};

use crate::scene::error::{SceneError, printable};
use crate::scene::files::Files;
use crate::scene::material::{MAX_EMISSION, Material, MaterialKey, bounded_emission};
use crate::scene::origin;
use crate::scene::progress::Reporter;
use crate::scene::size;
use crate::scene::texture::picture::{TextureKey, TextureStore};
use crate::scene::{LoadOptions, Scene};

/// Maximum number of warnings per scene: a malicious file could cause millions.
const MAX_WARNINGS: usize = 100;
/// A scene under construction, and where its files are read from.
#[derive(Debug)]
pub(super) struct Builder<'p> {
    pub scene: Scene,
    pub files: Files,
    pub textures: TextureStore,
    /// Progress of the current model.
    pub progress: Reporter<'p>,
    /// Number of threads to use, at least 1.
    pub threads: usize,
    materials: HashMap<MaterialKey, u32>,
    /// Whether the scene's origin is chosen: by its first model.
    has_origin: bool,
    /// Files with emission out of range.
    bad_emission: HashSet<PathBuf>,
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
            has_origin: false,
            bad_emission: HashSet::new(),
            allow_outside: options.allow_outside,
            max_triangles: options.max_triangles,
        }
    }

    /// Starts a model. Its libraries and images must be inside its folder, unless `allow_outside` is set.
    pub fn begin_model(&mut self, path: &Path) {
        if !self.allow_outside {
            self.files.confine_to(path);
        }
    }

    /// Chooses the scene's origin from points of the first model in world space, metres: where it lies, if that is far from the
    /// world's origin in relation to its size. Positions relative to it keep their digits in `f32`. Reorders the points.
    pub fn choose_origin(&mut self, path: &Path, points: &mut Vec<DVec3>) {
        points.retain(|point| point.is_finite());
        if self.has_origin || points.is_empty() {
            return;
        }
        self.has_origin = true;
        let middle = origin::middle(points);
        self.scene.origin = middle.origin();
        if middle.is_geocentric() {
            let what = "coordinates are geocentric (ECEF): +Y is not up there, and sun and sky are tilted; export it in a local frame with +Y up";
            self.warn(path, what);
        }
    }

    /// The transform to the space of the scene's positions, of points that are given relative to `origin` of their own space.
    pub fn scene_from_world(&self, world_from_own: DAffine3, origin: DVec3) -> Affine3A {
        let moved = world_from_own.transform_point3(origin) - self.scene.origin;
        DAffine3::from_mat3_translation(world_from_own.matrix3, moved).as_affine3a()
    }

    /// Warns of a scene whose size in metres is implausible, unless its unit was given.
    pub fn warn_of_size(&mut self, path: &Path, has_unit: bool) {
        let size = size::implausible(&self.scene).filter(|_| !has_unit);
        if let Some(size) = size {
            let what = format!(
                "the scene {size}, and light depends on size; if its unit is not the metre, give --unit mm, cm, in or ft (or --unit m)"
            );
            self.warn(path, &what);
        }
    }

    /// Adds a warning about a file.
    pub fn warn(&mut self, path: &Path, what: &str) {
        if self.scene.warnings.len() >= MAX_WARNINGS {
            if self.scene.warnings.len() == MAX_WARNINGS {
                let omitted = "further warnings are omitted".to_owned();
                self.scene.warnings.push(omitted);
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

    /// Warns that a file outside the model's folder was not read.
    pub fn warn_outside(&mut self, owner: &Path, path: &Path) {
        let what = format!(
            "{} is outside the model's folder and was not read; pass --allow-outside to allow it",
            path.display()
        );
        self.warn(owner, &what);
    }

    /// Checks that this many more triangles may be added to the scene.
    ///
    /// # Errors
    /// When the limit is exceeded.
    pub fn check_triangles(&self, path: &Path, triangles: usize) -> Result<(), SceneError> {
        let all = self.scene.triangles().saturating_add(triangles);
        if all <= self.max_triangles && self.scene.has_indices_for(triangles.saturating_mul(3)) {
            return Ok(());
        }
        Err(SceneError::TooMany {
            path: path.to_owned(),
            triangles: all,
            limit: self.max_triangles,
        })
    }

    /// Checks that this many triangles may be read, drawn or not. A file may reference the same triangles many times.
    ///
    /// # Errors
    /// When the limit is exceeded.
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

    /// Number of triangle corners that may still be added.
    pub fn corners_left(&self) -> usize {
        let triangles = self.max_triangles.saturating_sub(self.scene.triangles());
        triangles.saturating_mul(3)
    }

    /// Adds a material unless an equal one exists; returns its index.
    pub fn add_material(&mut self, material: Material) -> u32 {
        let materials = &mut self.scene.materials;
        *self.materials.entry(material.key()).or_insert_with(|| {
            materials.push(material);
            (materials.len() - 1) as u32
        })
    }

    /// Index of a texture, created on first use; `None` (with a warning) if that fails.
    pub fn texture(&mut self, owner: &Path, key: TextureKey) -> Option<usize> {
        let textures = &mut self.scene.textures;
        match self.textures.get(&self.files, key, textures) {
            Ok(index) => index,
            Err(what) => {
                self.warn(owner, &what);
                None
            }
        }
    }

    /// L_e of a material within its range, cd/m²; the first one of a file that is not is told of.
    pub fn emission(&mut self, owner: &Path, material: &str, rgb: [f32; 3]) -> [f32; 3] {
        let bounded = bounded_emission(rgb);
        if bounded != rgb && self.bad_emission.insert(owner.to_owned()) {
            let what = format!(
                "emission of \"{material}\" is outside 0 to {MAX_EMISSION:e} cd/m²; the nearest is used, here and in other materials"
            );
            self.warn(owner, &what);
        }
        bounded
    }

    /// Mean red, green, blue and alpha of an image, 0..1 as encoded; 1 (with a warning) if that fails.
    pub fn mean(&mut self, owner: &Path, path: &Path) -> [f32; 4] {
        match self.textures.mean(&self.files, path) {
            Ok(mean) => mean.unwrap_or([1.0; 4]),
            Err(what) => {
                self.warn(owner, &what);
                [1.0; 4]
            }
        }
    }
}
