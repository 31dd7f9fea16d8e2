//! Models of known right results: each file is read as its reference is.

use std::path::Path;

use glam::{DVec3, Vec3};
use skylight::scene::{LoadOptions, Reflectances, Scene, Unit, Up, load};

/// File, reference, and how the file is to be read.
const SAME: [(&str, &str, Up, Option<Unit>); 34] = {
    const fn plain(
        file: &'static str,
        reference: &'static str,
    ) -> (&'static str, &'static str, Up, Option<Unit>) {
        (file, reference, Up::Y, None)
    }
    [
        plain(
            "models/01_webp_texture/blender_webp.gltf",
            "webp_with_fallback.gltf",
        ),
        plain(
            "models/01_webp_texture/webp_not_required.gltf",
            "webp_with_fallback.gltf",
        ),
        plain(
            "models/01_webp_texture/basisu_with_fallback.gltf",
            "webp_with_fallback.gltf",
        ),
        plain(
            "models/02_scene_without_nodes/blender_three_scenes.gltf",
            "reference.gltf",
        ),
        plain(
            "models/04_positions_without_min_max/no_bounds.glb",
            "reference.gltf",
        ),
        plain("models/05_gpu_instancing/trees.gltf", "reference.gltf"),
        plain(
            "models/05_gpu_instancing/trees_required.gltf",
            "reference.gltf",
        ),
        plain("models/06_specular_glossiness/house.gltf", "reference.gltf"),
        plain(
            "models/07_skin_under_scaled_armature/person_by_wall.gltf",
            "reference.gltf",
        ),
        plain(
            "models/08_morph_default_weights/shutter_mesh_weights.gltf",
            "reference.gltf",
        ),
        plain(
            "models/08_morph_default_weights/shutter_node_weights.gltf",
            "reference.gltf",
        ),
        plain(
            "models/11_georeferenced/stairs_utm.obj",
            "stairs_at_origin.obj",
        ),
        plain(
            "models/11_georeferenced/stairs_epsg3857.obj",
            "stairs_at_origin.obj",
        ),
        plain(
            "models/11_georeferenced/stairs_node_utm.gltf",
            "stairs_local.gltf",
        ),
        plain(
            "models/11_georeferenced/stairs_node_ecef.gltf",
            "stairs_local.gltf",
        ),
        plain(
            "models/11_georeferenced/house_whole_metres_utm.obj",
            "house_whole_metres_0.obj",
        ),
        plain("models/12_kd_black_with_texture/maya.obj", "reference.obj"),
        plain(
            "models/15_vertex_of_seven_numbers/three_posts_rgba.obj",
            "reference.obj",
        ),
        plain("models/16_case_of_file_names/house.obj", "reference.obj"),
        plain(
            "models/16_case_of_file_names/library_right.obj",
            "reference.obj",
        ),
        (
            "models/18_z_up_from_ifc/ifcconvert_house.obj",
            "reference.obj",
            Up::Z,
            None,
        ),
        plain(
            "models/26_one_face_with_a_missing_vertex/house.obj",
            "reference.obj",
        ),
        plain(
            "models/30_quantised_by_gltfpack/house_gltfpack.glb",
            "house_not_listed_as_required.glb",
        ),
        (
            "models/33_house_in_other_units/house_millimetres.obj",
            "house_metres.obj",
            Up::Y,
            Some(Unit::Mm),
        ),
        (
            "models/33_house_in_other_units/house_inches.obj",
            "house_metres.obj",
            Up::Y,
            Some(Unit::In),
        ),
        plain("daylight/14_far_from_origin/o1000.obj", "origin.obj"),
        plain("daylight/14_far_from_origin/o10000.obj", "origin.obj"),
        plain("daylight/14_far_from_origin/o100000.obj", "origin.obj"),
        plain("daylight/14_far_from_origin/o1000000.obj", "origin.obj"),
        plain("daylight/14_far_from_origin/far.obj", "origin.obj"),
        plain("daylight/14_far_from_origin/utm.obj", "origin.obj"),
        plain("daylight/14_far_from_origin/moved.toml", "origin.obj"),
        plain("daylight/14_far_from_origin/back.toml", "origin.obj"),
        plain("daylight/14_far_from_origin/node_utm.gltf", "node_0.gltf"),
    ]
};

fn read(path: &Path, up: Up, unit: Option<Unit>) -> Scene {
    let options = LoadOptions {
        up,
        unit,
        ..LoadOptions::default()
    };
    match load(path, &options) {
        Ok(loaded) => loaded.scene,
        Err(error) => panic!("{error}"),
    }
}

/// What a scene looks like, whatever the order of its triangles and wherever it lies: area, and moments of place and reflectance
/// over it, from the lower corner of its bounds.
fn moments(scene: &Scene) -> [DVec3; 5] {
    let means = Reflectances::new(scene);
    let mut sums = [DVec3::ZERO; 5];
    sums[0] = scene.bounds.extent().as_dvec3();
    for (number, triangle) in scene.indices.chunks_exact(3).enumerate() {
        let corner = |i: usize| Vec3::from(scene.positions[triangle[i] as usize]);
        let [a, b, c] = [0, 1, 2].map(|i| (corner(i) - scene.bounds.min).as_dvec3());
        let area = 0.5 * (b - a).cross(c - a);
        let at = (a + b + c) / 3.0;
        let diffuse = DVec3::from(means.of(number as u32).diffuse.map(f64::from));
        sums[1] += area.length() * at;
        sums[2] += area.length() * diffuse;
        sums[3] += area.length() * diffuse.x * at;
        sums[4] += area.dot(DVec3::ONE) * at * at;
    }
    sums
}

#[test]
fn files_are_read_as_their_references_are() {
    let Some(shared) = crate::common::shared() else {
        return;
    };
    let cases = shared.join("cases");
    let mut wrong = Vec::new();
    for (file, reference, up, unit) in SAME {
        let path = cases.join(file);
        let reference = path.with_file_name(reference);
        let found = moments(&read(&path, up, unit));
        let expected = moments(&read(&reference, Up::Y, None));
        let far = |(a, b): (DVec3, DVec3)| {
            let distance = (a - b).length();
            distance.is_nan() || distance > 3e-3 * b.length().max(1.0)
        };
        if found.into_iter().zip(expected).any(far) {
            wrong.push(format!("{file}: {found:?} instead of {expected:?}"));
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn what_is_not_drawn_is_told_of() {
    let Some(shared) = crate::common::shared() else {
        return;
    };
    for (file, part) in [
        (
            "models/01_webp_texture/basisu_only.gltf",
            "KHR_texture_basisu is not drawn",
        ),
        (
            "models/11_georeferenced/stairs_node_ecef.gltf",
            "geocentric (ECEF)",
        ),
        (
            "models/26_one_face_with_a_missing_vertex/house.obj",
            "line 43: \"178213\"",
        ),
        ("models/32_pictures_of_odd_kinds/all.obj", "old.dds"),
        (
            "models/33_house_in_other_units/house_millimetres.obj",
            "--unit",
        ),
        (
            "models/33_house_in_other_units/house_scale_model_1_to_500.obj",
            "--unit",
        ),
    ] {
        let scene = read(&shared.join("cases").join(file), Up::Y, None);
        let told = scene.warnings.iter().filter(|w| w.contains(part)).count();
        assert_eq!(told, 1, "{file}: {:?}", scene.warnings);
    }
    let house = read(
        &shared.join("cases/models/33_house_in_other_units/house_metres.obj"),
        Up::Y,
        None,
    );
    assert_eq!(house.warnings, [""; 0]);
}
