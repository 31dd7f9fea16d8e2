//! R in the window recompiles the shaders; errors are shown on screen, and the last valid shaders stay in use.

use std::fs;
use std::path::Path;
use std::thread::sleep;
use std::time::Duration;

use crate::running::{DIRECT, Running, difference, shared_machine};

const STAGE: &str = "include/tone_map.glsl";

/// Copies a folder recursively.
fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).expect("a folder");
    for entry in fs::read_dir(from).expect("sources") {
        let path = entry.expect("an entry").path();
        let copied = to.join(path.file_name().expect("a name"));
        if path.is_dir() {
            copy(&path, &copied);
        } else {
            fs::copy(&path, copied).expect("a copy");
        }
    }
}

#[test]
fn a_changed_shader_is_seen_and_a_broken_one_is_told() {
    let _machine = shared_machine();
    let folder = tempfile::tempdir().expect("a scratch folder");
    let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders_glsl");
    copy(&sources, folder.path());
    let file = folder.path().join(STAGE);
    let good = fs::read_to_string(&file).expect("the source");
    let variables = [("SKYLIGHT_SHADERS", folder.path())];
    let words = ["--size", "320x180", "--samples", "1", "--validate"];
    let words = [&words[..], &DIRECT].concat();
    let running = Running::bare_with(&words, &variables);
    let before = running.daylit();

    // The sources are those that were compiled in: the picture stays the same.
    running.display.typed('r');
    sleep(Duration::from_secs(2));
    assert!(difference(&before, &running.picture()) < 0.01);

    let swapped = good.replace("return vec4(c, alike);", "return vec4(c.bgr, alike);");
    assert_ne!(good, swapped, "{STAGE} has changed: adapt this test");
    fs::write(&file, &swapped).expect("written");
    let red = running.after(|d| d.typed('r'));
    assert!(difference(&before, &red) > 0.05, "colours are swapped");

    fs::write(
        &file,
        good.replace("return vec4(c,", "return no such thing(c,"),
    )
    .expect("written");
    let told = running.after(|d| d.typed('r'));
    // The message overlays the picture, which still has the swapped shader.
    assert!(difference(&red, &told) < difference(&before, &told));
    let output = running.close();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(output.status.success(), "{said}");
    assert!(said.contains(STAGE) && said.contains("error"), "{said}");
}
