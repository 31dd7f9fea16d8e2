//! Valid, odd and hostile files: each one loads or fails with one line that gives the reason.

use std::fs;
use std::path::{Path, PathBuf};

use skylight::options::{OptionValues, Options};
use skylight::scene::{LoadOptions, Loaded, Scene, load, load_with_progress};

use crate::support::{assert_valid, files_below};

/// Shared files that must fail, with a part of the error message.
const REFUSED: [(&str, &str); 11] = [
    (
        "tinyobj_odd/invalid-face-definition.obj",
        "has no triangles",
    ),
    ("tinyobj_odd/invalid-relative-texture-index.obj", "line 2"),
    ("tinyobj_odd/invalid-relative-vertex-index.obj", "line 1"),
    (
        "tinyobj_odd/issue-356-leading-spaces-newmtl.obj",
        "has no triangles",
    ),
    ("tinyobj_odd/line-prim.obj", "has no triangles"),
    ("tinyobj_odd/points-prim.obj", "has no triangles"),
    ("trimesh_odd/empty.obj", "has no triangles"),
    ("trimesh_odd/face_in_group_name.obj", "has no triangles"),
    ("trimesh_odd/obj_empty.obj", "has no triangles"),
    ("trimesh_odd/obj_points.obj", "has no triangles"),
    ("trimesh_odd/obj_wireframe.obj", "has no triangles"),
];

/// Triangle counts from INDEX.md, including degenerate triangles.
const COUNTS: [(&str, usize); 12] = [
    ("gltf_small/BoxTextured.glb", 12),
    ("gltf_small/BoxInterleaved.glb", 12),
    ("gltf_small/Duck.glb", 4_212),
    ("gltf_small/CesiumMilkTruck.glb", 3_624),
    ("house/house.obj", 1_620),
    ("colonnade/colonnade.obj", 2_240),
    ("teapot/teapot_on_plane.obj", 6_322),
    ("medieval_building/Medieval_building.obj", 16_715),
    ("stanford_bunny/stanford-bunny.obj", 69_451),
    ("spot/spot_triangulated.obj", 5_856),
    ("courtyard/scene.obj", 104_816),
    ("trimesh_odd/cube.OBJ", 12),
];

/// The number in the warning about degenerate triangles.
fn without_area(scene: &Scene) -> usize {
    let warning = scene
        .warnings
        .iter()
        .find(|w| w.contains("triangles without area"));
    let number = warning.and_then(|w| w.split_once(": ")?.1.split(' ').next()?.parse().ok());
    number.unwrap_or(0)
}

#[test]
fn every_shared_model_loads_or_fails_with_the_right_line() {
    let Some(shared) = crate::common::shared() else {
        return;
    };
    let scenes = shared.join("scenes");
    let files = files_below(&scenes, &["obj", "gltf", "glb"]);
    let (mut refused, mut wrong) = (0, Vec::new());
    for path in &files {
        let name = path
            .strip_prefix(&scenes)
            .expect("below the folder")
            .to_string_lossy()
            .into_owned();
        let expected = REFUSED.iter().find(|(file, _)| *file == name);
        match (load(path, &LoadOptions::default()), expected) {
            (Ok(loaded), None) => {
                println!(
                    "{name} | {} | {}",
                    loaded.scene.triangles(),
                    loaded.scene.warnings.join("; ")
                );
                assert_valid(&name, &loaded.scene);
                let count = COUNTS.iter().find(|(file, _)| *file == name);
                let all = loaded.scene.triangles() + without_area(&loaded.scene);
                assert!(count.is_none_or(|(_, n)| *n == all), "{name}: {all}");
            }
            (Err(error), Some((_, part))) => {
                let line = error.to_string().replace(&*scenes.to_string_lossy(), "..");
                println!("{name} | refused | {line}");
                assert!(line.contains(part) && line.lines().count() == 1, "{line}");
                refused += 1;
            }
            (Ok(_), Some(_)) => wrong.push(format!("{name} should be refused")),
            (Err(error), None) => wrong.push(format!("{name} should load: {error}")),
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    assert_eq!(
        refused,
        REFUSED.len(),
        "some files that should be refused are missing"
    );
    assert!(
        files.len() >= 130,
        "only {} files in {}",
        files.len(),
        scenes.display()
    );
}

#[test]
fn textures_are_found_and_upright() {
    let Some(shared) = crate::common::shared() else {
        return;
    };
    let load = |name: &str| {
        load(&shared.join("scenes").join(name), &LoadOptions::default())
            .expect(name)
            .scene
    };
    for (name, textures) in [
        ("medieval_building/Medieval_building.obj", 7),
        ("spot/spot_triangulated.obj", 1),
        ("kenney_suburb/OBJ format/building-type-a.obj", 1),
        ("trimesh_odd/fuze.obj", 1),
    ] {
        let scene = load(name);
        assert_eq!(
            scene.textures.len(),
            textures,
            "{name}: {:?}",
            scene.warnings
        );
        assert!(
            scene.materials.iter().any(|m| m.diffuse_texture.is_some()),
            "{name}"
        );
    }
    // The cow's muzzle is pink in the texture; with flipped v it would have the colour of the hide.
    let spot = load("spot/spot_triangulated.obj");
    let texture = &spot.textures[0];
    let front = (0..spot.positions.len())
        .min_by(|a, b| spot.positions[*a][2].total_cmp(&spot.positions[*b][2]));
    let [u, v] = spot.texcoords[front.expect("a vertex")];
    let texel = |t: f32, n: u32| ((t * n as f32) as u32).min(n - 1) as usize;
    let at = 4 * (texel(v, texture.height) * texture.width as usize + texel(u, texture.width));
    let [r, _, b] = [0, 1, 2].map(|i| i32::from(texture.rgba8[at + i]));
    assert!(r - b > 40, "the muzzle is {:?}", &texture.rgba8[at..at + 3]);
}

/// Names and contents of files.
type Files<'a> = &'a [(&'a str, &'a [u8])];

/// Writes these files to a scratch folder; also returns the path of the first.
fn folder(files: Files) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for (name, bytes) in files {
        fs::write(folder.path().join(name), bytes).expect("a file");
    }
    let first = folder.path().join(files[0].0);
    (folder, first)
}

fn try_load(files: Files) -> Result<Loaded, String> {
    let (_folder, path) = folder(files);
    load(&path, &LoadOptions::default()).map_err(|error| error.to_string())
}

const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

#[test]
fn hostile_models_fail_with_one_line() {
    let faced = |face: &str| format!("{TRIANGLE}{face}\n").into_bytes();
    let many = "v ".repeat(100_000);
    for (text, part) in [
        (Vec::new(), "has no triangles"),
        (TRIANGLE.as_bytes().to_vec(), "has no triangles"),
        (faced("f 1 2 4"), "line 4"),
        (faced("f 1 2 4294967297"), "line 4"),
        (faced("f 1 2 99999999999999999999999999"), "line 4"),
        (faced("f 1 2 -99999999999"), "line 4"),
        (faced("f 0 0 0"), "line 4"),
        (faced("f 1 2 3/1/1/1"), "line 4"),
        (faced("f 1 2 three"), "line 4"),
        (faced("f 1 1 1"), "1 triangles without area"),
        (
            b"v 1e400 0 0\nv 1 nan 0\nv 0 1 -inf\nf 1 2 3".to_vec(),
            "1 triangles with infinite",
        ),
        (many.into_bytes(), "line 1"),
        (vec![0; 10_000], "has no triangles"),
        (vec![0xff; 10_000], "has no triangles"),
        ("f \\\n".repeat(1000).into_bytes(), "line 1"),
    ] {
        let error = try_load(&[("m.obj", &text)]).expect_err(part);
        assert!(error.contains(part) && error.contains("m.obj"), "{error}");
        assert_eq!(error.lines().count(), 1, "{error}");
    }
}

#[test]
fn a_line_that_cannot_be_read_costs_the_line() {
    let whole = try_load(&[("m.obj", format!("{TRIANGLE}f 1 2 3\n").as_bytes())]).expect("sound");
    for (line, part) in [
        (
            "f 1 2 4",
            "line 5: \"4\" refers to a vertex that does not exist (there are 3)",
        ),
        ("f 1 2 three", "line 5: \"three\" is not a corner of a face"),
        ("v a b c", "line 5: a vertex position is not a number"),
        ("v 1 2", "line 5: a vertex position needs three numbers"),
        ("vn 1 x 0", "line 5: a normal is not a number"),
        ("vt x", "line 5: a texture coordinate is not a number"),
    ] {
        let text = format!("{TRIANGLE}f 1 2 3\n{line}\n");
        let scene = try_load(&[("m.obj", text.as_bytes())]).expect(line).scene;
        assert_eq!(scene.positions, whole.scene.positions, "{line}");
        assert_eq!(scene.indices, whole.scene.indices, "{line}");
        assert_eq!(scene.warnings.len(), 1, "{line}: {:?}", scene.warnings);
        assert!(
            scene.warnings[0].contains(part),
            "{line}: {:?}",
            scene.warnings
        );
    }
}

#[test]
fn missing_libraries_and_textures_are_warnings() {
    let obj = format!("mtllib m.mtl\n{TRIANGLE}usemtl a\nf 1 2 3\n");
    let obj = obj.as_bytes();
    let cases: [(Files, &str); 5] = [
        (&[("m.obj", obj)], "material library \"m.mtl\" is missing"),
        (
            &[("m.obj", obj), ("m.mtl", b"newmtl b\n")],
            "material \"a\" not defined",
        ),
        (
            &[("m.obj", obj), ("m.mtl", b"newmtl a\nmap_Kd x.png\n")],
            "x.png is missing",
        ),
        (
            &[
                ("m.obj", obj),
                ("m.mtl", b"newmtl a\nmap_Kd x.png\n"),
                ("x.png", b"\x89PNG\r\n\x1a\nrest"),
            ],
            "cannot be decoded",
        ),
        (
            &[("m.obj", obj), ("m.mtl", b"newmtl a\nKd 1\nKs 1 2\n")],
            "1 malformed lines ignored",
        ),
    ];
    for (files, part) in cases {
        let scene = try_load(files).expect(part).scene;
        assert!(
            scene.warnings.iter().any(|w| w.contains(part)),
            "{part}: {:?}",
            scene.warnings
        );
        assert_valid(part, &scene);
    }
}

#[test]
fn invisible_materials_are_not_drawn_and_counted_and_others_are_glass() {
    let obj = format!("mtllib m.mtl\n{TRIANGLE}usemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n");
    let files: [(&str, &[u8]); 2] = [
        ("m.obj", obj.as_bytes()),
        ("m.mtl", b"newmtl a\nd 0\nnewmtl b\nd 0.6\n"),
    ];
    let scene = try_load(&files).expect("one triangle is left").scene;
    assert_eq!(scene.triangles(), 1);
    let glass = scene.materials[0].glass.expect("glass");
    assert!(glass.iter().all(|v| (v - 0.4).abs() < 1e-6), "{glass:?}");
    assert!(
        scene.warnings[0].contains("1 triangles of transparent materials"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn a_picture_that_claims_to_be_huge_is_not_decoded() {
    let mut png = Vec::new();
    image::RgbaImage::new(1, 1)
        .write_to(&mut std::io::Cursor::new(&mut png), image::ImageFormat::Png)
        .expect("a PNG");
    // Width and height are the first fields of the header chunk. Its checksum becomes wrong, but the size is checked first.
    png[16..24].copy_from_slice(&[0, 1, 0, 0, 0, 1, 0, 0]);
    let obj = format!("mtllib m.mtl\n{TRIANGLE}usemtl a\nf 1 2 3\n");
    let files: [(&str, &[u8]); 3] = [
        ("m.obj", obj.as_bytes()),
        ("m.mtl", b"newmtl a\nmap_Kd x.png\n"),
        ("x.png", &png),
    ];
    let scene = try_load(&files).expect("a plain triangle").scene;
    assert!(
        scene.textures.is_empty() && scene.warnings[0].contains("x.png"),
        "{:?}",
        scene.warnings
    );
}

#[test]
fn paths_that_are_not_files() {
    let options = LoadOptions::default();
    let (folder, _) = folder(&[("a.obj", b"")]);
    let folder = folder.path();
    fs::create_dir(folder.join("dir.obj")).expect("a folder");
    for (name, part) in [
        ("none.obj", "no such file"),
        ("none.toml", "no such file"),
        ("none", "no such file"),
        ("a.obj/b.obj", "no such file"),
        ("dir.obj", "is a directory"),
        ("", "is a directory"),
    ] {
        let error = load(&folder.join(name), &options)
            .expect_err(name)
            .to_string();
        assert!(
            error.contains(part) && error.lines().count() == 1,
            "{name}: {error}"
        );
    }
    let device = load(Path::new("/dev/zero"), &options)
        .map(|_| ())
        .map_err(|e| e.to_string());
    assert!(device.is_err(), "a device is no model");
    let small = LoadOptions {
        max_file_bytes: 3,
        ..options
    };
    fs::write(folder.join("a.obj"), TRIANGLE).expect("a file");
    let error = load(&folder.join("a.obj"), &small)
        .expect_err("too large")
        .to_string();
    assert!(error.contains("the limit is 3"), "{error}");
}

#[test]
fn malformed_scene_files_fail_with_one_line() {
    let error = try_load(&[("s.toml", b"[[mesh]]\nfile = \"s.toml\"\n")]).expect_err("itself");
    assert!(
        error.contains("s.toml") && error.contains("is a scene file"),
        "{error}"
    );
    let deep = format!("a = {}", "[".repeat(100_000));
    let error = try_load(&[("s.toml", deep.as_bytes())]).expect_err("deep");
    assert!(
        error.contains("line 1 is no TOML") && error.len() < 400,
        "{error}"
    );
    let typo = b"[[mesh]]\nfile = \"m.obj\"\n[sky]\nturbidty = 3\n";
    let triangle = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    let loaded = try_load(&[("s.toml", typo), ("m.obj", triangle)]).expect("a scene");
    let typo = Options::resolve(&OptionValues::default(), &loaded).expect_err("typo");
    let typo = typo.to_string();
    assert!(
        typo.contains("turbidty") && typo.contains("known are sky, turbidity"),
        "{typo}"
    );
}

#[test]
fn progress_is_reported_from_another_thread() {
    let told = std::sync::Mutex::new(Vec::new());
    let tell = |share: f32, stage: &'static str| told.lock().expect("told").push((share, stage));
    let scene = std::thread::scope(|threads| {
        let loading = threads
            .spawn(|| load_with_progress(None, &LoadOptions::default(), &tell).expect("bundled"));
        loading.join().expect("loaded").scene
    });
    assert!(scene.triangles() > 0);
    let told = told.into_inner().expect("told");
    assert!(
        told.len() > 3 && told.is_sorted_by(|a, b| a.0 <= b.0),
        "{told:?}"
    );
    assert_eq!(told.last().map(|t| t.0), Some(1.0));
}

#[test]
fn the_island_is_valid() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("assets/island.toml");
    let island = load(&path, &LoadOptions::default()).expect("the island");
    assert_valid("island", &island.scene);
    assert_eq!(island.scene.warnings, Vec::<String>::new());
    let triangles = island.scene.triangles();
    assert!((150_000..300_000).contains(&triangles), "{triangles}");
    let names = |list: &[skylight::scene::NamedOptions]| -> Vec<String> {
        list.iter().map(|named| named.name.clone()).collect()
    };
    assert_eq!(names(&island.cameras), ["bay", "temple", "veranda"]);
    assert_eq!(
        names(&island.moments),
        ["morning", "noon", "evening", "dusk", "moonlight"]
    );
    let sea = island
        .scene
        .casting()
        .iter()
        .filter(|casts| !**casts)
        .count();
    assert_eq!(sea, 1, "only the sea casts no shadow");
}

/// Writes a model that is large enough for the cache, with a library.
fn large_model(folder: &Path) -> PathBuf {
    let mut text = String::from("mtllib m.mtl\nusemtl a\n");
    for i in 0..90_000 {
        text += &format!("v {i}.25 0 0.5\nv {i}.75 1.5 0\nv {i}.5 0 1\nf -3 -2 -1\n");
    }
    fs::write(folder.join("m.mtl"), "newmtl a\nKd 0.1 0.2 0.3\n").expect("a library");
    fs::write(folder.join("m.obj"), text).expect("a model");
    folder.join("m.obj")
}

#[test]
fn a_cached_model_is_equal_and_damaged_or_stale_entries_are_replaced() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = large_model(folder.path());
    let cache = folder.path().join("cache");
    let options = LoadOptions {
        cache: Some(cache.clone()),
        ..LoadOptions::default()
    };
    let mut plain = load(&path, &LoadOptions::default()).expect("a model");
    plain.scene.bvh = Some(plain.scene.hierarchy().into_owned());
    let entries = || -> Vec<PathBuf> {
        let list = fs::read_dir(&cache).expect("the cache");
        list.map(|entry| entry.expect("an entry").path()).collect()
    };
    assert_eq!(load(&path, &options).expect("read"), plain);
    let [entry] = &entries()[..] else {
        panic!("one entry: {:?}", entries())
    };
    let whole = fs::read(entry).expect("the entry");
    assert_eq!(load(&path, &options).expect("from the cache"), plain);
    for at in [0, 9, whole.len() / 2, whole.len() - 1] {
        let mut damaged = whole.clone();
        damaged[at] ^= 0x40;
        fs::write(entry, &damaged).expect("damage");
        assert_eq!(load(&path, &options).expect("rebuilt"), plain, "byte {at}");
        assert_eq!(fs::read(entry).expect("the new entry"), whole, "byte {at}");
    }
    fs::write(entry, &whole[..whole.len() / 3]).expect("a cut");
    assert_eq!(load(&path, &options).expect("rebuilt"), plain);
    fs::write(folder.path().join("m.mtl"), "newmtl a\nKd 0.9 0.2 0.3\n").expect("a library");
    let changed = load(&path, &options).expect("with the new library").scene;
    assert_eq!(changed.materials[0].diffuse[0], 0.9);
}

#[test]
fn a_cache_that_cannot_be_written_is_one_warning() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = large_model(folder.path());
    let file = folder.path().join("m.mtl");
    let options = LoadOptions {
        cache: Some(file.join("cache")),
        ..LoadOptions::default()
    };
    let mut plain = load(&path, &LoadOptions::default()).expect("a model").scene;
    plain.bvh = Some(plain.hierarchy().into_owned());
    let mut scene = load(&path, &options).expect("a model").scene;
    let warnings = std::mem::take(&mut scene.warnings);
    assert!(
        warnings.len() == 1 && warnings[0].contains("cannot be cached in"),
        "{warnings:?}"
    );
    assert!(warnings[0].contains("--no-cache"), "{warnings:?}");
    assert_eq!(scene, plain);
}

#[test]
fn models_read_nothing_outside_their_folder() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let inner = folder.path().join("inner");
    fs::create_dir(&inner).expect("a folder");
    let png = folder.path().join("secret.png");
    image::RgbImage::new(2, 2).save(&png).expect("a picture");
    let outside = png.display();
    let link = inner.join("link.png");
    std::os::unix::fs::symlink(&png, &link).expect("a link");
    for name in ["../secret.png", "link.png", &outside.to_string()] {
        let mtl = format!("newmtl a\nmap_Kd {name}\n");
        fs::write(inner.join("m.mtl"), mtl).expect("a library");
        let obj = format!("mtllib m.mtl\n{TRIANGLE}usemtl a\nf 1 2 3\n");
        fs::write(inner.join("m.obj"), obj).expect("a model");
        let scene = load(&inner.join("m.obj"), &LoadOptions::default())
            .expect(name)
            .scene;
        assert!(scene.textures.is_empty(), "{name}");
        let told = scene.warnings.iter().any(|w| w.contains("--allow-outside"));
        assert!(told, "{name}: {:?}", scene.warnings);
        let trusting = LoadOptions {
            allow_outside: true,
            ..LoadOptions::default()
        };
        let scene = load(&inner.join("m.obj"), &trusting).expect(name).scene;
        assert_eq!(scene.textures.len(), 1, "{name}: {:?}", scene.warnings);
    }
}
