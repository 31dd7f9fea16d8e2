//! Primitives of glTF meshes: triangle lists, strips and fans, with vertex attributes.

use glam::{Vec2, Vec3};

use crate::scene::gltf::accessor::Accessor;
use crate::scene::gltf::buffers::Buffers;
use crate::scene::gltf::faces::Faces;
use crate::scene::gltf::item::Item;
use crate::scene::gltf::material::Surface;
use crate::scene::losses::Losses;

/// Topology of a primitive.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Mode {
    Triangles,
    Strip,
    Fan,
}

/// A primitive, and what its losses are told to.
pub struct Primitive<'r, 'j> {
    pub item: Item<'j>,
    /// Its path in the JSON.
    pub place: &'r str,
    pub buffers: &'r Buffers<'j>,
    pub losses: &'r mut Losses,
    /// Corners that may still be read.
    pub limit: usize,
}

impl Primitive<'_, '_> {
    /// Whether it has triangles, as opposed to points and lines.
    pub fn has_faces(&self) -> bool {
        !matches!(self.item.get("mode").index(), Some(0..=3))
    }

    /// Reads it. An attribute that is not valid is left out, and so are triangles of vertices that do not exist.
    pub fn faces(&mut self, surface: Surface) -> Result<Faces, String> {
        let mode = match self.item.get("mode").index_or(4) {
            Some(4) => Mode::Triangles,
            Some(5) => Mode::Strip,
            Some(6) => Mode::Fan,
            _ => return Err("it has an unknown mode".to_owned()),
        };
        let positions = self.positions()?;
        let count = positions.len();
        let indices = match self.item.get("indices") {
            given if given.exists() => self.indices(given)?,
            _ => (0..count as u32).collect(),
        };
        let mut indices = as_triangles(indices, mode);
        self.drop_dangling(&mut indices, count);
        let mut faces = Faces {
            indices,
            positions,
            normals: self.attribute("NORMAL", count),
            tangents: None,
            texcoords: Vec::new(),
            colours: self.colours(count),
        };
        if surface.material.has_normal_map {
            faces.tangents = self.attribute("TANGENT", count);
        }
        let set = format!("TEXCOORD_{}", surface.texcoord_set);
        faces.texcoords = self.attribute(&set, count).unwrap_or_default();
        for uv in &mut faces.texcoords {
            let transformed = surface
                .material
                .texture_from_mesh
                .transform_point2(Vec2::from(*uv));
            *uv = if transformed.is_finite() {
                transformed.into()
            } else {
                [0.0; 2]
            };
        }
        Ok(faces)
    }

    fn positions(&self) -> Result<Vec<[f32; 3]>, String> {
        let accessor = self.item.get("attributes").get("POSITION").index();
        let accessor = self
            .buffers
            .accessor(accessor.ok_or("it has no positions")?, self.limit)?;
        let draco = self.item.extension("KHR_draco_mesh_compression");
        if accessor.view.is_none() && draco.exists() {
            let what = "Draco compression is not read, export or transform it without";
            return Err(what.to_owned());
        }
        if accessor.view.is_none() && !accessor.sparse.exists() {
            return Err("its positions have no data".to_owned());
        }
        if accessor.width != 3 {
            return Err("its positions are no vectors of three".to_owned());
        }
        self.buffers.floats(&accessor)
    }

    fn indices(&self, given: Item<'_>) -> Result<Vec<u32>, String> {
        let number = given.index().ok_or("its indices are no accessor")?;
        let accessor = self.buffers.accessor(number, self.limit)?;
        let indices = self.buffers.integers::<1>(&accessor)?;
        Ok(indices.into_iter().map(|[i]| i).collect())
    }

    fn drop_dangling(&mut self, indices: &mut Vec<u32>, count: usize) {
        let in_range = |i: &u32| (*i as usize) < count;
        if indices.iter().all(in_range) {
            return;
        }
        let before = indices.len();
        let kept = indices.chunks_exact(3).filter(|t| t.iter().all(in_range));
        *indices = kept.flatten().copied().collect();
        let place = self.place;
        let what = "triangles of vertices that do not exist left out";
        self.losses
            .add_many(what, (before - indices.len()) / 3, || {
                format!("{place} has {count} vertices")
            });
    }

    /// Reads an attribute; `None` if it is absent, or (with a loss) not valid.
    fn attribute<const N: usize>(&mut self, name: &str, count: usize) -> Option<Vec<[f32; N]>> {
        let read = |accessor: &Accessor<'_>| self.buffers.floats::<N>(accessor);
        self.valid(name, count, read)
    }

    fn valid<T>(
        &mut self,
        name: &str,
        count: usize,
        read: impl FnOnce(&Accessor<'_>) -> Result<T, String>,
    ) -> Option<T> {
        let given = self.item.get("attributes").get(name);
        if !given.exists() {
            return None;
        }
        let accessor = || {
            let number = given.index().ok_or("it is no accessor")?;
            let accessor = self.buffers.accessor(number, count)?;
            if accessor.count != count {
                return Err(format!("it has {} elements for {count}", accessor.count));
            }
            read(&accessor)
        };
        let result: Result<T, String> = accessor();
        result
            .map_err(|why| {
                let place = self.place;
                let what = "attributes that are not valid left out";
                self.losses
                    .add(what, || format!("{place}.attributes.{name}: {why}"));
            })
            .ok()
    }

    /// Linear RGBA; alpha is optional.
    fn colours(&mut self, count: usize) -> Option<Vec<[f32; 4]>> {
        let mut has_alpha = false;
        let buffers = self.buffers;
        let colours = self.valid("COLOR_0", count, |accessor| {
            has_alpha = accessor.width == 4;
            // Whole numbers are always meant as fractions; some exporters forget to say so.
            let accessor = Accessor {
                normalised: true,
                ..*accessor
            };
            buffers.floats::<4>(&accessor)
        });
        colours.map(|mut colours| {
            for [r, g, b, a] in &mut colours {
                *a = if has_alpha { *a } else { 1.0 };
                for v in [r, g, b, a] {
                    *v = if v.is_finite() { *v } else { 1.0 };
                }
            }
            colours
        })
    }

    /// Joints and weights of each vertex, of all sets: up to four of each a set.
    pub fn influences(&mut self, count: usize) -> Vec<Vec<([u32; 4], [f32; 4])>> {
        let mut sets = Vec::new();
        for set in 0..MOST_SETS {
            let buffers = self.buffers;
            let joints = self.valid(&format!("JOINTS_{set}"), count, |a| {
                buffers.integers::<4>(a)
            });
            let weights = self.attribute::<4>(&format!("WEIGHTS_{set}"), count);
            let Some((joints, weights)) = joints.zip(weights) else {
                break;
            };
            sets.push(joints.into_iter().zip(weights).collect());
        }
        sets
    }

    /// Adds the morph targets with their weights.
    pub fn morph(&mut self, faces: &mut Faces, weights: &[f64]) {
        let targets = self.item.get("targets").items().zip(weights).enumerate();
        for (i, (target, weight)) in targets.filter(|(_, (_, weight))| **weight != 0.0) {
            let mut moved = false;
            for name in ["POSITION", "NORMAL"] {
                let values = if name == "POSITION" {
                    Some(&mut faces.positions)
                } else {
                    faces.normals.as_mut()
                };
                let (Some(values), true) = (values, target.get(name).exists()) else {
                    continue;
                };
                let read = || {
                    let number = target.get(name).index().ok_or("no accessor")?;
                    let accessor = self.buffers.accessor(number, values.len())?;
                    let moves = self.buffers.floats::<3>(&accessor)?;
                    let fits = moves.len() == values.len();
                    if fits {
                        Ok(moves)
                    } else {
                        Err("too few elements".to_owned())
                    }
                };
                match read() {
                    Ok(moves) => add(values, &moves, *weight as f32),
                    Err(why) => {
                        let place = self.place;
                        let what = "morph targets that are not valid left out";
                        self.losses
                            .add(what, || format!("{place}.targets[{i}].{name}: {why}"));
                    }
                }
                moved = true;
            }
            if moved {
                // They would belong to the shape before.
                faces.tangents = None;
            }
        }
        if let Some(normals) = &mut faces.normals {
            for normal in normals {
                *normal = Vec3::from(*normal).normalize_or_zero().into();
            }
        }
    }
}

/// Sets of joints and weights that are read.
const MOST_SETS: usize = 4;

fn add(values: &mut [[f32; 3]], moves: &[[f32; 3]], weight: f32) {
    for (value, by) in values.iter_mut().zip(moves) {
        *value = (Vec3::from(*value) + weight * Vec3::from(*by)).into();
    }
}

fn as_triangles(indices: Vec<u32>, mode: Mode) -> Vec<u32> {
    match mode {
        Mode::Strip => indices
            .windows(3)
            .enumerate()
            // Every second triangle of a strip has the opposite winding.
            .flat_map(|(i, w)| {
                if i % 2 == 0 {
                    [w[0], w[1], w[2]]
                } else {
                    [w[1], w[0], w[2]]
                }
            })
            .collect(),
        Mode::Fan => match indices.split_first() {
            Some((hub, rim)) => rim.windows(2).flat_map(|w| [*hub, w[0], w[1]]).collect(),
            None => indices,
        },
        Mode::Triangles => {
            let mut indices = indices;
            indices.truncate(indices.len() / 3 * 3);
            indices
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans_keep_their_winding() {
        let strip = as_triangles(vec![0, 1, 2, 3, 4], Mode::Strip);
        assert_eq!(strip, [0, 1, 2, 2, 1, 3, 2, 3, 4]);
        let fan = as_triangles(vec![9, 1, 2, 3], Mode::Fan);
        assert_eq!(fan, [9, 1, 2, 9, 2, 3]);
        assert!(as_triangles(vec![], Mode::Fan).is_empty());
        assert_eq!(as_triangles(vec![0, 1, 2, 3], Mode::Triangles), [0, 1, 2]);
    }
}
