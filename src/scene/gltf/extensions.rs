//! Which extensions are drawn, which change no picture, and which are told of because they are not drawn.

use std::collections::BTreeMap;

use crate::scene::gltf::item::Item;

/// Drawn, or told of where they are used with what became of the part.
const HANDLED: [&str; 20] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_avif",
    "EXT_texture_webp",
    "KHR_draco_mesh_compression",
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_visibility",
    "KHR_texture_basisu",
    "KHR_texture_transform",
    "MSFT_texture_dds",
    // The material that a primitive names is one of its variants.
    "KHR_materials_variants",
    // The node itself is the finest level.
    "MSFT_lod",
];

/// Beginnings of the names of extensions that change no still picture: metadata, sound, physics, behaviour, hints.
const INVISIBLE: [&str; 25] = [
    "ADOBE_",
    "AGI_",
    "CESIUM_primitive_outline",
    "EXT_feature_metadata",
    "EXT_instance_features",
    "EXT_mesh_features",
    "EXT_mesh_manifold",
    "EXT_structural_metadata",
    "FB_geometry_metadata",
    "GRIFFEL_bim_data",
    "KHR_accessor_float64",
    "KHR_animation",
    "KHR_audio",
    "KHR_interactivity",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_physics",
    "KHR_xmp",
    "MSFT_packing",
    "MSFT_physics",
    "MSFT_screencoverage",
    "MX_",
    "OMI_",
    "VRM",
    "VRMC_",
];

/// Extensions of materials that are not drawn: name, the property that is zero where they do nothing, and what is drawn instead.
const MATERIALS: [(&str, &str, &str); 8] = [
    (
        "KHR_materials_volume",
        "thicknessFactor",
        "its bodies are drawn as panes of glass",
    ),
    (
        "KHR_materials_diffuse_transmission",
        "diffuseTransmissionFactor",
        "no light comes through its surfaces",
    ),
    (
        "KHR_materials_clearcoat",
        "clearcoatFactor",
        "drawn without the coat",
    ),
    (
        "KHR_materials_sheen",
        "sheenColorFactor",
        "drawn without the sheen",
    ),
    (
        "KHR_materials_iridescence",
        "iridescenceFactor",
        "drawn in one colour",
    ),
    (
        "KHR_materials_anisotropy",
        "anisotropyStrength",
        "highlights are the same in all directions",
    ),
    ("KHR_materials_dispersion", "dispersion", "drawn without it"),
    (
        "KHR_materials_volume_scatter",
        "multiscatterColor",
        "drawn without it",
    ),
];

/// The extensions that are told of, each with what is drawn instead.
#[derive(Debug, Default)]
pub struct Told(BTreeMap<String, &'static str>);

impl Told {
    /// The extensions without which a file asks not to be drawn; it is drawn all the same.
    pub fn of_file(root: Item<'_>) -> Self {
        let mut told = Self::default();
        for name in root
            .get("extensionsRequired")
            .items()
            .filter_map(Item::text)
        {
            told.see_name(name);
        }
        told
    }

    /// Looks at the extensions of a part that is drawn.
    pub fn see(&mut self, part: Item<'_>) {
        for name in part.extensions() {
            let material = MATERIALS.iter().find(|(own, ..)| *own == name);
            match material {
                Some((_, key, instead)) if has_effect(part.extension(name).get(key)) => {
                    self.tell(name, instead);
                }
                Some(_) => {}
                None => self.see_name(name),
            }
        }
    }

    fn see_name(&mut self, name: &str) {
        let is_known = HANDLED.contains(&name) || MATERIALS.iter().any(|(own, ..)| *own == name);
        if !is_known && !INVISIBLE.iter().any(|start| name.starts_with(start)) {
            self.tell(name, "unknown here; drawn without it");
        }
    }

    /// Tells of an extension, once.
    pub fn tell(&mut self, name: &str, instead: &'static str) {
        if !self.0.contains_key(name) {
            self.0.insert(name.to_owned(), instead);
        }
    }

    /// A line for each extension.
    pub fn lines(&self) -> impl Iterator<Item = String> {
        self.0.iter().map(|(name, instead)| {
            let name = crate::scene::losses::shortened(name, 60);
            format!("{name} is not drawn: {instead}")
        })
    }
}

/// Whether a factor of an extension is not zero.
fn has_effect(factor: Item<'_>) -> bool {
    let is_set = |item: Item<'_>| item.number().is_some_and(|v| v != 0.0);
    is_set(factor) || factor.items().any(is_set)
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn only_what_changes_the_picture_is_told_of_once() {
        let file =
            json!({"extensionsRequired": ["KHR_mesh_quantization", "ACME_fur", "KHR_xmp_json_ld"]});
        let mut told = Told::of_file(Item::of(&file));
        let glass = json!({"extensions": {
            "KHR_materials_transmission": {"transmissionFactor": 0.9},
            "KHR_materials_volume": {"thicknessFactor": 0.2},
            "KHR_materials_clearcoat": {"clearcoatFactor": 0},
            "KHR_materials_sheen": {"sheenColorFactor": [0, 0, 0.1]},
            "KHR_materials_ior": {"ior": 1.4}, "ACME_fur": {}}});
        told.see(Item::of(&glass));
        told.see(Item::of(&glass));
        let lines: Vec<String> = told.lines().collect();
        let names: Vec<&str> = lines
            .iter()
            .filter_map(|line| line.split(' ').next())
            .collect();
        assert_eq!(
            names,
            ["ACME_fur", "KHR_materials_sheen", "KHR_materials_volume"]
        );
    }
}
