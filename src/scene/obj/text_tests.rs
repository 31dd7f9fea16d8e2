//! Tests of the OBJ parser.

use glam::Vec3;

use super::*;
use crate::scene::mesh::soup::{Corner, NONE};

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

fn told(out: &ObjText) -> Vec<String> {
    out.losses.lines().collect()
}

fn good(text: &str) -> ObjText {
    let out = read(text, 1, DVec3::ZERO);
    assert_eq!(told(&out), [""; 0]);
    out
}

fn positions(corners: &[Corner; 3]) -> [u32; 3] {
    corners.map(|c| c.position)
}

#[test]
fn a_backslash_continues_a_line() {
    let out = good(&format!(
        "# c\n{TRIANGLE}\nf 1 2 \\\n 3\nusemtl\tred stone\nf 1 2 3\n"
    ));
    assert_eq!(positions(&out.soup.triangles[0].corners), [0, 1, 2]);
    assert_eq!(out.materials, ["", "red stone"]);
    let out = read(
        &format!("{TRIANGLE}f 1 \\\n 2 \\\n3\nf 1 2 9"),
        1,
        DVec3::ZERO,
    );
    assert!(told(&out)[0].contains("line 7"), "{:?}", told(&out));
}

#[test]
fn negative_indices_count_back() {
    let out = good(&format!("{TRIANGLE}f -3 -2 -1\nv 5 5 5\nf -4 -3 -1"));
    let corners: Vec<_> = out
        .soup
        .triangles
        .iter()
        .map(|t| positions(&t.corners))
        .collect();
    assert_eq!(corners, [[0, 1, 2], [0, 1, 3]]);
}

#[test]
fn groups_and_missing_normals_are_kept_per_face() {
    let out = good(&format!(
        "{TRIANGLE}vn 0 0 1\ns 3\nf 1//1 2//1 3//1\ns off\nf 1//1 2 3//1\nf 1//9 2//9 3//9\n"
    ));
    let kept = |t: &crate::scene::mesh::soup::Triangle| (t.smoothing, t.corners[0].normal != NONE);
    let kept: Vec<_> = out.soup.triangles.iter().map(kept).collect();
    assert_eq!(kept, [(3, true), (0, false), (0, false)]);
    assert_eq!(out.dangling, 1, "only the last has an index out of range");
}

#[test]
fn bad_faces_name_their_line() {
    for (face, part) in [
        ("f 1 2 9", "does not exist"),
        ("f 0 1 2", "start at 1"),
        ("f 1 2 -4", "does not exist"),
        ("f 1 2 99999999999999999999999", "not a corner"),
        ("f -9223372036854775808 1 2", "does not exist"),
        ("f 1 2 x", "not a corner"),
        ("f 1 2 /3", "has no vertex index"),
        ("f 1/1/1/1 2 3", "more than three"),
        ("v 1 2", "three numbers"),
    ] {
        let out = read(&format!("{TRIANGLE}{face}\nf 1 2 3\n"), 1, DVec3::ZERO);
        let [line] = &told(&out)[..] else {
            panic!("{face}: {:?}", told(&out))
        };
        assert!(
            line.contains("line 4") && line.contains(part),
            "{face}: {line}"
        );
        assert_eq!(out.soup.triangles.len(), 1, "the other stays: {face}");
    }
}

#[test]
fn points_and_lines_are_skipped() {
    let out = good("v 0 0 0\nv 1 0 0 0.5\nv 1.#IND 1 0\nl 1 2\np 1\nf 1 2\nvt 0.5\n");
    assert_eq!(out.not_faces, 3);
    assert_eq!(out.soup.positions[1], Vec3::X);
    assert!(out.soup.positions[2].x.is_nan());
    assert_eq!(out.soup.texcoords[0], glam::Vec2::new(0.5, 0.0));
}

#[test]
fn colours_follow_the_position() {
    let out = good("v 0 0 0\nv 1 0 0 0.5 0.25 1\nv 0 1 0 1 0.1 0.2 0.3\nv 0 0 1 nan 0 0\n");
    assert_eq!(
        out.soup.colours,
        [[1.0; 4], [0.5, 0.25, 1.0, 1.0], [1.0, 0.1, 0.2, 0.3]],
        "the fourth colour is not finite; the list is padded later"
    );
    assert_eq!(out.sevens, 1);
}

/// The same file, parsed as one chunk and as four.
#[test]
fn chunks_give_what_the_whole_gives() {
    let mut text = String::new();
    for i in 0..60_000 {
        let colour = if i % 3 == 0 { " 0.5 0.5 0.5" } else { "" };
        text += &format!("v {i} 0 0{colour}\nv {i} 1 0\nv {i} 0 1\nvn 0 1 0\nvt 0.5 {i}\n");
        match i % 5 {
            0 => text += "f -3/-1/-1 -2/-1/-1 \\\n-1/-1/-1\n",
            1 => text += &format!("usemtl m{}\nf -3//-1 -2//-1 -1//-1 -3//-1\n", i % 7),
            2 => text += "s 4\nf 1 2 3\n",
            3 => text += "s off\n",
            _ => text += "f -3/-1 -2/-1 -1/-1\nl 1 2\n",
        }
    }
    assert!(text.len() > 3 * MIN_CHUNK, "{}", text.len());
    let parsed = |text: &str, threads| read(text, threads, DVec3::ZERO);
    let (whole, parts) = (parsed(&text, 1), parsed(&text, 4));
    assert_eq!(cut(&text, 4).len(), 4);
    assert_eq!(whole.soup.triangles, parts.soup.triangles);
    assert_eq!(whole.soup.positions, parts.soup.positions);
    assert_eq!(whole.soup.normals, parts.soup.normals);
    assert_eq!(whole.soup.texcoords, parts.soup.texcoords);
    assert_eq!(whole.soup.polygons, parts.soup.polygons);
    assert_eq!(whole.soup.colour_of(0), parts.soup.colour_of(0));
    assert_eq!(whole.soup.colour_of(179_997), parts.soup.colour_of(179_997));
    assert_eq!(whole.soup.colour_of(179_999), parts.soup.colour_of(179_999));
    assert_eq!(whole.materials, parts.materials);
    assert_eq!(
        (whole.not_faces, whole.dangling),
        (parts.not_faces, parts.dangling)
    );
    let broken = format!("f 1 2 x\n{text}f 1 2 x\n");
    let told_of = told(&parsed(&broken, 4));
    assert_eq!(told(&parsed(&broken, 1)), told_of);
    assert!(
        told_of[0].starts_with("2 faces left out; first: line 1:"),
        "{told_of:?}"
    );
}

#[test]
fn every_spelling_of_a_line_is_read() {
    for (line, x) in [
        ("v 1,5 0 0", 1.5),
        ("v 1.5,0,0", 1.5),
        ("v\t1.5  0 0 # far", 1.5),
        ("v +1.5e0 0 0 1.0", 1.5),
        ("v 1.5 0", f32::NAN),
        ("v -nan(ind) 0 0", f32::NAN),
        ("v 1.#INF 0 0", f32::INFINITY),
        ("v x 0 0", f32::NAN),
    ] {
        let out = read(&format!("{line}\nf 1 1 1 # of\tthis\n"), 1, DVec3::ZERO);
        let found = out.soup.positions[0].x;
        assert!(
            found == x || found.is_nan() && x.is_nan(),
            "{line}: {found}"
        );
        assert_eq!(out.soup.triangles.len(), 1, "{line}");
    }
}

#[test]
fn positions_are_relative_to_an_origin_in_f64() {
    let text =
        "#\nv 500000.125 1 -6100000.0625\nv 500001.126 1 -6100000\nv 500000 2 -6100000\nf 1 2 3\n";
    let points = sample(text);
    assert_eq!(points.len(), 3);
    let out = read(text, 1, DVec3::new(5e5, 0.0, -6.1e6));
    assert_eq!(out.soup.positions[0].to_array(), [0.125, 1.0, -0.0625]);
    assert_eq!(out.soup.positions[1].x, 1.126);
    let many = "#\n".to_owned() + &"v 1 2 3\nv 4 5 6\n".repeat(5000);
    assert!(
        (200..600).contains(&sample(&many).len()),
        "{}",
        sample(&many).len()
    );
}
