//! Tests of the MTL parser.

use super::*;
use crate::scene::LoadOptions;
use crate::scene::files::Files;
use crate::scene::material::MAX_EMISSION;
use crate::scene::progress::Reporter;

static FILES: &[(&str, &[u8])] = &[
    ("a b.mtl", b""),
    ("c.mtl", b""),
    ("tex/wood.png", b"no picture"),
];

fn with_builder<T>(act: impl FnOnce(&mut Builder<'_>) -> T) -> T {
    let progress = Reporter::new(&|_, _| ());
    act(&mut Builder::new(
        Files::embedded(FILES),
        &LoadOptions::default(),
        progress,
    ))
}

fn read(mtl: &str) -> Vec<Material> {
    with_builder(|builder| {
        let mut libraries = Libraries::default();
        libraries.add(builder, Path::new("m.mtl"), mtl);
        let entries = libraries.entries.iter();
        entries
            .map(|entry| entry.material(builder, Path::new("m.obj")))
            .collect()
    })
}

#[test]
fn libraries_are_found_by_any_spelling() {
    let find = |rest| {
        with_builder(|builder| find_libraries(builder, Path::new("m.obj"), Path::new(""), rest))
    };
    assert_eq!(find("a b.mtl"), [Path::new("a b.mtl")]);
    assert_eq!(
        find("none.mtl a\\ b.mtl  c.mtl"),
        [Path::new("a b.mtl"), Path::new("c.mtl")]
    );
    assert_eq!(find("C:\\models\\c.mtl"), [Path::new("c.mtl")]);
    assert!(find("none.mtl").is_empty());
    let picture = Files::embedded(FILES).find(Path::new(""), "tex\\wood.png");
    assert_eq!(picture, Lookup::Found("tex/wood.png".into()));
}

#[test]
fn values_are_clamped_and_malformed_ones_ignored() {
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
fn emission_is_read_and_bounded_with_one_warning() {
    let mtl = "newmtl a\nKe 3 2 0.5\nnewmtl b\nKe 7\nnewmtl c\nKe -1 2 1e30\nnewmtl d\nKe 1e30\nnewmtl e\nKe nan 1 1\n\
               newmtl f\nmap_Ke none.png\n";
    let (materials, warnings) = with_builder(|builder| {
        let mut libraries = Libraries::default();
        libraries.add(builder, Path::new("m.mtl"), mtl);
        let entries = libraries.entries.iter();
        let materials: Vec<_> = entries
            .map(|entry| entry.material(builder, Path::new("m.obj")))
            .collect();
        (materials, builder.scene.warnings.clone())
    });
    let emissions = materials.iter().map(|m| m.emission);
    let most = MAX_EMISSION;
    let expected = [
        [3.0, 2.0, 0.5],
        [7.0; 3],
        [0.0, 2.0, most],
        [most; 3],
        [0.0; 3],
        [0.0; 3],
    ];
    assert!(emissions.eq(expected), "{materials:?}");
    let told = |what: &str| warnings.iter().filter(|w| w.contains(what)).count();
    assert_eq!(told("emission of \"c\""), 1, "{warnings:?}");
    assert_eq!(told("malformed"), 1, "{warnings:?}");
    assert_eq!(told("none.png"), 1, "{warnings:?}");
    assert_eq!(warnings.len(), 3, "{warnings:?}");
}

#[test]
fn a_map_of_emission_without_a_factor_is_emission_itself() {
    let emission = |lines: &str| {
        let mut files = FILES.to_vec();
        files.push(("lamp.bmp", LAMP));
        let progress = Reporter::new(&|_, _| ());
        let files: &'static [(&str, &[u8])] = files.leak();
        let mut builder = Builder::new(Files::embedded(files), &LoadOptions::default(), progress);
        let mut libraries = Libraries::default();
        let text = format!("newmtl a\n{lines}map_Ke -s 2 3 lamp.bmp\n");
        libraries.add(&mut builder, Path::new("m.mtl"), &text);
        let (material, uv) = libraries
            .material(&mut builder, Path::new("m.obj"), "a")
            .expect("a material");
        assert_eq!(material.emissive_texture, Some(0));
        assert_eq!(uv.matrix2.x_axis.x, 2.0);
        material.emission
    };
    assert_eq!(emission(""), [1.0; 3]);
    assert_eq!(emission("Ke 0 0 0\n"), [1.0; 3]);
    assert_eq!(emission("Ke 5 4 3\n"), [5.0, 4.0, 3.0]);
}

/// A picture of one pixel: BMP, 24 bits.
const LAMP: &[u8] = &[
    b'B', b'M', 58, 0, 0, 0, 0, 0, 0, 0, 54, 0, 0, 0, 40, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0,
    24, 0, 0, 0, 0, 0, 4, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 10, 20, 30, 0,
];

#[test]
fn dissolve_overrides_transparency() {
    let opacity = |lines: &str| read(&format!("newmtl a\n{lines}"))[0].dissolve;
    assert_eq!(opacity("d 0.75\nTr 0.5\n"), 0.75);
    assert_eq!(opacity("Tr 0.6\n"), 1.0 - 0.6f32);
    assert_eq!(opacity("Tr 1.0\n"), 1.0);
    assert_eq!(opacity("d 0\n"), 0.0);
    assert_eq!(opacity(""), 1.0);
}

#[test]
fn a_texture_that_fails_leaves_the_colour() {
    assert_eq!(read("newmtl a\nmap_Kd tex/wood.png\n")[0].diffuse, [0.5; 3]);
    assert_eq!(
        read("newmtl a\nKd 0.2 0.3 0.4\nmap_Kd none.png\n")[0].diffuse,
        [0.2, 0.3, 0.4]
    );
}

#[test]
fn illumination_models_without_highlights_have_no_specular_lobe() {
    for (line, glossy) in [
        ("", true),
        ("illum 0", false),
        ("illum 1", false),
        ("illum 2", true),
    ] {
        let material = &read(&format!("newmtl a\nKs 0.45\n{line}\n"))[0];
        assert_eq!(material.specular[0] > 0.0, glossy, "{line}");
    }
}

#[test]
fn pbr_keys_override_phong() {
    let material = &read("newmtl a\nKd 0.8 0.8 0.8\nKs 1 1 1\nNs 10\nPm 1\nPr 0.5\n")[0];
    assert!((material.specular[0] - 0.2).abs() < 1e-6, "{material:?}");
    assert!((material.diffuse[0] - 0.6).abs() < 1e-6, "{material:?}");
    assert!((material.shininess - 30.0).abs() < 1e-3, "{material:?}");
}
