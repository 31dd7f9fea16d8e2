//! Screens and windows of other kinds: 30 bits, no HDR, windows that another program destroys, drivers that cannot present.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::thread::sleep;
use std::time::Duration;

use crate::running::{DIRECT, Running, difference, program, shared_machine};
use crate::x::{Display, keysym};

/// A small view of one sample: a picture taken before it is at rest is nearly the same.
const SMALL: [&str; 7] = [
    "colonnade",
    "--size",
    "320x180",
    "--samples",
    "1",
    "--sky",
    "preetham",
];

fn view() -> Vec<&'static str> {
    [&SMALL[..], &DIRECT, &["--quiet"]].concat()
}

/// Compiles a C file beside this one to a shared library in `folder`.
pub fn library(folder: &Path, source: &str, define: &str) -> PathBuf {
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/window");
    let library = folder.join(source).with_extension("so");
    let built = Command::new("cc")
        .args(["-shared", "-fPIC", "-O1", define, "-o"])
        .arg(&library)
        .arg(sources.join(source))
        .arg("-ldl")
        .output()
        .expect("a C compiler; run scripts/setup");
    let said = String::from_utf8_lossy(&built.stderr);
    assert!(built.status.success(), "{said}");
    library
}

#[test]
fn a_screen_of_30_bits_shows_the_picture_and_the_panel() {
    let _machine = shared_machine();
    let words = [&view()[..], &["--validate"]].concat();
    let [eight, ten] = [24, 30].map(|bits| {
        let folder = tempfile::tempdir().expect("a scratch folder");
        let define = format!("-DDEPTH={bits}");
        let presents = library(folder.path(), "depth_of_window.c", &define);
        let variables = [("LD_PRELOAD", presents.as_path())];
        let running = Running::on(Display::of_depth(bits), &words, &variables).bared();
        let shown = running.daylit();
        let panel = running.after(|d| d.key(keysym::TAB, false));
        running.close_well();
        (shown, panel)
    });
    let flips = [
        difference(&eight.0, &ten.0),
        difference(&eight.1, &ten.1),
        difference(&ten.0, &ten.1),
    ];
    println!("FLIP of 30 bits against 24: the picture, the panel; between these two: {flips:.5?}");
    assert!(flips[0] < 0.002 && flips[1] < 0.02, "{flips:?}");
    assert!(flips[2] > 0.1, "the panel is there: {flips:?}");
}

#[test]
fn hdr_is_refused_where_there_is_none_and_auto_goes_without() {
    let _machine = shared_machine();
    let refused = Running::with(&[&view()[..], &["--hdr", "on"]].concat(), &[]).ended();
    let said = line_of(&refused);
    assert!(
        said.contains("no HDR signal") && said.contains("--hdr auto") && said.contains("_SRGB"),
        "{said}"
    );
    let [off, auto] = ["off", "auto"].map(|hdr| {
        let running = Running::bare(&[&view()[..], &["--hdr", hdr, "--validate"]].concat());
        let shown = running.daylit();
        running.close_well();
        shown
    });
    let flip = difference(&off, &auto);
    assert!(flip < 0.002, "{flip}");
}

/// The only line on stderr, an error with exit code 1.
fn line_of(output: &Output) -> String {
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.starts_with("error: "), "{said}");
    said
}

#[test]
fn a_window_that_another_program_destroys_ends_with_one_line() {
    let _machine = shared_machine();
    for moment in ["at once", "loading", "at rest", "moving"] {
        let running = Running::with(&view(), &[]);
        match moment {
            "at once" => {}
            "loading" => sleep(Duration::from_millis(300)),
            _ => drop(running.picture()),
        }
        if moment == "moving" {
            running.display.point(100, 90);
            running.display.press(1);
            for step in 0..10 {
                running.display.point(100 + 5 * step, 90);
            }
        }
        running.display.destroy(running.window);
        let said = line_of(&running.ended());
        println!("{moment}: {said}");
        assert!(
            said.contains("another program closed the window") && said.contains("--resume"),
            "{moment}: {said}"
        );
    }
}

#[test]
fn a_program_whose_connection_is_killed_says_so_in_one_line() {
    let _machine = shared_machine();
    let running = Running::with(&view(), &[]);
    running.picture();
    running.display.kill_client(running.window);
    let output = running.ended();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    println!("{said}");
    // Xlib itself ends the program, with its own line.
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(!said.contains("panicked"), "{said}");
}

/// A driver that draws but has no window system: lavapipe, or whatever driver the tests run on, without those extensions.
/// `None` where its manifest is not known.
fn headless_driver(folder: &Path) -> Option<PathBuf> {
    let manifest = std::env::var_os("VK_DRIVER_FILES")?;
    let manifest = std::fs::read_to_string(manifest).ok()?;
    let (_, rest) = manifest.split_once("\"library_path\"")?;
    let driver = rest.split('"').nth(1)?;
    let define = format!("-DDRIVER=\"{driver}\"");
    let library = library(folder, "headless_driver.c", &define);
    let headless = folder.join("headless.json");
    let text = format!(
        r#"{{"file_format_version": "1.0.0", "ICD": {{"library_path": "{}", "api_version": "1.3.0"}}}}"#,
        library.display()
    );
    std::fs::write(&headless, text).expect("written");
    Some(headless)
}

#[test]
fn where_no_driver_presents_one_line_names_what_is_missing_and_points_to_render() {
    let _machine = shared_machine();
    let folder = tempfile::tempdir().expect("a scratch folder");
    let Some(driver) = headless_driver(folder.path()) else {
        println!("skipped: VK_DRIVER_FILES names no driver");
        return;
    };
    let variables = [
        ("VK_DRIVER_FILES", driver.as_path()),
        ("VK_ICD_FILENAMES", driver.as_path()),
    ];
    let said = line_of(&Running::with(&view(), &variables).ended());
    println!("{said}");
    assert!(
        said.contains("VK_KHR_surface, VK_KHR_xlib_surface are missing")
            && said.contains("skylight render"),
        "{said}"
    );
    // Files need no window system.
    let rendered = program(folder.path())
        .args(["render", "--size", "64x36", "-o", "small.png"])
        .args(["--sky", "preetham"])
        .args(DIRECT)
        .envs(variables)
        .output()
        .expect("the program starts");
    assert!(rendered.status.success(), "{rendered:?}");
    // Without any driver that is what is told.
    let none = folder.path().join("none.json");
    let variables = [
        ("VK_DRIVER_FILES", none.as_path()),
        ("VK_ICD_FILENAMES", none.as_path()),
    ];
    let said = line_of(&Running::with(&view(), &variables).ended());
    assert!(said.contains("no Vulkan"), "{said}");
}
