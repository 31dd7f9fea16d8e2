//! Generates `assets/island.glb`: an island with a temple, a cottage, a pier and a calm sea.
//!
//! ```text
//! cargo run --release --example make_island            # writes assets/island.glb
//! cargo run --release --example make_island -- out.glb
//! ```
//!
//! The terrain is turbulence noise and the trees are L-systems. The seed is fixed, so every run writes the same bytes.

mod cottage;
mod glb;
mod lsystem;
mod mesh;
mod noise;
mod plants;
mod rocks;
mod temple;
mod terrain;
mod textures;
mod trees;

use std::path::PathBuf;

use glam::{Affine3A, Quat, Vec3, vec3};

use glb::{Glb, Material, Node};
use mesh::Mesh;

/// Indices of the materials.
struct Palette {
    ground: usize,
    sea: usize,
    marble: usize,
    rock: usize,
    bark: usize,
    leaves: usize,
    plaster: usize,
    tiles: usize,
    timber: usize,
    paint: usize,
    glass: usize,
}

const PLAIN: Material = Material {
    name: "",
    colour: [0.5; 3],
    metallic: 0.0,
    roughness: 1.0,
    ior: 1.5,
    picture: None,
    normals: None,
    cutoff: None,
};

impl Palette {
    fn new(glb: &mut Glb) -> Self {
        let grain = glb.picture("grain", &textures::grain(false));
        let stone = glb.picture("stone", &textures::grain(true));
        let leaves = glb.picture("leaves", &textures::leaves());
        let bumps = glb.picture("bumps", &textures::bumps());
        let ripples = glb.picture("ripples", &textures::ripples());
        let mut stony = |name, colour, picture, bump| {
            glb.material(&Material {
                name,
                colour,
                picture: Some(picture),
                normals: Some((bumps, bump)),
                ..PLAIN
            })
        };
        Self {
            ground: stony("ground", [1.0; 3], grain, 0.8),
            marble: stony("marble", [0.86, 0.77, 0.60], stone, 0.35),
            rock: stony("rock", [0.46, 0.395, 0.315], stone, 1.0),
            tiles: stony("tiles", [0.60, 0.235, 0.12], stone, 0.3),
            plaster: plain(glb, "plaster", [0.80, 0.765, 0.69]),
            timber: plain(glb, "timber", [0.27, 0.185, 0.115]),
            bark: plain(glb, "bark", [0.19, 0.13, 0.09]),
            paint: plain(glb, "paint", [0.045, 0.16, 0.27]),
            sea: glb.material(&Material {
                name: "sea",
                colour: [1.0; 3],
                roughness: 0.03,
                ior: 1.33,
                normals: Some((ripples, 0.55)),
                ..PLAIN
            }),
            leaves: glb.material(&Material {
                name: "leaves",
                colour: [1.0; 3],
                picture: Some(leaves),
                cutoff: Some(0.4),
                ..PLAIN
            }),
            glass: glb.material(&Material {
                name: "glass",
                colour: [0.02, 0.025, 0.03],
                roughness: 0.0,
                ..PLAIN
            }),
        }
    }
}

fn plain(glb: &mut Glb, name: &'static str, colour: [f32; 3]) -> usize {
    glb.material(&Material {
        name,
        colour,
        ..PLAIN
    })
}

fn add_land(glb: &mut Glb, palette: &Palette) {
    let meshes = [
        ("land", palette.ground, terrain::land()),
        ("sea", palette.sea, terrain::sea()),
    ];
    for (name, material, mesh) in meshes {
        let mesh = glb.mesh(name, &[(material, &mesh)]);
        glb.placed(mesh, Affine3A::IDENTITY);
    }
}

fn add_temple(glb: &mut Glb, palette: &Palette) {
    let middle = terrain::TEMPLE;
    let building = glb.mesh("temple", &[(palette.marble, &temple::building())]);
    glb.placed(building, Affine3A::from_translation(middle));
    let column = glb.mesh("column", &[(palette.marble, &temple::column())]);
    for (i, (at, broken)) in temple::places().into_iter().enumerate() {
        let mesh = match broken {
            Some(height) => glb.mesh("stump", &[(palette.marble, &temple::stump(height))]),
            None => column,
        };
        glb.node(&Node {
            mesh,
            at: middle + at,
            turn: 0.7 * i as f32,
            scale: 1.0,
        });
    }
    let drum = glb.mesh("drum", &[(palette.marble, &temple::stump(0.85))]);
    for (x, z, turn) in [
        (-13.2, 4.6, 0.4),
        (-12.4, 7.4, 1.7),
        (-15.0, -2.2, 2.6),
        (-11.4, -8.0, 0.9),
    ] {
        let at = middle + vec3(x, 0.0, z);
        let y = terrain::height(glam::vec2(at.x, at.z)) + 0.38;
        let turn = Quat::from_rotation_y(turn) * Quat::from_rotation_x(1.53);
        glb.placed(
            drum,
            Affine3A::from_rotation_translation(turn, vec3(at.x, y, at.z)),
        );
    }
}

fn add_cottage(glb: &mut Glb, palette: &Palette) {
    let c = cottage::cottage();
    let parts: [(usize, &Mesh); 6] = [
        (palette.plaster, &c.plaster),
        (palette.tiles, &c.tiles),
        (palette.timber, &c.timber),
        (palette.paint, &c.paint),
        (palette.glass, &c.glass),
        (palette.rock, &c.stone),
    ];
    let mesh = glb.mesh("cottage", &parts);
    glb.node(&Node {
        mesh,
        at: terrain::COTTAGE,
        turn: -0.30,
        scale: 1.0,
    });
    let [from, to] = terrain::PIER;
    let pier = glb.mesh("pier", &[(palette.timber, &cottage::pier(from, to))]);
    glb.placed(pier, Affine3A::IDENTITY);
    let [hull, wood] = cottage::boat();
    let boat = glb.mesh("boat", &[(palette.paint, &hull), (palette.timber, &wood)]);
    let turn = Quat::from_rotation_y(1.1);
    let at: Vec3 = vec3(6.6, 0.12, 51.5);
    glb.placed(boat, Affine3A::from_rotation_translation(turn, at));
}

fn main() -> std::io::Result<()> {
    let path = std::env::args_os().nth(1).map_or_else(
        || PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("assets/island.glb"),
        PathBuf::from,
    );
    let mut glb = Glb::default();
    let palette = Palette::new(&mut glb);
    add_land(&mut glb, &palette);
    add_temple(&mut glb, &palette);
    add_cottage(&mut glb, &palette);
    rocks::add(&mut glb, &palette);
    plants::add(&mut glb, &palette);
    let (stored, drawn) = glb.triangles();
    let file = glb.finish();
    std::fs::write(&path, &file)?;
    println!(
        "{}: {} bytes, {stored} triangles stored, {drawn} drawn",
        path.display(),
        file.len()
    );
    Ok(())
}
