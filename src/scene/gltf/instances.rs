//! Instances of a node by EXT_mesh_gpu_instancing.

use glam::{DAffine3, DQuat, DVec3};

use crate::scene::gltf::buffers::Buffers;
use crate::scene::gltf::item::Item;

/// The transforms of EXT_mesh_gpu_instancing, at most `limit`.
pub fn transforms(
    buffers: &Buffers<'_>,
    attributes: Item<'_>,
    limit: usize,
) -> Result<Vec<DAffine3>, String> {
    fn column<const N: usize>(
        buffers: &Buffers<'_>,
        item: Item<'_>,
        limit: usize,
    ) -> Result<Option<Vec<[f64; N]>>, String> {
        if !item.exists() {
            return Ok(None);
        }
        let accessor = buffers.accessor(item.index().ok_or("no accessor")?, limit)?;
        let values = buffers.floats::<N>(&accessor)?;
        Ok(Some(values.into_iter().map(|v| v.map(f64::from)).collect()))
    }
    let translations = column::<3>(buffers, attributes.get("TRANSLATION"), limit)?;
    let rotations = column::<4>(buffers, attributes.get("ROTATION"), limit)?;
    let scales = column::<3>(buffers, attributes.get("SCALE"), limit)?;
    let counts = [
        translations.as_ref().map(Vec::len),
        rotations.as_ref().map(Vec::len),
        scales.as_ref().map(Vec::len),
    ];
    let mut given = counts.into_iter().flatten();
    let count = given.next().ok_or("no attribute is known")?;
    if given.any(|other| other != count) {
        return Err("its attributes differ in length".to_owned());
    }
    let of = |i: usize| {
        let rotation = rotations
            .as_ref()
            .map_or(DQuat::IDENTITY, |r| DQuat::from_array(r[i]));
        let is_unit = rotation.length() > 1e-6;
        DAffine3::from_scale_rotation_translation(
            scales.as_ref().map_or(DVec3::ONE, |s| DVec3::from(s[i])),
            if is_unit {
                rotation.normalize()
            } else {
                DQuat::IDENTITY
            },
            translations
                .as_ref()
                .map_or(DVec3::ZERO, |t| DVec3::from(t[i])),
        )
    };
    Ok((0..count).map(of).collect())
}
