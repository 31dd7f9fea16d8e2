use glam::Vec3;

use super::*;
use crate::scene::Loaded;
use crate::scene::files::Files;
use crate::scene::load::load_from;

const OBJ: &[u8] = b"v 1 0 0\nv 0 0 2\nv 0 1 0\nf 1 2 3\n";

fn load(toml: &str) -> Result<Loaded, String> {
    let toml: &'static [u8] = toml.to_owned().into_bytes().leak();
    let files: Vec<(&'static str, &'static [u8])> = vec![("dir/s.toml", toml), ("dir/m.obj", OBJ)];
    load_from(
        &mut Files::embedded(files.leak()),
        Path::new("dir/s.toml"),
        &LoadOptions::default(),
        &|_, _| (),
    )
    .map_err(|error| error.to_string())
}

fn positions(mesh: &str) -> Vec<[f32; 3]> {
    load(&format!("[[mesh]]\nfile = \"m.obj\"\n{mesh}"))
        .expect("good scene")
        .scene
        .positions
}

#[test]
fn transforms_apply_in_the_documented_order() {
    assert_eq!(positions("translate = [1, 2, 3]")[0], [2.0, 2.0, 3.0]);
    assert_eq!(positions("scale = 2")[1], [0.0, 0.0, 4.0]);
    assert_eq!(positions("up = \"z\"")[1], [0.0, 2.0, 0.0]);
    assert_eq!(
        positions("unit = \"cm\"\nscale = 2\ntranslate = [0, 1, 0]")[1],
        [0.0, 1.0, 0.04]
    );
    let turned = positions("rotate = [0, 90, 0]\ntranslate = [0, 0, 5]")[0];
    assert!(
        (Vec3::from(turned) - Vec3::new(0.0, 0.0, 4.0)).length() < 1e-6,
        "{turned:?}"
    );
    // First about x: z becomes −y. Then about z: −y becomes x.
    let twice = positions("rotate = [90, 0, 90]")[1];
    assert!(
        (Vec3::from(twice) - Vec3::new(2.0, 0.0, 0.0)).length() < 1e-6,
        "{twice:?}"
    );
}

fn row(table: &str, key: &str, text: &str) -> (String, String, String) {
    (table.to_owned(), key.to_owned(), text.to_owned())
}

/// Table, key and text of every option.
fn rows(loaded: &Loaded) -> Vec<(String, String, String)> {
    let tables = loaded.options.iter();
    let rows = |t: &NamedOptions| {
        t.options
            .clone()
            .into_iter()
            .map(|(k, v)| row(&t.name, &k, &v))
            .collect::<Vec<_>>()
    };
    tables.flat_map(rows).collect()
}

#[test]
fn options_become_pairs_of_text() {
    let loaded = load(
        "[[mesh]]\nfile = \"m.obj\"\n[place]\nplace = [55.79, 12.52]\nwhen = 2026-06-21T14:00:00+02:00\n\
         [sky]\nturbidity = 3\n[camera]\neye = [1, -2, 3.5]\n[exposure]\nexposure = \"auto\"\n",
    )
    .expect("good scene");
    let expected = [
        ("exposure", "exposure", "auto"),
        ("place", "place", "55.79,12.52"),
        ("place", "when", "2026-06-21T14:00:00+02:00"),
        ("sky", "turbidity", "3"),
        ("camera", "eye", "1,-2,3.5"),
    ];
    assert_eq!(rows(&loaded), expected.map(|(t, k, v)| row(t, k, v)));
}

#[test]
fn the_first_named_camera_stands_in_for_a_nameless_one() {
    let mesh = "[[mesh]]\nfile = \"m.obj\"\n";
    let named = "[[camera]]\nname = \"a\"\nfov = 30\n[[camera]]\nname = \"b\"\nfov = 40\n";
    let loaded = load(&format!("{mesh}{named}")).expect("good scene");
    assert_eq!(rows(&loaded), [row("camera", "fov", "30")]);
    assert_eq!(loaded.cameras[1].name, "b");
    let both = load(&format!("{mesh}{named}[[camera]]\nfov = 50\n")).expect("good scene");
    assert_eq!(rows(&both), [row("camera", "fov", "50")]);
}

#[test]
fn nonsense_is_named() {
    let mesh = "[[mesh]]\nfile = \"m.obj\"\n";
    for (text, part) in [
        ("".to_owned(), "has no [[mesh]]"),
        ("mesh = 3".to_owned(), "write [[mesh]]"),
        ("[[mesh]]\nfile = \"s.toml\"".to_owned(), "is a scene file"),
        (
            "[[mesh]]\nfile = \"n.obj\"".to_owned(),
            "n.obj: no such file",
        ),
        (
            "[[mesh]]\nfil = \"m.obj\"".to_owned(),
            "unknown key \"fil\" in [[mesh]]; known are file",
        ),
        (format!("skye = 3\n{mesh}"), "unknown key \"skye\""),
        (format!("{mesh}scale = 0"), "scale must be"),
        (format!("{mesh}scale = nan"), "scale must be"),
        (
            format!("{mesh}translate = [1, 2]"),
            "translate must be three numbers",
        ),
        (format!("{mesh}up = \"x\""), "up of a [[mesh]]"),
        (format!("{mesh}unit = \"km\""), "unit of a [[mesh]]"),
        (format!("{mesh}smooth = 300"), "smooth must be"),
        (
            format!("{mesh}[sky]\nturbidity = [[1]]"),
            "turbidity must be a number",
        ),
        (
            format!("{mesh}[[camera]]\n[[camera]]\n"),
            "two cameras have no name",
        ),
        (format!("{mesh}= 3"), "line 3 is no TOML"),
    ] {
        let error = load(&text).expect_err(&text);
        assert!(error.contains(part), "{text}: {error}");
        assert_eq!(error.lines().count(), 1, "{error}");
    }
}
