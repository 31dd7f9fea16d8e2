//! A bake in another renderer: Mitsuba 3 (`pip install mitsuba`) lights planes with the equirectangular sky.
//!
//! Skipped if `python3` (or the interpreter named by `SKYLIGHT_PYTHON`) has no Mitsuba; with `SKYLIGHT_MITSUBA=require` that
//! is a failure.

use std::path::Path;
use std::process::Command;

use serde_json::Value;

const SUN: (f64, f64) = (137.0, 25.0);

/// The values that Mitsuba computes from `sky.exr` in a folder; `None` without Mitsuba.
fn mitsuba(folder: &Path, mode: &str) -> Option<Value> {
    let python = std::env::var("SKYLIGHT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mitsuba_bake.py");
    let mut command = Command::new(&python);
    let files = ["sky.exr", "sky.json"].map(|name| folder.join(name));
    let output = command.arg(script).args(files).arg(mode).output();
    let absent = match &output {
        Ok(output) => output.status.code() == Some(3),
        Err(_) => true,
    };
    if absent {
        let required = std::env::var("SKYLIGHT_MITSUBA").is_ok_and(|value| value == "require");
        assert!(
            !required,
            "SKYLIGHT_MITSUBA=require, but {python} has no mitsuba"
        );
        println!("skipped: {python} has no mitsuba; pip install mitsuba, or set SKYLIGHT_PYTHON");
        return None;
    }
    let output = output.expect("it ran");
    let errors = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{errors}");
    Some(serde_json::from_slice(&output.stdout).expect("JSON"))
}

/// Bakes `sky.exr`; its description.
fn bake(folder: &Path, sky: &str) -> Value {
    let output = Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder)
        .args(["bake", "--map", "sky", "--size", "512", "-o", "sky.exr"])
        .args(sky.split_whitespace())
        .output()
        .expect("it starts");
    assert!(output.status.success(), "{output:?}");
    let text = std::fs::read_to_string(folder.join("sky.json")).expect("a sidecar");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn mitsuba_sees_the_same_sky() {
    let folder = tempfile::tempdir().expect("a folder");
    let sidecar = bake(
        folder.path(),
        &format!("--sky preetham --sun {},{}", SUN.0, SUN.1),
    );
    let Some(found) = mitsuba(folder.path(), "planes") else {
        return;
    };
    for normal in ["+y", "+x", "-x", "+z", "-z"] {
        for channel in 0..3 {
            let mitsubas = found["irradiance"][normal][channel].as_f64().expect("lux");
            let ours = sidecar["sky"]["irradiance"][normal][channel]
                .as_f64()
                .expect("lux");
            let error = mitsubas / ours - 1.0;
            println!(
                "{normal} {channel}: {mitsubas:.1} and {ours:.1} lux, {:.3} %",
                100.0 * error
            );
            assert!(error.abs() < 5e-3, "{normal} {channel}: {mitsubas} {ours}");
        }
    }
    let azimuth = found["azimuth"].as_f64().expect("degrees");
    println!("brightest azimuth {azimuth}");
    assert!((azimuth - SUN.0).abs() < 0.2, "{azimuth}");
}

/// Noon, a low sun, dusk.
const ATMOSPHERES: [&str; 3] = ["180,60", "137,10", "137,-4"];

#[test]
fn planes_under_an_atmosphere_have_our_illuminance() {
    let folder = tempfile::tempdir().expect("a folder");
    let luminance = |rgb: &Value| {
        let of = |c: usize| rgb[c].as_f64().expect("lux");
        0.2126 * of(0) + 0.7152 * of(1) + 0.0722 * of(2)
    };
    for sun in ATMOSPHERES {
        let sidecar = bake(folder.path(), &format!("--sky atmosphere --sun {sun}"));
        let Some(found) = mitsuba(folder.path(), "up") else {
            return;
        };
        let ours = [
            luminance(&sidecar["sky"]["diffuse_horizontal_rgb"]),
            sidecar["global_horizontal_lux"].as_f64().expect("lux"),
        ];
        let mitsubas = ["sky", "sky_and_sun"].map(|key| luminance(&found[key]));
        let errors = [0, 1].map(|i| mitsubas[i] / ours[i] - 1.0);
        println!(
            "sun {sun}: {mitsubas:.4?} and {ours:.4?} lux, {:.3?} %",
            errors.map(|e| 100.0 * e)
        );
        assert!(errors.iter().all(|e| e.abs() < 3e-3), "{sun}: {errors:?}");
    }
}
