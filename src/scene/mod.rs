//! Models, materials, textures, cameras and scene files, without a device.
//!
//! [`load`] turns a scene file or a model into one [`Scene`]: every mesh in world space, in one arena of vertices and
//! indices, ready to be uploaded. World space is right-handed, metres, +Y up, +X east, −Z north.

mod bounds;
mod builder;
mod bundled;
mod camera;
mod error;
mod files;
mod material;
mod normals;
mod obj;
mod obj_text;
mod progress;
mod scene_file;
mod soup;
mod texture;
mod triangulate;

use std::path::{Path, PathBuf};

use glam::Affine3A;

pub use bounds::Bounds;
pub use bundled::bundled;
pub use camera::{Camera, DEFAULT_FOV_DEG};
pub use error::SceneError;
pub use material::Material;
pub use progress::Progress;
pub use scene_file::NamedCamera;
pub use texture::Texture;

use builder::Builder;
use files::Files;
use obj::{Placement, append_obj};
use progress::Reporter;

/// Everything there is to see: one arena of vertices, the parts that draw them, and what they look like.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Vertex positions in world space, metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals in world space, one for each position.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, one for each position; (0, 0) is the corner of the first row and first texel.
    pub texcoords: Vec<[f32; 2]>,
    /// Three for each triangle, counter-clockwise seen from the front; numbers of `positions`.
    pub indices: Vec<u32>,
    /// What is drawn with one material; together they cover `indices` without gaps.
    pub parts: Vec<Part>,
    /// Looked up by [`Part::material`].
    pub materials: Vec<Material>,
    /// Looked up by the texture numbers of [`Material`].
    pub textures: Vec<Texture>,
    /// Around everything.
    pub bounds: Bounds,
    /// What was odd but no reason to stop, one line each.
    pub warnings: Vec<String>,
}

/// A run of triangles of one mesh with one material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// Where it starts in [`Scene::indices`].
    pub first_index: u32,
    /// A multiple of three, not zero.
    pub index_count: u32,
    /// Number of its material in [`Scene::materials`].
    pub material: u32,
    /// Around its triangles, metres.
    pub bounds: Bounds,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            positions: Vec::new(),
            normals: Vec::new(),
            texcoords: Vec::new(),
            indices: Vec::new(),
            parts: Vec::new(),
            materials: Vec::new(),
            textures: Vec::new(),
            bounds: Bounds::EMPTY,
            warnings: Vec::new(),
        }
    }
}

impl Scene {
    /// Number of triangles.
    pub fn triangles(&self) -> usize {
        self.indices.len() / 3
    }
}

/// What [`load`] may do.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadOptions {
    /// Smooths corners that have no normal below this crease angle, degrees 0..180. None: smoothing groups, else flat.
    /// A mesh of a scene file with its own `smooth` goes by that.
    pub smooth_deg: Option<f32>,
    /// Pictures with a longer edge are not decoded, texels. 16 384 by default.
    pub max_texture_edge: u32,
    /// Most that all decoded pictures together may take, bytes. 1 GiB by default.
    pub max_texture_bytes: u64,
    /// Larger files are not read, bytes. 4 GiB by default.
    pub max_file_bytes: u64,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            smooth_deg: None,
            max_texture_edge: 16_384,
            max_texture_bytes: 1 << 30,
            max_file_bytes: 1 << 32,
        }
    }
}

/// A scene and what its file asks for besides.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// Where from, for messages.
    pub path: PathBuf,
    /// What is seen.
    pub scene: Scene,
    /// Options of the scene file as the command line would have them, without dashes: `("turbidity", "3")`. The
    /// nameless `[camera]` is among them. Empty for a model.
    pub options: Vec<(String, String)>,
    /// The named cameras, in the order of the file.
    pub cameras: Vec<NamedCamera>,
}

/// Reads a scene file (`.toml`) or a model (`.obj`).
///
/// # Errors
/// One line that names the file, for whatever keeps the scene from being shown. A missing material library or texture is
/// a line in [`Scene::warnings`] instead.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, SceneError> {
    load_telling(Some(path), options, &|_, _| ())
}

/// As [`load`], or the bundled scene without a path, telling how far it is. It needs no device and may run on any thread,
/// so that an event loop can go on meanwhile.
///
/// # Errors
/// As [`load`].
pub fn load_telling(
    path: Option<&Path>,
    options: &LoadOptions,
    progress: Progress<'_>,
) -> Result<Loaded, SceneError> {
    let disk = Files::Disk {
        max_bytes: options.max_file_bytes,
    };
    match path {
        Some(path) => load_from(disk, path, options, progress),
        None => bundled::load_bundled(options, progress),
    }
}

fn load_from(
    files: Files,
    path: &Path,
    options: &LoadOptions,
    progress: Progress<'_>,
) -> Result<Loaded, SceneError> {
    let mut builder = Builder::new(files, options, Reporter::new(progress));
    let extension = path
        .extension()
        .map(|e| e.to_string_lossy().to_ascii_lowercase());
    let (options, cameras) = match extension.as_deref() {
        Some("toml") => scene_file::append_scene(&mut builder, path, options)?,
        _ => {
            let placement = Placement {
                world_from_mesh: Affine3A::IDENTITY,
                smooth_deg: options.smooth_deg,
            };
            append_model(&mut builder, path, &placement)?;
            (Vec::new(), Vec::new())
        }
    };
    progress(1.0, "loaded");
    Ok(Loaded {
        path: path.to_owned(),
        scene: builder.scene,
        options,
        cameras,
    })
}

/// Adds a model of any known format.
fn append_model(
    builder: &mut Builder<'_>,
    path: &Path,
    placement: &Placement,
) -> Result<(), SceneError> {
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
        Some("obj") => append_obj(builder, path, placement),
        Some("gltf" | "glb") => {
            unsupported("glTF is not supported yet; convert it to OBJ".to_owned())
        }
        // A missing file or a directory is the better news than its extension.
        _ => match builder.files.probe(path) {
            Err(error @ (SceneError::Missing(_) | SceneError::Directory(_))) => Err(error),
            _ => unsupported(
                "is no scene file (.toml) and no model (.obj); convert it to OBJ".to_owned(),
            ),
        },
    }
}
