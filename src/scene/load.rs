//! Loading of scene files and models.

use std::path::{Path, PathBuf};

use crate::scene::builder::Builder;
use crate::scene::bundled::{BUNDLED, bundled_name, load_bundled};
use crate::scene::error::printable;
use crate::scene::files::Files;
use crate::scene::obj::append_obj;
use crate::scene::placement::{Placement, Unit, Up, upright};
use crate::scene::progress::{Progress, Reporter};
use crate::scene::scene_file::{
    NamedCamera, NamedMoment, NamedOptions, SceneFileOptions, camera_table,
};
use crate::scene::{Bvh, Scene, SceneError, cache, gltf, scene_file};

/// Options and limits for [`load`].
#[derive(Debug, Clone, PartialEq)]
pub struct LoadOptions {
    /// Crease angle below which corners without a normal are smoothed, degrees, 0..180. `None`: by smoothing groups, or flat
    /// without them. The `smooth` key of a mesh in a scene file overrides it.
    pub smooth_deg: Option<f32>,
    /// The axis of models that points up; the `up` key of a mesh in a scene file overrides it. Default: +Y.
    pub up: Up,
    /// The unit of models; the `unit` key of a mesh in a scene file overrides it. `None`: metres, with a warning if the size of a
    /// model is implausible.
    pub unit: Option<Unit>,
    /// Maximum edge length of an image, texels; larger images are not decoded. Default: 16 384.
    pub max_texture_edge: u32,
    /// Limit on the total size of decoded images, bytes. Default: 1 GiB.
    pub max_texture_bytes: u64,
    /// Limit on the size of each file and on the total size of a scene's files, bytes. Default: 4 GiB.
    pub max_file_bytes: u64,
    /// Limit on the number of triangles in a scene, including instances. Default: 64 Mi.
    pub max_triangles: usize,
    /// Whether a model may read libraries, images and buffers outside its folder. Default: false, because a downloaded model
    /// must not read other files.
    pub allow_outside: bool,
    /// Folder of the cache of processed scenes, which makes a large model load faster the second time. Default: none.
    pub cache: Option<PathBuf>,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            smooth_deg: None,
            up: Up::Y,
            unit: None,
            max_texture_edge: 16_384,
            max_texture_bytes: 1 << 30,
            max_file_bytes: 1 << 32,
            max_triangles: 64 << 20,
            allow_outside: false,
            cache: None,
        }
    }
}

/// A loaded scene and the options of its file.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// Path, for messages.
    pub path: PathBuf,
    /// The scene.
    pub scene: Scene,
    /// Option tables of the scene file, with options as command-line names without dashes: `("turbidity", "3")`. The last is
    /// the unnamed `[camera]`. For a model: its first camera, if any.
    pub options: Vec<NamedOptions>,
    /// Named cameras, in file order.
    pub cameras: Vec<NamedCamera>,
    /// Named moments, in file order.
    pub moments: Vec<NamedMoment>,
}

/// Reads a scene file (`.toml`) or a model (`.obj`, `.gltf`, `.glb`).
///
/// # Errors
/// When the scene cannot be loaded. A missing material library or texture is only a warning in [`Scene::warnings`].
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, SceneError> {
    load_with_progress(Some(path), options, &|_, _| ())
}

/// Same as [`load`], with progress reports. Also loads a bundled scene by name ([`BUNDLED`]); without a path, the first one. It
/// needs no device and may run on any thread.
///
/// # Errors
/// As [`load`].
pub fn load_with_progress(
    path: Option<&Path>,
    options: &LoadOptions,
    progress: Progress<'_>,
) -> Result<Loaded, SceneError> {
    let disk = Files::disk(options.max_file_bytes);
    let name = match path.map(|path| (path, bundled_name(path))) {
        Some((path, None)) => return load_cached(disk, path, options, progress),
        Some((_, Some(name))) => name,
        None => BUNDLED[0],
    };
    load_bundled(name, options, progress)
}

/// Loads a large model from the cache if its entry is valid; otherwise from its files, and writes the entry.
fn load_cached(
    mut files: Files,
    path: &Path,
    options: &LoadOptions,
    progress: Progress<'_>,
) -> Result<Loaded, SceneError> {
    let large = std::fs::metadata(path).is_ok_and(|meta| meta.len() >= cache::MIN_MODEL_BYTES);
    let Some(folder) = options.cache.as_deref().filter(|_| large) else {
        return load_from(&mut files, path, options, progress);
    };
    progress(0.0, "checking the cache");
    let content = files.digest(path)?;
    let entry = cache::entry_path(folder, path, content, options);
    if let Some(loaded) = cache::read(&entry, path) {
        progress(1.0, "loaded");
        return Ok(loaded);
    }
    files.start_record();
    let mut loaded = load_from(&mut files, path, options, progress)?;
    progress(1.0, "building the hierarchy");
    loaded.scene.bvh = Some(Bvh::of(&loaded.scene, |_| true));
    if let Err(error) = cache::write(&entry, &loaded, files.take_record()) {
        let line = format!(
            "the scene cannot be cached in {} ({error}); check the disk or pass --no-cache",
            folder.display()
        );
        loaded.scene.warnings.push(printable(&line));
    }
    Ok(loaded)
}

/// Progress after reading the files and before computing the layout.
const READING: f32 = 0.9;

/// Loads a scene file or a model from a source of files.
pub(super) fn load_from(
    files: &mut Files,
    path: &Path,
    options: &LoadOptions,
    progress: Progress<'_>,
) -> Result<Loaded, SceneError> {
    let reading = Reporter::new(progress).up_to(READING);
    let mut builder = Builder::new(files.clone(), options, reading);
    let extension = path
        .extension()
        .map(|e| e.to_string_lossy().to_ascii_lowercase());
    let file_options = match extension.as_deref() {
        Some("toml") => scene_file::append_scene(&mut builder, path, options)?,
        _ => {
            let placement = Placement {
                world_from_mesh: upright(options.up, options.unit.unwrap_or(Unit::M)),
                smooth_deg: options.smooth_deg,
            };
            let cameras = append_model(&mut builder, path, &placement)?;
            builder.warn_of_size(path, options.unit.is_some());
            let first = cameras.first().map(|c| c.options.clone());
            SceneFileOptions {
                options: first.map(camera_table).into_iter().collect(),
                cameras,
                moments: Vec::new(),
            }
        }
    };
    builder.scene.pad_attributes();
    *files = builder.files;
    progress(READING, "sorting");
    builder.scene.arrange();
    progress(1.0, "loaded");
    Ok(Loaded {
        path: path.to_owned(),
        scene: builder.scene,
        options: file_options.options,
        cameras: file_options.cameras,
        moments: file_options.moments,
    })
}

/// Adds a model of any supported format; returns its cameras.
pub(super) fn append_model(
    builder: &mut Builder<'_>,
    path: &Path,
    placement: &Placement,
) -> Result<Vec<NamedCamera>, SceneError> {
    builder.begin_model(path);
    let unsupported = |what: String| {
        Err(SceneError::Unsupported {
            path: path.to_owned(),
            what,
        })
    };
    let extension = path
        .extension()
        .map(|e| e.to_string_lossy().to_ascii_lowercase());
    match extension.as_deref() {
        Some("obj") => append_obj(builder, path, placement).map(|()| Vec::new()),
        Some("gltf" | "glb") => gltf::append_gltf(builder, path, placement),
        // A missing file or a directory is reported before an unknown extension.
        _ => match builder.files.probe(path) {
            Err(error @ (SceneError::Missing(_) | SceneError::Directory(_))) => Err(error),
            _ => unsupported(
                "is neither a scene file (.toml) nor a model (.obj, .gltf, .glb); convert it"
                    .to_owned(),
            ),
        },
    }
}
