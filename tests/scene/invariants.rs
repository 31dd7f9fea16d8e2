//! Invariants of a scene that the renderer relies on.

use skylight::scene::Scene;

/// Checks all invariants.
pub fn assert_valid(name: &str, scene: &Scene) {
    assert_geometry(name, scene);
    assert_parts(name, scene);
    assert_materials(name, scene);
    let one_line = |w: &String| w.lines().count() == 1;
    let warnings = &scene.warnings;
    assert!(warnings.iter().all(one_line), "{name}: {warnings:?}");
}

/// Attributes of one length, all numbers finite, unit normals, indices in range.
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

/// Parts that cover all indices without gaps.
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

/// Reflectances within 0..1, textures in range and of their size.
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
