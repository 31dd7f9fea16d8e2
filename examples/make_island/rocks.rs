//! Boulders: noisy balls along the shore and on the hill.

use glam::{Affine3A, Quat, Vec3, vec2, vec3};

use crate::Palette;
use crate::glb::Glb;
use crate::mesh::{Mesh, point};
use crate::noise::{Chance, turbulence};
use crate::terrain::{height, slope};

fn boulder(seed: u32) -> Mesh {
    let (rows, columns) = (13, 21);
    let place = |row: usize, column: usize| {
        let polar = std::f32::consts::PI * row as f32 / (rows - 1) as f32;
        let turn = -std::f32::consts::TAU * (column % (columns - 1)) as f32 / (columns - 1) as f32;
        let out = vec3(
            polar.sin() * turn.cos(),
            -polar.cos(),
            polar.sin() * turn.sin(),
        );
        let p = vec2(out.x + 1.7 * out.y, out.z - 0.6 * out.y);
        let r = 0.72 + 0.75 * turbulence(p * 1.3, 4, 0, seed)
            - 0.2 * (out.x * 5.0 + seed as f32).sin().max(0.6);
        out * r * vec3(1.0, 0.72, 1.0)
    };
    let mut mesh = Mesh::default();
    mesh.grid(rows, columns, |row, column| {
        let p = place(row, column);
        let up = place((row + 1).min(rows - 1), column) - place(row.saturating_sub(1), column);
        let right = place(row, (column + 1) % (columns - 1))
            - place(row, (column + columns - 2) % (columns - 1));
        let normal = right.cross(up).normalize_or(p);
        point(
            p,
            if normal.dot(p) < 0.0 { -normal } else { normal },
            vec2(column as f32 * 0.15, row as f32 * 0.15),
        )
    });
    mesh
}

pub fn add(glb: &mut Glb, palette: &Palette) {
    let shapes: Vec<usize> = (0..4)
        .map(|seed| glb.mesh("boulder", &[(palette.rock, &boulder(70 + seed))]))
        .collect();
    let mut chance = Chance::new(91);
    let mut placed = 0;
    while placed < 46 {
        let p = vec2(chance.within(-75.0, 75.0), chance.within(-58.0, 58.0));
        let h = height(p);
        let by_shore = (-1.1..0.7).contains(&h) && p.y < 26.0;
        let on_hill = h > 6.0 && slope(p).y < 0.8;
        if !by_shore && !on_hill {
            continue;
        }
        let size = chance.within(0.35, if by_shore { 1.5 } else { 1.2 }) * chance.within(0.7, 1.25);
        let turn = Quat::from_rotation_y(chance.within(0.0, 6.3))
            * Quat::from_rotation_x(chance.within(-0.4, 0.4));
        let at = vec3(p.x, h + 0.1 * size, p.y);
        let place = Affine3A::from_scale_rotation_translation(Vec3::splat(size), turn, at);
        glb.placed(shapes[placed % 4], place);
        placed += 1;
    }
}
