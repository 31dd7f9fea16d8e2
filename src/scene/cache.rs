//! Processed scenes on disk, so that a large model starts quickly the second time.
//!
//! An entry is found by the content of the model, its path and the options; it names every other file that was read, with
//! its content, and ends with a checksum. Whatever does not agree is not trusted: the model is read again and the entry
//! written anew.

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::bounds::Bounds;
use super::files::{Digest, ReadFile, digest};
use super::material::Material;
use super::scene_file::NamedOptions;
use super::texture::{Encoding, Texture};
use super::{LoadOptions, Loaded, Part, Scene};

/// Changes with the form of entries and with what reading a model makes of it.
const VERSION: u32 = 1;
/// Models below this size are read as fast as an entry, bytes.
pub(super) const SMALLEST: u64 = 4 << 20;
/// Most that all entries together may take, bytes; the oldest go first.
const MOST: u64 = 4 << 30;

/// What an entry says before its arrays.
#[derive(Serialize, Deserialize)]
struct Head {
    version: u32,
    files: Vec<ReadFile>,
    parts: Vec<Part>,
    materials: Vec<Material>,
    textures: Vec<Picture>,
    bounds: Bounds,
    warnings: Vec<String>,
    options: Vec<(String, String)>,
    cameras: Vec<NamedOptions>,
    moments: Vec<NamedOptions>,
    /// Bytes of positions, normals, texture coordinates, colours, tangents and indices.
    lengths: [usize; 6],
}

#[derive(Serialize, Deserialize)]
struct Picture {
    name: String,
    width: u32,
    height: u32,
    encoding: Encoding,
}

/// Where the entry of a model is.
pub(super) fn place(folder: &Path, path: &Path, model: Digest, options: &LoadOptions) -> PathBuf {
    let asked = LoadOptions {
        cache: None,
        ..options.clone()
    };
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let key = format!("{VERSION} {model:?} {path:?} {asked:?}");
    let name: String = digest(key.as_bytes())[..16]
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    folder.join(format!("{name}.scene"))
}

/// The scene of an entry; none if there is no entry, if it is damaged or if a file that it depends on has changed.
pub(super) fn read(entry: &Path, path: &Path) -> Option<Loaded> {
    let bytes = fs::read(entry).ok()?;
    let (body, checksum) = bytes.split_last_chunk::<32>()?;
    if digest(body) != *checksum {
        return None;
    }
    let (length, rest) = body.split_first_chunk::<8>()?;
    let (head, arrays) =
        rest.split_at_checked(usize::try_from(u64::from_le_bytes(*length)).ok()?)?;
    let head: Head = serde_json::from_slice(head).ok()?;
    let fresh = head.version == VERSION && head.files.iter().all(ReadFile::is_unchanged);
    fresh.then(|| head.loaded(arrays, path)).flatten()
}

/// Writes an entry, whole or not at all. A cache that cannot be written is no reason to stop.
pub(super) fn write(entry: &Path, loaded: &Loaded, mut files: Vec<ReadFile>) -> Option<()> {
    // The place of the entry tells the model itself.
    files.retain(|file| file.path != loaded.path);
    let folder = entry.parent()?;
    fs::create_dir_all(folder).ok()?;
    make_room(folder);
    let head = serde_json::to_vec(&Head::of(loaded, files)).ok()?;
    let scene = &loaded.scene;
    let mut file = tempfile::NamedTempFile::new_in(folder).ok()?;
    let mut hasher = blake3::Hasher::new();
    let length = (head.len() as u64).to_le_bytes();
    let start = [&length[..], &head];
    let arrays = arrays(scene);
    let textures = scene.textures.iter().map(|t| t.rgba8.as_slice());
    for bytes in start.into_iter().chain(arrays).chain(textures) {
        hasher.update(bytes);
        file.write_all(bytes).ok()?;
    }
    file.write_all(hasher.finalize().as_bytes()).ok()?;
    file.persist(entry).ok()?;
    Some(())
}

fn arrays(scene: &Scene) -> [&[u8]; 6] {
    [
        bytemuck::cast_slice(&scene.positions),
        bytemuck::cast_slice(&scene.normals),
        bytemuck::cast_slice(&scene.texcoords),
        bytemuck::cast_slice(&scene.colours),
        bytemuck::cast_slice(&scene.tangents),
        bytemuck::cast_slice(&scene.indices),
    ]
}

/// Removes the oldest entries while all together take more than [`MOST`].
fn make_room(folder: &Path) {
    let Ok(entries) = fs::read_dir(folder) else {
        return;
    };
    let mut entries: Vec<_> = entries
        .flatten()
        .filter(|entry| entry.path().extension().is_some_and(|e| e == "scene"))
        .filter_map(|entry| {
            let meta = entry.metadata().ok()?;
            Some((meta.modified().ok()?, meta.len(), entry.path()))
        })
        .collect();
    entries.sort();
    let mut all: u64 = entries.iter().map(|(_, bytes, _)| bytes).sum();
    for (_, bytes, path) in entries {
        if all <= MOST {
            break;
        }
        // One that another process removed is gone as well.
        let _ = fs::remove_file(path);
        all -= bytes;
    }
}

impl Head {
    fn of(loaded: &Loaded, files: Vec<ReadFile>) -> Self {
        let scene = &loaded.scene;
        let picture = |t: &Texture| Picture {
            name: t.name.clone(),
            width: t.width,
            height: t.height,
            encoding: t.encoding,
        };
        Self {
            version: VERSION,
            files,
            parts: scene.parts.clone(),
            materials: scene.materials.clone(),
            textures: scene.textures.iter().map(picture).collect(),
            bounds: scene.bounds,
            warnings: scene.warnings.clone(),
            options: loaded.options.clone(),
            cameras: loaded.cameras.clone(),
            moments: loaded.moments.clone(),
            lengths: arrays(scene).map(<[u8]>::len),
        }
    }

    fn loaded(self, mut bytes: &[u8], path: &Path) -> Option<Loaded> {
        let lengths = self.lengths;
        let mut take = |length: usize| {
            let (taken, rest) = bytes.split_at_checked(length)?;
            bytes = rest;
            Some(taken)
        };
        let scene = Scene {
            positions: numbers(take(lengths[0])?)?,
            normals: numbers(take(lengths[1])?)?,
            texcoords: numbers(take(lengths[2])?)?,
            colours: numbers(take(lengths[3])?)?,
            tangents: numbers(take(lengths[4])?)?,
            indices: numbers(take(lengths[5])?)?,
            textures: self
                .textures
                .into_iter()
                .map(|picture| {
                    let size = 4 * u64::from(picture.width) * u64::from(picture.height);
                    Some(Texture {
                        rgba8: take(usize::try_from(size).ok()?)?.to_vec(),
                        name: picture.name,
                        width: picture.width,
                        height: picture.height,
                        encoding: picture.encoding,
                    })
                })
                .collect::<Option<_>>()?,
            parts: self.parts,
            materials: self.materials,
            bounds: self.bounds,
            warnings: self.warnings,
        };
        is_sound(&scene).then(|| Loaded {
            path: path.to_owned(),
            scene,
            options: self.options,
            cameras: self.cameras,
            moments: self.moments,
        })
    }
}

/// Entries need not be aligned in the file.
fn numbers<T: bytemuck::Pod>(bytes: &[u8]) -> Option<Vec<T>> {
    let count = bytes.len() / size_of::<T>();
    if count * size_of::<T>() != bytes.len() {
        return None;
    }
    let mut values = vec![T::zeroed(); count];
    bytemuck::cast_slice_mut(&mut values).copy_from_slice(bytes);
    Some(values)
}

/// What the renderer relies on: numbers in range, streams of one length.
fn is_sound(scene: &Scene) -> bool {
    let vertices = scene.positions.len();
    let whole = |n: usize| n == vertices;
    let streams = whole(scene.normals.len()) && whole(scene.texcoords.len());
    let optional = [scene.colours.len(), scene.tangents.len()];
    let in_range = |i: &u32| (*i as usize) < vertices;
    let part = |p: &Part| {
        let end = u64::from(p.first_index) + u64::from(p.index_count);
        end <= scene.indices.len() as u64 && (p.material as usize) < scene.materials.len()
    };
    let material = |m: &Material| {
        let maps = [m.diffuse_texture, m.specular_texture, m.normal_texture];
        maps.iter().flatten().all(|i| *i < scene.textures.len())
    };
    streams
        && optional.iter().all(|n| *n == 0 || whole(*n))
        && scene.indices.iter().all(in_range)
        && scene.parts.iter().all(part)
        && scene.materials.iter().all(material)
}
