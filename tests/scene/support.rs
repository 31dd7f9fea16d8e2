//! Shared helpers: finding files, writing GLB, checking a scene.

use std::path::{Path, PathBuf};

use skylight::scene::Scene;

/// All files below a folder with one of these extensions (any case), sorted.
pub fn files_below(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let entries = std::fs::read_dir(folder).expect("a readable folder");
    for path in entries.map(|entry| entry.expect("an entry").path()) {
        let is_wanted = |e: &std::ffi::OsStr| extensions.iter().any(|x| e.eq_ignore_ascii_case(x));
        if path.is_dir() {
            found.extend(files_below(&path, extensions));
        } else if path.extension().is_some_and(is_wanted) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// A GLB file with a JSON chunk and a binary chunk.
pub fn glb(json: &[u8], binary: &[u8]) -> Vec<u8> {
    let pad = |bytes: &[u8], with: u8| {
        let mut padded = bytes.to_vec();
        padded.resize(bytes.len().next_multiple_of(4), with);
        padded
    };
    let (json, binary) = (pad(json, b' '), pad(binary, 0));
    let total = (28 + json.len() + binary.len()) as u32;
    let mut file = [*b"glTF", 2u32.to_le_bytes(), total.to_le_bytes()].concat();
    for (kind, bytes) in [(b"JSON", &json), (b"BIN\0", &binary)] {
        file.extend((bytes.len() as u32).to_le_bytes());
        file.extend(kind);
        file.extend(bytes);
    }
    file
}

/// Checks the invariants that the renderer relies on.
pub fn assert_valid(name: &str, scene: &Scene) {
    assert_geometry(name, scene);
    assert_parts(name, scene);
    assert_materials(name, scene);
    let one_line = |w: &String| w.lines().count() == 1;
    let warnings = &scene.warnings;
    assert!(warnings.iter().all(one_line), "{name}: {warnings:?}");
}

/// Attributes have equal lengths, all numbers are finite, normals are unit vectors, indices are in range.
fn assert_geometry(name: &str, scene: &Scene) {
    let vertices = scene.positions.len();
    let required = [scene.normals.len(), scene.texcoords.len()];
    assert_eq!(required, [vertices; 2], "{name}");
    let optional = [scene.colours.len(), scene.tangents.len()];
    let fits = |n: &usize| [0, vertices].contains(n);
    assert!(optional.iter().all(fits), "{name}: {optional:?}");
    let vectors = scene.positions.iter().chain(&scene.normals).flatten();
    let mut numbers = vectors.chain(scene.texcoords.iter().flatten());
    assert!(numbers.all(|v| v.is_finite()), "{name}: finite numbers");
    let unit = |n: &[f32; 3]| (n.iter().map(|v| v * v).sum::<f32>() - 1.0).abs() < 1e-3;
    assert!(scene.normals.iter().all(unit), "{name}: unit normals");
    assert!(scene.triangles() > 0, "{name}");
    assert!(scene.indices.len().is_multiple_of(3), "{name}");
    let in_range = |i: &u32| (*i as usize) < vertices;
    assert!(scene.indices.iter().all(in_range), "{name}");
}

/// Parts cover all indices without gaps.
fn assert_parts(name: &str, scene: &Scene) {
    let mut next = 0;
    for part in &scene.parts {
        assert_eq!(part.first_index, next, "{name}: parts are contiguous");
        assert!(part.index_count > 0, "{name}");
        assert!((part.material as usize) < scene.materials.len(), "{name}");
        next += part.index_count;
    }
    assert_eq!(
        next as usize,
        scene.indices.len(),
        "{name}: parts cover all"
    );
}

/// Reflectances are within 0..1, texture indices are in range, textures match their size.
fn assert_materials(name: &str, scene: &Scene) {
    for material in &scene.materials {
        let maps = [
            material.diffuse_texture,
            material.specular_texture,
            material.normal_texture,
        ];
        let in_range = |i: &usize| *i < scene.textures.len();
        assert!(maps.iter().flatten().all(in_range), "{name}");
        let unit = |v: &f32| (0.0..=1.0).contains(v);
        let mut reflectances = material.diffuse.iter().chain(&material.specular);
        assert!(reflectances.all(unit), "{name}: {material:?}");
    }
    for texture in &scene.textures {
        let bytes = 4 * (texture.width * texture.height) as usize;
        assert_eq!(texture.rgba8.len(), bytes, "{name}: {}", texture.name);
    }
}
