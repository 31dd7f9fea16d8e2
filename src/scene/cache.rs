//! A disk cache of processed scenes, which makes a large model load faster the second time.
//!
//! An entry is keyed by the content of the model, its path and the options. It lists every other file that was read, with the
//! hash of its content, and ends with a checksum. If anything does not match, the model is loaded again and the entry is
//! replaced.

use std::fs;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::scene::bounds::Bounds;
use crate::scene::bvh::FlatBvh;
use crate::scene::culling::layout::{FlatLayout, clusters, ranges};
use crate::scene::files::{Digest, ReadFile, digest};
use crate::scene::material::Material;
use crate::scene::scene_file::NamedOptions;
use crate::scene::texture::{Encoding, Texture, Wrap};
use crate::scene::{Bvh, Layout, LoadOptions, Loaded, Node, Part, Scene};

/// Version of the entry format and of the result of loading a model.
const VERSION: u32 = 8;
/// Minimum size of a cached model, bytes. Smaller models load as fast as a cache entry.
pub(super) const MIN_MODEL_BYTES: u64 = 4 << 20;
/// Limit on the total size of all entries, bytes.
const MAX_BYTES: u64 = 4 << 30;

/// Number of arrays in an entry, not counting textures.
const ARRAYS: usize = 10;

/// Header of an entry, followed by its arrays.
#[derive(Serialize, Deserialize)]
struct Head {
    version: u32,
    files: Vec<ReadFile>,
    parts: Vec<Part>,
    materials: Vec<Material>,
    textures: Vec<Picture>,
    bounds: Bounds,
    origin: DVec3,
    warnings: Vec<String>,
    options: Vec<NamedOptions>,
    cameras: Vec<NamedOptions>,
    moments: Vec<NamedOptions>,
    /// Lengths of the arrays: positions, normals, texture coordinates, colours, tangents, indices, then clusters and parts
    /// of the layout, nodes and triangles of the hierarchy.
    lengths: [usize; ARRAYS],
}

#[derive(Serialize, Deserialize)]
struct Picture {
    name: String,
    width: u32,
    height: u32,
    encoding: Encoding,
    wrap: [Wrap; 2],
}

/// Path of the entry of a model.
pub(super) fn entry_path(
    folder: &Path,
    path: &Path,
    model: Digest,
    options: &LoadOptions,
) -> PathBuf {
    let options = LoadOptions {
        cache: None,
        ..options.clone()
    };
    let path = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let key = format!("{VERSION} {model:?} {path:?} {options:?}");
    let name: String = digest(key.as_bytes())[..16]
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    folder.join(format!("{name}.scene"))
}

/// Reads an entry. `None` if it does not exist, is corrupt, or depends on a file that has changed.
pub(super) fn read(entry: &Path, path: &Path) -> Option<Loaded> {
    let mut entry = Entry::open(entry)?;
    let [length] = entry.numbers::<u64>(1)?[..] else {
        return None;
    };
    let head = entry.numbers::<u8>(usize::try_from(length).ok()?)?;
    let head: Head = serde_json::from_slice(&head).ok()?;
    if head.version != VERSION {
        return None;
    }
    let (mut scene, nodes, order) = head.scene(&mut entry)?;
    let agrees = entry.checksum_agrees() && head.files.iter().all(ReadFile::is_unchanged);
    if !agrees || !is_valid(&scene) {
        return None;
    }
    scene.bvh = Some(Bvh::from_stored(nodes, &order, &scene)?);
    Some(Loaded {
        path: path.to_owned(),
        scene,
        options: head.options,
        cameras: head.cameras,
        moments: head.moments,
    })
}

/// An entry being read. Its contents must not be used before [`Entry::checksum_agrees`].
struct Entry {
    file: fs::File,
    /// Bytes left before the checksum.
    left: u64,
    hasher: blake3::Hasher,
}

impl Entry {
    /// Chunk size for reading and hashing, bytes: fits into the cache of a core.
    const STEP: usize = 1 << 18;

    fn open(path: &Path) -> Option<Self> {
        let file = fs::File::open(path).ok()?;
        let length = file.metadata().ok()?.len();
        Some(Self {
            file,
            left: length.checked_sub(blake3::OUT_LEN as u64)?,
            hasher: blake3::Hasher::new(),
        })
    }

    /// Reads the next `count` numbers.
    fn numbers<T: bytemuck::Pod>(&mut self, count: usize) -> Option<Vec<T>> {
        let bytes = count.checked_mul(size_of::<T>())?;
        // Checked before allocating: a corrupt entry may claim any length.
        self.left = self.left.checked_sub(bytes as u64)?;
        let mut values = vec![T::zeroed(); count];
        for step in bytemuck::cast_slice_mut(&mut values).chunks_mut(Self::STEP) {
            self.file.read_exact(step).ok()?;
            self.hasher.update(step);
        }
        Some(values)
    }

    /// Whether all bytes have been read and the checksum matches.
    fn checksum_agrees(&mut self) -> bool {
        let mut checksum = Digest::default();
        let read = self.file.read_exact(&mut checksum);
        self.left == 0 && read.is_ok() && self.hasher.finalize() == checksum
    }
}

/// Writes an entry atomically.
///
/// # Errors
/// When the folder is not writable.
pub(super) fn write(entry: &Path, loaded: &Loaded, mut files: Vec<ReadFile>) -> io::Result<()> {
    let scene = &loaded.scene;
    let (Some(folder), Some(layout), Some(bvh)) = (entry.parent(), &scene.layout, &scene.bvh)
    else {
        return Ok(());
    };
    // The model itself is already covered by the key.
    files.retain(|file| file.path != loaded.path);
    fs::create_dir_all(folder)?;
    remove_oldest(folder);
    let (layout, bvh) = (FlatLayout::of(layout), FlatBvh::of(bvh));
    let arrays = arrays(scene, &layout, &bvh);
    let lengths = arrays.map(|(_, count)| count);
    let head = serde_json::to_vec(&Head::of(loaded, files, lengths))?;
    let mut file = tempfile::NamedTempFile::new_in(folder)?;
    let mut hasher = blake3::Hasher::new();
    let length = (head.len() as u64).to_le_bytes();
    let start = [&length[..], &head];
    let arrays = arrays.map(|(bytes, _)| bytes);
    let textures = scene.textures.iter().map(|t| t.rgba8.as_slice());
    for bytes in start.into_iter().chain(arrays).chain(textures) {
        hasher.update(bytes);
        file.write_all(bytes)?;
    }
    file.write_all(hasher.finalize().as_bytes())?;
    file.persist(entry)?;
    Ok(())
}

/// The bytes and the element count of each array.
fn arrays<'s>(
    scene: &'s Scene,
    layout: &'s FlatLayout,
    bvh: &'s FlatBvh<'s>,
) -> [(&'s [u8], usize); ARRAYS] {
    fn array<T: bytemuck::Pod>(values: &[T]) -> (&[u8], usize) {
        (bytemuck::cast_slice(values), values.len())
    }
    [
        array(&scene.positions),
        array(&scene.normals),
        array(&scene.texcoords),
        array(&scene.colours),
        array(&scene.tangents),
        array(&scene.indices),
        array(&layout.clusters),
        array(&layout.of_part),
        array(bvh.nodes),
        array(&bvh.order),
    ]
}

/// Removes the oldest entries until the total size is within [`MAX_BYTES`].
fn remove_oldest(folder: &Path) {
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
        if all <= MAX_BYTES {
            break;
        }
        // Another process may already have removed it.
        let _ = fs::remove_file(path);
        all -= bytes;
    }
}

impl Head {
    fn of(loaded: &Loaded, files: Vec<ReadFile>, lengths: [usize; ARRAYS]) -> Self {
        let scene = &loaded.scene;
        let picture = |t: &Texture| Picture {
            name: t.name.clone(),
            width: t.width,
            height: t.height,
            encoding: t.encoding,
            wrap: t.wrap,
        };
        Self {
            version: VERSION,
            files,
            parts: scene.parts.clone(),
            materials: scene.materials.clone(),
            textures: scene.textures.iter().map(picture).collect(),
            bounds: scene.bounds,
            origin: scene.origin,
            warnings: scene.warnings.clone(),
            options: loaded.options.clone(),
            cameras: loaded.cameras.clone(),
            moments: loaded.moments.clone(),
            lengths,
        }
    }

    /// Reads the arrays: a scene, and the nodes and triangles of its hierarchy.
    fn scene(&self, entry: &mut Entry) -> Option<(Scene, Vec<Node>, Vec<u32>)> {
        let lengths = self.lengths;
        let mut scene = Scene {
            positions: entry.numbers(lengths[0])?,
            normals: entry.numbers(lengths[1])?,
            texcoords: entry.numbers(lengths[2])?,
            colours: entry.numbers(lengths[3])?,
            tangents: entry.numbers(lengths[4])?,
            indices: entry.numbers(lengths[5])?,
            layout: Some(Layout {
                clusters: clusters(&entry.numbers(lengths[6])?),
                of_part: ranges(&entry.numbers(lengths[7])?),
            }),
            parts: self.parts.clone(),
            materials: self.materials.clone(),
            bounds: self.bounds,
            origin: self.origin,
            warnings: self.warnings.clone(),
            ..Scene::default()
        };
        let (nodes, order) = (entry.numbers(lengths[8])?, entry.numbers(lengths[9])?);
        let textures = self.textures.iter().map(|picture| picture.read(entry));
        scene.textures = textures.collect::<Option<_>>()?;
        Some((scene, nodes, order))
    }
}

impl Picture {
    fn read(&self, entry: &mut Entry) -> Option<Texture> {
        let size = 4 * u64::from(self.width) * u64::from(self.height);
        Some(Texture {
            rgba8: entry.numbers(usize::try_from(size).ok()?)?,
            name: self.name.clone(),
            width: self.width,
            height: self.height,
            encoding: self.encoding,
            wrap: self.wrap,
        })
    }
}

/// Whether the invariants of a scene hold: indices in range, attributes of the same length.
fn is_valid(scene: &Scene) -> bool {
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
        let maps = m.textures();
        maps.iter().flatten().all(|i| *i < scene.textures.len())
    };
    streams
        && optional.iter().all(|n| *n == 0 || whole(*n))
        && scene.indices.iter().all(in_range)
        && scene.parts.iter().all(part)
        && scene.materials.iter().all(material)
        && scene.layout.as_ref().is_some_and(|l| l.fits(scene))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::hills;

    #[test]
    fn an_entry_with_the_hierarchy_of_another_scene_is_refused() {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let entry = folder.path().join("hills.scene");
        let mut scene = hills(300);
        scene.arrange();
        let mut loaded = Loaded {
            path: PathBuf::from("hills.obj"),
            scene,
            options: Vec::new(),
            cameras: Vec::new(),
            moments: Vec::new(),
        };
        for (other, is_own) in [(hills(500), false), (loaded.scene.clone(), true)] {
            loaded.scene.bvh = Some(other.hierarchy().into_owned());
            write(&entry, &loaded, Vec::new()).expect("an entry");
            let again = read(&entry, &loaded.path);
            assert_eq!(again, is_own.then(|| loaded.clone()));
        }
    }
}
