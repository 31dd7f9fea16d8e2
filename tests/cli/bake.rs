//! `skylight bake`, end to end, read back by an independent reader: units, orientation, and the accompanying files.

use std::f64::consts::PI;
use std::path::Path;
use std::process::{Command, Output};

use exr::prelude::read_first_rgba_layer_from_file;
use glam::DVec3;
use serde_json::Value;
use skylight::daylight::cube;
use skylight::daylight::quadrature::SphereQuadrature;
use skylight::daylight::{Conditions, Daylight};

const SUN: (f64, f64) = (137.0, 25.0);

fn bake(folder: &Path, line: &str) -> Output {
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder)
        .args(["bake", "--sun", &format!("{},{}", SUN.0, SUN.1)])
        .args(line.split_whitespace())
        .output()
        .expect("it starts")
}

fn baked(folder: &Path, line: &str) {
    let output = bake(folder, line);
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{line}: {errors}");
}

/// Rows of texels.
type Rows = Vec<Vec<DVec3>>;

fn read(path: &Path) -> Rows {
    let image = read_first_rgba_layer_from_file(
        path,
        |size, _| vec![vec![DVec3::ZERO; size.width()]; size.height()],
        |rows: &mut Rows, at, (r, g, b, _): (f32, f32, f32, f32)| {
            rows[at.y()][at.x()] = DVec3::new(r.into(), g.into(), b.into());
        },
    );
    image.expect("an EXR").layer_data.channel_data.pixels
}

/// Direction of a texel by the convention in the sidecar file, implemented independently.
fn direction(i: usize, j: usize, width: usize, height: usize) -> DVec3 {
    let azimuth = (360.0 * (i as f64 + 0.5) / width as f64).to_radians();
    let elevation = (90.0 - 180.0 * (j as f64 + 0.5) / height as f64).to_radians();
    DVec3::new(
        azimuth.sin() * elevation.cos(),
        elevation.sin(),
        -azimuth.cos() * elevation.cos(),
    )
}

/// Irradiance of an environment by summation over its texels.
fn irradiance(rows: &Rows, normal: DVec3) -> DVec3 {
    let (width, height) = (rows[0].len(), rows.len());
    let mut sum = DVec3::ZERO;
    for (j, row) in rows.iter().enumerate() {
        for (i, value) in row.iter().enumerate() {
            let d = direction(i, j, width, height);
            let solid_angle = 2.0 * PI / width as f64 * PI / height as f64 * d.with_y(0.0).length();
            sum += *value * (d.dot(normal).max(0.0) * solid_angle);
        }
    }
    sum
}

fn daylight() -> Daylight {
    Daylight::new(&Conditions {
        sun_azimuth_deg: SUN.0,
        sun_elevation_deg: SUN.1,
        ..Conditions::default()
    })
}

fn normals() -> [DVec3; 6] {
    [
        DVec3::Y,
        DVec3::X,
        DVec3::NEG_Z,
        DVec3::NEG_Y,
        DVec3::new(1.0, 1.0, 1.0).normalize(),
        DVec3::new(-0.6, 0.3, -0.2).normalize(),
    ]
}

#[test]
fn the_sky_lights_planes_as_the_daylight_does() {
    let folder = tempfile::tempdir().expect("a folder");
    baked(folder.path(), "--map sky --size 128 -o sky.exr");
    let rows = read(&folder.path().join("sky.exr"));
    assert_eq!((rows[0].len(), rows.len()), (512, 256));
    let daylight = daylight();
    for normal in normals() {
        let found = irradiance(&rows, normal);
        let expected =
            SphereQuadrature::sphere(128, 256).irradiance(normal, |d| daylight.radiance(d));
        let error = ((found - expected) / expected).abs().max_element();
        println!("{normal}: {error:.1e}");
        assert!(error < 5e-3, "{normal}: {found} {expected}");
    }
}

/// Preetham's is at the sun; the atmosphere's forward peak is so broad that air near the horizon is brighter.
#[test]
fn the_brightest_direction_is_the_suns() {
    let folder = tempfile::tempdir().expect("a folder");
    baked(
        folder.path(),
        "--map sky --size 512 -o sky.exr --sky preetham",
    );
    let rows = read(&folder.path().join("sky.exr"));
    let texels = rows.iter().enumerate();
    let all = texels.flat_map(|(j, row)| row.iter().enumerate().map(move |(i, v)| (v.y, i, j)));
    let (_, i, j) = all.max_by(|a, b| a.0.total_cmp(&b.0)).expect("texels");
    let azimuth = 360.0 * (i as f64 + 0.5) / rows[0].len() as f64;
    let elevation = 90.0 - 180.0 * (j as f64 + 0.5) / rows.len() as f64;
    assert!((azimuth - SUN.0).abs() < 0.2, "{azimuth}");
    assert!((elevation - SUN.1).abs() < 0.2, "{elevation}");
}

#[test]
fn irradiance_by_direction_is_that_of_the_sky() {
    let folder = tempfile::tempdir().expect("a folder");
    baked(folder.path(), "--map irradiance --size 8 -o e.exr");
    let rows = read(&folder.path().join("e.exr"));
    let (width, height) = (rows[0].len(), rows.len());
    assert_eq!((width, height), (32, 16));
    let daylight = daylight();
    let nodes = SphereQuadrature::sphere(128, 256);
    for (i, j) in [(0, 0), (5, 3), (12, 7), (20, 8), (31, 15)] {
        let normal = direction(i, j, width, height);
        let expected = nodes.irradiance(normal, |d| daylight.radiance(d));
        let error = ((rows[j][i] - expected) / expected).abs().max_element();
        assert!(error < 1e-3, "{i} {j} {error:e}");
    }
}

#[test]
fn faces_and_cross_hold_vulkans_cube() {
    let folder = tempfile::tempdir().expect("a folder");
    baked(folder.path(), "--map sky --size 8 --layout faces -o f.exr");
    baked(folder.path(), "--map sky --size 8 --layout cross -o c.exr");
    let cross = read(&folder.path().join("c.exr"));
    assert_eq!((cross[0].len(), cross.len()), (32, 24));
    let daylight = daylight();
    let places = [(2, 1), (0, 1), (1, 0), (1, 2), (1, 1), (3, 1)];
    for (face, name) in ["px", "nx", "py", "ny", "pz", "nz"].iter().enumerate() {
        let rows = read(&folder.path().join(format!("f_{name}.exr")));
        for (i, j) in (0..8).flat_map(|i| (0..8).map(move |j| (i, j))) {
            let expected = daylight
                .radiance(cube::texel_direction(face, i, j, 8))
                .as_vec3();
            assert_eq!(rows[j][i].as_vec3(), expected, "{name} {i} {j}");
            let (column, row) = places[face];
            assert_eq!(cross[row * 8 + j][column * 8 + i].as_vec3(), expected);
        }
    }
    assert_eq!(cross[0][0], DVec3::ZERO);
}

#[test]
fn hdr_and_exr_agree_and_the_sidecar_says_what_they_are() {
    let folder = tempfile::tempdir().expect("a folder");
    baked(folder.path(), "--map sky --size 16 -o a.exr");
    baked(folder.path(), "--map sky --size 16 -o b.hdr");
    let exr = read(&folder.path().join("a.exr"));
    let hdr = image::open(folder.path().join("b.hdr")).expect("an HDR");
    for (x, y, pixel) in hdr.to_rgb32f().enumerate_pixels() {
        let value = exr[y as usize][x as usize];
        let error = (DVec3::from_array(pixel.0.map(f64::from)) - value).abs();
        assert!(error.max_element() < value.max_element() / 120.0);
    }
    let text = std::fs::read_to_string(folder.path().join("b.json")).expect("a sidecar");
    let sidecar: Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(sidecar["unit"], "cd/m^2");
    assert_eq!(sidecar["files"][0]["name"], "b.hdr");
    assert_eq!(sidecar["files"][0]["width"], 64);
    assert_eq!(sidecar["inputs"]["sun"], "137,25");
    assert_eq!(sidecar["sun"]["azimuth_deg"], 137.0);
    assert!(
        sidecar["sun"]["illuminance_rgb"][0]
            .as_f64()
            .is_some_and(|v| v > 1e4)
    );
}

#[test]
fn all_files_or_none() {
    let folder = tempfile::tempdir().expect("a folder");
    // One of the eight targets is a folder, so nothing may be written.
    std::fs::create_dir(folder.path().join("f_nz.exr")).expect("made");
    let output = bake(folder.path(), "--map sky --size 8 --layout faces -o f.exr");
    assert_eq!(output.status.code(), Some(1));
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(
        text.contains("f_nz.exr") && text.lines().count() == 1,
        "{text}"
    );
    assert_eq!(folder.path().read_dir().expect("folder").count(), 1);
    for (line, part) in [
        ("--map sky -o a.png", ".exr or .hdr or .ktx2"),
        ("--map sky --size 100 -o a.ktx2", "--size 128"),
        ("--map specular --size 16 -o a.exr", "--size 16"),
        ("--map sky --layout cross -o a.ktx2", "--layout"),
        ("--map sky --texels bc6h -o a.hdr", "--texels"),
        ("--map sky --size 3 -o a.exr", "4..=4096"),
        ("-o a.exr", "--map"),
        ("--map moon -o a.exr", "moon"),
    ] {
        let output = bake(folder.path(), line);
        let text = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(2), "{line}: {text}");
        assert!(text.contains(part) && text.lines().count() == 1, "{text}");
    }
}

#[test]
fn options_of_a_device_are_not_accepted_in_silence() {
    let folder = tempfile::tempdir().expect("a folder");
    let line = "--map sky -o sky.exr --size 16 --validate --device 9";
    let output = bake(folder.path(), line);
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{told}");
    for option in ["--validate", "--device"] {
        let notice = format!("notice: bake needs no device: {option} has no effect");
        assert!(told.lines().any(|l| l == notice), "{told}");
    }
    let output = bake(folder.path(), &format!("{line} --quiet"));
    assert!(output.stderr.is_empty());
}
