//! A number that tells one scene from another.

use super::Scene;

impl Scene {
    /// Hash of everything that light depends on, as hexadecimal digits: shapes, materials and pictures. Scenes that differ have different
    /// ones, and the same model has the same one on every machine with this byte order.
    pub fn digest(&self) -> String {
        let mut hasher = blake3::Hasher::new();
        let mut add = |bytes: &[u8]| {
            hasher.update(&(bytes.len() as u64).to_le_bytes());
            hasher.update(bytes);
        };
        add(bytemuck::cast_slice(&self.origin.to_array()));
        add(bytemuck::cast_slice(&self.positions));
        add(bytemuck::cast_slice(&self.normals));
        add(bytemuck::cast_slice(&self.texcoords));
        add(bytemuck::cast_slice(&self.colours));
        add(bytemuck::cast_slice(&self.tangents));
        add(bytemuck::cast_slice(&self.indices));
        for part in &self.parts {
            add(format!("{part:?}").as_bytes());
        }
        for material in &self.materials {
            add(format!("{material:?}").as_bytes());
        }
        for texture in &self.textures {
            let (size, how) = (
                [texture.width, texture.height],
                (texture.encoding, texture.wrap),
            );
            add(format!("{size:?} {how:?}").as_bytes());
            add(&texture.rgba8);
        }
        hasher.finalize().to_hex().to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Material;

    #[test]
    fn scenes_that_differ_have_different_digests() {
        let scene = Scene {
            positions: vec![[0.0; 3]; 2],
            materials: vec![Material::default()],
            ..Scene::default()
        };
        assert_eq!(scene.digest(), scene.clone().digest());
        let mut moved = scene.clone();
        moved.positions[1][2] = 1e-9;
        let mut lamp = scene.clone();
        lamp.materials[0].emission[0] = 1.0;
        // The same bytes, divided otherwise.
        let mut other = scene.clone();
        other.normals = other.positions.split_off(1);
        let all = [&scene, &moved, &lamp, &other].map(Scene::digest);
        let distinct: std::collections::HashSet<_> = all.iter().collect();
        assert_eq!(distinct.len(), 4);
    }
}
