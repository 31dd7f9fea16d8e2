//! Tests of MTL reading.

use super::*;
use crate::scene::LoadOptions;
use crate::scene::progress::Reporter;

static FILES: &[(&str, &[u8])] = &[
    ("a b.mtl", b""),
    ("c.mtl", b""),
    ("tex/wood.png", b"no picture"),
];

fn read(mtl: &str) -> Vec<Material> {
    let progress = Reporter::new(&|_, _| ());
    let mut builder = Builder::new(Files::Embedded(FILES), &LoadOptions::default(), progress);
    let mut libraries = Libraries::default();
    libraries.add(&mut builder, Path::new("m.mtl"), mtl);
    let (materials, _) = tobj::load_mtl_buf(&mut libraries.text.as_bytes()).expect("clean text");
    materials
        .iter()
        .map(|m| libraries.material(&mut builder, Path::new("m.obj"), m))
        .collect()
}

#[test]
fn texture_options_are_left_out() {
    for (line, name) in [
        ("wood.png", "wood.png"),
        ("texture 01.png", "texture 01.png"),
        ("-s 0.1 0.2 specular.jpg", "specular.jpg"),
        ("-o 0.1 diffuse.jpg", "diffuse.jpg"),
        ("-t 0.1 0.2 0.3 a b.jpg", "a b.jpg"),
        ("-colorspace sRGB -o 0.1 d.jpg", "d.jpg"),
        ("-imfchan r bump.jpg -bm 1.5", "bump.jpg"),
        ("-mm 0.1 0.3 s.jpg", "s.jpg"),
        ("-type cube_top s.jpg", "s.jpg"),
        ("-s 1 1 1 2", "2"),
        ("\"quoted name.png\"", "quoted name.png"),
        ("-bm", "-bm"),
    ] {
        assert_eq!(texture_name(line), name, "{line}");
    }
}

#[test]
fn libraries_are_found_by_any_spelling() {
    let find = |rest| find_libraries(&Files::Embedded(FILES), Path::new(""), rest);
    assert_eq!(find("a b.mtl"), [Path::new("a b.mtl")]);
    assert_eq!(
        find("none.mtl a\\ b.mtl  c.mtl"),
        [Path::new("a b.mtl"), Path::new("c.mtl")]
    );
    assert_eq!(find("C:\\models\\c.mtl"), [Path::new("c.mtl")]);
    assert!(find("none.mtl").is_empty());
    let picture = super::find(&Files::Embedded(FILES), Path::new(""), "tex\\wood.png");
    assert_eq!(picture, Path::new("tex/wood.png"));
}

#[test]
fn values_are_bounded_and_nonsense_is_left_out() {
    let materials =
        read("newmtl a\nKd 2 -1 0.5\nKs 0.3\nNs 0\nnewmtl b\nKd 1 0\nKs nan 0 0\nNs x\nd 1e400\n");
    assert_eq!(materials[0].diffuse, [1.0, 0.0, 0.5]);
    assert_eq!(materials[0].specular, [0.3; 3]);
    assert_eq!(materials[0].shininess, 1.0);
    let default = Material {
        name: "b".into(),
        ..Material::default()
    };
    assert_eq!(materials[1], default);
}

#[test]
fn dissolve_rules_over_transparency() {
    let opacity = |lines: &str| read(&format!("newmtl a\n{lines}"))[0].dissolve;
    assert_eq!(opacity("d 0.75\nTr 0.5\n"), 0.75);
    assert_eq!(opacity("Tr 0.6\n"), 1.0 - 0.6f32);
    assert_eq!(opacity("Tr 1.0\n"), 1.0);
    assert_eq!(opacity("d 0\n"), 0.0);
    assert_eq!(opacity(""), 1.0);
}

#[test]
fn a_texture_that_fails_leaves_the_plain_colour() {
    assert_eq!(read("newmtl a\nmap_Kd tex/wood.png\n")[0].diffuse, [0.5; 3]);
    assert_eq!(
        read("newmtl a\nKd 0.2 0.3 0.4\nmap_Kd none.png\n")[0].diffuse,
        [0.2, 0.3, 0.4]
    );
}

#[test]
fn illumination_models_without_highlights_have_no_gloss() {
    let source = |illumination_model| tobj::Material {
        specular: Some([0.45; 3]),
        illumination_model,
        ..tobj::Material::default()
    };
    for (model, glossy) in [
        (None, true),
        (Some(0), false),
        (Some(1), false),
        (Some(2), true),
    ] {
        assert_eq!(has_highlights(&source(model)), glossy, "{model:?}");
    }
}
