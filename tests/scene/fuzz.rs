//! Fuzz tests of files and command lines: valid input with random edits and with words known to break parsers. The result
//! must be a valid scene or a one-line error, in bounded time.
//!
//! `SKYLIGHT_FUZZ_CASES=1000000 cargo test --release --test scene fuzz` runs a million cases of each target.

use std::ffi::OsString;
use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use proptest::prelude::*;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use skylight::cli::{self, CliExit};
use skylight::scene::{LoadOptions, Scene, Up, load};

use crate::support::{assert_valid, glb};

/// Default number of cases per target.
const SHORT_RUN: u32 = 400;
/// Time after which loading counts as a hang, plus an allowance per byte of the files.
const LIMIT: Duration = Duration::from_secs(30);
const LIMIT_PER_BYTE: Duration = Duration::from_micros(50);
/// Small limits, so that exceeding them shows.
const OPTIONS: LoadOptions = LoadOptions {
    smooth_deg: None,
    up: Up::Y,
    unit: None,
    max_texture_edge: 512,
    max_texture_bytes: 4 << 20,
    max_file_bytes: 1 << 20,
    max_triangles: 20_000,
    allow_outside: false,
    cache: None,
};

/// Tests a property with `SKYLIGHT_FUZZ_CASES` random cases, or with the default cases, which are always the same. Failures
/// are shrunk and printed, not stored.
fn run<S: Strategy>(strategy: S, property: impl Fn(S::Value)) {
    let asked = std::env::var("SKYLIGHT_FUZZ_CASES").ok();
    let is_short = asked.is_none();
    let config = Config {
        cases: asked.map_or(SHORT_RUN, |n| n.parse().expect("a number of cases")),
        failure_persistence: None,
        max_shrink_iters: 2_000,
        ..Config::default()
    };
    let cases = config.cases;
    let mut runner = if is_short {
        let same = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
        TestRunner::new_with_rng(config, same)
    } else {
        TestRunner::new(config)
    };
    let started = Instant::now();
    let result = runner.run(&strategy, |value| {
        property(value);
        Ok(())
    });
    result.unwrap_or_else(|error| panic!("{error}"));
    println!("{cases} cases in {:.1} s", started.elapsed().as_secs_f32());
}

/// One edit of a file.
#[derive(Debug, Clone)]
enum Edit {
    Overwrite(u8),
    Insert(usize),
    Remove(usize),
    Double(usize),
    CutOff,
}

/// Edits; positions are fractions of the file's length.
fn edits() -> impl Strategy<Value = Vec<(f64, Edit)>> {
    let edit = prop_oneof![
        any::<u8>().prop_map(Edit::Overwrite),
        any::<usize>().prop_map(Edit::Insert),
        (1usize..40).prop_map(Edit::Remove),
        (1usize..200).prop_map(Edit::Double),
        Just(Edit::CutOff),
    ];
    prop::collection::vec((0.0..1.0f64, edit), 1..12)
}

fn edited(seed: &[u8], words: &[&str], edits: &[(f64, Edit)]) -> Vec<u8> {
    let mut bytes = seed.to_vec();
    for (place, edit) in edits {
        let at = (place * bytes.len() as f64) as usize;
        let end = |length: usize| (at + length).min(bytes.len());
        match edit {
            Edit::Overwrite(value) => {
                if let Some(byte) = bytes.get_mut(at) {
                    *byte = *value;
                }
            }
            Edit::Insert(number) => {
                let word = words[number % words.len()].bytes();
                bytes.splice(at..at, word);
            }
            Edit::Remove(length) => {
                bytes.drain(at..end(*length));
            }
            Edit::Double(length) => {
                let twice = bytes[at..end(*length)].to_vec();
                bytes.splice(at..at, twice);
            }
            Edit::CutOff => bytes.truncate(at),
        }
    }
    bytes
}

/// Checks the invariants and the limits of a scene.
fn assert_bounded(scene: &Scene) {
    assert_valid("fuzz", scene);
    assert!(scene.triangles() <= OPTIONS.max_triangles);
    let bytes: usize = scene.textures.iter().map(|t| t.rgba8.len()).sum();
    assert!(bytes as u64 <= OPTIONS.max_texture_bytes);
    assert!(scene.warnings.len() <= 101);
}

/// Writes the files and loads the first one.
fn try_files(folder: &Path, files: &[(&str, &[u8])]) {
    for (name, bytes) in files {
        fs::write(folder.join(name), bytes).expect("a scratch file");
    }
    let size: usize = files.iter().map(|(_, bytes)| bytes.len()).sum();
    let started = Instant::now();
    match load(&folder.join(files[0].0), &OPTIONS) {
        Ok(loaded) => assert_bounded(&loaded.scene),
        Err(error) => {
            let line = error.to_string();
            assert_eq!(line.lines().count(), 1, "{line}");
            assert!(line.len() < 2_000, "{} characters", line.len());
        }
    }
    let limit = LIMIT + LIMIT_PER_BYTE * size as u32;
    assert!(
        started.elapsed() < limit,
        "{size} bytes took {:?}",
        started.elapsed()
    );
}

const OBJ: &str = "mtllib m.mtl\no a\nv 0 0 0 1 0.5 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 1 1\n\
    vn 0 0 1\nusemtl red stone\ns 1\nf 1/1/1 2/2/1 3/3/1\nf -5 -4 -3 -2\ng b\nusemtl leaf\nf 1//1 2//1 5//1\n\
    f 1/1 3/2 5/3 4/1 2/2\ns off\nl 1 2\np 3\nf 1 2 \\\n 3\n";
const MTL: &str = "newmtl red stone\nKd 0.8 0.2 0.1\nKs 0.1\nNs 20\nd 0.9\nillum 2\nmap_Kd -s 2 2 -o 0.5 x.png\n\
    newmtl leaf\nPm 0.5\nPr 0.3\nmap_d -imfchan r x.png\nmap_Bump -bm 2 x.png\nnorm x.png\nTr 0.2\n";
const OBJ_WORDS: &[&str] = &[
    "nan",
    "inf",
    "-1",
    "0",
    "1e39",
    "99999999999999999999",
    "-9223372036854775808",
    "4294967295",
    "\\\n",
    "\n",
    "\0",
    "/",
    "//",
    "f 1 2 3\n",
    "f 1 1 1\n",
    "v 1 2\n",
    "v 3e38 3e38 -3e38\n",
    "vn 0 0 0\n",
    "s 4294967295\n",
    "usemtl a\n",
    "mtllib ../m.mtl\n",
    "mtllib /etc/passwd\n",
    "newmtl\n",
    "map_Kd ../../x.png\n",
    "map_Kd \n",
    "-bm",
    "\u{feff}",
    "é",
    "f 1 2 3 4 5 1 2 3 4 5 1 2 3 4 5\n",
    "Kd 1 0\n",
    "d -1\n",
    "Ns 1e38\n",
    "#",
    "1.#IND",
    "1,5",
    "\r",
    "-nan(ind)",
    "map_Kd -clamp on x.png\n",
    "v 500000 0 -6100000\n",
    "v 1 2 3 1 0 0 1\n",
];

fn png(width: u32, height: u32) -> Vec<u8> {
    encoded(width, height, image::ImageFormat::Png)
}

fn encoded(width: u32, height: u32, format: image::ImageFormat) -> Vec<u8> {
    let picture =
        image::RgbImage::from_fn(width, height, |x, y| image::Rgb([x as u8, y as u8, 90]));
    let mut bytes = std::io::Cursor::new(Vec::new());
    let picture = image::DynamicImage::ImageRgb8(picture);
    match format {
        image::ImageFormat::Hdr => picture.into_rgb32f().write_to(&mut bytes, format),
        _ => picture.write_to(&mut bytes, format),
    }
    .expect("an encoder");
    bytes.into_inner()
}

#[test]
fn obj_and_mtl() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    fs::write(folder.path().join("x.png"), png(4, 4)).expect("a picture");
    run((edits(), edits()), |(obj, mtl)| {
        let obj = edited(OBJ.as_bytes(), OBJ_WORDS, &obj);
        let mtl = edited(MTL.as_bytes(), OBJ_WORDS, &mtl);
        try_files(folder.path(), &[("m.obj", &obj), ("m.mtl", &mtl)]);
    });
}

/// A glTF file with two instances of a textured quad and a camera: the JSON and the binary chunk.
fn gltf_seed() -> (String, Vec<u8>) {
    let floats: [f32; 44] = std::array::from_fn(|i| match i {
        0..12 => [0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., 0.][i],
        12..24 => f32::from(i % 3 == 2),
        24..32 => [0., 1., 1., 1., 1., 0., 0., 0.][i - 24],
        _ => 0.5,
    });
    let mut binary: Vec<u8> = floats.iter().flat_map(|v| v.to_le_bytes()).collect();
    binary.truncate(176);
    binary.extend([0u16, 1, 2, 0, 2, 3].iter().flat_map(|i| i.to_le_bytes()));
    let picture = binary.len();
    binary.extend(png(4, 4));
    let length = binary.len() - picture;
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"scene":0,"scenes":[{{"nodes":[0,1]}}],
        "nodes":[{{"mesh":0,"children":[2],"scale":[2,1,-1],"extensions":{{"EXT_mesh_gpu_instancing":{{"attributes":{{"TRANSLATION":0}}}}}}}},{{"camera":0,"translation":[0,0,5]}},{{"mesh":1,"skin":0,"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,3,0,0,1]}}],
        "skins":[{{"joints":[1,0]}}],"samplers":[{{"wrapS":33071,"wrapT":33648}}],
        "cameras":[{{"type":"perspective","perspective":{{"yfov":0.7,"znear":0.1}}}}],
        "meshes":[{{"primitives":[{{"attributes":{{"POSITION":0,"NORMAL":1,"TEXCOORD_0":2,"COLOR_0":3}},"indices":4,"material":0,"mode":4}}]}},{{"weights":[0.5],"primitives":[{{"attributes":{{"POSITION":0,"JOINTS_0":5,"WEIGHTS_0":3}},"indices":4,"material":1,"targets":[{{"POSITION":1}}]}}]}}],
        "materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0,"extensions":{{"KHR_texture_transform":{{"offset":[0.5,0],"rotation":1,"scale":[2,2]}}}}}},"metallicFactor":0.5,"roughnessFactor":0.2}},"normalTexture":{{"index":0,"scale":0.5}},"alphaMode":"MASK","doubleSided":true}},{{"extensions":{{"KHR_materials_pbrSpecularGlossiness":{{"diffuseTexture":{{"index":0}},"glossinessFactor":0.5}}}}}}],
        "textures":[{{"source":0,"sampler":0}}],"images":[{{"bufferView":4,"mimeType":"image/png"}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":4,"min":[0,0,0],"max":[1,1,0]}},{{"bufferView":0,"byteOffset":48,"componentType":5126,"type":"VEC3","count":4}},{{"bufferView":1,"componentType":5126,"type":"VEC2","count":4}},{{"bufferView":2,"componentType":5126,"type":"VEC3","count":4}},{{"bufferView":3,"componentType":5123,"type":"SCALAR","count":6}},{{"bufferView":2,"componentType":5121,"type":"VEC4","count":4}}],
        "bufferViews":[{{"buffer":0,"byteLength":96}},{{"buffer":0,"byteOffset":96,"byteLength":32}},{{"buffer":0,"byteOffset":128,"byteLength":48}},{{"buffer":0,"byteOffset":176,"byteLength":12}},{{"buffer":0,"byteOffset":{picture},"byteLength":{length}}}],
        "extensionsUsed":["KHR_texture_transform"],"buffers":[{{"byteLength":{}}}]}}"#,
        binary.len()
    );
    (json, binary)
}

const GLTF_WORDS: &[&str] = &[
    "0",
    "9",
    "-1",
    "1e300",
    "4294967295",
    "18446744073709551615",
    "null",
    "[]",
    "{}",
    "\"\"",
    "[[[[[[[[",
    "\"mode\":5,",
    "\"mode\":6,",
    "\"mode\":0,",
    "\"children\":[0],",
    "\"byteStride\":4,",
    "\"byteOffset\":18446744073709551615,",
    "\"count\":1000000000,",
    "\"sparse\":{\"count\":1,\"indices\":{\"bufferView\":3,\"componentType\":5123},\"values\":{\"bufferView\":0}},",
    "\"normalized\":true,",
    "5121",
    "5120",
    "5125",
    "\"SCALAR\"",
    "\"VEC4\"",
    "\"MAT4\"",
    "\"uri\":\"../../etc/passwd\",",
    "\"uri\":\"data:;base64,AAAA\",",
    "\"TANGENT\":3,",
    "\"BLEND\"",
    "NaN",
    "// \n",
    "\\u",
    "\"skin\":0,",
    "\"weights\":[1,2,3],",
    "\"targets\":[{\"POSITION\":0}],",
    "\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"SCALE\":1}}},",
    "\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteLength\":96,\"byteStride\":12,\"count\":4,\"mode\":\"ATTRIBUTES\"}},",
    "\"extensions\":{\"KHR_draco_mesh_compression\":{}},",
    "33071",
    "\"extensionsRequired\":[\"KHR_draco_mesh_compression\"],",
];

#[test]
fn gltf_json_and_chunks() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let (json, binary) = gltf_seed();
    try_files(folder.path(), &[("m.glb", &glb(json.as_bytes(), &binary))]);
    let sound = load(&folder.path().join("m.glb"), &OPTIONS).expect("the seed itself");
    assert_eq!(
        (sound.scene.triangles(), sound.cameras.len()),
        (10, 1),
        "{:?}",
        sound.scene.warnings
    );
    assert_eq!(
        sound.scene.warnings.len(),
        1,
        "the normal map has no transform"
    );
    run(
        (edits(), edits(), edits(), 0..4u8),
        |(text, bytes, whole, which)| {
            let text = edited(json.as_bytes(), GLTF_WORDS, &text);
            let bytes = edited(&binary, GLTF_WORDS, &bytes);
            let file = match which {
                0 => glb(&text, &binary),
                1 => glb(json.as_bytes(), &bytes),
                2 => glb(&text, &bytes),
                _ => edited(&glb(json.as_bytes(), &binary), GLTF_WORDS, &whole),
            };
            try_files(folder.path(), &[("m.glb", &file)]);
        },
    );
}

/// Regressions: failures found by longer runs.
#[test]
fn former_crashes() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let (json, binary) = gltf_seed();
    let load = |json: &str| {
        let file = glb(json.as_bytes(), &binary);
        try_files(folder.path(), &[("m.glb", &file)]);
        load(&folder.path().join("m.glb"), &OPTIONS).map_err(|error| error.to_string())
    };
    for (sound, broken, part) in [
        (
            "\"accessors\"",
            "\"accessorz\"",
            "accessors[0] does not exist",
        ),
        (
            "\"POSITION\":0",
            "\"POSITION\":99",
            "accessors[99] does not exist",
        ),
        ("[{\"bufferView\":4,", "[{", "images[0]: it has neither"),
    ] {
        let told = match load(&json.replace(sound, broken)) {
            Ok(loaded) => loaded.scene.warnings.join("\n"),
            Err(line) => line,
        };
        assert!(told.contains(part), "{told}");
    }
    let toml = folder.path().join("s.toml");
    fs::write(&toml, "[[mesh]]\nfile = \"\"\"\na\nb\"\"\"\n").expect("a scratch file");
    let error = skylight::scene::load(&toml, &OPTIONS)
        .expect_err("no such file")
        .to_string();
    assert!(
        error.lines().count() == 1 && error.contains("a\\nb"),
        "{error}"
    );
    let untyped =
        load(&json.replace(",\"mimeType\":\"image/png\"", "")).expect("a picture without a type");
    assert_eq!(untyped.scene.textures.len(), 3);
}

const TOML: &str = "[[mesh]]\nfile = \"m.obj\"\ntranslate = [1, 2.5, -3]\nrotate = [0, 90, 0]\nscale = 2\nup = \"z\"\nsmooth = 30\n\
    [place]\nplace = [55.7, 12.6]\nwhen = 2026-06-21T14:00:00+02:00\n[sky]\nturbidity = 2.5\n[light]\nfresnel = \"schlick\"\n\
    [[moment]]\nname = \"noon\"\nturbidity = 4\n[[camera]]\nname = \"a\"\neye = [1, 2, 3]\ntarget = [0, 0, 0]\nfov = 40\n";
const TOML_WORDS: &[&str] = &[
    "[[mesh]]\n",
    "[mesh]\n",
    "nan",
    "inf",
    "1e300",
    "-1",
    "[",
    "]",
    "{}",
    "\"",
    "'''",
    "=",
    "\n",
    "file = \"../m.obj\"\n",
    "file = \"s.toml\"\n",
    "scale = 0\n",
    "1979-05-27",
    "true",
    "[[[[[[[[[[[[[[[[",
    "a.b.c = 1\n",
    "\u{0}",
    "é",
];

#[test]
fn scene_files() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    fs::write(folder.path().join("m.obj"), OBJ).expect("a model");
    fs::write(folder.path().join("m.mtl"), "newmtl leaf\nKd 0 1 0\n").expect("a library");
    run(edits(), |changes| {
        let toml = edited(TOML.as_bytes(), TOML_WORDS, &changes);
        try_files(folder.path(), &[("s.toml", &toml)]);
    });
}

#[test]
fn headers_of_pictures() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    fs::write(
        folder.path().join("m.mtl"),
        "newmtl a\nmap_Kd x.tga\nmap_d x.tga\nbump x.tga\n",
    )
    .expect("a library");
    let obj = b"mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\n";
    use image::ImageFormat::{Bmp, Gif, Hdr, Jpeg, Png, Tga, Tiff, WebP};
    let seeds = [Png, Jpeg, Bmp, Tga, Gif, WebP, Tiff, Hdr].map(|format| encoded(9, 7, format));
    let words = [
        "\u{0}\u{0}\u{0}\u{0}",
        "\u{7f}\u{7f}\u{7f}\u{7f}",
        "IDAT",
        "IHDR",
        "RIFF",
        "#?RADIANCE\n",
        "-Y 99999 +X 99999\n",
    ];
    // Half of the edits hit the headers, at the start of the file.
    let place = prop_oneof![Just(1.0f64), Just(0.15)];
    run(
        (0..seeds.len(), edits(), place),
        |(seed, mut changes, within)| {
            changes.iter_mut().for_each(|(at, _)| *at *= within);
            let picture = edited(&seeds[seed], &words, &changes);
            try_files(folder.path(), &[("m.obj", obj), ("x.tga", &picture)]);
        },
    );
}

const CLI_WORDS: &[&str] = &[
    "render",
    "bench",
    "sky",
    "bake",
    "info",
    "view",
    "--size",
    "1280x720",
    "0x0",
    "--when",
    "2026-06-21T14:00+02:00",
    "--sun",
    "215,42",
    "--place",
    "55,12",
    "--solar",
    "200,10",
    "-o",
    "a.png",
    "a.exr",
    "--turbidity",
    "nan",
    "-3",
    "1e400",
    "--preset",
    "lecture",
    "--eye",
    "1,2,3",
    "--show",
    "albedo",
    "--camera",
    "",
    "--",
    "-",
    "--help",
    "--layers",
    "--gamma",
    "=",
    "--size=",
    "--samples",
    "99999999999999999999",
    "scene.toml",
    "é\u{0}",
    "--allow-outside",
    "--max-triangles",
    "--moment",
    "noon",
    "--json",
];

#[test]
fn command_lines() {
    let word = prop_oneof![
        8 => (0..CLI_WORDS.len()).prop_map(|i| CLI_WORDS[i].to_owned()),
        1 => "\\PC{0,12}",
        1 => "--[a-z-]{1,12}(=[0-9.,x-]{0,9})?",
    ];
    run(prop::collection::vec(word, 0..9), |words| {
        let line = std::iter::once("skylight".to_owned()).chain(words);
        if let Err(CliExit::Usage(text)) = cli::parse(line.map(OsString::from)) {
            assert_eq!(text.lines().count(), 1, "{text}");
        }
    });
}
