//! Models, materials, textures, cameras and scene files, without a device.
//!
//! [`load`] turns a scene file or a model into one [`Scene`]: every mesh in world space, in one arena of vertices and
//! indices, ready to be uploaded. World space is right-handed, metres, +Y up, +X east, −Z north.

mod bounds;
mod builder;
mod bundled;
mod cache;
mod camera;
mod culling;
mod error;
mod files;
mod gltf;
mod material;
mod mesh;
mod obj;
mod progress;
mod scene_file;
mod texture;

use std::path::{Path, PathBuf};

use glam::Affine3A;
use serde::{Deserialize, Serialize};

pub use bounds::Bounds;
pub use bundled::{BUNDLED, bundled, bundled_name};
pub use camera::{Camera, DEFAULT_FOV_DEG};
pub use culling::bodies::{Bodies, Body};
pub use culling::clusters::{Cluster, Clusters, Solid};
pub use culling::layout::Layout;
pub use error::SceneError;
pub(crate) use error::shown;
pub use material::Material;
pub use progress::Progress;
pub use scene_file::{NamedCamera, NamedMoment, NamedOptions};
pub use texture::{Encoding, Texture};

use builder::Builder;
use files::Files;
use obj::{Placement, append_obj};
use progress::Reporter;
use scene_file::{SceneFileOptions, camera_table};

/// Everything there is to see: one arena of vertices, the parts that draw them, and what they look like.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    /// Vertex positions in world space, metres.
    pub positions: Vec<[f32; 3]>,
    /// Unit normals in world space, one for each position.
    pub normals: Vec<[f32; 3]>,
    /// Texture coordinates, one for each position; (0, 0) is the corner of the first row and first texel.
    pub texcoords: Vec<[f32; 2]>,
    /// Linear RGBA that multiplies ρ_d and opacity, 0..65535 for 0..1: one for each position, or none at all.
    pub colours: Vec<[u16; 4]>,
    /// For normal maps: unit tangent toward growing u, then the sign of the bitangent (normal x tangent x sign points
    /// toward the upper rows of the picture), −32767..32767 for −1..1: one for each position, or none at all.
    pub tangents: Vec<[i16; 4]>,
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
    /// How it is drawn, if that is known already. It holds for the indices as they are.
    pub layout: Option<Layout>,
}

/// A run of triangles of one mesh with one material.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Part {
    /// Where it starts in [`Scene::indices`].
    pub first_index: u32,
    /// A multiple of three, not zero.
    pub index_count: u32,
    /// Number of its material in [`Scene::materials`].
    pub material: u32,
    /// Whether its vertices have colours of their own.
    pub has_colours: bool,
    /// Around its triangles, metres.
    pub bounds: Bounds,
}

impl Default for Scene {
    fn default() -> Self {
        Self {
            positions: Vec::new(),
            normals: Vec::new(),
            texcoords: Vec::new(),
            colours: Vec::new(),
            tangents: Vec::new(),
            indices: Vec::new(),
            parts: Vec::new(),
            materials: Vec::new(),
            textures: Vec::new(),
            bounds: Bounds::EMPTY,
            warnings: Vec::new(),
            layout: None,
        }
    }
}

impl Scene {
    /// Colours and tangents have an entry for each vertex, or none at all.
    fn fill_streams(&mut self) {
        let vertices = self.positions.len();
        if !self.colours.is_empty() {
            self.colours.resize(vertices, [u16::MAX; 4]);
        }
        if !self.tangents.is_empty() {
            self.tangents.resize(vertices, [0; 4]);
        }
    }

    /// Finds out how it is drawn, and brings its indices into that order.
    pub fn arrange(&mut self) {
        let (indices, layout) = Layout::of(self);
        self.indices = indices;
        self.layout = Some(layout);
    }

    /// Which parts may cast a shadow: all but a flat ground (or sea) below the middle of all else and more than four times
    /// as wide. Drawing it would spread a shadow map over kilometres where there is nothing to shade.
    pub fn casting(&self) -> Vec<bool> {
        let flat = |part: &Part| {
            let extent = part.bounds.extent();
            extent.y <= 1e-5 * extent.x.max(extent.z)
        };
        let solid = self.parts.iter().filter(|part| !flat(part));
        let solid = solid.fold(Bounds::EMPTY, |all, part| all.union(part.bounds));
        let extent = solid.extent();
        let is_ground = |part: &Part| {
            let wide = part.bounds.extent();
            flat(part)
                && wide.x.min(wide.z) > 4.0 * extent.x.max(extent.z)
                && part.bounds.max.y <= solid.centre().y
        };
        let casts = |part| solid.is_empty() || !is_ground(part);
        self.parts.iter().map(casts).collect()
    }

    /// Around all parts that may cast a shadow.
    pub fn casters(&self) -> Bounds {
        let parts = self.parts.iter().zip(self.casting());
        let casting = parts.filter(|(_, casts)| *casts);
        casting.fold(Bounds::EMPTY, |all, (part, _)| all.union(part.bounds))
    }

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
    /// Most triangles of a scene, instances counted. 64 million by default.
    pub max_triangles: usize,
    /// Whether a model may name libraries, pictures and buffers outside of its own folder tree. False by default: a
    /// downloaded model has no business with other files.
    pub allow_outside: bool,
    /// Folder for processed scenes: a large model starts quickly the second time. None by default.
    pub cache: Option<PathBuf>,
}

impl Default for LoadOptions {
    fn default() -> Self {
        Self {
            smooth_deg: None,
            max_texture_edge: 16_384,
            max_texture_bytes: 1 << 30,
            max_file_bytes: 1 << 32,
            max_triangles: 64 << 20,
            allow_outside: false,
            cache: None,
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
    /// The option tables of the scene file: options as on the command line, without dashes, `("turbidity", "3")`. The
    /// nameless `[camera]` is the last of them. For a model: its first camera, if it has any.
    pub options: Vec<NamedOptions>,
    /// The named cameras, in the order of the file.
    pub cameras: Vec<NamedCamera>,
    /// The named moments, in the order of the file.
    pub moments: Vec<NamedMoment>,
}

/// Reads a scene file (`.toml`) or a model (`.obj`, `.gltf`, `.glb`).
///
/// # Errors
/// One line that names the file, for whatever keeps the scene from being shown. A missing material library or texture is
/// a line in [`Scene::warnings`] instead.
pub fn load(path: &Path, options: &LoadOptions) -> Result<Loaded, SceneError> {
    load_telling(Some(path), options, &|_, _| ())
}

/// As [`load`], or a bundled scene by its name ([`BUNDLED`]) or, without a path, the first of them, telling how far it is. It needs
/// no device and may run on any thread, so that an event loop can go on meanwhile.
///
/// # Errors
/// As [`load`].
pub fn load_telling(
    path: Option<&Path>,
    options: &LoadOptions,
    progress: Progress<'_>,
) -> Result<Loaded, SceneError> {
    let disk = Files::disk(options.max_file_bytes);
    let name = match path.map(|path| (path, bundled_name(path))) {
        Some((path, None)) => return load_by_cache(disk, path, options, progress),
        Some((_, Some(name))) => name,
        None => BUNDLED[0],
    };
    bundled::load_bundled(name, options, progress)
}

/// From the cache if there is one, the model is large and its entry sound; else from the files, and into the cache.
fn load_by_cache(
    mut files: Files,
    path: &Path,
    options: &LoadOptions,
    progress: Progress<'_>,
) -> Result<Loaded, SceneError> {
    let large = std::fs::metadata(path).is_ok_and(|meta| meta.len() >= cache::SMALLEST);
    let Some(folder) = options.cache.as_deref().filter(|_| large) else {
        return load_from(&mut files, path, options, progress);
    };
    progress(0.0, "looking in the cache");
    let content = files.digest(path)?;
    let entry = cache::place(folder, path, content, options);
    if let Some(loaded) = cache::read(&entry, path) {
        progress(1.0, "loaded");
        return Ok(loaded);
    }
    files.start_record();
    let loaded = load_from(&mut files, path, options, progress)?;
    cache::write(&entry, &loaded, files.take_record());
    Ok(loaded)
}

/// Share of loading that comes before the layout.
const READING: f32 = 0.9;

fn load_from(
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
    let said = match extension.as_deref() {
        Some("toml") => scene_file::append_scene(&mut builder, path, options)?,
        _ => {
            let placement = Placement {
                world_from_mesh: Affine3A::IDENTITY,
                smooth_deg: options.smooth_deg,
            };
            let cameras = append_model(&mut builder, path, &placement)?;
            let first = cameras.first().map(|c| c.options.clone());
            SceneFileOptions {
                options: first.map(camera_table).into_iter().collect(),
                cameras,
                moments: Vec::new(),
            }
        }
    };
    builder.scene.fill_streams();
    *files = builder.files;
    progress(READING, "sorting");
    builder.scene.arrange();
    progress(1.0, "loaded");
    Ok(Loaded {
        path: path.to_owned(),
        scene: builder.scene,
        options: said.options,
        cameras: said.cameras,
        moments: said.moments,
    })
}

/// Adds a model of any known format; returns its cameras.
fn append_model(
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
        // A missing file or a directory is the better news than its extension.
        _ => match builder.files.probe(path) {
            Err(error @ (SceneError::Missing(_) | SceneError::Directory(_))) => Err(error),
            _ => unsupported(
                "is no scene file (.toml) and no model (.obj, .gltf, .glb); convert it".to_owned(),
            ),
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn part(min: [f32; 3], max: [f32; 3]) -> Part {
        Part {
            first_index: 0,
            index_count: 3,
            material: 0,
            has_colours: false,
            bounds: Bounds {
                min: min.into(),
                max: max.into(),
            },
        }
    }

    #[test]
    fn a_wide_ground_casts_nothing_but_a_roof_does() {
        let house = part([-5.0, 0.0, -5.0], [5.0, 6.0, 5.0]);
        let sea = part([-900.0, 0.1, -900.0], [900.0, 0.1, 900.0]);
        let lawn = part([-9.0, 0.0, -9.0], [9.0, 0.0, 9.0]);
        let sail = part([-900.0, 9.0, -900.0], [900.0, 9.0, 900.0]);
        let scene = |parts: &[Part]| Scene {
            parts: parts.to_vec(),
            ..Scene::default()
        };
        assert_eq!(scene(&[house, sea, lawn]).casting(), [true, false, true]);
        assert_eq!(scene(&[house, sail]).casting(), [true, true]);
        assert_eq!(scene(&[sea]).casting(), [true], "nothing else is there");
        assert_eq!(scene(&[house, sea]).casters().max, Vec3::new(5.0, 6.0, 5.0));
    }
}
