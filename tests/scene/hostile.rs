//! Models crafted to cost time and memory: each one loads or fails in bounded time and memory.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use skylight::scene::{LoadOptions, Loaded, SceneError, load};

use crate::support::glb;

const CORNERS: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

fn options() -> LoadOptions {
    LoadOptions {
        max_file_bytes: 16 << 20,
        max_texture_bytes: 16 << 20,
        max_triangles: 100_000,
        ..LoadOptions::default()
    }
}

/// Loads a model; fails the test if it takes longer than `seconds`.
fn load_within(path: &Path, seconds: u64) -> Result<Loaded, SceneError> {
    let started = Instant::now();
    let result = load(path, &options());
    let took = started.elapsed();
    println!("{}: {took:.1?}", path.display());
    assert!(took < Duration::from_secs(seconds), "{took:?}");
    result
}

fn error_of(result: Result<Loaded, SceneError>) -> String {
    let line = result.expect_err("too much").to_string();
    assert_eq!(line.lines().count(), 1, "{line}");
    line
}

#[test]
fn a_library_of_many_spellings_is_read_once() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    fs::create_dir(folder.path().join("x")).expect("a folder");
    // One megabyte; the limit allows reading it sixteen times.
    let library = "newmtl a\nKd 1 0 0\n".repeat(60_000);
    fs::write(folder.path().join("m.mtl"), library).expect("written");
    let spellings: String = (0..500)
        .map(|i| {
            format!(
                "mtllib {}{}m.mtl\n",
                "./".repeat(i % 50),
                "x/../".repeat(i / 50)
            )
        })
        .collect();
    let obj = folder.path().join("a.obj");
    fs::write(&obj, format!("{spellings}{CORNERS}usemtl a\nf 1 2 3\n")).expect("written");
    let scene = load_within(&obj, 20).expect("a sound model").scene;
    assert_eq!(scene.materials[0].diffuse, [1.0, 0.0, 0.0]);
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
}

#[test]
fn a_scene_that_names_a_model_too_often_fails() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let points = "v 0 0 0\n".repeat(100_000);
    fs::write(
        folder.path().join("a.obj"),
        format!("{CORNERS}{points}f 1 2 3\n"),
    )
    .expect("written");
    let toml = folder.path().join("a.toml");
    fs::write(&toml, "[[mesh]]\nfile = \"a.obj\"\n".repeat(20_000)).expect("written");
    let line = error_of(load_within(&toml, 20));
    assert!(
        line.contains("a.obj") && line.contains("--max-file-mib"),
        "{line}"
    );
}

#[test]
fn polygons_count_before_they_are_split() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let obj = folder.path().join("a.obj");
    fs::write(&obj, format!("{CORNERS}f{}\n", " 1 2 3".repeat(2_000_000))).expect("written");
    let line = error_of(load_within(&obj, 20));
    assert!(
        line.contains("5999998 triangles") && line.contains("--max-triangles"),
        "{line}"
    );
}

#[test]
fn the_work_on_pictures_that_fail_is_bounded() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let mut png = std::io::Cursor::new(Vec::new());
    image::DynamicImage::new_rgb8(1800, 1800)
        .write_to(&mut png, image::ImageFormat::Png)
        .expect("an encoder");
    let png = png.into_inner();
    // The end is missing, so decoders fail only after nearly all of the work.
    let cut = &png[..png.len() - 40];
    let (mut mtl, mut faces) = (String::new(), String::new());
    for i in 0..400 {
        fs::write(folder.path().join(format!("{i}.png")), cut).expect("written");
        mtl += &format!("newmtl m{i}\nmap_Kd {i}.png\nmap_Pr whole.png\n");
        faces += &format!("usemtl m{i}\nf 1 2 3\n");
    }
    fs::write(folder.path().join("whole.png"), &png).expect("written");
    fs::write(folder.path().join("m.mtl"), mtl).expect("written");
    let obj = folder.path().join("a.obj");
    fs::write(&obj, format!("mtllib m.mtl\n{CORNERS}{faces}")).expect("written");
    let scene = load_within(&obj, 20).expect("drawn without textures").scene;
    let said = scene.warnings.join("\n");
    assert!(said.contains("cannot be decoded"), "{said}");
    assert!(said.contains("exceeds the limit on decoding"), "{said}");
}

#[test]
fn buffers_and_primitives_that_are_the_same_are_not_copied() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let path = folder.path().join("a.glb");
    // A thousand buffers of 8 MB that share one chunk: 8 GB if each were copied.
    let binary = vec![0u8; 8 << 20];
    let buffers = vec![format!(r#"{{"byteLength":{}}}"#, binary.len()); 1000].join(",");
    let json = format!(
        r#"{{"asset":{{"version":"2.0"}},"buffers":[{buffers}],"scenes":[{{"nodes":[0]}}],"nodes":[{{"mesh":0}}],
        "bufferViews":[{{"buffer":0,"byteLength":{0}}}],
        "accessors":[{{"bufferView":0,"componentType":5126,"type":"VEC3","count":60000,"min":[0,0,0],"max":[0,0,0]}}],
        "meshes":[{{"primitives":[{1}]}}]}}"#,
        binary.len(),
        vec![r#"{"attributes":{"POSITION":0}}"#; 20_000].join(","),
    );
    fs::write(&path, glb(json.as_bytes(), &binary)).expect("written");
    // All of its 400 million triangles are degenerate: none is drawn, but they count toward the limit.
    let line = error_of(load_within(&path, 20));
    assert!(line.contains("--max-triangles"), "{line}");
}

/// Runs the program on a model; returns its peak memory, bytes.
#[cfg(target_os = "linux")]
fn peak(model: Option<&Path>, folder: &Path) -> u64 {
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_skylight"))
        .arg("render")
        .args(model)
        .args([
            "--size",
            "16x16",
            "--shadow-size",
            "64",
            "--ambient",
            "ssao",
            "--ao-radius",
            "0",
            "--no-cache",
            "-o",
        ])
        .arg(folder.join("o.png"))
        .stdout(std::process::Stdio::null())
        .spawn()
        .expect("the program starts");
    let mut peak = 0;
    while child.try_wait().expect("a state").is_none() {
        let status = fs::read_to_string(format!("/proc/{}/status", child.id())).unwrap_or_default();
        let line = status.lines().find(|line| line.starts_with("VmHWM:"));
        let kib = line.and_then(|line| line.split_whitespace().nth(1)?.parse::<u64>().ok());
        peak = kib.map_or(peak, |kib| kib << 10);
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(child.wait().expect("an end").success());
    peak
}

/// Limit on peak memory relative to the model's size. Ordinary models need less than 6; one material per face needs most.
#[cfg(target_os = "linux")]
const MULTIPLE: f64 = 60.0;

#[cfg(target_os = "linux")]
#[test]
fn memory_is_bounded_by_a_multiple_of_the_file() {
    let folder = tempfile::tempdir().expect("a scratch folder");
    let base = peak(None, folder.path());
    // Tiny faces, so that drawing takes no time.
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 0 0\nv 1e-4 0 0\nv 0 1e-4 0\nf 1 2 3\n";
    for (name, body) in [
        ("triangles", "f 4 5 6\n".repeat(1_000_000)),
        ("quads", "f 4 5 6 5\n".repeat(800_000)),
        ("a polygon", format!("f{}\n", " 4 5 6".repeat(1_000_000))),
        ("points", "v 1 1 1\n".repeat(1_000_000)),
        (
            "materials",
            (0..400_000)
                .map(|i| format!("usemtl {i}\nf 4 5 6\n"))
                .collect(),
        ),
    ] {
        let obj = folder.path().join("a.obj");
        fs::write(&obj, format!("{corners}{body}")).expect("written");
        let size = obj.metadata().expect("the model").len();
        let multiple = peak(Some(&obj), folder.path()).saturating_sub(base) as f64 / size as f64;
        println!(
            "{name}: {:.1} MB, {multiple:.1} times the file in memory",
            size as f64 / 1e6
        );
        assert!(multiple < MULTIPLE, "{name}: {multiple}");
    }
}
