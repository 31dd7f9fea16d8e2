//! The program on devices that are not here: pretended ones draw what the true one draws, clean under validation, or are refused by name.

use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::thread;

use crate::pretended::Layer;
use crate::town;

const VIEW: &str = "town.obj --size 96x54 --eye 90,30,120 --target 0,8,-10 --sun 200,40 --no-cache";

/// Light of sun and sky alone: fast.
const DIRECT: &str = "--sky preetham --bounces 0 --ambient ssao";

/// What else is drawn on some devices: cells and the table of the air; the dome and gathered rays, by compute; large cubes of sky.
const FULL: [&str; 3] = [
    "--sky atmosphere",
    "--sky preetham --samples 16 --route compute",
    "--sky preetham --preset lecture",
];

/// Largest FLIP between pictures of a pretended device and of the true one.
const MOST_FLIP: f64 = 0.002;

/// Devices on which the program draws, by the words of the layer.
const DRAWN: [&str; 20] = [
    "align256",
    "gpu,min",
    "bare",
    "nogeom,nostore",
    "nopush",
    "nostats,nofsa,noindep",
    "nof32lin",
    "nof32blit,nosrgbblit",
    "dim4096",
    "fb",
    "gpu,period",
    "gpu,ts0",
    "gpu,ts36",
    "split,align256",
    "split,nogeom,nopush",
    "poison",
    "apple",
    "apart",
    // The least that a device may have: a phone, with and without geometry shaders.
    "gpu,min,align256,split,nopush,ts36,apart",
    "gpu,bare,min,nopush,nostore,nof32lin,nof32blit,ts0,dim4096,poison",
];

/// Devices on which [`FULL`] is drawn too.
const THOROUGH: [&str; 3] = ["apple,gpu", DRAWN[18], DRAWN[19]];

/// Devices that are measured, and how.
const MEASURED: [(&str, &str); 3] = [
    ("apple,gpu,period", "timestamps of the device"),
    (DRAWN[18], "timestamps of the device"),
    (DRAWN[19], "submitted alone"),
];

/// Devices that are refused, and what they lack.
const REFUSED: [(&str, &str); 9] = [
    ("noscalar", "scalarBlockLayout"),
    ("noreset", "hostQueryReset"),
    ("nof32rt", "storing and rendering of R32G32B32A32_SFLOAT"),
    ("nod32", "depth of D32_SFLOAT"),
    ("norgb32v", "the vertex format R32G32B32_SFLOAT"),
    ("nocompute", "a queue for graphics and compute together"),
    ("apple,wide", "vertices of 4 bytes (it has multiples of 16)"),
    ("noncoh", "no memory for uniforms"),
    (
        "gpu,hang",
        "\"Fake GPU\" has not finished its work for 60 s",
    ),
];

/// A folder with the scene, and the program on the true or a pretended device.
struct Place {
    folder: tempfile::TempDir,
    layer: &'static Layer,
}

impl Place {
    fn new(layer: &'static Layer) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        town::write(folder.path());
        Self { folder, layer }
    }

    /// Runs the program; `words` is `None` for the true device.
    fn run(&self, words: Option<&str>, line: &str) -> Output {
        let mut command = Command::new(env!("CARGO_BIN_EXE_skylight"));
        if let Some(words) = words {
            command.envs(self.layer.variables(words));
        }
        command
            .current_dir(self.folder.path())
            .args(line.split_whitespace())
            .output()
            .expect("the program starts")
    }

    /// Draws a picture and compares it with `reference`, drawn by the true device.
    fn drawn(&self, words: &str, options: &str, reference: &str) -> Result<(), String> {
        let file = format!("{}.exr", words.replace(',', "-"));
        let file = format!("{reference}-{file}");
        let output = self.run(
            Some(words),
            &format!("render {VIEW} {options} --validate -o {file}"),
        );
        clean(&output)?;
        let output = self.run(None, &format!("compare {reference} {file}"));
        let told = text(&output.stdout);
        let flip = told.lines().find_map(|l| l.strip_prefix("FLIP, shown"));
        let flip = flip.and_then(|l| l.split_whitespace().next()?.parse::<f64>().ok());
        match flip {
            Some(flip) if flip <= MOST_FLIP => Ok(()),
            other => Err(format!("FLIP {other:?}: {}", text(&output.stderr))),
        }
    }

    /// Draws the pictures of the true device.
    fn references(&self) {
        let all = FULL
            .iter()
            .enumerate()
            .map(|(i, options)| (format!("full{i}.exr"), *options));
        for (file, options) in all.chain([("direct.exr".to_owned(), DIRECT)]) {
            let output = self.run(None, &format!("render {VIEW} {options} -o {file}"));
            assert!(output.status.success(), "{}", text(&output.stderr));
        }
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// Whether the program has succeeded without a message.
fn clean(output: &Output) -> Result<(), String> {
    let said = text(&output.stderr);
    let is_told = |l: &str| l.starts_with("notice: ") || l.starts_with("poisoned");
    let is_silent = said.lines().all(is_told);
    let is_clean = is_silent && output.status.success();
    is_clean
        .then_some(())
        .ok_or_else(|| format!("{:?}: {said}", output.status))
}

/// Something to do, by name, and why it went wrong.
type Job<'p> = (String, Box<dyn Fn() -> Result<(), String> + Sync + 'p>);

/// Runs jobs on two threads; fails with all that went wrong.
fn all(jobs: &[Job<'_>]) {
    let (next, failures) = (AtomicUsize::new(0), Mutex::new(Vec::new()));
    thread::scope(|scope| {
        for _ in 0..2 {
            scope.spawn(|| {
                while let Some((name, job)) = jobs.get(next.fetch_add(1, Ordering::Relaxed)) {
                    if let Err(why) = job() {
                        let mut failures = failures.lock().unwrap_or_else(PoisonError::into_inner);
                        failures.push(format!("{name}: {why}"));
                    }
                }
            });
        }
    });
    let failures = failures
        .into_inner()
        .unwrap_or_else(PoisonError::into_inner);
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}

#[test]
fn pretended_devices_draw_the_same_pictures() {
    let Some(layer) = Layer::get() else { return };
    let place = &Place::new(layer);
    place.references();
    let mut jobs: Vec<Job<'_>> = Vec::new();
    for words in THOROUGH {
        for (i, options) in FULL.into_iter().enumerate() {
            let draw = move || place.drawn(words, options, &format!("full{i}.exr"));
            jobs.push((format!("{words} {options}"), Box::new(draw)));
        }
    }
    for (words, timed) in MEASURED {
        let bench = move || {
            let line = format!("bench {VIEW} {DIRECT} --frames 1 --validate --quiet");
            let output = place.run(Some(words), &line);
            clean(&output)?;
            let told = text(&output.stdout);
            told.contains(timed).then_some(()).ok_or(told)
        };
        jobs.push((format!("{words} bench"), Box::new(bench)));
    }
    for words in DRAWN {
        let draw = move || place.drawn(words, DIRECT, "direct.exr");
        jobs.push((words.to_owned(), Box::new(draw)));
    }
    all(&jobs);
}

#[test]
fn every_message_of_the_validation_layer_is_printed_once_with_its_identifier() {
    let Some(layer) = Layer::get() else { return };
    let place = Place::new(layer);
    let line = format!("render {VIEW} {DIRECT} --validate -o none.exr");
    let output = place.run(Some("less"), &line);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{said}");
    let count = said
        .strip_prefix("error: ")
        .and_then(|l| l.split(' ').next()?.parse().ok());
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(count, Some(lines.len()), "{said}");
    assert!(lines.iter().all(|line| line.contains("VUID-")), "{said}");
    // Layers of other years have other rules for the same fault.
    for identifier in [
        "VUID-VkPushConstantRange-size-00298",
        "VUID-vkCmdPushConstants-size-00371",
        "VUID-VkPipelineLayoutCreateInfo-",
    ] {
        assert!(said.contains(identifier), "{identifier}: {said}");
    }
    let distinct: std::collections::BTreeSet<&str> = lines.iter().copied().collect();
    assert_eq!(distinct.len(), lines.len(), "{said}");
}

#[test]
fn devices_that_lack_something_are_refused_by_name() {
    let Some(layer) = Layer::get() else { return };
    let place = Place::new(layer);
    for (words, lacking) in REFUSED {
        let line = format!("render {VIEW} {DIRECT} --validate -o none.exr");
        let output = place.run(Some(words), &line);
        let said = text(&output.stderr);
        let first = said
            .lines()
            .find(|l| !l.starts_with("notice: "))
            .unwrap_or_default();
        assert_eq!(output.status.code(), Some(1), "{words}: {said}");
        assert!(
            first.starts_with("error: ") && first.contains(lacking),
            "{words}: {said}"
        );
        assert!(!said.contains("is waited for"), "{words}: {said}");
        assert!(!place.folder.path().join("none.exr").exists(), "{words}");
    }
}

#[test]
fn pictures_wider_than_a_framebuffer_are_drawn_in_tiles() {
    let Some(layer) = Layer::get() else { return };
    let place = Place::new(layer);
    let line =
        format!("render {VIEW} {DIRECT} --ao-radius 0 --validate").replace("96x54", "4200x8");
    let whole = place.run(None, &format!("{line} -o whole.exr"));
    let tiles = place.run(Some("fb"), &format!("{line} -o tiles.exr"));
    clean(&whole).and(clean(&tiles)).expect("drawn");
    assert!(
        text(&tiles.stdout).contains("tiles"),
        "{}",
        text(&tiles.stdout)
    );
    let told = text(&place.run(None, "compare whole.exr tiles.exr").stdout);
    assert!(told.contains("FLIP, shown            0.000"), "{told}");
}

#[test]
fn what_a_device_lacks_and_has_is_told() {
    let Some(layer) = Layer::get() else { return };
    let place = Place::new(layer);
    let info = |words| {
        let output = place.run(Some(words), "info");
        assert!(output.status.success(), "{}", text(&output.stderr));
        text(&output.stdout)
    };
    let apple = info("apple");
    assert!(
        apple.contains("VK_KHR_portability_subset, without constantAlphaColorBlendFactors"),
        "{apple}"
    );
    assert!(apple.contains("triangleFans"), "{apple}");
    let narrow = info("nof32lin,ts0,fb");
    for part in [
        "linear filter of R32G32B32A32_SFLOAT: no",
        "blending of R32G32B32A32_SFLOAT: no",
        "timestamps: no",
        "largest  4096 pixels",
    ] {
        assert!(narrow.contains(part), "{part}: {narrow}");
    }
    assert!(info("nod32").contains("lacks    depth of D32_SFLOAT"));
}

#[test]
fn drivers_of_portability_are_found() {
    let Some(layer) = Layer::get() else { return };
    let Some(driver) = ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"]
        .iter()
        .find_map(|name| std::env::var(name).ok())
        .or_else(default_driver)
    else {
        println!("skipped: no manifest of lavapipe in /usr/share/vulkan/icd.d");
        return;
    };
    let place = Place::new(layer);
    let manifest = fs::read_to_string(&driver).expect("a manifest");
    let mut manifest: serde_json::Value = serde_json::from_str(&manifest).expect("JSON");
    manifest["ICD"]["is_portability_driver"] = true.into();
    let file = place.folder.path().join("portability.json");
    fs::write(&file, manifest.to_string()).expect("written");
    let output = Command::new(env!("CARGO_BIN_EXE_skylight"))
        .arg("info")
        .env("VK_DRIVER_FILES", &file)
        .env("VK_ICD_FILENAMES", &file)
        .output()
        .expect("the program starts");
    let told = text(&output.stdout);
    assert!(
        told.contains("nothing that skylight needs"),
        "{told}{}",
        text(&output.stderr)
    );
}

/// The manifest of the software driver.
fn default_driver() -> Option<String> {
    let folder = fs::read_dir(Path::new("/usr/share/vulkan/icd.d")).ok()?;
    let files = folder.filter_map(|entry| entry.ok()?.path().into_os_string().into_string().ok());
    files.into_iter().find(|file| file.contains("lvp_icd"))
}
