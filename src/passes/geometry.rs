//! The scene on the device: one arena of vertices and indices, textures, a table of materials.

use glam::Vec3;

use crate::gpu::{
    Buffer, BufferKind, Draws, Format, Image, ImageDesc, ImageKind, Recorder, Result,
    upload_buffer, upload_texture,
};
use crate::scene::{Bounds, Material, Scene, Texture};

/// What is drawn with one material.
#[derive(Debug, Clone, Copy)]
pub struct Part {
    /// First index.
    pub first: u32,
    /// Number of indices.
    pub count: u32,
    /// Number of the material.
    pub material: u32,
}

/// A material as draws need it.
struct Surface {
    diffuse: Vec3,
    diffuse_map: usize,
    specular_map: usize,
}

/// The uploaded scene.
pub struct Geometry {
    positions: Buffer,
    normals: Buffer,
    texcoords: Buffer,
    indices: Buffer,
    index_count: u32,
    parts: Vec<Part>,
    surfaces: Vec<Surface>,
    textures: Vec<Image>,
    materials: Buffer,
    bounds: Bounds,
}

impl Geometry {
    /// Uploads a scene; `recorder` must be recording.
    ///
    /// # Errors
    /// When the device has no memory left.
    pub fn new(recorder: &mut Recorder, scene: &Scene) -> Result<Self> {
        let vertex = |recorder: &mut Recorder, name, bytes| {
            upload_buffer(recorder, name, BufferKind::Vertex, bytes)
        };
        let indices = bytemuck::cast_slice(&scene.indices);
        let table: Vec<[f32; 4]> = scene.materials.iter().map(table_row).collect();
        // Texture 0 is white: it stands for "no map".
        let mut textures = vec![upload(recorder, &white())?];
        for texture in &scene.textures {
            textures.push(upload(recorder, texture)?);
        }
        let mut parts: Vec<Part> = scene
            .parts
            .iter()
            .map(|p| Part {
                first: p.first_index,
                count: p.index_count,
                material: p.material,
            })
            .collect();
        parts.sort_by_key(|p| p.material);
        Ok(Self {
            positions: vertex(
                recorder,
                "positions",
                bytemuck::cast_slice(&scene.positions),
            )?,
            normals: vertex(recorder, "normals", bytemuck::cast_slice(&scene.normals))?,
            texcoords: vertex(
                recorder,
                "texcoords",
                bytemuck::cast_slice(&scene.texcoords),
            )?,
            indices: upload_buffer(recorder, "indices", BufferKind::Index, indices)?,
            index_count: scene.indices.len() as u32,
            parts,
            surfaces: scene.materials.iter().map(surface).collect(),
            textures,
            materials: upload_buffer(
                recorder,
                "materials",
                BufferKind::Storage,
                bytemuck::cast_slice(&table),
            )?,
            bounds: scene.bounds,
        })
    }

    /// The box around everything.
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// ρ_s and p of every material.
    pub fn materials(&self) -> &Buffer {
        &self.materials
    }

    /// Number of triangles.
    pub fn triangles(&self) -> u32 {
        self.index_count / 3
    }

    /// Draws everything, positions only.
    pub fn draw_positions(&self, draws: &mut Draws<'_, '_>) {
        if self.index_count > 0 {
            draws.geometry(&[&self.positions], &self.indices);
            draws.indexed(0, self.index_count);
        }
    }

    /// Draws part after part; `bind` is called with each new material: its number, ρ_d, the maps of ρ_d and ρ_s.
    pub fn draw_surfaces(
        &self,
        draws: &mut Draws<'_, '_>,
        mut bind: impl FnMut(&mut Draws<'_, '_>, u32, Vec3, &Image, &Image),
    ) {
        draws.geometry(
            &[&self.positions, &self.normals, &self.texcoords],
            &self.indices,
        );
        let mut bound = None;
        for part in &self.parts {
            if bound != Some(part.material) {
                let s = &self.surfaces[part.material as usize];
                let (diffuse, specular) = (
                    &self.textures[s.diffuse_map],
                    &self.textures[s.specular_map],
                );
                bind(draws, part.material, s.diffuse, diffuse, specular);
                bound = Some(part.material);
            }
            draws.indexed(part.first, part.count);
        }
    }
}

fn table_row(material: &Material) -> [f32; 4] {
    let [r, g, b] = material.specular;
    [r, g, b, material.shininess]
}

fn surface(material: &Material) -> Surface {
    let map = |texture: Option<usize>| texture.map_or(0, |t| t + 1);
    Surface {
        diffuse: material.diffuse.into(),
        diffuse_map: map(material.diffuse_texture),
        specular_map: map(material.specular_texture),
    }
}

fn white() -> Texture {
    Texture {
        name: "white".into(),
        width: 1,
        height: 1,
        rgba8: vec![255; 4],
    }
}

fn upload(recorder: &mut Recorder, texture: &Texture) -> Result<Image> {
    let smaller = texture.mip_levels();
    let levels: Vec<&[u8]> = std::iter::once(texture.rgba8.as_slice())
        .chain(smaller.iter().map(|t| t.rgba8.as_slice()))
        .collect();
    let desc = ImageDesc {
        name: &texture.name,
        format: Format::R8G8B8A8_SRGB,
        size: [texture.width, texture.height],
        kind: ImageKind::Flat,
        levels: levels.len() as u32,
    };
    upload_texture(recorder, &desc, &levels)
}
