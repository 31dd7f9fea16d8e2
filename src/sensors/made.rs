//! What the grids of made sensors have in common.

use glam::Vec2;

use crate::scene::Scene;

/// Part of the spacing of made sensors by which it may be exceeded: lengths of models are rounded.
const ROUNDING: f32 = 0.01;

/// Made sensors lie on tenths of a millimetre, for numbers that are easy to read.
pub(super) const DIGITS: f32 = 1e4;

/// Numbers of made sensors along the sides of an area, metres, at most `spacing` apart.
pub(super) fn counts(size: Vec2, spacing: f32) -> Vec2 {
    (size / spacing - ROUNDING).ceil().max(Vec2::ONE)
}

/// The first name that no material has, and the names of all.
pub(super) fn unknown_material(scene: &Scene, asked: &[String]) -> Option<(String, String)> {
    let names = || scene.materials.iter().map(|m| m.name.as_str());
    let unknown = |name: &&String| !names().any(|known| known == name.as_str());
    let name = asked.iter().find(unknown)?;
    Some((name.clone(), names().collect::<Vec<_>>().join(", ")))
}
