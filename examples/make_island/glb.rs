//! A writer for binary glTF: meshes with materials, instances and images.

use glam::{Affine3A, Quat, Vec3};
use serde_json::{Value, json};

use crate::mesh::Mesh;

/// A metallic-roughness material.
pub struct Material {
    pub name: &'static str,
    /// Linear RGB.
    pub colour: [f32; 3],
    pub metallic: f32,
    pub roughness: f32,
    pub ior: f32,
    /// Index of the base colour image.
    pub picture: Option<usize>,
    /// Index of the normal map, and the factor on its slopes.
    pub normals: Option<(usize, f32)>,
    /// Alpha below this value is cut out.
    pub cutoff: Option<f32>,
}

/// An upright instance of a mesh.
pub struct Node {
    pub mesh: usize,
    pub at: Vec3,
    /// Rotation about +Y, radians.
    pub turn: f32,
    pub scale: f32,
}

/// The file under construction.
#[derive(Default)]
pub struct Glb {
    binary: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    materials: Vec<Value>,
    images: Vec<Value>,
    nodes: Vec<Value>,
    triangles: Vec<usize>,
    drawn: usize,
}

impl Glb {
    /// Appends bytes; returns the index of their buffer view.
    fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.binary.len();
        self.binary.extend_from_slice(bytes);
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        let view = json!({ "buffer": 0, "byteOffset": offset, "byteLength": bytes.len() });
        self.views.push(view);
        self.views.len() - 1
    }

    fn accessor(&mut self, bytes: &[u8], kind: &str, component: u32, count: usize) -> usize {
        let view = self.view(bytes);
        self.accessors.push(json!({
            "bufferView": view, "componentType": component, "type": kind, "count": count
        }));
        self.accessors.len() - 1
    }

    fn floats(&mut self, values: impl Iterator<Item = f32>, kind: &str, count: usize) -> usize {
        let bytes: Vec<u8> = values.flat_map(f32::to_le_bytes).collect();
        self.accessor(&bytes, kind, 5126, count)
    }

    /// Adds a PNG image; returns its index.
    pub fn picture(&mut self, name: &str, png: &[u8]) -> usize {
        let view = self.view(png);
        self.images
            .push(json!({ "name": name, "bufferView": view, "mimeType": "image/png" }));
        self.images.len() - 1
    }

    /// Adds a material; returns its index.
    pub fn material(&mut self, m: &Material) -> usize {
        let [r, g, b] = m.colour;
        let mut pbr = json!({
            "baseColorFactor": [r, g, b, 1.0],
            "metallicFactor": m.metallic, "roughnessFactor": m.roughness
        });
        if let Some(picture) = m.picture {
            pbr["baseColorTexture"] = json!({ "index": picture });
        }
        let mut material = json!({
            "name": m.name, "doubleSided": true, "pbrMetallicRoughness": pbr,
            "extensions": { "KHR_materials_ior": { "ior": m.ior } }
        });
        if let Some((picture, scale)) = m.normals {
            material["normalTexture"] = json!({ "index": picture, "scale": scale });
        }
        if let Some(cutoff) = m.cutoff {
            material["alphaMode"] = json!("MASK");
            material["alphaCutoff"] = json!(cutoff);
        }
        self.materials.push(material);
        self.materials.len() - 1
    }

    /// Adds a mesh of parts with their materials; returns its index.
    pub fn mesh(&mut self, name: &str, parts: &[(usize, &Mesh)]) -> usize {
        let drawn = parts.iter().filter(|(_, mesh)| !mesh.indices.is_empty());
        let primitives: Vec<Value> = drawn
            .clone()
            .map(|(material, mesh)| self.primitive(*material, mesh))
            .collect();
        self.triangles
            .push(drawn.map(|(_, mesh)| mesh.indices.len() / 3).sum());
        self.meshes
            .push(json!({ "name": name, "primitives": primitives }));
        self.meshes.len() - 1
    }

    fn primitive(&mut self, material: usize, mesh: &Mesh) -> Value {
        let mesh = &mesh.without_degenerate();
        let (points, count) = (&mesh.points, mesh.points.len());
        let position = points.iter().flat_map(|p| p.position.to_array());
        let position = self.floats(position, "VEC3", count);
        let extreme = |f: fn(Vec3, Vec3) -> Vec3| {
            points
                .iter()
                .map(|p| p.position)
                .reduce(f)
                .map(|v| v.to_array())
        };
        self.accessors[position]["min"] = json!(extreme(Vec3::min));
        self.accessors[position]["max"] = json!(extreme(Vec3::max));
        let normals = points.iter().flat_map(|p| p.normal.to_array());
        let normal = self.floats(normals, "VEC3", count);
        let mut attributes = json!({ "POSITION": position, "NORMAL": normal });
        let of = &self.materials[material];
        let textured = of["normalTexture"].is_object()
            || of["pbrMetallicRoughness"]["baseColorTexture"].is_object();
        if textured {
            let uv = points.iter().flat_map(|p| p.uv.to_array());
            attributes["TEXCOORD_0"] = json!(self.floats(uv, "VEC2", count));
        }
        if points.iter().any(|p| p.colour != Vec3::ONE) {
            attributes["COLOR_0"] = json!(self.colours(mesh));
        }
        let indices = self.indices(mesh);
        json!({ "attributes": attributes, "indices": indices, "material": material })
    }

    /// Writes vertex colours as normalised 16-bit RGBA.
    fn colours(&mut self, mesh: &Mesh) -> usize {
        let unorm = |v: f32| (v.clamp(0.0, 1.0) * 65_535.0).round() as u16;
        let rgba = |c: Vec3| [c.x, c.y, c.z, 1.0].map(unorm);
        let bytes: Vec<u8> = mesh
            .points
            .iter()
            .flat_map(|p| rgba(p.colour))
            .flat_map(u16::to_le_bytes)
            .collect();
        let accessor = self.accessor(&bytes, "VEC4", 5123, mesh.points.len());
        self.accessors[accessor]["normalized"] = json!(true);
        accessor
    }

    fn indices(&mut self, mesh: &Mesh) -> usize {
        let count = mesh.indices.len();
        if mesh.points.len() <= 65_535 {
            let small = mesh.indices.iter().map(|i| *i as u16);
            let bytes: Vec<u8> = small.flat_map(u16::to_le_bytes).collect();
            return self.accessor(&bytes, "SCALAR", 5123, count);
        }
        let bytes: Vec<u8> = mesh.indices.iter().flat_map(|i| i.to_le_bytes()).collect();
        self.accessor(&bytes, "SCALAR", 5125, count)
    }

    /// Adds an instance of a mesh, upright.
    pub fn node(&mut self, node: &Node) {
        self.drawn += self.triangles[node.mesh];
        let turn = Quat::from_rotation_y(node.turn).to_array();
        self.nodes.push(json!({
            "mesh": node.mesh, "translation": node.at.to_array(),
            "rotation": turn, "scale": Vec3::splat(node.scale).to_array()
        }));
    }

    /// Adds an instance of a mesh with any transform.
    pub fn placed(&mut self, mesh: usize, place: Affine3A) {
        self.drawn += self.triangles[mesh];
        let (scale, rotation, translation) = place.to_scale_rotation_translation();
        self.nodes.push(json!({
            "mesh": mesh, "translation": translation.to_array(),
            "rotation": rotation.to_array(), "scale": scale.to_array()
        }));
    }

    /// Number of triangles stored, and number drawn including all instances.
    pub fn triangles(&self) -> (usize, usize) {
        (self.triangles.iter().sum(), self.drawn)
    }

    /// Encodes the whole file.
    pub fn finish(self) -> Vec<u8> {
        let all: Vec<usize> = (0..self.nodes.len()).collect();
        let textures: Vec<Value> = (0..self.images.len())
            .map(|i| json!({ "source": i }))
            .collect();
        let document = json!({
            "asset": { "version": "2.0", "generator": "skylight make_island" },
            "extensionsUsed": ["KHR_materials_ior"],
            "scene": 0, "scenes": [{ "nodes": all }], "nodes": self.nodes, "meshes": self.meshes,
            "materials": self.materials, "textures": textures, "images": self.images,
            "accessors": self.accessors, "bufferViews": self.views,
            "buffers": [{ "byteLength": self.binary.len() }]
        });
        let mut text = document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let mut file = Vec::new();
        let total = 12 + 8 + text.len() + 8 + self.binary.len();
        let chunks = [(*b"JSON", &text), (*b"BIN\0", &self.binary)];
        file.extend(*b"glTF");
        file.extend(2u32.to_le_bytes());
        file.extend((total as u32).to_le_bytes());
        for (kind, bytes) in chunks {
            file.extend((bytes.len() as u32).to_le_bytes());
            file.extend(kind);
            file.extend(bytes);
        }
        file
    }
}
