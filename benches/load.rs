//! Benchmark of loading a large model. An OBJ of a million triangles is read by this program and by the crate `tobj`
//! (alternating, each in its own process), then rendered by the program, first without and then with its cache. Prints wall
//! times as ratios within one run, and peak memory as a multiple of the file size.
//!
//! Run with `cargo bench --bench load`; `SKYLIGHT_LOAD_TRIANGLES=100000` uses a smaller model.

use std::fs::File;
use std::io::{BufWriter, Write as _};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use skylight::scene::{LoadOptions, hills, load};

/// Upper bound on the peak memory of a render, as a multiple of the file size.
const MEMORY: f64 = 6.0;
/// Runs per reader; the fastest counts.
const RUNS: usize = 3;

fn main() {
    let words: Vec<String> = std::env::args().collect();
    if let [_, flag, reader, model, ..] = &words[..]
        && flag == "--read"
    {
        let numbers = read(reader, Path::new(model));
        println!("{}", numbers.map(|n| n.to_string()).join(" "));
        return;
    }
    let triangles = std::env::var("SKYLIGHT_LOAD_TRIANGLES").map_or(1_000_000, |n| {
        n.parse::<usize>().expect("a number of triangles")
    });
    let folder = tempfile::tempdir().expect("a scratch folder");
    let model = folder.path().join("hills.obj");
    write_hills(&model, triangles);
    let bytes = model.metadata().expect("the model").len();
    println!("{triangles} triangles, {:.1} MB", bytes as f64 / 1e6);
    let parsed = compare_readers(&model, bytes);

    // Warm-up: shaders are compiled once per machine, which says nothing about the model.
    let _ = render(folder.path(), None);
    for name in ["without cache", "from the cache"] {
        let (wall, peak) = render(folder.path(), Some(&model));
        let memory = peak as f64 / bytes as f64;
        println!(
            "start to PNG, {name}: {wall:.2} s, {:.2} x tobj; peak memory {memory:.2} x the file",
            wall / parsed,
        );
        assert!(memory < MEMORY, "the bound is {MEMORY} x the file");
    }
}

/// Prints time and memory of both readers; returns the time of `tobj`, seconds.
fn compare_readers(model: &Path, bytes: u64) -> f64 {
    let mut best = [
        ("skylight", [f64::INFINITY; 3]),
        ("tobj", [f64::INFINITY; 3]),
    ];
    for _ in 0..RUNS {
        for (reader, least) in &mut best {
            let mut command = Command::new(std::env::current_exe().expect("this program"));
            command.args(["--read", reader]).arg(model);
            let output = command.output().expect("this program again");
            assert!(output.status.success());
            let text = String::from_utf8(output.stdout).expect("text");
            let numbers = text.split_whitespace().map(|n| n.parse::<f64>());
            for (least, number) in least.iter_mut().zip(numbers) {
                *least = least.min(number.expect("a number"));
            }
        }
    }
    let [(_, [whole, _, layout]), (_, [parsed, ..])] = best;
    for (reader, [seconds, peak, _]) in best {
        println!(
            "read by {reader}: {seconds:.2} s, {:.2} x tobj; peak memory {:.2} x the file",
            seconds / parsed,
            peak / bytes as f64
        );
    }
    let share = layout / whole;
    println!("bodies and clusters: {share:.2} of the time of skylight");
    parsed
}

/// Reads a model with one reader. Returns the time in seconds, the peak memory in bytes, and the time of the draw layout
/// (bodies and clusters) alone in seconds.
fn read(reader: &str, model: &Path) -> [f64; 3] {
    let started = Instant::now();
    let since = |started: Instant| started.elapsed().as_secs_f64();
    let peak = || peak_of("self").expect("the memory of this process") as f64;
    if reader == "tobj" {
        let (models, _) = tobj::load_obj(model, &tobj::GPU_LOAD_OPTIONS).expect("tobj reads it");
        assert!(!models.is_empty());
        return [since(started), peak(), f64::INFINITY];
    }
    let mut scene = load(model, &LoadOptions::default()).expect("a model").scene;
    let (reading, peak) = (since(started), peak());
    let started = Instant::now();
    scene.arrange();
    [reading, peak, since(started)]
}

/// Renders the model, or the bundled scene if there is none; returns seconds and peak memory in bytes.
fn render(folder: &Path, model: Option<&Path>) -> (f64, u64) {
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
        peak = peak_of(&child.id().to_string()).unwrap_or(peak);
        std::thread::sleep(Duration::from_millis(2));
    }
    assert!(child.wait().expect("an end").success());
    (started.elapsed().as_secs_f64(), peak)
}

/// Peak resident memory of a process, bytes.
fn peak_of(process: &str) -> Option<u64> {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
    let line = status.lines().find(|line| line.starts_with("VmHWM:"))?;
    let kib: u64 = line.split_whitespace().nth(1)?.parse().ok()?;
    Some(kib << 10)
}

/// Writes a hilly terrain with normals and texture coordinates.
fn write_hills(path: &Path, triangles: usize) {
    let scene = hills(triangles);
    let mut file = BufWriter::new(File::create(path).expect("a file"));
    for [x, y, z] in &scene.positions {
        writeln!(file, "v {x:.6} {y:.6} {z:.6}").expect("written");
    }
    for [u, v] in &scene.texcoords {
        writeln!(file, "vt {u:.6} {v:.6}").expect("written");
    }
    for [x, y, z] in &scene.normals {
        writeln!(file, "vn {x:.4} {y:.4} {z:.4}").expect("written");
    }
    for triangle in scene.indices.chunks_exact(3) {
        let [a, b, c] = [0, 1, 2].map(|i| triangle[i] + 1);
        writeln!(file, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}").expect("written");
    }
    file.flush().expect("written");
}
