//! A bake in another renderer: Mitsuba 3 (`pip install mitsuba`) lights planes with the equirectangular sky.
//!
//! Skipped if `python3` (or the interpreter named by `SKYLIGHT_PYTHON`) has no Mitsuba; with `SKYLIGHT_MITSUBA=require` that
//! is a failure.

use std::process::Command;

use serde_json::Value;

const SUN: (f64, f64) = (137.0, 25.0);

/// The values that Mitsuba computes from the map; `None` without Mitsuba.
fn mitsuba(map: &std::path::Path) -> Option<Value> {
    let python = std::env::var("SKYLIGHT_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/mitsuba_bake.py");
    let mut command = Command::new(&python);
    let output = command.arg(script).arg(map).arg(SUN.1.to_string()).output();
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

#[test]
fn mitsuba_sees_the_same_sky() {
    let folder = tempfile::tempdir().expect("a folder");
    let sun = format!("{},{}", SUN.0, SUN.1);
    let output = Command::new(env!("CARGO_BIN_EXE_skylight"))
        .current_dir(folder.path())
        .args([
            "bake", "--map", "sky", "--size", "512", "-o", "sky.exr", "--sun", &sun,
        ])
        .output()
        .expect("it starts");
    assert!(output.status.success(), "{output:?}");
    let Some(found) = mitsuba(&folder.path().join("sky.exr")) else {
        return;
    };
    let text = std::fs::read_to_string(folder.path().join("sky.json")).expect("a sidecar");
    let sidecar: Value = serde_json::from_str(&text).expect("JSON");
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
