//! `skylight bake` to KTX2, read back by the crate `ktx2`: every sky has its illuminance, by day and at night; levels of roughness.

use std::f64::consts::PI;
use std::path::Path;
use std::process::Command;

use glam::DVec3;
use half::f16;
use serde_json::Value;
use skylight::daylight::cube;

fn run(folder: &Path, line: &str) -> Vec<u8> {
    let output = Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder)
        .args(line.split_whitespace())
        .output()
        .expect("it starts");
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{line}: {errors}");
    output.stdout
}

/// A cube read back: values of each level, face by face and row by row, in the file's unit.
struct Cube {
    levels: Vec<Vec<DVec3>>,
    scale: f64,
    reader: ktx2::Reader<Vec<u8>>,
}

impl Cube {
    fn read(path: &Path) -> Self {
        let bytes = std::fs::read(path).expect("a file");
        let reader = ktx2::Reader::new(bytes).expect("a KTX2");
        let scale: f64 = text(&reader, "skylight:scale").parse().expect("a number");
        let half = |b: &[u8]| f16::from_le_bytes([b[0], b[1]]).to_f64();
        let texel = |b: &[u8]| scale * DVec3::new(half(b), half(&b[2..]), half(&b[4..]));
        let levels = reader
            .levels()
            .map(|level| level.data.chunks_exact(8).map(texel).collect());
        Self {
            levels: levels.collect(),
            scale,
            reader,
        }
    }

    fn edge(&self, level: usize) -> usize {
        (self.levels[level].len() as f64 / 6.0).sqrt() as usize
    }

    /// Illuminance of a plane that faces up, lux, by the sum over a level's texels.
    fn up(&self, level: usize) -> f64 {
        let edge = self.edge(level);
        let texels = cube::texels(edge).zip(&self.levels[level]);
        texels
            .map(|((face, i, j), value)| {
                let cosine = cube::texel_direction(face, i, j, edge).y.max(0.0);
                let luminance = value.dot(DVec3::new(0.2126, 0.7152, 0.0722));
                luminance * cosine * cube::texel_solid_angle(i, j, edge)
            })
            .sum()
    }
}

fn text(reader: &ktx2::Reader<Vec<u8>>, key: &str) -> String {
    let pair = reader.key_value_data().find(|(name, _)| *name == key);
    let (_, value) = pair.unwrap_or_else(|| panic!("no {key}"));
    String::from_utf8_lossy(value)
        .trim_end_matches('\0')
        .to_owned()
}

/// Skies of all kinds, by day, at dusk and at night.
const SKIES: [&str; 11] = [
    "--sky preetham --sun 137,25",
    "--sky hosek --sun 137,40",
    "--sky perez --dni 600 --dhi 110 --sun 137,35",
    "--sky cie-1 --sun 137,25",
    "--sky cie-12 --sun 137,50",
    "--sky preetham --cloud-cover 0.6 --sun 137,25",
    "--sky atmosphere --sun 137,25",
    "--sky atmosphere --sun 137,2",
    "--sky atmosphere --sun 137,-4",
    "--sky atmosphere --sun 137,-17",
    "--sky atmosphere --place 52.5,13.4 --when 2026-01-03T00:00:00+01:00",
];

#[test]
fn every_sky_has_its_illuminance_by_day_and_at_night() {
    let folder = tempfile::tempdir().expect("a folder");
    for sky in SKIES {
        run(
            folder.path(),
            &format!("bake --map sky --size 128 -o sky.ktx2 {sky}"),
        );
        let report: Value =
            serde_json::from_slice(&run(folder.path(), &format!("sky --json {sky}")))
                .expect("JSON");
        let expected = report["sky"]["diffuse_horizontal_lux"]
            .as_f64()
            .expect("lux");
        let cube = Cube::read(&folder.path().join("sky.ktx2"));
        let errors: Vec<f64> = (0..4)
            .map(|level| cube.up(level) / expected - 1.0)
            .collect();
        let printed: Vec<String> = errors
            .iter()
            .map(|e| format!("{:.3} %", 100.0 * e))
            .collect();
        println!(
            "{sky}: {expected:.3e} lux, scale {}, levels {printed:?}",
            cube.scale
        );
        assert!(errors[0].abs() < 2e-3, "{sky}: {errors:?}");
    }
}

#[test]
fn a_night_keeps_its_digits() {
    let folder = tempfile::tempdir().expect("a folder");
    let sun = "--sky atmosphere --sun 137,-17 --map sky --size 32";
    run(folder.path(), &format!("bake {sun} -o night.ktx2"));
    run(
        folder.path(),
        &format!("bake {sun} --layout faces -o night.exr"),
    );
    let cube = Cube::read(&folder.path().join("night.ktx2"));
    assert!(
        cube.scale < 1e-6 && cube.scale.log2().fract() == 0.0,
        "{}",
        cube.scale
    );
    let first = exr::prelude::read_first_rgba_layer_from_file(
        folder.path().join("night_px.exr"),
        |size, _| vec![DVec3::ZERO; size.area()],
        |texels: &mut Vec<DVec3>, at, (r, g, b, _): (f32, f32, f32, f32)| {
            texels[at.y() * 32 + at.x()] = DVec3::new(r.into(), g.into(), b.into());
        },
    );
    let face = first.expect("an EXR").layer_data.channel_data.pixels;
    assert!(face.iter().any(|v| v.max_element() < 1e-3));
    for (found, expected) in cube.levels[0].iter().zip(&face) {
        let error = (found / expected - 1.0).abs().max_element();
        assert!(error < 5e-4, "{found} {expected}");
    }
}

#[test]
fn the_file_says_what_it_holds() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = "bake --map sky --size 16 -o a.ktx2 --sky cie-12 --place 55.68,12.57 --when 2026-06-21T14:00:00+02:00";
    run(folder.path(), line);
    let cube = Cube::read(&folder.path().join("a.ktx2"));
    let header = cube.reader.header();
    assert_eq!(
        (header.pixel_width, header.face_count, header.level_count),
        (16, 6, 5)
    );
    assert_eq!(
        cube.reader.color_primaries(),
        Some(ktx2::ColorPrimaries::BT709)
    );
    assert_eq!(
        cube.reader.transfer_function(),
        Some(ktx2::TransferFunction::Linear)
    );
    for (key, value) in [
        ("KTXorientation", "rd"),
        ("skylight:unit", "cd/m^2"),
        ("skylight:sky", "cie-12"),
        ("skylight:place", "55.68,12.57"),
        ("skylight:when", "2026-06-21T14:00:00+02:00"),
        ("skylight:scale", "1"),
    ] {
        assert_eq!(text(&cube.reader, key), value, "{key}");
    }
    let sidecar = std::fs::read_to_string(folder.path().join("a.json")).expect("a sidecar");
    let sidecar: Value = serde_json::from_str(&sidecar).expect("JSON");
    assert_eq!(sidecar["layout"], "cube");
    assert_eq!(sidecar["files"][0]["levels"], 5);
    assert_eq!(sidecar["files"][0]["scale"], 1.0);
}

#[test]
fn faces_are_those_of_the_pictures() {
    // The brightest texel is beside the sun: 137°, 25° is on the face +z or +x.
    let folder = tempfile::tempdir().expect("a folder");
    run(
        folder.path(),
        "bake --map sky --size 64 -o a.ktx2 --sky preetham --sun 137,25",
    );
    let cube = Cube::read(&folder.path().join("a.ktx2"));
    let (azimuth, elevation) = (137f64.to_radians(), 25f64.to_radians());
    let sun = DVec3::new(
        azimuth.sin() * elevation.cos(),
        elevation.sin(),
        -azimuth.cos() * elevation.cos(),
    );
    let texels = cube::texels(64).zip(&cube.levels[0]);
    let brightest = texels.max_by(|a, b| a.1.y.total_cmp(&b.1.y));
    let ((face, i, j), _) = brightest.expect("texels");
    let found = cube::texel_direction(face, i, j, 64);
    assert!(found.dot(sun) > 0.999, "{found} {sun}");
}

#[test]
fn blocks_keep_the_sky() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = "--map sky --size 128 --sky atmosphere --sun 137,-4";
    run(folder.path(), &format!("bake {line} -o half.ktx2"));
    run(
        folder.path(),
        &format!("bake {line} --texels bc6h -o blocks.ktx2"),
    );
    let exact = Cube::read(&folder.path().join("half.ktx2"));
    let bytes = std::fs::read(folder.path().join("blocks.ktx2")).expect("a file");
    let reader = ktx2::Reader::new(bytes).expect("a KTX2");
    assert_eq!(
        reader.header().format,
        Some(ktx2::Format::BC6H_UFLOAT_BLOCK)
    );
    let scale: f64 = text(&reader, "skylight:scale").parse().expect("a number");
    let level = reader.levels().next().expect("a level");
    let mut square = (0.0, 0.0);
    for (k, block) in level.data.chunks_exact(16).enumerate() {
        let mut values = [f16::ZERO; 48];
        block_compression::decode::decode_block_bc6h(block, &mut values, 12, false);
        let (face, x, y) = (k / 1024, 4 * (k % 32), 4 * (k / 32 % 32));
        for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
            let expected = exact.levels[0][(face * 128 + y + j) * 128 + x + i].y;
            square.0 += (scale * values[12 * j + 3 * i + 1].to_f64() - expected).powi(2);
            square.1 += expected.powi(2);
        }
    }
    let error = (square.0 / square.1).sqrt();
    println!("BC6H: {:.2} % rms", 100.0 * error);
    assert!(error < 1e-2, "{error}");
}

#[test]
fn the_roughest_level_is_the_irradiance_and_the_smoothest_the_sky() {
    let folder = tempfile::tempdir().expect("a folder");
    let sky = "--sky atmosphere --sun 137,25";
    run(
        folder.path(),
        &format!("bake --map specular --size 64 -o m.ktx2 {sky}"),
    );
    run(
        folder.path(),
        &format!("bake --map sky --size 64 -o s.ktx2 {sky}"),
    );
    run(
        folder.path(),
        &format!("bake --map irradiance --size 16 -o e.ktx2 {sky}"),
    );
    let read = |name: &str| Cube::read(&folder.path().join(name));
    let (specular, sky, irradiance) = (read("m.ktx2"), read("s.ktx2"), read("e.ktx2"));
    assert_eq!(specular.levels.len(), 3);
    assert_eq!(
        text(&specular.reader, "skylight:roughness"),
        "level / (levels - 1)"
    );
    assert_eq!(specular.levels[0], sky.levels[0]);
    // GGX of roughness 1 is a cosine lobe.
    let mut worst = 0f64;
    for (found, e) in specular.levels[2].iter().zip(&irradiance.levels[0]) {
        worst = worst.max((found * PI / e - 1.0).abs().max_element());
    }
    println!("pi L of roughness 1 against E: {:.2} %", 100.0 * worst);
    assert!(worst < 1e-2, "{worst}");
}

#[test]
fn pictures_of_a_specular_map_are_one_for_each_roughness() {
    let folder = tempfile::tempdir().expect("a folder");
    run(
        folder.path(),
        "bake --map specular --size 32 --layout faces -o m.exr --sky cie-5 --sun 137,25",
    );
    let text = std::fs::read_to_string(folder.path().join("m.json")).expect("a sidecar");
    let sidecar: Value = serde_json::from_str(&text).expect("JSON");
    let files = sidecar["files"].as_array().expect("files");
    assert_eq!(files.len(), 12);
    assert_eq!(
        (&files[0]["name"], &files[0]["width"]),
        (&"m_m0_px.exr".into(), &32.into())
    );
    assert_eq!(
        (&files[11]["name"], &files[11]["width"]),
        (&"m_m1_nz.exr".into(), &16.into())
    );
    assert_eq!(
        (&files[5]["roughness"], &files[6]["roughness"]),
        (&0.0.into(), &1.0.into())
    );
    for file in files {
        let name = file["name"].as_str().expect("a name");
        assert!(folder.path().join(name).is_file(), "{name}");
    }
}
