//! Tree species: a grammar, turtle parameters and leaves for each.

use glam::{Vec2, Vec3, vec2, vec3};

use crate::lsystem::{Grammar, Leaf, Walk, walk};
use crate::mesh::Mesh;
use crate::noise::Chance;
use crate::textures::{BROAD, FROND, NEEDLE, SPRAY};

/// Wood and leaves.
pub struct Tree {
    pub wood: Mesh,
    pub leaves: Mesh,
}

/// Foliage of a species.
struct Foliage {
    /// Tile in the leaf atlas.
    tile: [Vec2; 2],
    /// Half size of a card, metres.
    size: f32,
    /// Cards per leaf position.
    cards: usize,
    /// Linear RGB factor on the atlas colours.
    tint: Vec3,
    /// 0: cards in random directions; 1: cards along their twigs.
    along: f32,
}

struct Species {
    grammar: Grammar,
    walk: Walk,
    foliage: Foliage,
}

/// An oak or olive: branches fork in threes into a round crown.
fn broadleaf() -> Species {
    Species {
        grammar: Grammar {
            axiom: "FFA",
            rules: &[
                (
                    'A',
                    &[
                        "!F[&FAL]/[&FAL]/[&!FAL]",
                        "!F[&FAL]/[&AL]/[&FAL]",
                        "!FF[&FAL]/[^FAL]",
                    ],
                ),
                ('F', &["F", "F", "F/"]),
            ],
            steps: 4,
        },
        walk: Walk {
            step: 0.72,
            shorter: 0.93,
            angle: 36.0,
            jitter: 12.0,
            radius: 0.20,
            thinner: 0.72,
            tropism: 0.05,
        },
        foliage: Foliage {
            tile: BROAD,
            size: 0.52,
            cards: 4,
            tint: vec3(0.95, 1.0, 0.9),
            along: 0.2,
        },
    }
}

/// An umbrella pine: a bare, leaning trunk and a flat dish of needles.
fn pine() -> Species {
    Species {
        grammar: Grammar {
            axiom: "FF/F/FFFA",
            rules: &[
                (
                    'A',
                    &[
                        "[&&!FB]/[&&!FB]/[&&!FFB]/[&!FB]/[&!FB]!FL",
                        "[&&!FFB]/[&&!FB]/[&&!FB]/[&!FB]!FL",
                    ],
                ),
                ('B', &["!F[+F!BL]/[-F!BL][^F!BL]L", "!F[+FBL]/[-FBL]L"]),
            ],
            steps: 5,
        },
        walk: Walk {
            step: 1.12,
            shorter: 0.82,
            angle: 35.0,
            jitter: 9.0,
            radius: 0.24,
            thinner: 0.70,
            tropism: 0.10,
        },
        foliage: Foliage {
            tile: NEEDLE,
            size: 0.56,
            cards: 3,
            tint: vec3(0.8, 1.0, 0.75),
            along: 0.35,
        },
    }
}

/// A cypress: a straight trunk with short twigs close to it.
fn cypress() -> Species {
    Species {
        grammar: Grammar {
            axiom: "FT",
            rules: &[(
                'T',
                &[
                    "!F[&FL]/[&FLFL]/[&FL]/[&FLFL]/[&FL]/T",
                    "!F[&FLFL]/[&FL]/[&FL]/[&FLFL]/[&FL]/T",
                ],
            )],
            steps: 14,
        },
        walk: Walk {
            step: 0.56,
            shorter: 0.955,
            angle: 44.0,
            jitter: 8.0,
            radius: 0.14,
            thinner: 0.88,
            tropism: 0.45,
        },
        foliage: Foliage {
            tile: SPRAY,
            size: 0.36,
            cards: 2,
            tint: vec3(0.62, 0.8, 0.6),
            along: 0.85,
        },
    }
}

/// A low shrub.
fn shrub() -> Species {
    Species {
        grammar: Grammar {
            axiom: "[&FA]/[&FA]/[&FA]/[&FA]FA",
            rules: &[('A', &["!F[&FL]/[&FL]/[&FL]L", "!F[&FL]/[&FL]AL"])],
            steps: 3,
        },
        walk: Walk {
            step: 0.24,
            shorter: 0.9,
            angle: 42.0,
            jitter: 12.0,
            radius: 0.03,
            thinner: 0.7,
            tropism: 0.1,
        },
        foliage: Foliage {
            tile: BROAD,
            size: 0.26,
            cards: 2,
            tint: vec3(0.85, 0.9, 0.55),
            along: 0.2,
        },
    }
}

impl Species {
    fn grow(&self, seed: u64) -> Tree {
        let mut chance = Chance::new(seed);
        let word = self.grammar.derive(&mut chance);
        let (branches, leaves) = walk(&word, &self.walk, &mut chance);
        let mut wood = Mesh::default();
        let thinnest = 0.018;
        for b in branches.iter().filter(|b| b.radii[0] > thinnest) {
            let sides = if b.radii[0] > 0.08 { 7 } else { 4 };
            wood.tube(b.ends, b.radii, sides);
        }
        Tree {
            wood,
            leaves: self.foliage.cards(&leaves, &mut chance),
        }
    }
}

impl Foliage {
    /// Leaf cards whose normals point out of the crown; darker on the inside and the underside.
    fn cards(&self, leaves: &[Leaf], chance: &mut Chance) -> Mesh {
        let low = leaves.iter().map(|l| l.at).reduce(Vec3::min);
        let high = leaves.iter().map(|l| l.at).reduce(Vec3::max);
        let (low, high) = (low.unwrap_or_default(), high.unwrap_or_default());
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low) + 0.3);
        let mut mesh = Mesh::default();
        for leaf in leaves {
            let out = (leaf.at - centre) / half;
            let shade =
                0.45 + 0.55 * out.length().min(1.0) * (0.75 + 0.25 * out.y.clamp(-1.0, 1.0));
            for _ in 0..self.cards {
                let tone = vec3(chance.within(0.85, 1.15), chance.within(0.9, 1.1), 1.0);
                mesh.tint(self.tint * tone * shade);
                self.card(&mut mesh, leaf, out, chance);
            }
        }
        mesh
    }

    fn card(&self, mesh: &mut Mesh, leaf: &Leaf, out: Vec3, chance: &mut Chance) {
        let random = |chance: &mut Chance| {
            vec3(
                chance.within(-1.0, 1.0),
                chance.within(-1.0, 1.0),
                chance.within(-1.0, 1.0),
            )
        };
        let loose = (random(chance) + vec3(0.0, 0.4, 0.0)).normalize_or(Vec3::Y);
        let up = (leaf.along * self.along + loose * (1.0 - self.along)).normalize_or(Vec3::Y);
        // The card faces roughly out of the crown.
        let face = (out.normalize_or(Vec3::Y) + random(chance) * 0.75).normalize_or(Vec3::Y);
        let right = up.cross(face).normalize_or(Vec3::X);
        let size = self.size * chance.within(0.8, 1.2);
        let normal = (out.normalize_or(Vec3::Y) + vec3(0.0, 0.35, 0.0)).normalize();
        let centre = leaf.at + up * size * 0.5 + random(chance) * self.size * 0.9;
        mesh.card(centre, [right * size, up * size], normal, self.tile);
    }
}

/// A date palm: a curved trunk and a crown of arching fronds.
fn palm(seed: u64) -> Tree {
    let mut chance = Chance::new(seed);
    let (mut wood, mut leaves) = (Mesh::default(), Mesh::default());
    let (lean, height) = (chance.within(0.5, 1.6), chance.within(5.2, 7.0));
    let at = |t: f32| vec3(lean * t * t, height * t, 0.25 * lean * (3.0 * t).sin());
    for i in 0..12 {
        let [a, b] = [i, i + 1].map(|k| k as f32 / 12.0);
        // Old leaf bases: each ring is slightly wider at its top.
        wood.tube([at(a), at(b)], [0.17 - 0.05 * a, 0.20 - 0.05 * b], 8);
    }
    let fronds = 26;
    for i in 0..fronds {
        let turn = i as f32 * 2.399 + chance.within(-0.2, 0.2);
        let rise = 1.15 - 1.5 * i as f32 / fronds as f32;
        frond(&mut leaves, at(1.0), turn, rise, &mut chance);
    }
    Tree { wood, leaves }
}

/// A strip of cards shaped like a shallow gutter that bends down.
fn frond(mesh: &mut Mesh, foot: Vec3, turn: f32, rise: f32, chance: &mut Chance) {
    let out = vec3(turn.cos(), 0.0, turn.sin());
    let side = vec3(-turn.sin(), 0.0, turn.cos());
    let length = chance.within(2.3, 2.9);
    let tone = chance.within(0.75, 1.1);
    mesh.tint(vec3(0.95, 1.0, 0.7) * tone);
    let spine = |t: f32| {
        let angle = rise - 2.0 * t * t;
        foot + out * (length * t * angle.cos().max(0.2))
            + Vec3::Y * (length * (rise * t - 0.95 * t * t))
    };
    let rows = 7;
    for half in [-1.0f32, 1.0] {
        mesh.grid(rows, 2, |row, column| {
            let t = row as f32 / (rows - 1) as f32;
            let across = if half < 0.0 { 1 - column } else { column } as f32 * half;
            let drop = -0.16 * across.abs();
            let position = spine(t) + side * (0.46 * across) + Vec3::Y * drop;
            let normal = Vec3::Y + 0.4 * out + side * 0.5 * across;
            let uv = FROND[0] + FROND[1] * vec2(0.5 + 0.5 * across, 1.0 - t);
            crate::mesh::point(position, normal, uv)
        });
    }
}

/// A tuft of dry grass: a few upright cards.
pub fn tuft(seed: u64) -> Mesh {
    let mut chance = Chance::new(seed);
    let mut mesh = Mesh::default();
    for _ in 0..3 {
        let angle = chance.within(0.0, std::f32::consts::TAU);
        let right = vec3(angle.cos(), 0.0, angle.sin()) * 0.26;
        let up = vec3(chance.within(-0.06, 0.06), 0.2, chance.within(-0.06, 0.06));
        let tone = chance.within(0.8, 1.3);
        mesh.tint(vec3(1.5, 1.25, 0.55) * tone);
        mesh.card(up, [right, up], Vec3::Y, NEEDLE);
    }
    mesh
}

/// All trees, two or three variants per species: broadleaf, pine, cypress, palm, shrub.
pub fn forest() -> [Vec<Tree>; 5] {
    let grow = |species: &Species, seeds: &[u64]| seeds.iter().map(|s| species.grow(*s)).collect();
    [
        grow(&broadleaf(), &[3, 14, 25]),
        grow(&pine(), &[7, 19]),
        grow(&cypress(), &[5, 6]),
        [2, 9].into_iter().map(palm).collect(),
        grow(&shrub(), &[4, 8]),
    ]
}
