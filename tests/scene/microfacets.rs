//! Roughness and metalness of glTF materials, and materials of MTL, which have none.

use skylight::scene::{LoadOptions, Microfacet, load};

use crate::emission::with_material;

/// The surface of a material of glTF.
fn microfacet(material: &str) -> Microfacet {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = with_material(folder.path(), material);
    let material = &scene.materials[scene.parts[0].material as usize];
    material.microfacet.expect("a surface of microfacets")
}

#[test]
fn gltf_gives_roughness_and_metalness() {
    let plain = microfacet("{}");
    assert_eq!(
        (plain.metallic, plain.roughness, plain.f90),
        (1.0, 1.0, 1.0)
    );
    let paint = microfacet(
        r#"{"pbrMetallicRoughness": {"baseColorFactor": [0.1, 0.2, 0.3, 1], "metallicFactor": 0.25, "roughnessFactor": 0.5},
            "extensions": {"KHR_materials_ior": {"ior": 2}, "KHR_materials_specular": {"specularFactor": 0.5}}}"#,
    );
    assert_eq!(
        (paint.base, paint.metallic, paint.roughness),
        ([0.1, 0.2, 0.3], 0.25, 0.5)
    );
    assert!((paint.f0[1] - 0.5 / 9.0).abs() < 1e-6 && paint.f90 == 0.5);
}

#[test]
fn their_texture_is_kept() {
    let mapped = microfacet(
        r#"{"pbrMetallicRoughness": {"metallicFactor": 0.5, "metallicRoughnessTexture": {"index": 0}}}"#,
    );
    assert_eq!((mapped.metallic, mapped.roughness), (0.5, 1.0));
    assert_eq!(mapped.texture, Some(0));
    // Without its picture the factors are left.
    let lost = microfacet(
        r#"{"pbrMetallicRoughness": {"roughnessFactor": 0.5, "metallicRoughnessTexture": {"index": 7}}}"#,
    );
    assert_eq!(
        (lost.metallic, lost.roughness, lost.texture),
        (1.0, 0.5, None)
    );
}

#[test]
fn specular_glossiness_reflects_its_specular_colour() {
    let gold = microfacet(
        r#"{"extensions": {"KHR_materials_pbrSpecularGlossiness":
            {"diffuseFactor": [0, 0, 0, 1], "specularFactor": [1, 0.7, 0.3], "glossinessFactor": 0.75}}}"#,
    );
    assert_eq!(
        (gold.base, gold.f0, gold.roughness),
        ([0.0; 3], [1.0, 0.7, 0.3], 0.25)
    );
}

#[test]
fn what_is_unlit_does_not_reflect() {
    let flat = microfacet(r#"{"extensions": {"KHR_materials_unlit": {}}}"#);
    assert_eq!((flat.f0, flat.f90, flat.metallic), ([0.0; 3], 0.0, 0.0));
}

#[test]
fn materials_of_mtl_are_phongs() {
    let folder = tempfile::tempdir().expect("a folder");
    let write =
        |name: &str, text: &str| std::fs::write(folder.path().join(name), text).expect("a file");
    write("a.mtl", "newmtl steel\nKd 0.5 0.5 0.5\nPm 1\nPr 0.3\n");
    write(
        "a.obj",
        "mtllib a.mtl\nusemtl steel\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
    );
    let scene = load(&folder.path().join("a.obj"), &LoadOptions::default())
        .expect("a scene")
        .scene;
    assert!(scene.materials.iter().all(|m| m.microfacet.is_none()));
    assert!(scene.materials.iter().any(|m| m.specular[0] > 0.2));
}
