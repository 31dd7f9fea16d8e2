//! The scene on the device: one arena of vertices and indices, textures, a table of materials.

use std::ops::Range;

use glam::Vec3;

use crate::gpu::{
    Buffer, BufferKind, Draws, Faces, Format, Image, ImageDesc, ImageKind, Recorder, Result,
    upload_buffer, upload_texture,
};
use crate::scene::{
    self, Bodies, Body, Bounds, Cluster, Clusters, Encoding, Material, Scene, Texture,
};

use super::cull::Cull;

/// What is drawn with one material.
#[derive(Debug, Clone)]
pub struct Part {
    /// Numbers of its clusters.
    pub clusters: Range<usize>,
    /// Number of the material.
    pub material: u32,
    /// How it is drawn.
    pub kind: Kind,
    /// Whether the shadow map needs it.
    pub casts: bool,
}

/// What the shaders of a part must do besides the plain minimum; each kind has a pipeline of its own.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Kind {
    /// Read colours at its vertices.
    pub colours: bool,
    /// Read a normal map.
    pub normal_map: bool,
    /// Leave holes.
    pub cut_out: bool,
    /// Read a map of ρ_d.
    pub diffuse_map: bool,
    /// Read a map of the factor on ρ_s.
    pub specular_map: bool,
}

impl Kind {
    /// Whether it needs more than maps of ρ_d and ρ_s.
    pub fn is_detailed(&self) -> bool {
        self.colours || self.normal_map || self.cut_out
    }
}

/// A material as draws need it.
#[derive(Debug, Clone, Copy)]
struct Surface {
    diffuse: Vec3,
    diffuse_map: Option<usize>,
    specular_map: Option<usize>,
    normal_map: Option<usize>,
    normal_scale: f32,
    cutoff: Option<f32>,
}

/// What a draw binds: a material with its maps.
#[derive(Clone, Copy)]
pub struct Bound<'g> {
    /// How it is drawn.
    pub kind: Kind,
    /// Number of the material.
    pub material: u32,
    /// ρ_d, multiplies its map.
    pub diffuse: Vec3,
    /// Map of ρ_d.
    pub diffuse_map: Option<&'g Image>,
    /// Map of the factor on ρ_s.
    pub specular_map: Option<&'g Image>,
    /// Normal map.
    pub normal_map: Option<&'g Image>,
    /// Factor on its slopes.
    pub normal_scale: f32,
    /// Alpha of the map of ρ_d below which there is a hole; 0 without holes.
    pub cutoff: f32,
    /// Stands for a map that is not there.
    pub white: &'g Image,
}

/// The uploaded scene.
pub struct Geometry {
    positions: Buffer,
    /// Normal, and how thick the body is behind the surface, metres.
    normals: Buffer,
    texcoords: Buffer,
    indices: Buffer,
    /// In the order of their indices.
    clusters: Vec<Cluster>,
    /// Colours and tangents, if any part is detailed.
    details: Option<[Buffer; 2]>,
    /// Sorted by kind.
    parts: Vec<Part>,
    surfaces: Vec<Surface>,
    textures: Vec<Image>,
    white: Image,
    is_specular: bool,
    materials: Image,
    bounds: Bounds,
    casters: Bounds,
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
        let bodies = Bodies::of(scene);
        let normals = normals_and_thickness(scene, &bodies);
        let surfaces: Vec<Surface> = scene.materials.iter().map(surface).collect();
        let textures: Result<Vec<Image>> = scene
            .textures
            .iter()
            .map(|texture| upload(recorder, texture))
            .collect();
        let (parts, clusters) = parts(scene, &bodies, &surfaces);
        let details = if parts.iter().any(|p| p.kind.is_detailed()) {
            Some(upload_details(recorder, scene)?)
        } else {
            None
        };
        Ok(Self {
            positions: vertex(
                recorder,
                "positions",
                bytemuck::cast_slice(&scene.positions),
            )?,
            normals: vertex(recorder, "normals", bytemuck::cast_slice(&normals))?,
            texcoords: vertex(
                recorder,
                "texcoords",
                bytemuck::cast_slice(&scene.texcoords),
            )?,
            indices: upload_buffer(
                recorder,
                "indices",
                BufferKind::Index,
                bytemuck::cast_slice(&clusters.indices),
            )?,
            clusters: clusters.list,
            details,
            parts,
            is_specular: scene.materials.iter().any(|m| m.specular != [0.0; 3]),
            surfaces,
            textures: textures?,
            white: upload(recorder, &white())?,
            materials: upload_materials(recorder, &scene.materials)?,
            bounds: scene.bounds,
            casters: scene.casters(),
        })
    }

    /// The box around everything.
    pub fn bounds(&self) -> &Bounds {
        &self.bounds
    }

    /// The box around everything that may cast a shadow.
    pub fn casters(&self) -> &Bounds {
        &self.casters
    }

    /// ρ_d, ρ_s and p of every material, see `include/materials.glsl`.
    pub fn materials(&self) -> &Image {
        &self.materials
    }

    /// ρ_d of a material, without its map.
    pub fn diffuse(&self, material: u32) -> Vec3 {
        self.surfaces
            .get(material as usize)
            .map_or(Vec3::ZERO, |s| s.diffuse)
    }

    /// Whether ρ_d and the factor on ρ_s vary over any material.
    pub fn has_albedo(&self) -> bool {
        let varies = |k: Kind| k.diffuse_map || k.specular_map || k.colours;
        self.kinds().any(varies)
    }

    /// Draws everything that casts a shadow into what `cull` sees and has no holes, positions only.
    pub fn draw_positions(&self, draws: &mut Draws<'_, '_>, cull: &Cull) {
        if self.clusters.is_empty() {
            return;
        }
        draws.geometry(&[&self.positions], &self.indices);
        let solid = self.parts.iter().filter(|p| p.casts && !p.kind.cut_out);
        let clusters = solid.flat_map(|p| &self.clusters[p.clusters.clone()]);
        for run in Runs::new(clusters, cull) {
            run.draw(draws);
        }
    }

    /// The kinds of its parts, in the order in which they are drawn.
    pub fn kinds(&self) -> impl Iterator<Item = Kind> {
        let mut kinds: Vec<Kind> = self.parts.iter().map(|p| p.kind).collect();
        kinds.dedup();
        kinds.into_iter()
    }

    /// Whether any material has a ρ_s.
    pub fn is_specular(&self) -> bool {
        self.is_specular
    }

    /// Draws the parts that are not detailed; `bind` is called with each new material.
    pub fn draw_plain<'g, 'r>(
        &'g self,
        draws: &mut Draws<'_, 'r>,
        cull: &Cull,
        bind: impl FnMut(&mut Draws<'_, 'r>, &Bound<'g>),
    ) {
        draws.geometry(
            &[&self.positions, &self.normals, &self.texcoords],
            &self.indices,
        );
        self.draw_parts(draws, |part| !part.kind.is_detailed(), cull, bind);
    }

    /// Draws the detailed parts; `bind` is called with each new material.
    pub fn draw_detailed<'g, 'r>(
        &'g self,
        draws: &mut Draws<'_, 'r>,
        cull: &Cull,
        bind: impl FnMut(&mut Draws<'_, 'r>, &Bound<'g>),
    ) {
        let Some([colours, tangents]) = &self.details else {
            return;
        };
        let plain = [&self.positions, &self.normals, &self.texcoords];
        let streams = [plain[0], plain[1], plain[2], colours, tangents];
        draws.geometry(&streams, &self.indices);
        self.draw_parts(draws, |part| part.kind.is_detailed(), cull, bind);
    }

    /// Draws positions and texture coordinates of the parts with holes; `bind` is called with each new material.
    pub fn draw_cut_outs<'g, 'r>(
        &'g self,
        draws: &mut Draws<'_, 'r>,
        cull: &Cull,
        bind: impl FnMut(&mut Draws<'_, 'r>, &Bound<'g>),
    ) {
        draws.geometry(&[&self.positions, &self.texcoords], &self.indices);
        self.draw_parts(draws, |part| part.casts && part.kind.cut_out, cull, bind);
    }

    fn draw_parts<'g, 'r>(
        &'g self,
        draws: &mut Draws<'_, 'r>,
        wanted: impl Fn(&Part) -> bool,
        cull: &Cull,
        mut bind: impl FnMut(&mut Draws<'_, 'r>, &Bound<'g>),
    ) {
        let mut current = None;
        for part in self.parts.iter().filter(|p| wanted(p)) {
            for run in Runs::new(&self.clusters[part.clusters.clone()], cull) {
                if current != Some((part.kind, part.material)) {
                    bind(draws, &self.bound(part));
                    current = Some((part.kind, part.material));
                }
                run.draw(draws);
            }
        }
    }

    fn bound(&self, part: &Part) -> Bound<'_> {
        let s = &self.surfaces[part.material as usize];
        let map = |index: Option<usize>| index.map(|i| &self.textures[i]);
        Bound {
            kind: part.kind,
            material: part.material,
            diffuse: s.diffuse,
            diffuse_map: map(s.diffuse_map),
            specular_map: map(s.specular_map),
            normal_map: map(s.normal_map),
            normal_scale: s.normal_scale,
            cutoff: s.cutoff.unwrap_or(0.0),
            white: &self.white,
        }
    }
}

/// A run of indices that is drawn at once.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Run {
    first: u32,
    count: u32,
    faces: Faces,
}

impl Run {
    fn draw(&self, draws: &mut Draws<'_, '_>) {
        draws.faces(self.faces);
        draws.indexed(self.first, self.count);
    }
}

impl Run {
    /// Whether both are better drawn as one, with what lies between them.
    fn is_followed_by(&self, next: &Self) -> bool {
        self.faces == next.faces && next.first - (self.first + self.count) <= BRIDGED
    }
}

/// Indices that are drawn in vain rather than in two draws: a draw costs a CPU 10 to 30 µs, which is what 200 triangles cost.
const BRIDGED: u32 = 3 * 200;

/// Runs of the clusters that are seen: those that nearly follow each other are drawn at once.
struct Runs<'c, I> {
    clusters: I,
    cull: &'c Cull,
    open: Option<Run>,
}

impl<'c, I: Iterator<Item = &'c Cluster>> Runs<'c, I> {
    fn new(clusters: impl IntoIterator<Item = &'c Cluster, IntoIter = I>, cull: &'c Cull) -> Self {
        Self {
            clusters: clusters.into_iter(),
            cull,
            open: None,
        }
    }
}

impl<'c, I: Iterator<Item = &'c Cluster>> Iterator for Runs<'c, I> {
    type Item = Run;

    fn next(&mut self) -> Option<Run> {
        for cluster in self.clusters.by_ref().filter(|c| self.cull.sees(c)) {
            let next = Run {
                first: cluster.first,
                count: cluster.count,
                faces: self.cull.faces(cluster),
            };
            match &mut self.open {
                Some(run) if run.is_followed_by(&next) => {
                    run.count = next.first + next.count - run.first;
                }
                open => {
                    let done = open.replace(next);
                    if done.is_some() {
                        return done;
                    }
                }
            }
        }
        self.open.take()
    }
}

/// The parts of a scene in the order in which they are drawn, and their clusters.
fn parts(scene: &Scene, bodies: &Bodies, surfaces: &[Surface]) -> (Vec<Part>, Clusters) {
    let casting = scene.casting();
    let kind = |p: &scene::Part| surfaces[p.material as usize].kind(p.has_colours);
    let mut order: Vec<usize> = (0..scene.parts.len()).collect();
    // Parts of one kind share a pipeline: as few changes as possible.
    order.sort_by_key(|i| (kind(&scene.parts[*i]), scene.parts[*i].material));
    let sorted = || order.iter().map(|i| (&scene.parts[*i], casting[*i]));
    let runs: Vec<(u32, u32)> = sorted()
        .map(|(p, _)| (p.first_index, p.index_count))
        .collect();
    let clusters = Clusters::of(scene, bodies, &runs);
    let part = |((part, casts), clusters): ((&scene::Part, bool), &Range<usize>)| Part {
        clusters: clusters.clone(),
        material: part.material,
        kind: kind(part),
        casts,
    };
    (sorted().zip(&clusters.of_run).map(part).collect(), clusters)
}

impl Surface {
    fn kind(&self, colours: bool) -> Kind {
        Kind {
            colours,
            normal_map: self.normal_map.is_some(),
            cut_out: self.cutoff.is_some(),
            diffuse_map: self.diffuse_map.is_some(),
            specular_map: self.specular_map.is_some(),
        }
    }
}

/// Colours and tangents for every vertex: white and none where the scene has none.
fn upload_details(recorder: &mut Recorder, scene: &Scene) -> Result<[Buffer; 2]> {
    let vertices = scene.positions.len();
    let (white, none) = (vec![[u16::MAX; 4]; vertices], vec![[0i16; 4]; vertices]);
    let given = |length: usize| length == vertices;
    let colours = if given(scene.colours.len()) {
        &scene.colours
    } else {
        &white
    };
    let tangents = if given(scene.tangents.len()) {
        &scene.tangents
    } else {
        &none
    };
    let colours = bytemuck::cast_slice(colours);
    let tangents = bytemuck::cast_slice(tangents);
    Ok([
        upload_buffer(recorder, "colours", BufferKind::Vertex, colours)?,
        upload_buffer(recorder, "tangents", BufferKind::Vertex, tangents)?,
    ])
}

fn normals_and_thickness(scene: &Scene, bodies: &Bodies) -> Vec<[f32; 4]> {
    let thickness: Vec<f32> = bodies.list.iter().map(Body::thickness).collect();
    let body = bodies.of_vertex.iter();
    let vertices = scene.normals.iter().zip(body);
    vertices
        .map(|([x, y, z], body)| [*x, *y, *z, thickness[*body as usize]])
        .collect()
}

/// Materials in a row of the table of materials.
const MATERIAL_COLUMNS: usize = 1024;

/// The table of `include/materials.glsl`.
fn upload_materials(recorder: &mut Recorder, materials: &[Material]) -> Result<Image> {
    let rows = 2 * materials.len().div_ceil(MATERIAL_COLUMNS).max(1);
    let mut table = vec![[0.0f32; 4]; rows * MATERIAL_COLUMNS];
    for (i, material) in materials.iter().enumerate() {
        let at = i / MATERIAL_COLUMNS * 2 * MATERIAL_COLUMNS + i % MATERIAL_COLUMNS;
        let ([r, g, b], [x, y, z]) = (material.diffuse, material.specular);
        table[at] = [r, g, b, 0.0];
        table[at + MATERIAL_COLUMNS] = [x, y, z, material.shininess];
    }
    let size = [MATERIAL_COLUMNS as u32, rows as u32];
    let desc = ImageDesc::flat("materials", Format::R32G32B32A32_SFLOAT, size);
    upload_texture(recorder, &desc, &[bytemuck::cast_slice(&table)])
}

fn surface(material: &Material) -> Surface {
    Surface {
        diffuse: material.diffuse.into(),
        diffuse_map: material.diffuse_texture,
        specular_map: material.specular_texture,
        normal_map: material.normal_texture,
        normal_scale: material.normal_scale,
        // The opacity of the material multiplies that of the map: the same test with one factor less.
        cutoff: material
            .alpha_cutoff
            .map(|c| c / material.dissolve.max(1e-6)),
    }
}

fn white() -> Texture {
    Texture {
        name: "white".into(),
        width: 1,
        height: 1,
        rgba8: vec![255; 4],
        encoding: Encoding::Srgb,
    }
}

fn upload(recorder: &mut Recorder, texture: &Texture) -> Result<Image> {
    let smaller = texture.mip_levels();
    let levels: Vec<&[u8]> = std::iter::once(texture.rgba8.as_slice())
        .chain(smaller.iter().map(|t| t.rgba8.as_slice()))
        .collect();
    let desc = ImageDesc {
        name: &texture.name,
        format: match texture.encoding {
            Encoding::Srgb => Format::R8G8B8A8_SRGB,
            Encoding::Linear => Format::R8G8B8A8_UNORM,
        },
        size: [texture.width, texture.height],
        kind: ImageKind::Flat,
        levels: levels.len() as u32,
    };
    upload_texture(recorder, &desc, &levels)
}
