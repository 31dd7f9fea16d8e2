//! A small model with air before the eye, a lamp and a pane of glass.

use std::fs;
use std::path::Path;

/// A square 300 m across with blocks, a lamp and a pane: with air before the eye.
const TOWN: [([f32; 3], [f32; 3], &str); 6] = [
    ([-150.0, -1.0, -150.0], [150.0, 0.0, 150.0], "ground"),
    ([-40.0, 0.0, -60.0], [-10.0, 25.0, -30.0], "wall"),
    ([10.0, 0.0, -80.0], [50.0, 40.0, -50.0], "wall"),
    ([-60.0, 0.0, 20.0], [-50.0, 8.0, 60.0], "wall"),
    ([-5.0, 0.0, -20.0], [5.0, 6.0, -10.0], "lamp"),
    ([15.0, 0.0, 0.0], [35.0, 10.0, 0.5], "pane"),
];

/// Corners of the faces of a block, counter-clockwise from outside.
const FACES: [[i32; 4]; 6] = [
    [1, 3, 7, 5],
    [0, 4, 6, 2],
    [2, 6, 7, 3],
    [0, 1, 5, 4],
    [4, 5, 7, 6],
    [0, 2, 3, 1],
];

const MATERIALS: &str = "newmtl ground\nKd 0.4 0.35 0.3\nnewmtl wall\nKd 0.7 0.7 0.65\nKs 0.2 0.2 0.2\nNs 40\n\
    newmtl lamp\nKd 0.5 0.5 0.5\nKe 2000 1500 1000\nnewmtl pane\nKd 0 0 0\nd 0.1\nTf 0.8 0.9 0.8\n";

/// Writes `town.obj` and its materials to a folder.
pub fn write(folder: &Path) {
    let mut town = "mtllib town.mtl\n".to_owned();
    for (low, high, material) in TOWN {
        let corner = |i: usize, axis: usize| {
            if i >> axis & 1 == 0 {
                low[axis]
            } else {
                high[axis]
            }
        };
        for i in 0..8 {
            town += &format!("v {} {} {}\n", corner(i, 0), corner(i, 1), corner(i, 2));
        }
        town += &format!("usemtl {material}\n");
        // Bit 0 of a corner's number is x, bit 1 y, bit 2 z.
        for [a, b, c, d] in FACES {
            town += &format!("f {} {} {} {}\n", a - 8, b - 8, c - 8, d - 8);
        }
    }
    fs::write(folder.join("town.obj"), town).expect("written");
    fs::write(folder.join("town.mtl"), MATERIALS).expect("written");
}
