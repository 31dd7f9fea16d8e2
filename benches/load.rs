//! How fast a large model is on the screen: an OBJ of a million triangles is made, read by the crate `tobj`, and rendered by the
//! program, first without and then with its cache. Prints wall time, CPU time is the shell's (`time`), and peak memory.
//!
//! `cargo bench --bench load`; `SKYLIGHT_LOAD_TRIANGLES=100000` makes a smaller one.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Bounds on a machine of two cores with a software driver, seconds.
const COLD: f64 = 3.0;
const CACHED: f64 = 0.8;
/// Peak memory over the size of the file.
const MEMORY: f64 = 6.0;

fn main() {
    let triangles = std::env::var("SKYLIGHT_LOAD_TRIANGLES").map_or(1_000_000, |n| {
        n.parse::<u32>().expect("a number of triangles")
    });
    let folder = tempfile::tempdir().expect("a scratch folder");
    let model = folder.path().join("hills.obj");
    write_hills(&model, triangles);
    let bytes = model.metadata().expect("the model").len();
    println!("{triangles} triangles, {:.1} MB", bytes as f64 / 1e6);

    let started = Instant::now();
    let (models, _) = tobj::load_obj(&model, &tobj::GPU_LOAD_OPTIONS).expect("tobj reads it");
    let parsed = started.elapsed().as_secs_f64();
    let read: usize = models.iter().map(|m| m.mesh.indices.len() / 3).sum();
    println!("tobj parses {read} triangles in {parsed:.2} s");
    drop(models);

    // Shaders are compiled once in the life of a machine: not the model's matter.
    let _ = run(folder.path(), None);
    for (name, bound) in [("cold", COLD), ("from cache", CACHED)] {
        let (wall, peak) = run(folder.path(), Some(&model));
        let memory = peak as f64 / bytes as f64;
        println!(
            "start to PNG, {name}: {wall:.2} s (bound {bound} s), {:.2} x tobj; peak memory {:.0} MB, {memory:.2} x the file (bound {MEMORY})",
            wall / parsed,
            peak as f64 / 1e6,
        );
    }
}

/// Renders and gives seconds and peak memory in bytes; of the bundled scene without a model.
fn run(folder: &Path, model: Option<&Path>) -> (f64, u64) {
    let started = Instant::now();
    let mut child = Command::new(env!("CARGO_BIN_EXE_skylight"))
        .arg("render")
        .args(model)
        .args(["--size", "1280x720", "-o"])
        .arg(folder.join("picture.png"))
        .env("XDG_CACHE_HOME", folder.join("cache"))
        .stdout(Stdio::null())
        .spawn()
        .expect("the program starts");
    let mut peak = 0;
    while child.try_wait().expect("a state").is_none() {
        peak = peak_of(&child).unwrap_or(peak);
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(child.wait().expect("an end").success());
    (started.elapsed().as_secs_f64(), peak)
}

/// The most memory that a process has had so far, bytes.
fn peak_of(child: &Child) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{}/status", child.id())).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib << 10)
}

/// A hilly square with normals and texture coordinates.
fn write_hills(path: &Path, triangles: u32) {
    let edge = (f64::from(triangles) / 2.0).sqrt().round() as u32;
    let side = edge + 1;
    let mut file = BufWriter::new(File::create(path).expect("a file"));
    let points =
        || (0..side).flat_map(move |y| (0..side).map(move |x| (f64::from(x), f64::from(y))));
    for (x, y) in points() {
        let height =
            3.0 * (x * 0.05).sin() * (y * 0.043).cos() + 0.3 * (x * 0.9).sin() * (y * 0.77).sin();
        writeln!(file, "v {:.6} {height:.6} {:.6}", x * 0.1, y * 0.1).expect("written");
    }
    for (x, y) in points() {
        let share = f64::from(edge);
        writeln!(file, "vt {:.6} {:.6}", x / share, y / share).expect("written");
    }
    for (x, y) in points() {
        let dx =
            1.5 * (x * 0.05).cos() * (y * 0.043).cos() + 2.7 * (x * 0.9).cos() * (y * 0.77).sin();
        let dz = -1.29 * (x * 0.05).sin() * (y * 0.043).sin()
            + 2.31 * (x * 0.9).sin() * (y * 0.77).cos();
        let n = glam::DVec3::new(-dx, 1.0, -dz).normalize();
        writeln!(file, "vn {:.4} {:.4} {:.4}", n.x, n.y, n.z).expect("written");
    }
    for y in 0..edge {
        for x in 0..edge {
            let a = y * side + x + 1;
            let (b, c, d) = (a + 1, a + side, a + side + 1);
            writeln!(file, "f {a}/{a}/{a} {c}/{c}/{c} {b}/{b}/{b}").expect("written");
            writeln!(file, "f {b}/{b}/{b} {c}/{c}/{c} {d}/{d}/{d}").expect("written");
        }
    }
    file.flush().expect("written");
}
