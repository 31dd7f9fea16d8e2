//! The window on a device that is not here.

use std::path::Path;

use crate::pretended::Layer;
use crate::running::{DIRECT, Running, difference, shared_machine};
use skylight::compare::Picture;

/// The least that a device with geometry shaders may have: memory apart, a queue that draws and does not compute, no push descriptors.
const PHONE: &str = "gpu,min,align256,split,nopush,ts0,apart";

fn shown(variables: &[(&str, &Path)]) -> Picture {
    let words = [
        &["--size", "320x180", "--samples", "2", "--validate"][..],
        &DIRECT,
    ]
    .concat();
    let running = Running::bare_with(&words, variables);
    let picture = running.picture();
    running.close_well();
    picture
}

#[test]
fn the_window_shows_the_same_on_a_pretended_device() {
    let Some(layer) = Layer::get() else { return };
    let _machine = shared_machine();
    let variables = layer.variables(PHONE);
    let variables = variables
        .each_ref()
        .map(|(name, value)| (*name, Path::new(value)));
    let flip = difference(&shown(&[]), &shown(&variables));
    println!("FLIP of the window on a pretended device: {flip:.5}");
    assert!(flip <= 0.002, "{flip}");
}

#[test]
fn a_device_that_hangs_ends_the_window_with_one_line_and_is_left_alone() {
    let Some(layer) = Layer::get() else { return };
    let _machine = shared_machine();
    let variables = layer.variables("gpu,hang");
    let variables = variables
        .each_ref()
        .map(|(name, value)| (*name, Path::new(value)));
    let words = [&["--size", "320x180", "--quiet"][..], &DIRECT].concat();
    let output = Running::with(&words, &variables).ended();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    println!("{said}");
    assert_eq!(output.status.code(), Some(1), "{said}");
    // The layer tells what is freed or waited for after the hang.
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.contains("has not finished its work for"), "{said}");
}
