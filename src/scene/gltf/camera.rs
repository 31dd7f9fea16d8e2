//! Perspective cameras of glTF files.

use glam::{DAffine3, DVec3};

use crate::scene::gltf::item::Item;
use crate::scene::scene_file::NamedCamera;

/// The camera of a node. `None` if it is orthographic, which is not supported, or not valid.
pub fn read(
    root: Item<'_>,
    node: Item<'_>,
    world_from_node: DAffine3,
    others: &[NamedCamera],
) -> Option<NamedCamera> {
    let number = node.get("camera").index()?;
    let camera = root.get("cameras").at(number);
    let fov = camera.get("perspective").get("yfov").number()?.to_degrees();
    let eye = world_from_node.translation;
    let forward = world_from_node
        .transform_vector3(DVec3::NEG_Z)
        .try_normalize()?;
    if !(1.0..=170.0).contains(&fov) || !eye.is_finite() {
        return None;
    }
    let given = node.get("name").text().or(camera.get("name").text());
    let name = given.map_or_else(|| format!("camera {number}"), str::to_owned);
    let taken = others.iter().any(|c| c.name == name);
    let name = if taken {
        format!("{name} {}", others.len())
    } else {
        name
    };
    // Digits beyond those of the positions would be noise.
    let point = |p: DVec3| {
        p.to_array()
            .map(|v| ((v * 1e6).round() / 1e6).to_string())
            .join(",")
    };
    Some(NamedCamera {
        name,
        options: vec![
            ("eye".to_owned(), point(eye)),
            ("target".to_owned(), point(eye + forward)),
            ("fov".to_owned(), (fov as f32).to_string()),
        ],
    })
}
