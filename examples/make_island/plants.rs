//! Vegetation: instances of trees, shrubs and tufts of grass.

use glam::{Affine3A, Quat, Vec2, Vec3, vec2, vec3};

use crate::Palette;
use crate::glb::{Glb, Node};
use crate::mesh::Mesh;
use crate::noise::{Chance, fractal, smoothstep};
use crate::terrain::{COTTAGE, TEMPLE, height, is_free, slope};
use crate::trees::{forest, tuft};

/// Mesh indices per species.
struct Species([Vec<usize>; 5]);

/// The plants placed so far, so that new ones do not overlap them.
struct Garden<'g> {
    glb: &'g mut Glb,
    species: Species,
    taken: Vec<(Vec2, f32)>,
    chance: Chance,
}

const BROADLEAF: usize = 0;
const PINE: usize = 1;
const CYPRESS: usize = 2;
const PALM: usize = 3;
const SHRUB: usize = 4;

impl Garden<'_> {
    /// Adds a plant if there is room; `room` is the radius it needs, metres.
    fn plant(&mut self, species: usize, p: Vec2, room: f32, size: f32) -> bool {
        let crowded = self.taken.iter().any(|(q, r)| (p - *q).length() < room + r);
        if crowded {
            return false;
        }
        self.taken.push((p, room));
        let shapes = &self.species.0[species];
        let shape = shapes[(self.chance.unit() * shapes.len() as f32) as usize % shapes.len()];
        self.glb.node(&Node {
            mesh: shape,
            at: vec3(p.x, height(p) - 0.12, p.y),
            turn: self.chance.within(0.0, std::f32::consts::TAU),
            scale: size * self.chance.within(0.82, 1.18),
        });
        true
    }

    /// Tries random positions until the requested number of plants is placed.
    fn scatter(
        &mut self,
        species: usize,
        count: usize,
        room: f32,
        size: f32,
        fits: impl Fn(Vec2) -> bool,
    ) {
        let (mut grown, mut tries) = (0, 0);
        while grown < count && tries < 40_000 {
            tries += 1;
            let p = vec2(
                self.chance.within(-70.0, 70.0),
                self.chance.within(-55.0, 55.0),
            );
            if is_free(p, 0.4 * room) && fits(p) && self.plant(species, p, room, size) {
                grown += 1;
            }
        }
    }
}

/// Whether a point is wooded; woods form patches.
fn wooded(p: Vec2) -> bool {
    fractal(p / 26.0, 3, 0, 71) > -0.06
}

/// Whether a point lies outside the views of temple, cottage and sea, which stay open.
fn open_view(p: Vec2) -> bool {
    let temple = p - vec2(TEMPLE.x, TEMPLE.z);
    let before_cottage = p.x > COTTAGE.x - 11.0 && p.x < COTTAGE.x + 8.0 && p.y > COTTAGE.z;
    let below_temple = p.x < -8.0 && p.x > -34.0 && p.y > -6.0;
    (temple / vec2(18.0, 14.0)).length() > 1.0 && !before_cottage && !below_temple
}

pub fn add(glb: &mut Glb, palette: &Palette) {
    let species = forest().map(|shapes| {
        let mesh = |tree: &crate::trees::Tree, glb: &mut Glb| {
            glb.mesh(
                "tree",
                &[(palette.bark, &tree.wood), (palette.leaves, &tree.leaves)],
            )
        };
        shapes.iter().map(|tree| mesh(tree, glb)).collect()
    });
    let mut garden = Garden {
        glb,
        species: Species(species),
        taken: Vec::new(),
        chance: Chance::new(2024),
    };
    let avenue = [
        (8.0, 28.6),
        (7.2, 21.5),
        (1.0, 15.8),
        (6.4, 10.0),
        (-0.2, 4.6),
        (-5.8, -0.6),
    ];
    for (x, z) in avenue {
        garden.plant(CYPRESS, vec2(x, z), 1.0, 1.0);
    }
    for (x, z) in [(11.6, 13.6), (24.4, 14.6), (25.6, 19.4)] {
        garden.plant(BROADLEAF, vec2(x, z), 2.2, 1.0);
    }
    for (x, z) in [(-41.0, 8.0), (-12.0, -15.5), (-40.5, -11.0)] {
        garden.plant(PINE, vec2(x, z), 2.5, 1.05);
    }
    garden.scatter(PALM, 11, 1.6, 1.0, |p| {
        height(p) < 3.4 && p.y > 4.0 && open_view(p)
    });
    garden.scatter(PINE, 17, 3.2, 1.0, |p| {
        height(p) > 4.5 && wooded(p) && open_view(p)
    });
    garden.scatter(BROADLEAF, 21, 2.6, 0.95, |p| {
        height(p) > 2.6 && wooded(p) && open_view(p)
    });
    garden.scatter(CYPRESS, 8, 1.3, 1.1, |p| {
        height(p) > 5.0 && wooded(p) && open_view(p)
    });
    garden.scatter(SHRUB, 90, 0.8, 1.0, |p| {
        height(p) > 1.9 && !(p.x > 8.0 && p.x < 22.0 && p.y > 24.0)
    });
    grass(garden.glb, palette, &mut garden.chance);
}

/// Tufts of grass, merged into patches.
fn grass(glb: &mut Glb, palette: &Palette, chance: &mut Chance) {
    let shapes: Vec<Mesh> = (0..4).map(|seed| tuft(300 + seed)).collect();
    let mut patches: std::collections::BTreeMap<(i32, i32), Mesh> = Default::default();
    let mut grown = 0;
    while grown < 2600 {
        let p = vec2(chance.within(-62.0, 62.0), chance.within(-46.0, 46.0));
        let density = smoothstep(-0.35, 0.4, fractal(p / 9.0, 3, 0, 81));
        if height(p) < 1.7 || !is_free(p, 0.0) || chance.unit() > density {
            continue;
        }
        let turn = Quat::from_rotation_arc(Vec3::Y, slope(p))
            * Quat::from_rotation_y(chance.within(0.0, 6.3));
        let size = Vec3::splat(chance.within(0.6, 1.35));
        let at = vec3(p.x, height(p) - 0.02, p.y);
        let cell = ((p.x / 24.0).floor() as i32, (p.y / 24.0).floor() as i32);
        let place = Affine3A::from_scale_rotation_translation(size, turn, at);
        patches
            .entry(cell)
            .or_default()
            .append(&shapes[grown % 4], place);
        grown += 1;
    }
    for patch in patches.values() {
        let mesh = glb.mesh("grass", &[(palette.leaves, patch)]);
        glb.placed(mesh, Affine3A::IDENTITY);
    }
}
