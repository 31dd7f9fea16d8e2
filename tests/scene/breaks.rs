//! A good file in which one thing that is not drawn is broken at a time gives the same scene; a part that is drawn and broken
//! costs itself, with one warning that names it.

use std::fs;

use serde_json::{Value, json};
use skylight::scene::{LoadOptions, Scene, load};

use crate::support::{assert_valid, glb};

/// Loads a file of these files, or says why not.
fn load_of(files: &[(&str, Vec<u8>)]) -> Result<Scene, String> {
    let folder = tempfile::tempdir().expect("a scratch folder");
    for (name, bytes) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().expect("a folder")).expect("a folder");
        fs::write(path, bytes).expect("a file");
    }
    let path = folder.path().join(files[0].0);
    match load(&path, &LoadOptions::default()) {
        Ok(loaded) => Ok(loaded.scene),
        Err(error) => Err(error.to_string()),
    }
}

/// What is seen of two scenes is the same.
fn assert_same(name: &str, scene: &Scene, good: &Scene) {
    assert_valid(name, scene);
    assert_eq!(
        scene.positions, good.positions,
        "{name}: {:?}",
        scene.warnings
    );
    assert_eq!(scene.normals, good.normals, "{name}");
    assert_eq!(scene.texcoords, good.texcoords, "{name}");
    assert_eq!(scene.indices, good.indices, "{name}");
    assert_eq!(scene.textures, good.textures, "{name}");
    let looks = |scene: &Scene| -> Vec<_> {
        let parts = scene.parts.iter();
        let materials = parts.map(|part| scene.materials[part.material as usize].clone());
        materials
            .map(|m| {
                (
                    m.diffuse,
                    m.specular,
                    m.shininess,
                    m.alpha_cutoff,
                    m.dissolve,
                )
            })
            .collect()
    };
    assert_eq!(looks(scene), looks(good), "{name}");
}

fn picture() -> Vec<u8> {
    let picture =
        image::RgbImage::from_fn(4, 4, |x, y| image::Rgb([60 * x as u8, 60 * y as u8, 9]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    picture
        .write_to(&mut bytes, image::ImageFormat::Png)
        .expect("an encoder");
    bytes.into_inner()
}

/// Two quads of different materials, one textured: the JSON and the buffer.
fn gltf() -> (Value, Vec<u8>) {
    let quad = [0f32, 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.];
    let numbers = quad
        .into_iter()
        .chain(quad.map(|v| v + 2.0))
        .chain([0., 1., 1., 1., 1., 0., 0., 0.]);
    let mut buffer: Vec<u8> = numbers.flat_map(f32::to_le_bytes).collect();
    buffer.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    let floats = |view: usize, kind: &str| json!({"bufferView": view, "componentType": 5126, "type": kind, "count": 4});
    let json = json!({
        "asset": {"version": "2.0", "generator": "test"},
        "scene": 0, "scenes": [{"nodes": [0, 1]}],
        "nodes": [{"mesh": 0, "name": "first"}, {"mesh": 1, "translation": [3, 0, 0]}],
        "meshes": [
            {"primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 2}, "indices": 3, "material": 0}]},
            {"primitives": [{"attributes": {"POSITION": 1}, "indices": 3, "material": 1}]}],
        "materials": [
            {"name": "brick", "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicFactor": 0}},
            {"name": "red", "pbrMetallicRoughness": {"baseColorFactor": [0.8, 0.1, 0.1, 1], "metallicFactor": 0}}],
        "textures": [{"source": 0}], "images": [{"uri": "a.png"}],
        "accessors": [floats(0, "VEC3"), floats(1, "VEC3"), floats(2, "VEC2"),
            {"bufferView": 3, "componentType": 5123, "type": "SCALAR", "count": 6}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}, {"buffer": 0, "byteOffset": 48, "byteLength": 48},
            {"buffer": 0, "byteOffset": 96, "byteLength": 32}, {"buffer": 0, "byteOffset": 128, "byteLength": 12}],
        "buffers": [{"byteLength": buffer.len(), "uri": "a.bin"}]});
    (json, buffer)
}

fn load_gltf(text: &[u8]) -> Result<Scene, String> {
    let (_, buffer) = gltf();
    load_of(&[
        ("m.gltf", text.to_vec()),
        ("a.bin", buffer),
        ("a.png", picture()),
    ])
}

/// The good file with a value put at a place: a pointer into the JSON, whose last part may be new or `-` for the end of a list.
fn with(pointer: &str, value: Value) -> Vec<u8> {
    let (mut json, _) = gltf();
    let (parent, key) = pointer.rsplit_once('/').expect("a pointer");
    match json.pointer_mut(parent).expect(pointer) {
        Value::Object(map) => drop(map.insert(key.to_owned(), value)),
        Value::Array(list) if key == "-" => list.push(value),
        Value::Array(list) => list[key.parse::<usize>().expect("an index")] = value,
        other => panic!("{pointer}: {other}"),
    }
    json.to_string().into_bytes()
}

#[test]
fn what_is_not_drawn_of_a_gltf_does_not_matter() {
    let (json, _) = gltf();
    let text = json.to_string();
    let good = load_gltf(text.as_bytes()).expect("the good file");
    assert_eq!(
        (good.triangles(), good.textures.len(), good.warnings.len()),
        (4, 1, 0)
    );
    for (pointer, value) in [
        ("/animations", json!([{"channels": "none"}])),
        (
            "/animations",
            json!([{"channels": [{"sampler": 9, "target": {"node": 99}}], "samplers": [{"input": -1}]}]),
        ),
        ("/animations", json!("a word")),
        ("/cameras", json!([{"type": "perspective"}])),
        ("/scenes/-", json!({})),
        ("/scenes/-", json!({"nodes": [99]})),
        ("/scenes/-", json!({"nodes": "none", "name": 5})),
        ("/scene", json!(7)),
        (
            "/skins",
            json!([{"joints": [99], "inverseBindMatrices": 99}]),
        ),
        ("/accessors/-", json!({"componentType": 1})),
        ("/accessors/-", json!(null)),
        ("/accessors/0/min", json!(["a", null])),
        ("/accessors/0/max", json!([0, 0, 0])),
        ("/accessors/0/name", json!({})),
        ("/bufferViews/-", json!({"buffer": 99, "byteLength": -1})),
        ("/bufferViews/0/target", json!("vertices")),
        ("/buffers/-", json!({"byteLength": 9, "uri": "gone.bin"})),
        ("/buffers/0/byteLength", json!(1)),
        ("/images/-", json!({"uri": "gone.png"})),
        ("/images/-", json!({})),
        ("/images/0/mimeType", json!("image/jpeg")),
        ("/textures/-", json!({"source": 99})),
        ("/textures/0/sampler", json!(99)),
        ("/samplers", json!([{"wrapS": "none"}])),
        (
            "/materials/-",
            json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": 99}}}),
        ),
        ("/materials/1/alphaCutoff", json!("half")),
        ("/materials/1/doubleSided", json!("yes")),
        ("/materials/1/occlusionTexture", json!({"index": 99})),
        (
            "/materials/1/extensions",
            json!({"KHR_materials_clearcoat": {"clearcoatFactor": 0}}),
        ),
        (
            "/meshes/-",
            json!({"primitives": [{"attributes": {"POSITION": 99}}]}),
        ),
        ("/meshes/0/weights", json!([0, 0])),
        ("/meshes/0/primitives/0/targets", json!([{"POSITION": 99}])),
        ("/meshes/0/primitives/0/attributes/_BATCHID", json!(99)),
        ("/meshes/0/primitives/0/attributes/JOINTS_0", json!("x")),
        ("/meshes/1/primitives/0/attributes/TEXCOORD_3", json!(99)),
        (
            "/nodes/-",
            json!({"children": [99], "mesh": 99, "rotation": [1]}),
        ),
        ("/nodes/0/name", json!(5)),
        ("/nodes/0/children", json!("none")),
        ("/extensionsUsed", json!(["ACME_unused"])),
        ("/extensionsRequired", json!(["KHR_xmp_json_ld", 5])),
        (
            "/extensions",
            json!({"KHR_lights_punctual": {"lights": [{"type": "spot"}]}}),
        ),
        ("/asset", json!(null)),
        ("/asset/version", json!("2.1")),
        ("/asset/minVersion", json!(9)),
        ("/asset/copyright", json!(["x"])),
        ("/extras", json!({"any": [1, {"thing": null}]})),
        ("/nodes/0/mesh", json!(0.0)),
    ] {
        let scene = load_gltf(&with(pointer, value.clone())).expect(pointer);
        assert_same(&format!("{pointer} = {value}"), &scene, &good);
        assert_eq!(scene.warnings, good.warnings, "{pointer} = {value}");
    }
}

#[test]
fn spellings_of_json_do_not_matter() {
    let (json, buffer) = gltf();
    let text = json.to_string();
    let good = load_gltf(text.as_bytes()).expect("the good file");
    let named = |name: &str| text.replacen("first", name, 1).into_bytes();
    let extra = |extra: &str| text.replacen('{', &format!("{{{extra},"), 1).into_bytes();
    let mut latin = named("caf~");
    let at = latin
        .iter()
        .position(|byte| *byte == b'~')
        .expect("the letter");
    latin[at] = 0xE9;
    let wide: Vec<u8> = std::iter::once(0xFEFF)
        .chain(text.encode_utf16())
        .flat_map(u16::to_le_bytes)
        .collect();
    for (name, bytes) in [
        (
            "a byte order mark",
            [b"\xEF\xBB\xBF", text.as_bytes()].concat(),
        ),
        ("UTF-16", wide),
        ("a name in Latin-1", latin),
        ("padding", [text.as_bytes(), b"  \n\0\0\0"].concat()),
        ("a control character", named("a\tb")),
        ("a lone surrogate", named("\\ud83d!")),
        ("a backslash", named("C:\\models")),
        ("NaN", extra("\"extras\":{\"v\":NaN,\"w\":-Infinity}")),
        (
            "numbers of C",
            extra("\"extras\":[-nan(ind),1.#INF,.5,1e999]"),
        ),
        (
            "depth",
            extra(&format!(
                "\"extras\":{}1{}",
                "[".repeat(500),
                "]".repeat(500)
            )),
        ),
        ("comments", extra("/* who */ \"extras\":1 // what\n")),
        ("a trailing comma", extra("\"extras\":[1,2,]")),
        ("old line ends", text.replace(',', ",\r").into_bytes()),
    ] {
        let scene = load_gltf(&bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_same(name, &scene, &good);
    }
    let mut own = json.clone();
    own["buffers"][0] = json!({"byteLength": buffer.len()});
    let container = glb(own.to_string().as_bytes(), &buffer);
    let mut long = container.clone();
    long[8..12].copy_from_slice(&u32::MAX.to_le_bytes());
    let more = [&container[..], b"\x04\0\0\0ABCDjunk\x09"].concat();
    for (name, bytes) in [
        ("a GLB", container),
        ("a wrong length", long),
        ("another chunk", more),
    ] {
        for file in ["m.glb", "m.gltf"] {
            let files = [(file, bytes.clone()), ("a.png", picture())];
            assert_same(name, &load_of(&files).expect(name), &good);
        }
    }
}

#[test]
fn a_broken_part_of_a_gltf_costs_itself() {
    let primitive = "/meshes/1/primitives/0";
    let place = "meshes[1].primitives[0]";
    for (pointer, value, left, part) in [
        (format!("{primitive}/attributes"), json!({}), 2, place),
        (
            format!("{primitive}/attributes/POSITION"),
            json!(99),
            2,
            place,
        ),
        (
            format!("{primitive}/attributes/POSITION"),
            json!(3),
            2,
            place,
        ),
        (format!("{primitive}/indices"), json!("x"), 2, place),
        (format!("{primitive}/indices"), json!(1), 2, place),
        (format!("{primitive}/mode"), json!(12), 2, place),
        (
            format!("{primitive}/attributes/NORMAL"),
            json!(99),
            4,
            "attributes.NORMAL: accessors[99]",
        ),
        (
            format!("{primitive}/attributes/COLOR_0"),
            json!(3),
            4,
            "attributes.COLOR_0",
        ),
        (
            format!("{primitive}/material"),
            json!(99),
            4,
            "materials[99]",
        ),
        ("/nodes/1/mesh".to_owned(), json!(99), 2, "meshes[99]"),
        (
            "/nodes/1/translation".to_owned(),
            json!([1, 2]),
            2,
            "nodes[1]",
        ),
        ("/nodes/1/matrix".to_owned(), json!([1, 2]), 2, "nodes[1]"),
        (
            "/nodes/0/children".to_owned(),
            json!([0]),
            4,
            "nodes[0] below nodes[0]",
        ),
        (
            "/scenes/0/nodes/-".to_owned(),
            json!(99),
            4,
            "nodes[99] of the scene",
        ),
        ("/nodes/1/skin".to_owned(), json!(0), 4, "skins[0]"),
        ("/nodes/1/camera".to_owned(), json!(7), 4, "nodes[1].camera"),
        (
            "/accessors/1/count".to_owned(),
            json!(5),
            2,
            "an accessor exceeds bufferViews[1]",
        ),
        (
            "/bufferViews/1/byteOffset".to_owned(),
            json!(999),
            2,
            "bufferViews[1] exceeds its buffer",
        ),
        (
            "/bufferViews/1/byteStride".to_owned(),
            json!(4),
            2,
            "bufferViews[1]",
        ),
        (
            "/materials/0/pbrMetallicRoughness/baseColorTexture/index".to_owned(),
            json!(9),
            4,
            "textures[9]",
        ),
        ("/textures/0/source".to_owned(), json!(9), 4, "images[9]"),
        (
            "/images/0/uri".to_owned(),
            json!("gone.png"),
            4,
            "gone.png is missing",
        ),
        (
            "/images/0/uri".to_owned(),
            json!("a.bin"),
            4,
            "a.bin has an unknown format",
        ),
        (
            "/images/0/uri".to_owned(),
            json!("data:image/png;base64,%%"),
            4,
            "images[0]",
        ),
        (
            "/textures/0".to_owned(),
            json!({"extensions": {"KHR_texture_basisu": {"source": 0}}}),
            4,
            "KHR_texture_basisu",
        ),
        (
            "/materials/1/extensions".to_owned(),
            json!({"KHR_materials_sheen": {"sheenColorFactor": [1, 1, 1]}}),
            4,
            "KHR_materials_sheen",
        ),
        (
            "/nodes/0/extensions".to_owned(),
            json!({"ACME_fur": {}}),
            4,
            "ACME_fur",
        ),
        (
            "/extensionsRequired".to_owned(),
            json!(["ACME_fur"]),
            4,
            "ACME_fur",
        ),
    ] {
        let scene = load_gltf(&with(&pointer, value.clone())).expect(&pointer);
        assert_valid(&pointer, &scene);
        assert_eq!(
            scene.triangles(),
            left,
            "{pointer} = {value}: {:?}",
            scene.warnings
        );
        let named = scene.warnings.iter().filter(|w| w.contains(part)).count();
        assert_eq!(named, 1, "{pointer} = {value}: {:?}", scene.warnings);
        let long = scene.warnings.iter().find(|w| w.chars().count() > 250);
        assert_eq!(long, None, "{pointer}");
    }
}

#[test]
fn a_file_with_nothing_to_draw_is_refused_in_one_short_line() {
    let draco = json!([{"primitives": [{"attributes": {"POSITION": 0}, "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0}}}]}]);
    let mut compressed: Value = serde_json::from_slice(&with("/meshes", draco)).expect("JSON");
    compressed["accessors"][0]["bufferView"] = Value::Null;
    let first = json!({"asset": {"version": "1.0"}, "meshes": {"m": {"primitives": []}}});
    for (json, parts) in [
        (compressed, ["Draco", "transform"]),
        (first, ["glTF 1.0", "glTF 2.0"]),
        (
            json!({"asset": {"version": "2.0"}}),
            ["no triangles", "export"],
        ),
        (json!([1]), ["no glTF", "export"]),
    ] {
        let error = load_gltf(json.to_string().as_bytes()).expect_err(parts[0]);
        let line = &error[error.find("m.gltf").expect("the name")..];
        assert!(parts.iter().all(|part| line.contains(part)), "{line}");
        assert!(
            line.chars().count() <= 180 && line.lines().count() == 1,
            "{line}"
        );
    }
}

const OBJ: &str = "mtllib m.mtl\no house\nv 0 0 0\nv 1.5 0 0\nv 1.5 1.5 0\nv 0 1.5 0\nv 0 0 2.25\nvt 0 0\nvt 1 0\nvt 1 1\nvn 0 0 1\n\
    usemtl brick\nf 1/1/1 2/2/1 3/3/1\nf 1/1 3/3 4/1\nusemtl red\nf 1 2 5\n";
const MTL: &str = "newmtl brick\nKd 0.5 0.5 0.5\nmap_Kd tex/a.png\nnewmtl red\nKd 0.75 0.25 0.25\nKs 0.5 0.5 0.5\nNs 20\nillum 2\n";

fn load_obj(obj: impl Into<Vec<u8>>, mtl: impl Into<Vec<u8>>) -> Result<Scene, String> {
    load_of(&[
        ("m.obj", obj.into()),
        ("m.mtl", mtl.into()),
        ("tex/a.png", picture()),
    ])
}

#[test]
fn what_is_not_drawn_of_an_obj_does_not_matter() {
    let good = load_obj(OBJ, MTL).expect("the good file");
    assert_eq!(
        (good.triangles(), good.textures.len(), good.warnings.len()),
        (3, 1, 0)
    );
    let with = |from: &str, to: &str| OBJ.replace(from, to).into_bytes();
    let more = |line: &str| format!("{OBJ}{line}\n").into_bytes();
    let wide: Vec<u8> = std::iter::once(0xFEFF)
        .chain(OBJ.encode_utf16())
        .flat_map(u16::to_be_bytes)
        .collect();
    for (name, obj) in [
        ("Windows", with("\n", "\r\n")),
        ("old Macs", with("\n", "\r")),
        ("both", with("\nv", "\r\nv")),
        ("a byte order mark", format!("\u{feff}{OBJ}").into_bytes()),
        ("UTF-16", wide),
        ("tabs", with(" ", "\t").into_iter().collect()),
        ("blanks", with("\n", "  \n  ")),
        ("no last line end", OBJ.trim_end().into()),
        (
            "a comment behind a face",
            with("3/3/1\n", "3/3/1 # the wall of 1 2 3\n"),
        ),
        ("commas between corners", with("f 1 2 5", "f 1, 2, 5;")),
        (
            "a comment behind a vertex",
            with("v 1.5 0 0\n", "v 1.5 0 0 # 7 8 9\n"),
        ),
        (
            "a comment behind a material",
            with("usemtl red", "usemtl red # paint"),
        ),
        (
            "a name in another case",
            with("usemtl brick", "usemtl Brick"),
        ),
        ("decimal commas", with("1.5", "1,5")),
        ("exponents", with("1.5", "+15E-1")),
        ("Fortran", with("1.5", "0.15D+01")),
        ("a weight", with("v 1.5 0 0\n", "v 1.5 0 0 1.0\n")),
        ("white colours", with("v 1.5 0 0\n", "v 1.5 0 0 1 1 1\n")),
        ("a continued line", with("f 1 2 5", "f 1 \\\n2 5")),
        ("a face of a vertex that does not exist", more("f 1 2 99")),
        ("a face of words", more("f one two three")),
        ("a face with index 0", more("f 0 1 2")),
        ("a face of two corners", more("f 1 2")),
        ("a line", more("l 1 2 3")),
        ("a point", more("p 1")),
        ("a vertex that is no number", more("v -nan(ind) 1.#INF x")),
        ("a vertex of two numbers", more("v 1 2")),
        ("a normal that is no number", more("vn x y z")),
        ("a texture coordinate that is no number", more("vt x")),
        (
            "a curve",
            more("cstype bezier\ndeg 3\ncurv 0 1 1 2 3 4\nend"),
        ),
        ("an unknown word", more("wibble 1 2 3\n@#$%")),
        (
            "a group in Latin-1",
            [OBJ.as_bytes(), b"g caf\xE9\n"].concat(),
        ),
        ("zeros", [OBJ.as_bytes(), &[0; 40]].concat()),
        ("a missing library", more("mtllib gone.mtl")),
        ("a library twice", more("mtllib m.mtl")),
        (
            "a library in another case",
            with("mtllib m.mtl", "mtllib M.MTL"),
        ),
        (
            "a library of another machine",
            with("mtllib m.mtl", "mtllib C:\\models\\m.mtl"),
        ),
        (
            "a library with a comment",
            with("mtllib m.mtl", "mtllib m.mtl # materials"),
        ),
        (
            "a library of another name",
            with("mtllib m.mtl", "mtllib old%20name.mtl"),
        ),
        ("no library", with("mtllib m.mtl\n", "")),
        ("a smoothing group in words", with("o house", "s none")),
    ] {
        let scene = load_obj(obj, MTL).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_same(name, &scene, &good);
        assert!(scene.warnings.len() <= 1, "{name}: {:?}", scene.warnings);
    }
}

#[test]
fn what_is_not_drawn_of_an_mtl_does_not_matter() {
    let good = load_obj(OBJ, MTL).expect("the good file");
    let with = |from: &str, to: &str| MTL.replace(from, to).into_bytes();
    let more = |line: &str| format!("{MTL}{line}\n").into_bytes();
    for (name, mtl) in [
        ("Windows", with("\n", "\r\n")),
        ("old Macs", with("\n", "\r")),
        ("a byte order mark", format!("\u{feff}{MTL}").into_bytes()),
        ("blanks", with("\n", " \t\n\t")),
        (
            "a comment behind a colour",
            with("0.25 0.25\n", "0.25 0.25 # red\n"),
        ),
        (
            "a comment behind a picture",
            with("a.png", "a.png # bricks"),
        ),
        ("a picture in another case", with("tex/a.png", "TEX/A.PNG")),
        (
            "a picture of another machine",
            with("tex/a.png", "D:\\work\\tex\\a.png"),
        ),
        (
            "a picture with backslashes",
            with("tex/a.png", "tex\\a.png"),
        ),
        ("an encoded picture", with("tex/a.png", "tex%2Fa.png")),
        (
            "a picture in quotation marks",
            with("tex/a.png", "\"tex/a.png\""),
        ),
        ("decimal commas", with("0.25 0.25", "0,25 0,25")),
        ("one bad colour", more("Kd red")),
        ("half a colour", more("Ks 1 2")),
        ("a bad exponent", more("Ns shiny")),
        ("an exponent that is no number", more("Ns 1.#QNAN")),
        ("an unknown word", more("wibble 1 2")),
        ("a bad model of light", more("illum two")),
        (
            "no light of the surroundings",
            more("Ka 0 0 0\nmap_Ka gone.png"),
        ),
        ("white transmission", more("Tf 1 1 1")),
        ("opaque in both ways", more("d 1\nTr 0")),
        (
            "an unused material",
            more("newmtl unused\nmap_Kd gone.png\nKd x"),
        ),
        ("a material twice", more("newmtl red\nKd 0 0 1")),
        ("keys in capitals", with("Kd", "KD")),
        ("an idle coat", more("Pc 0\nPs 0\naniso 0")),
        (
            "a line before the first material",
            format!("Kd 1 1 1\n{MTL}").into_bytes(),
        ),
        ("a map without a name", more("map_Bump")),
        (
            "a name in Latin-1",
            [MTL.as_bytes(), b"newmtl caf\xE9\n"].concat(),
        ),
        ("zeros", [MTL.as_bytes(), &[0; 9]].concat()),
        (
            "an option without a value",
            with("map_Kd ", "map_Kd -clamp off "),
        ),
        ("a gamma", with("map_Kd ", "map_Kd -colorspace sRGB ")),
        ("no last line end", MTL.trim_end().into()),
    ] {
        let scene = load_obj(OBJ, mtl).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_same(name, &scene, &good);
        assert!(scene.warnings.len() <= 1, "{name}: {:?}", scene.warnings);
    }
}
