//! The scene on the device: vertex and index buffers, textures, and a table of materials.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use bytemuck::cast_slice;
use glam::Vec3;

use crate::daylight::glass::internal_transmittance;
use crate::gpu::{
    Buffer, BufferKind, Draws, Image, Outside, Pass, Recorder, Result, Sampler, upload_buffer,
};
use crate::scene::{self, Bounds, Cluster, Layout, Scene, Texture, Wrap};

use crate::passes::surfaces::culling::{Cull, Runs};
use crate::passes::surfaces::facts::Facts;
use crate::passes::surfaces::triangles::upload_material_numbers;
use crate::passes::surfaces::upload::{surface, upload, upload_details, upload_materials, white};
use crate::passes::view::View;

/// The geometry of one material.
#[derive(Debug, Clone)]
pub struct Part {
    /// Indices of its clusters.
    pub clusters: Range<usize>,
    /// Number of the material.
    pub material: u32,
    /// Shader features and pipeline.
    pub kind: Kind,
    /// Whether it casts shadows.
    pub casts: bool,
    /// What one passage straight through the glass leaves, linear RGB, if it is a pane: such parts are drawn by
    /// [`Geometry::draw_panes`] alone.
    pub glass: Option<Vec3>,
}

/// Shader features of a part; each kind has a pipeline.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Kind {
    /// Read vertex colours.
    pub colours: bool,
    /// Read a normal map.
    pub normal_map: bool,
    /// Discard by alpha.
    pub cut_out: bool,
    /// Read a texture of ρ_d.
    pub diffuse_map: bool,
    /// Read a texture of the factor on ρ_s, or of roughness and metalness.
    pub specular_map: bool,
    /// Read a texture of the factor on L_e.
    pub emissive_map: bool,
}

impl Kind {
    /// Whether it needs more than maps of ρ_d, ρ_s and L_e.
    pub fn is_detailed(&self) -> bool {
        self.colours || self.normal_map || self.cut_out
    }
}

/// Where L_e of a pixel is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum EmissionSource {
    /// Nothing emits light.
    #[default]
    None,
    /// In the table of materials.
    Materials,
    /// In the table of materials, with a factor in an image: there are emissive textures.
    Image,
}

/// A material with the data that draw calls need.
#[derive(Debug, Clone, Copy)]
pub(in crate::passes) struct Surface {
    pub diffuse: Vec3,
    pub diffuse_map: Option<usize>,
    pub specular_map: Option<usize>,
    pub normal_map: Option<usize>,
    pub emissive_map: Option<usize>,
    pub normal_scale: f32,
    pub is_specular: bool,
    /// Metalness, if it reflects by GGX.
    pub metallic: Option<f32>,
    /// L_e, cd/m².
    pub emission: Vec3,
    pub cutoff: Option<f32>,
}

/// The bindings of a draw call: a material with its maps.
#[derive(Clone, Copy)]
pub struct Bound<'g> {
    /// Shader features and pipeline.
    pub kind: Kind,
    /// Number of the material.
    pub material: u32,
    /// ρ_d, or the base colour of a surface that reflects by GGX, 0..1; a factor on its map.
    pub diffuse: Vec3,
    /// Map of ρ_d.
    pub diffuse_map: Option<Map<'g>>,
    /// Map of the factor on ρ_s, or of roughness (green) and metalness (blue).
    pub specular_map: Option<Map<'g>>,
    /// Normal map.
    pub normal_map: Option<Map<'g>>,
    /// Map of the factor on L_e.
    pub emissive_map: Option<Map<'g>>,
    /// Factor on the slopes of the normal map.
    pub normal_scale: f32,
    /// Whether it has a ρ_s.
    pub is_specular: bool,
    /// Metalness, if it reflects by GGX.
    pub metallic: Option<f32>,
    /// Alpha of the map of ρ_d below which fragments are discarded; 0: no alpha test.
    pub cutoff: f32,
    /// Placeholder for missing maps.
    pub white: Map<'g>,
}

/// A texture, and how it is looked up.
#[derive(Clone, Copy)]
pub struct Map<'g> {
    /// The texture.
    pub image: &'g Image,
    /// Its sampler.
    pub sampler: Sampler,
}

/// The uploaded scene.
pub struct Geometry {
    positions: Buffer,
    normals: Buffer,
    texcoords: Buffer,
    indices: Buffer,
    /// Of each triangle, where they are numbered.
    material_numbers: Option<Buffer>,
    /// In index order.
    clusters: Vec<Cluster>,
    /// Colours and tangents, if any part is detailed.
    details: Option<[Buffer; 2]>,
    /// Sorted by kind.
    parts: Vec<Part>,
    /// Panes of glass.
    panes: Vec<Part>,
    /// Cluster ranges of opaque casters, in index order; no two touch.
    casting: Vec<Range<usize>>,
    /// The same with a ground that casts no shadow.
    opaque: Vec<Range<usize>>,
    surfaces: Vec<Surface>,
    textures: Vec<(Image, Sampler)>,
    white: Image,
    materials: Image,
    facts: Arc<Facts>,
}

impl Geometry {
    /// Uploads a scene; `recorder` must be recording.
    ///
    /// # Errors
    /// Fails when the device is out of memory.
    pub fn new(recorder: &mut Recorder, scene: &Scene) -> Result<Self> {
        let (indices, layout) = arranged(scene);
        let vertex = |recorder: &mut Recorder, name, bytes| {
            upload_buffer(recorder, name, BufferKind::Vertex, bytes)
        };
        let surfaces: Vec<Surface> = scene.materials.iter().map(surface).collect();
        let textures: Result<Vec<_>> = scene
            .textures
            .iter()
            .map(|texture| Ok((upload(recorder, texture)?, sampler(texture))))
            .collect();
        let parts = parts(scene, &layout, &surfaces);
        let (panes, parts): (Vec<Part>, Vec<Part>) =
            parts.into_iter().partition(|part| part.glass.is_some());
        let clusters = layout.into_owned().clusters;
        let casting = joined_ranges(parts.iter().filter(|p| p.casts && !p.kind.cut_out));
        let cast = casting.iter().flat_map(|r| &clusters[r.clone()]);
        let largest = size_of_val(scene.positions.as_slice()).max(size_of_val(&*indices));
        let material_numbers =
            upload_material_numbers(recorder, (&parts, &clusters), indices.len() / 3, largest)?;
        let facts = Facts {
            has_panes: !panes.is_empty(),
            is_numbered: material_numbers.is_some(),
            casting_triangles: cast.map(|cluster| cluster.count as usize / 3).sum(),
            ..facts(scene, &parts, &surfaces)
        };
        let details = if parts.iter().any(|p| p.kind.is_detailed()) {
            Some(upload_details(recorder, scene)?)
        } else {
            None
        };
        Ok(Self {
            positions: vertex(recorder, "positions", cast_slice(&scene.positions))?,
            normals: vertex(recorder, "normals", cast_slice(&scene.normals))?,
            texcoords: vertex(recorder, "texcoords", cast_slice(&scene.texcoords))?,
            indices: upload_buffer(recorder, "indices", BufferKind::Index, cast_slice(&indices))?,
            material_numbers,
            clusters,
            details,
            casting,
            opaque: joined_ranges(parts.iter().filter(|p| !p.kind.cut_out)),
            parts,
            panes,
            surfaces,
            textures: textures?,
            white: upload(recorder, &white())?,
            materials: upload_materials(recorder, &scene.materials)?,
            facts: Arc::new(facts),
        })
    }

    /// What passes are created from.
    pub fn facts(&self) -> &Arc<Facts> {
        &self.facts
    }

    /// Bounding box of the scene.
    pub fn bounds(&self) -> &Bounds {
        &self.facts.bounds
    }

    /// Bounding box of all shadow casters.
    pub fn casters(&self) -> &Bounds {
        &self.facts.casters
    }

    /// Clusters that may be visible in the whole picture that this view is part of.
    pub fn seen(&self, view: &View) -> impl Iterator<Item = &Cluster> {
        let cull = Cull::camera(&view.whole());
        self.clusters.iter().filter(move |c| cull.sees(c))
    }

    /// Clusters within the frustum of a view, including back-facing ones.
    pub fn around(&self, view: &View) -> impl Iterator<Item = &Cluster> {
        let cull = Cull::camera(&view.whole());
        self.clusters.iter().filter(move |c| cull.holds(c))
    }

    /// ρ_d, ρ_s, p and L_e of every material, see `include/materials.glsl`.
    pub fn materials(&self) -> &Image {
        &self.materials
    }

    /// ρ_d of a material, or the base colour of one that reflects by GGX, 0..1, without its map.
    pub fn diffuse(&self, material: u32) -> Vec3 {
        self.surfaces
            .get(material as usize)
            .map_or(Vec3::ZERO, |s| s.diffuse)
    }

    /// L_e of a material, cd/m², without its map.
    pub fn emission(&self, material: u32) -> Vec3 {
        self.surfaces
            .get(material as usize)
            .map_or(Vec3::ZERO, |s| s.emission)
    }

    /// Draws all opaque casters that `cull` keeps, positions only; for light from below (`is_below`) also the ground, which shadows nothing
    /// from above.
    pub fn draw_positions(&self, draws: &mut Draws<'_, '_>, cull: &Cull, is_below: bool) {
        if self.clusters.is_empty() {
            return;
        }
        draws.geometry(&[&self.positions], &self.indices);
        // A run may go on over culled clusters, so each range has its own: between them are panes and cut-outs.
        let ranges = if is_below {
            &self.opaque
        } else {
            &self.casting
        };
        for range in ranges {
            for run in Runs::new(&self.clusters[range.clone()], cull) {
                run.draw(draws);
            }
        }
    }

    /// Draws surfaces without maps whose normals match their winding. `bind` is called for each new material.
    pub fn draw_untextured<'g, 'r>(
        &'g self,
        draws: &mut Draws<'_, 'r>,
        cull: &Cull,
        bind: impl FnMut(&mut Draws<'_, 'r>, &Bound<'g>),
    ) {
        draws.geometry(&self.streams(), &self.indices);
        self.draw_parts(draws, is_untextured, cull, bind);
    }

    /// Draws positions of all surfaces without maps. `bind` gets the number of the first triangle of each draw.
    pub fn draw_numbered<'r>(
        &self,
        draws: &mut Draws<'_, 'r>,
        cull: &Cull,
        mut bind: impl FnMut(&mut Draws<'_, 'r>, u32),
    ) {
        draws.geometry(&[&self.positions], &self.indices);
        for part in self.parts.iter().filter(|p| p.kind == Kind::default()) {
            for run in Runs::new(&self.clusters[part.clusters.clone()], cull) {
                bind(draws, run.first_triangle());
                run.draw(draws);
            }
        }
    }

    /// Binds indices, positions, normals and numbers of materials for shaders that look triangles up by their number.
    pub fn bound_to<'r>(&'r self, pass: Pass<'r>) -> Pass<'r> {
        // Without numbers nothing is looked up, but the binding must be written.
        let numbers = self.material_numbers.as_ref().unwrap_or(&self.indices);
        pass.storage("Indices", &self.indices)
            .storage("Positions", &self.positions)
            .storage("Normals", &self.normals)
            .storage("MaterialNumbers", numbers)
    }

    /// Draws the other parts that are not detailed. `bind` is called for each new material.
    pub fn draw_textured<'g, 'r>(
        &'g self,
        draws: &mut Draws<'_, 'r>,
        cull: &Cull,
        bind: impl FnMut(&mut Draws<'_, 'r>, &Bound<'g>),
    ) {
        draws.geometry(&self.streams(), &self.indices);
        let is_drawn = |p: &Part, c: &Cluster| {
            (self.facts.is_numbered && p.kind == Kind::default()) || is_untextured(p, c)
        };
        let textured = |p: &Part, c: &Cluster| !p.kind.is_detailed() && !is_drawn(p, c);
        self.draw_parts(draws, textured, cull, bind);
    }

    /// Vertex streams of all surfaces.
    fn streams(&self) -> [&Buffer; 3] {
        [&self.positions, &self.normals, &self.texcoords]
    }

    /// Draws the detailed parts. `bind` is called for each new material.
    pub fn draw_detailed<'g, 'r>(
        &'g self,
        draws: &mut Draws<'_, 'r>,
        cull: &Cull,
        bind: impl FnMut(&mut Draws<'_, 'r>, &Bound<'g>),
    ) {
        let Some([colours, tangents]) = &self.details else {
            return;
        };
        let [positions, normals, texcoords] = self.streams();
        let streams = [positions, normals, texcoords, colours, tangents];
        draws.geometry(&streams, &self.indices);
        self.draw_parts(draws, |part, _| part.kind.is_detailed(), cull, bind);
    }

    /// Draws positions and texture coordinates of alpha-tested parts. `bind` is called for each new material.
    pub fn draw_cut_outs<'g, 'r>(
        &'g self,
        draws: &mut Draws<'_, 'r>,
        cull: &Cull,
        bind: impl FnMut(&mut Draws<'_, 'r>, &Bound<'g>),
    ) {
        draws.geometry(&[&self.positions, &self.texcoords], &self.indices);
        let cut_out = |p: &Part, _: &Cluster| p.casts && p.kind.cut_out;
        self.draw_parts(draws, cut_out, cull, bind);
    }

    /// Draws positions and normals of panes of glass. `bind` gets what one passage straight through the glass leaves, linear RGB.
    pub fn draw_panes<'r>(
        &self,
        draws: &mut Draws<'_, 'r>,
        cull: &Cull,
        mut bind: impl FnMut(&mut Draws<'_, 'r>, Vec3),
    ) {
        draws.geometry(&[&self.positions, &self.normals], &self.indices);
        for part in &self.panes {
            bind(draws, part.glass.unwrap_or_default());
            for run in Runs::new(&self.clusters[part.clusters.clone()], cull) {
                run.draw(draws);
            }
        }
    }

    fn draw_parts<'g, 'r>(
        &'g self,
        draws: &mut Draws<'_, 'r>,
        wanted: impl Fn(&Part, &Cluster) -> bool,
        cull: &Cull,
        mut bind: impl FnMut(&mut Draws<'_, 'r>, &Bound<'g>),
    ) {
        let mut current = None;
        for part in &self.parts {
            let clusters = self.clusters[part.clusters.clone()].iter();
            for run in Runs::new(clusters.filter(|c| wanted(part, c)), cull) {
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
        let map = |index: Option<usize>| {
            let (image, sampler) = &self.textures[index?];
            Some(Map {
                image,
                sampler: *sampler,
            })
        };
        Bound {
            kind: part.kind,
            material: part.material,
            diffuse: s.diffuse,
            diffuse_map: map(s.diffuse_map),
            specular_map: map(s.specular_map),
            normal_map: map(s.normal_map),
            emissive_map: map(s.emissive_map),
            normal_scale: s.normal_scale,
            is_specular: s.is_specular,
            metallic: s.metallic,
            cutoff: s.cutoff.unwrap_or(0.0),
            white: Map {
                image: &self.white,
                sampler: Sampler::Surface(Outside::Repeat, Outside::Repeat),
            },
        }
    }
}

/// What passes depend on of surfaces that are no panes of glass.
fn facts(scene: &Scene, parts: &[Part], surfaces: &[Surface]) -> Facts {
    let is_rough = surfaces.iter().any(|s| s.metallic.is_some());
    Facts {
        bounds: scene.bounds,
        casters: scene.casters(),
        kinds: kinds(parts),
        emission_source: emission_source(parts, surfaces),
        has_panes: false,
        is_specular: is_rough || surfaces.iter().any(|s| s.is_specular),
        is_rough,
        casting_triangles: 0,
        is_numbered: false,
    }
}

/// The kinds of parts, in draw order.
fn kinds(parts: &[Part]) -> Vec<Kind> {
    let mut kinds: Vec<Kind> = parts.iter().map(|p| p.kind).collect();
    kinds.dedup();
    kinds
}

fn emission_source(parts: &[Part], surfaces: &[Surface]) -> EmissionSource {
    let emits = |part: &Part| surfaces[part.material as usize].emission != Vec3::ZERO;
    if parts.iter().any(|part| part.kind.emissive_map) {
        EmissionSource::Image
    } else if parts.iter().any(emits) {
        EmissionSource::Materials
    } else {
        EmissionSource::None
    }
}

/// The sampler of a texture.
fn sampler(texture: &Texture) -> Sampler {
    let [u, v] = texture.wrap.map(|wrap| match wrap {
        Wrap::Repeat => Outside::Repeat,
        Wrap::Mirror => Outside::Mirror,
        Wrap::Clamp => Outside::Clamp,
    });
    Sampler::Surface(u, v)
}

/// Whether a cluster needs no maps and no test for the side of its normals.
fn is_untextured(part: &Part, cluster: &Cluster) -> bool {
    part.kind == Kind::default() && cluster.normals_match_winding
}

/// A scene's indices and layout: those of its file, or new ones for a scene built in memory.
fn arranged(scene: &Scene) -> (Cow<'_, [u32]>, Cow<'_, Layout>) {
    match &scene.layout {
        Some(layout) => (Cow::Borrowed(&scene.indices), Cow::Borrowed(layout)),
        None => {
            let (indices, layout) = Layout::of(scene);
            (Cow::Owned(indices), Cow::Owned(layout))
        }
    }
}

/// The parts of a scene, in draw order.
fn parts(scene: &Scene, layout: &Layout, surfaces: &[Surface]) -> Vec<Part> {
    let casting = scene.casting();
    let all = scene.parts.iter().zip(&layout.of_part).zip(casting);
    let part = |((part, clusters), casts): ((&scene::Part, &Range<usize>), bool)| Part {
        clusters: clusters.clone(),
        material: part.material,
        kind: surfaces[part.material as usize].kind(part.has_colours),
        casts,
        glass: scene.materials[part.material as usize].glass.map(internal),
    };
    let mut parts: Vec<Part> = all.map(part).collect();
    // Sorted by kind to minimize pipeline changes.
    parts.sort_by_key(|part| (part.kind, part.material));
    parts
}

/// What one passage straight through a pane leaves, of its transmittance at normal incidence, linear RGB.
fn internal(transmittance: [f32; 3]) -> Vec3 {
    let one = |t: f32| internal_transmittance(f64::from(t)) as f32;
    Vec3::from(transmittance.map(one))
}

/// Cluster ranges of parts, in index order; those that touch are one, so that runs continue from part to part.
fn joined_ranges<'p>(parts: impl Iterator<Item = &'p Part>) -> Vec<Range<usize>> {
    let mut ranges: Vec<Range<usize>> = parts.map(|p| p.clusters.clone()).collect();
    ranges.sort_by_key(|range| range.start);
    ranges.dedup_by(|next, before| {
        let touches = before.end == next.start;
        if touches {
            before.end = next.end;
        }
        touches
    });
    ranges
}

impl Surface {
    fn kind(&self, colours: bool) -> Kind {
        Kind {
            colours,
            normal_map: self.normal_map.is_some(),
            cut_out: self.cutoff.is_some(),
            diffuse_map: self.diffuse_map.is_some(),
            specular_map: self.specular_map.is_some(),
            emissive_map: self.emissive_map.is_some(),
        }
    }
}
