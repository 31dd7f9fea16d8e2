//! Skins at rest: each vertex goes with its joints, by the sum of weight x joint x inverse bind matrix.

use glam::{DAffine3, DMat3, DMat4, DVec3};

use crate::scene::gltf::buffers::Buffers;
use crate::scene::gltf::faces::Faces;
use crate::scene::gltf::item::Item;
use crate::scene::gltf::mesh::Primitive;
use crate::scene::gltf::nodes::Graph;

/// Inverse bind matrices that are read.
const MAX_JOINTS: usize = 1 << 16;

/// The joints of a skin: from the mesh's space to the file's.
pub struct Skin(Vec<DAffine3>);

impl Skin {
    /// Reads skin number `number`.
    pub fn read(
        root: Item<'_>,
        number: usize,
        graph: &Graph,
        buffers: &Buffers<'_>,
    ) -> Result<Self, String> {
        let skin = root.get("skins").at(number);
        let joints = skin.get("joints").items();
        let count = joints.len();
        if count == 0 {
            return Err("it has no joints".to_owned());
        }
        let binds = match skin.get("inverseBindMatrices") {
            given if given.exists() => {
                let number = given.index().ok_or("its matrices are no accessor")?;
                let accessor = buffers.accessor(number, MAX_JOINTS)?;
                if accessor.width != 16 || accessor.count < count {
                    return Err("it has too few inverse bind matrices".to_owned());
                }
                buffers.floats::<16>(&accessor)?
            }
            _ => vec![DMat4::IDENTITY.as_mat4().to_cols_array(); count],
        };
        let joint = |(joint, bind): (Item<'_>, [f32; 16])| {
            let file_from_joint = graph.file_from_node(joint.index()?)?;
            let joint_from_mesh = DMat4::from_cols_array(&bind.map(f64::from));
            let all = file_from_joint * DAffine3::from_mat4(joint_from_mesh);
            all.is_finite().then_some(all)
        };
        let all: Option<Vec<DAffine3>> = joints.zip(binds).map(joint).collect();
        all.map(Self)
            .ok_or("a joint has no valid transform".to_owned())
    }

    /// Moves the vertices of a primitive to the file's space, relative to the point that is returned.
    pub fn pose(&self, primitive: &mut Primitive<'_, '_>, faces: &mut Faces) -> Option<DVec3> {
        let sets = primitive.influences(faces.positions.len());
        if sets.is_empty() {
            return None;
        }
        let origin = self.0[0].translation.round();
        let mut is_mirrored = false;
        for vertex in 0..faces.positions.len() {
            let set = sets.iter().map(|set| set[vertex]);
            let blend = self.blend(set);
            let position = DVec3::from(faces.positions[vertex].map(f64::from));
            let moved = blend.transform_point3(position) - origin;
            faces.positions[vertex] = moved.as_vec3().into();
            is_mirrored |= blend.matrix3.determinant() < 0.0;
            if let Some(normals) = &mut faces.normals {
                let normal = DVec3::from(normals[vertex].map(f64::from));
                let moved = cofactor(blend.matrix3) * normal;
                normals[vertex] = moved.normalize_or_zero().as_vec3().into();
            }
        }
        faces.tangents = None;
        if is_mirrored {
            faces.indices.chunks_exact_mut(3).for_each(|t| t.swap(1, 2));
        }
        Some(origin)
    }

    /// The weighted sum of the joints of a vertex; the first joint if its weights are not valid.
    fn blend(&self, sets: impl Iterator<Item = ([u32; 4], [f32; 4])>) -> DAffine3 {
        let (mut matrix, mut translation, mut sum) = (DMat3::ZERO, DVec3::ZERO, 0.0);
        for (joints, weights) in sets {
            for (joint, weight) in joints.into_iter().zip(weights) {
                let joint = self.0.get(joint as usize);
                let weight = f64::from(weight);
                let Some(joint) = joint.filter(|_| weight > 0.0 && weight.is_finite()) else {
                    continue;
                };
                matrix += joint.matrix3 * weight;
                translation += joint.translation * weight;
                sum += weight;
            }
        }
        if sum > 0.0 {
            DAffine3::from_mat3_translation(matrix * (1.0 / sum), translation / sum)
        } else {
            self.0[0]
        }
    }
}

/// The matrix for normals, up to a positive factor: it exists for flat transforms too.
fn cofactor(m: DMat3) -> DMat3 {
    let [x, y, z] = [m.x_axis, m.y_axis, m.z_axis];
    let sign = if m.determinant() < 0.0 { -1.0 } else { 1.0 };
    DMat3::from_cols(sign * y.cross(z), sign * z.cross(x), sign * x.cross(y))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_blend_and_need_not_sum_to_one() {
        let joints = [DVec3::X, DVec3::Y].map(DAffine3::from_translation);
        let skin = Skin(joints.to_vec());
        let blend = |joints, weights| {
            let set = std::iter::once((joints, weights));
            skin.blend(set).transform_point3(DVec3::ZERO)
        };
        let none = [0; 4];
        assert_eq!(
            blend([0, 1, 0, 0], [1.0, 1.0, 0.0, 0.0]),
            DVec3::new(0.5, 0.5, 0.0)
        );
        assert_eq!(blend([1, 0, 0, 0], [0.25, 0.0, 0.0, 0.0]), DVec3::Y);
        assert_eq!(blend(none, [0.0; 4]), DVec3::X, "without weights");
        assert_eq!(blend([9; 4], [f32::NAN; 4]), DVec3::X, "without joints");
    }

    #[test]
    fn normals_stay_perpendicular() {
        let m = DMat3::from_diagonal(DVec3::new(2.0, 1.0, -1.0));
        let slope = cofactor(m) * DVec3::new(1.0, 1.0, 0.0);
        assert_eq!(slope.dot(m * DVec3::new(1.0, -1.0, 0.0)), 0.0);
        assert!(slope.x > 0.0, "and keep their side");
    }
}
