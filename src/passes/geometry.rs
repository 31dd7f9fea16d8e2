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
#[derive(Debug, Clone, Copy)]
struct Surface {
    diffuse: Vec3,
    diffuse_map: Option<usize>,
    specular_map: Option<usize>,
}

/// What a draw binds: a material with its maps.
#[derive(Clone, Copy)]
pub struct Bound<'g> {
    /// Number of the material.
    pub material: u32,
    /// ρ_d, multiplies its map.
    pub diffuse: Vec3,
    /// Map of ρ_d.
    pub diffuse_map: Option<&'g Image>,
    /// Map of the factor on ρ_s.
    pub specular_map: Option<&'g Image>,
    /// Stands for a map that is not there.
    pub white: &'g Image,
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
    white: Image,
    is_specular: bool,
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
        let surfaces: Vec<Surface> = scene.materials.iter().map(surface).collect();
        let textures: Result<Vec<Image>> = scene
            .textures
            .iter()
            .map(|texture| upload(recorder, texture))
            .collect();
        let mut parts: Vec<Part> = scene
            .parts
            .iter()
            .map(|p| Part {
                first: p.first_index,
                count: p.index_count,
                material: p.material,
            })
            .collect();
        // Materials with the same kinds of maps share a pipeline: as few changes as possible.
        parts.sort_by_key(|p| {
            let s = &surfaces[p.material as usize];
            (
                s.diffuse_map.is_some(),
                s.specular_map.is_some(),
                p.material,
            )
        });
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
            is_specular: scene.materials.iter().any(|m| m.specular != [0.0; 3]),
            surfaces,
            textures: textures?,
            white: upload(recorder, &white())?,
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

    /// Draws everything, positions only.
    pub fn draw_positions(&self, draws: &mut Draws<'_, '_>) {
        if self.index_count > 0 {
            draws.geometry(&[&self.positions], &self.indices);
            draws.indexed(0, self.index_count);
        }
    }

    /// Whether any material has a ρ_s.
    pub fn is_specular(&self) -> bool {
        self.is_specular
    }

    /// Draws part after part; `bind` is called with each new material.
    pub fn draw_surfaces<'g, 'r>(
        &'g self,
        draws: &mut Draws<'_, 'r>,
        mut bind: impl FnMut(&mut Draws<'_, 'r>, &Bound<'g>),
    ) {
        draws.geometry(
            &[&self.positions, &self.normals, &self.texcoords],
            &self.indices,
        );
        let mut current = None;
        for part in &self.parts {
            if current != Some(part.material) {
                bind(draws, &self.bound(part.material));
                current = Some(part.material);
            }
            draws.indexed(part.first, part.count);
        }
    }

    fn bound(&self, material: u32) -> Bound<'_> {
        let s = &self.surfaces[material as usize];
        let map = |index: Option<usize>| index.map(|i| &self.textures[i]);
        Bound {
            material,
            diffuse: s.diffuse,
            diffuse_map: map(s.diffuse_map),
            specular_map: map(s.specular_map),
            white: &self.white,
        }
    }
}

fn table_row(material: &Material) -> [f32; 4] {
    let [r, g, b] = material.specular;
    [r, g, b, material.shininess]
}

fn surface(material: &Material) -> Surface {
    Surface {
        diffuse: material.diffuse.into(),
        diffuse_map: material.diffuse_texture,
        specular_map: material.specular_texture,
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
