//! Emission of glTF materials: factor, strength and texture, and values that make no sense.

use std::path::Path;

use skylight::scene::{LoadOptions, MAX_EMISSION, Scene, load};

/// A picture of one pixel: BMP, 24 bits.
const LAMP: &[u8] = &[
    b'B', b'M', 58, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0,
    24, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 10, 20, 30, 0,
];

/// Loads a triangle with texture coordinates and a material.
pub fn with_material(folder: &Path, material: &str) -> Scene {
    let corners = [0f32, 0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0., 0., 1.];
    let bytes: Vec<u8> = corners.iter().flat_map(|v| v.to_le_bytes()).collect();
    let gltf = format!(
        r#"{{"asset": {{"version": "2.0"}}, "extensionsUsed": ["KHR_materials_emissive_strength"],
        "nodes": [{{"mesh": 0}}], "buffers": [{{"uri": "a.bin", "byteLength": 60}}],
        "bufferViews": [{{"buffer": 0, "byteLength": 36}}, {{"buffer": 0, "byteOffset": 36, "byteLength": 24}}],
        "accessors": [
            {{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}},
            {{"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2"}}],
        "images": [{{"uri": "lamp.bmp"}}], "textures": [{{"source": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": 0, "TEXCOORD_0": 1}}, "material": 0}}]}}],
        "materials": [{material}]}}"#
    );
    std::fs::write(folder.join("a.bin"), bytes).expect("a buffer");
    std::fs::write(folder.join("lamp.bmp"), LAMP).expect("a picture");
    std::fs::write(folder.join("a.gltf"), gltf).expect("a model");
    load(&folder.join("a.gltf"), &LoadOptions::default())
        .expect("a scene")
        .scene
}

#[test]
fn emission_of_gltf_is_factor_times_strength_times_texture() {
    let folder = tempfile::tempdir().expect("a folder");
    let strength = |s: &str| {
        format!(
            r#""extensions": {{"KHR_materials_emissive_strength": {{"emissiveStrength": {s}}}}}"#
        )
    };
    let texture = r#""emissiveTexture": {"index": 0}"#;
    let factor = |f: &str| format!(r#""emissiveFactor": {f}"#);
    for (fields, emission, is_mapped, warnings) in [
        (vec![], [0.0; 3], false, 0),
        // A factor of black: the texture is not even read.
        (vec![texture.to_owned()], [0.0; 3], false, 0),
        (vec![factor("[1, 0.6, 0.1]")], [1.0, 0.6, 0.1], false, 0),
        (
            vec![
                factor("[1, 0.5, 0.25]"),
                strength("5000"),
                texture.to_owned(),
            ],
            [5000.0, 2500.0, 1250.0],
            true,
            0,
        ),
        (vec![factor("[1, 1, -1]")], [1.0, 1.0, 0.0], false, 1),
        (
            vec![factor("[1, 1, 0]"), strength("-3")],
            [0.0; 3],
            false,
            1,
        ),
        (
            vec![factor("[1, 0, 0]"), strength("1e30")],
            [MAX_EMISSION, 0.0, 0.0],
            false,
            1,
        ),
    ] {
        let scene = with_material(folder.path(), &format!("{{{}}}", fields.join(", ")));
        let material = &scene.materials[scene.parts[0].material as usize];
        println!("{fields:?}: {:?} {:?}", material.emission, scene.warnings);
        assert_eq!(material.emission, emission, "{fields:?}");
        assert_eq!(material.emissive_texture.is_some(), is_mapped, "{fields:?}");
        assert_eq!(scene.warnings.len(), warnings, "{:?}", scene.warnings);
    }
}
