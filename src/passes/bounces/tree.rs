//! The bounding volume hierarchy of the scene on the device: two images of 32-bit words, see `include/bvh.glsl`, and a table of the
//! triangles that emit light, see `include/emitters.glsl`.

use std::thread;

use glam::{DVec3, Vec2, Vec3};

use crate::daylight::colour::luminance;
use crate::daylight::glass;
use crate::gpu::{Format, Image, ImageDesc, Pass, Recorder, Result, Sampler, upload_texture};
use crate::passes::bounces::shared_exponent;
use crate::passes::bounces::wide::{Wide, WideNode};
use crate::passes::{glass_index, kilo};
use crate::scene::{Emitter, Emitters, Mean, Reflectances, Scene, Triangle};

/// Nodes and triangles in a row of their images; the rows are longer if there would be too many.
const COLUMNS: usize = 1024;

/// Constants of pipelines that trace rays. Scenes of about one size have the same, so that what is compiled for one serves the others.
pub type RayConstants = [(&'static str, u32); 5];

/// What pipelines that trace rays are created from. Unlike the hierarchy it may go to another thread.
#[derive(Debug, Clone, Copy)]
pub struct TreeFacts {
    node_columns: u32,
    triangle_columns: u32,
    most_steps: u32,
    /// Of the device, pixels: see `corner_error` in `include/bvh.glsl`.
    corner_step: f32,
    emitter_columns: u32,
    is_emissive: bool,
}

impl TreeFacts {
    /// Constants of pipelines that trace rays.
    pub fn constants(&self) -> RayConstants {
        [
            glass_index(),
            ("NODE_COLUMNS", self.node_columns),
            ("TRIANGLE_COLUMNS", self.triangle_columns),
            ("MOST_STEPS", self.most_steps),
            ("CORNER_STEP", self.corner_step.to_bits()),
        ]
    }

    /// Constants of pipelines that trace rays and sample the emitters.
    pub fn constants_with_emitters(&self) -> [(&'static str, u32); 7] {
        let [index, nodes, triangles, steps, corners] = self.constants();
        [
            index,
            nodes,
            triangles,
            steps,
            corners,
            ("EMITS", self.is_emissive.into()),
            ("EMITTER_COLUMNS", self.emitter_columns),
        ]
    }
}

/// The hierarchy in images.
pub struct Tree {
    nodes: Image,
    triangles: Image,
    numbers: Vec<u32>,
    emitters: Image,
    facts: TreeFacts,
}

impl Tree {
    /// Uploads the hierarchy of all surfaces of a scene; `recorder` must be recording.
    ///
    /// # Errors
    /// Fails when the device is out of memory or cannot hold images of that size.
    pub fn new(recorder: &mut Recorder, scene: &Scene) -> Result<Self> {
        let bvh = scene.hierarchy();
        let wide = Wide::of(&bvh);
        let most_rows = recorder.context().summary().max_image_edge as usize;
        let (nodes, node_columns) = upload(
            recorder,
            "hierarchy: nodes",
            &wide.nodes,
            most_rows,
            WideNode::words,
        )?;
        let reflectances = Reflectances::new(scene);
        let (triangles, triangle_columns) = upload(
            recorder,
            "hierarchy: triangles",
            &wide.triangles,
            most_rows,
            |position| {
                let triangle = &bvh.triangles()[*position as usize];
                triangle_words(triangle, &reflectances.of(triangle.number))
            },
        )?;
        let number = |position: &u32| bvh.triangles()[*position as usize].number;
        let numbers: Vec<u32> = wide.triangles.iter().map(number).collect();
        let emitters = Emitters::of(scene, &reflectances, |rgb| luminance(rgb.as_dvec3()));
        let positions = positions(&numbers, &emitters);
        let rows = emitter_rows(&emitters, &positions);
        let (table, emitter_columns) =
            upload(recorder, "emitters", &rows, most_rows, |row| [*row])?;
        Ok(Self {
            nodes,
            triangles,
            numbers,
            emitters: table,
            facts: TreeFacts {
                node_columns,
                triangle_columns,
                most_steps: most_steps(wide.nodes.len() + bvh.triangles().len()),
                corner_step: recorder.context().summary().corner_step(),
                emitter_columns,
                is_emissive: !emitters.list().is_empty(),
            },
        })
    }

    /// What pipelines that trace rays are created from.
    pub fn facts(&self) -> &TreeFacts {
        &self.facts
    }

    /// Whether any triangle emits light.
    pub fn is_emissive(&self) -> bool {
        self.facts.is_emissive
    }

    /// For each triangle of the image, its number in the scene.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// Binds the images to a pass.
    pub fn bound_to<'r>(&'r self, pass: Pass<'r>) -> Pass<'r> {
        pass.sample("bvh_nodes", &self.nodes, Sampler::Nearest)
            .sample("bvh_triangles", &self.triangles, Sampler::Nearest)
    }

    /// Binds the images and the emitters to a pass.
    pub fn bound_with_emitters<'r>(&'r self, pass: Pass<'r>) -> Pass<'r> {
        self.bound_to(pass)
            .sample("emitters", &self.emitters, Sampler::Nearest)
    }
}

/// Most steps of a ray in a hierarchy of so many nodes and triangles: no fewer, and one of few numbers.
fn most_steps(elements: usize) -> u32 {
    let classes = [16, 20, 24].map(|bits| 1 << bits);
    let of_all = classes.into_iter().find(|most| elements <= *most);
    of_all.unwrap_or(elements) as u32
}

/// For each triangle of the scene its position in the image; empty if none is asked for.
fn positions(numbers: &[u32], emitters: &Emitters) -> Vec<u32> {
    if emitters.list().is_empty() {
        return Vec::new();
    }
    let mut positions = vec![0; numbers.len()];
    for (position, number) in (0..).zip(numbers) {
        positions[*number as usize] = position;
    }
    positions
}

/// The table of the emitters: their number and the sum of area times luminance, kcd, then for each the position of its triangle and the share
/// of power up to it.
fn emitter_rows(emitters: &Emitters, positions: &[u32]) -> Vec<[u32; 4]> {
    let total = kilo(DVec3::splat(emitters.total())).x;
    let header = [emitters.list().len() as u32, total.to_bits(), 0, 0];
    let row = |emitter: &Emitter| {
        let up_to = (emitter.up_to as f32).to_bits();
        [positions[emitter.triangle as usize], up_to, 0, 0]
    };
    [header]
        .into_iter()
        .chain(emitters.list().iter().map(row))
        .collect()
}

/// Rows of an image for so many rows of elements: never a power of two, for which lavapipe compiles the shaders again.
fn rows_of(needed: usize) -> usize {
    let rows = needed.max(3);
    if rows.is_power_of_two() {
        rows + 1
    } else {
        rows
    }
}

/// Uploads elements of `N` texels each, in rows, and returns the number of elements in a row. One of `most_rows` is left for [`rows_of`].
fn upload<T: Sync, const N: usize>(
    recorder: &mut Recorder,
    name: &str,
    elements: &[T],
    most_rows: usize,
    words: impl Fn(&T) -> [[u32; 4]; N] + Sync,
) -> Result<(Image, u32)> {
    let columns = COLUMNS * elements.len().div_ceil(COLUMNS * (most_rows - 1)).max(1);
    let rows = rows_of(elements.len().div_ceil(columns));
    let mut table = vec![[[0u32; 4]; N]; rows * columns];
    let threads = thread::available_parallelism().map_or(1, usize::from);
    let share = elements.len().div_ceil(threads).max(1);
    thread::scope(|scope| {
        let chunks = table.chunks_mut(share).zip(elements.chunks(share));
        for (target, source) in chunks {
            let words = &words;
            scope.spawn(move || {
                for (target, element) in target.iter_mut().zip(source) {
                    *target = words(element);
                }
            });
        }
    });
    let size = [(columns * N) as u32, rows as u32];
    let desc = ImageDesc::texture(name, Format::R32G32B32A32_UINT, size);
    let words = bytemuck::cast_slice(table.as_flattened());
    let image = upload_texture(recorder, &desc, &[words])?;
    Ok((image, columns as u32))
}

fn texel(v: Vec3, word: u32) -> [u32; 4] {
    let [x, y, z] = v.to_array().map(f32::to_bits);
    [x, y, z, word]
}

/// Mark of a pane of glass in the word of its opacity.
const PANE: u32 = 1 << 31;

/// Mark of a pane that is a slab: only the face where light enters counts.
const SLAB: u32 = 1 << 30;

/// Bits of the opacity in the word of a cut-out, and of each of the two octahedral coordinates of its normal that follow.
const OPACITY_BITS: u32 = 8;
const NORMAL_BITS: u32 = 11;

/// The normal in the word of a cut-out (Cigolle et al. 2014), for `octahedral_decode`.
fn normal_word(n: Vec3) -> u32 {
    let p = n.truncate() / n.abs().element_sum();
    let sign = |v: f32| if v >= 0.0 { 1.0 } else { -1.0 };
    let folded = Vec2::new((1.0 - p.y.abs()) * sign(p.x), (1.0 - p.x.abs()) * sign(p.y));
    let most = (1 << NORMAL_BITS) - 1;
    let bits = |v: f32| ((0.5 * v + 0.5).clamp(0.0, 1.0) * most as f32).round() as u32;
    let at = if n.z >= 0.0 { p } else { folded };
    (bits(at.x) | bits(at.y) << NORMAL_BITS) << OPACITY_BITS
}

/// The word of a pane of glass: rays have no colour, so it is that of the luminance.
fn pane_word((normal_transmittance, is_slab): ([f32; 3], bool)) -> u32 {
    let grey = luminance(Vec3::from(normal_transmittance).as_dvec3());
    let slab = if is_slab { SLAB } else { 0 };
    PANE | slab | (glass::internal_transmittance(grey) * 65535.0).round() as u32
}

fn triangle_words(triangle: &Triangle, mean: &Mean) -> [[u32; 4]; 3] {
    let opacity = match mean.glass {
        Some(pane) => pane_word(pane),
        None => {
            let opacity = (mean.opacity.clamp(0.0, 1.0) * 255.0).round() as u32;
            opacity | mean.normal.map_or(0, normal_word)
        }
    };
    let emission = kilo(Vec3::from(mean.emission).as_dvec3());
    let [r, g, b] = mean.diffuse.map(|v| v.clamp(0.0, 1.0));
    let bits = |v: f32, most: u32| (v * most as f32).round() as u32;
    let albedo = bits(r, 2047) | bits(g, 2047) << 11 | bits(b, 1023) << 22;
    [
        texel(triangle.corner, albedo),
        texel(triangle.edge1, shared_exponent::pack(emission)),
        texel(triangle.edge2, opacity),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::passes::surfaces::gbuffer::unpack_normal;

    #[test]
    fn shaders_of_scenes_of_one_class_are_the_same() {
        for elements in [0, 1, 1023, 40_000, 1 << 16] {
            assert_eq!(most_steps(elements), 1 << 16);
        }
        for elements in [(1 << 16) + 1, 1 << 20, (1 << 24) + 1, 1 << 30] {
            assert!(most_steps(elements) as usize >= elements);
        }
        for needed in 0..16_384 {
            let rows = rows_of(needed);
            assert!(rows >= needed && !rows.is_power_of_two() && rows < 16_384);
        }
    }

    #[test]
    fn normals_of_cut_outs_are_precise_to_an_eighth_of_a_degree_and_leave_the_marks_alone() {
        let normals = (0..500).map(|i| {
            let [u, v] = [0.754_877_7, 0.569_840_3].map(|step: f32| (step * i as f32).fract());
            let (z, turn) = (2.0 * u - 1.0, std::f32::consts::TAU * v);
            let radius = (1.0 - z * z).sqrt();
            Vec3::new(radius * turn.cos(), radius * turn.sin(), z)
        });
        for n in normals.chain([Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::Z, Vec3::NEG_Z]) {
            let word = normal_word(n);
            assert_eq!(word & (PANE | SLAB | 0xff), 0);
            let half = |shift: u32| {
                let bits = word >> (OPACITY_BITS + shift) & ((1 << NORMAL_BITS) - 1);
                let v = bits as f32 / ((1 << NORMAL_BITS) - 1) as f32 * 2.0 - 1.0;
                ((v * 32767.0).round() as i16).cast_unsigned()
            };
            let decoded = Vec3::from(unpack_normal([half(0), half(NORMAL_BITS)]));
            let off = decoded.angle_between(n).to_degrees();
            assert!(off < 0.125, "{n}: {off}");
        }
    }
}
