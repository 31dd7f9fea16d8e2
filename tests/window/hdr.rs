//! The window on an HDR screen that a Vulkan layer pretends, see `hdr_screen.c`.

use std::ffi::OsString;
use std::path::Path;

use glam::DVec3;
use skylight::compare::{Picture, read};
use skylight::daylight::colour::srgb_oetf;
use skylight::daylight::hdr::{PAPER_WHITE, bounded, hdr10};

use crate::pretended::{layer_in, write_manifest};
use crate::running::{DIRECT, Running, shared_machine};
use crate::surfaces::library;
use crate::x::until;

/// Exposure value, and the luminance that it maps to paper white, cd/m².
const EV100: f64 = 11.0;
const WHITE: f64 = 1.2 * 2048.0;

/// How far the codes of a screenshot are from the signal of a picture in cd/m² on a screen of this peak, cd/m²: the mean and the most of all
/// channels, steps of 8 bits.
fn steps(picture: &Picture, shown: &Picture, peak: f64) -> [f64; 2] {
    let channels = picture
        .rgb
        .iter()
        .zip(&shown.rgb)
        .flat_map(|(colour, shown)| {
            let colour = DVec3::from_array(colour.map(f64::from)) / WHITE;
            let signal = hdr10(bounded(colour, peak / PAPER_WHITE));
            let code = |i: usize| srgb_oetf(f64::from(shown[i])) - signal[i];
            [0, 1, 2].map(|i| (255.0 * code(i)).abs())
        });
    let (sum, most) = channels.fold((0.0, 0.0f64), |(sum, most), s| (sum + s, most.max(s)));
    [sum / (3 * shown.rgb.len()) as f64, most]
}

fn layer(folder: &Path) -> [(&'static str, OsString); 2] {
    write_manifest(&library(folder, "hdr_screen.c", "-DNDEBUG"));
    layer_in(folder)
}

#[test]
fn an_hdr_screen_gets_luminances_and_is_told_how_bright_they_become() {
    let _machine = shared_machine();
    let folder = tempfile::tempdir().expect("a scratch folder");
    let layer = layer(folder.path());
    let variables = layer
        .each_ref()
        .map(|(name, value)| (*name, Path::new(value)));
    let ev100 = EV100.to_string();
    let words = [
        "colonnade",
        "--size",
        "320x180",
        "--samples",
        "1",
        "--quiet",
        "--ev100",
        &ev100,
    ];
    let screen = ["--hdr", "on", "--hdr-peak", "600", "--validate"];
    let words = [&words[..], &DIRECT, &screen].concat();
    let running = Running::bare_with(&words, &variables);
    running.daylit();
    running.display.typed('p');
    let file = running.folder.path().join("skylight-colonnade-1.exr");
    until("the picture in cd/m²", || file.is_file().then_some(()));
    let luminances = until("a whole file", || read(&file).ok());
    let shown = running.picture();
    let right = steps(&luminances, &shown, 600.0);
    let darker = steps(&luminances, &shown, 500.0);
    let output = running.close();
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    println!(
        "steps, mean and most: {right:.3?}; of a screen of a lower peak: {darker:.3?}; {said}"
    );
    assert!(output.status.success(), "{said}");
    // Rounding is half a step, the dither of 10 bits an eighth, half floats of the display values the rest.
    assert!(
        right[0] < 0.3 && right[1] < 1.0 && darker[1] > 3.0,
        "{right:?} {darker:?}"
    );
    let told = "metadata: green 0.300 0.600, white 0.3127 0.3290, at most 600, at least 0, brightest 600, mean 0";
    assert!(
        said.lines().count() >= 1 && said.lines().all(|line| line == told),
        "{said}"
    );
}
