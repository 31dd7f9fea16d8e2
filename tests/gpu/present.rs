//! What the window shows, drawn to images of each format without a window, against the CPU.
//!
//! Verified to fail with two rows of the matrix of BT.2020 swapped, with paper at 100 cd/m², without the sRGB curve, with the interface
//! blended after the encoding, and with a tone curve on HDR screens.

use std::sync::Arc;

use glam::{DVec3, UVec2};
use skylight::daylight::colour::{srgb_eotf, srgb_oetf};
use skylight::daylight::hdr::{PAPER_WHITE, bounded, hdr10, scrgb};
use skylight::daylight::tone_curve::ToneCurve;
use skylight::gpu::{
    Context, Encoding, Format, Image, ImageDesc, Output, Overlay, UiFrame, upload_texture,
};
use skylight::passes::light::lighting::Show;
use skylight::passes::picture::present::{Present, interface_format};
use skylight::passes::picture::tone_map::{Scale, ToneMap, ToneSettings};

use crate::common::Worst;
use crate::gpu::{Device, HALF_ROUNDOFF};

const SIZE: [u32; 2] = [64, 48];

/// Colours of all hues over eight decades, cd/m².
fn colours() -> Vec<DVec3> {
    let at = |i: u32| {
        let (x, y) = (f64::from(i % SIZE[0]) / 64.0, f64::from(i / SIZE[0]));
        let level = 1e-2 * 10f64.powf(y / 6.0);
        let hue = |k: f64| 0.55 + 0.45 * (std::f64::consts::TAU * (x + k / 3.0)).cos();
        DVec3::new(hue(0.0), hue(1.0), hue(2.0)) * level
    };
    (0..SIZE[0] * SIZE[1]).map(at).collect()
}

/// Tone settings that show 1000 cd/m² as white, on a screen of this peak, cd/m².
fn settings(peak: Option<f64>) -> ToneSettings {
    ToneSettings {
        show: Show::Beauty,
        curve: ToneCurve::Neutral,
        scale: Scale::Fixed(1e-3),
        white: 4.0,
        gamma: None,
        depth_scale: 1.0,
        false_colour: None,
        hours: 1.0,
        peak: peak.map(|peak| peak / PAPER_WHITE),
    }
}

/// The display values of a picture, cd/m².
fn tone_mapped(device: &mut Device, picture: &[DVec3], settings: ToneSettings) -> ToneMap {
    let texels: Vec<[f32; 4]> = picture
        .iter()
        .map(|rgb| (*rgb * 1e-3).as_vec3().extend(1.0).to_array())
        .collect();
    let desc = ImageDesc::flat("picture", Format::R32G32B32A32_SFLOAT, SIZE);
    let source = device
        .run(|rec| upload_texture(rec, &desc, &[bytemuck::cast_slice(&texels)]).expect("uploaded"));
    let tone_map = ToneMap::new(&device.context, SIZE, settings).expect("a pass");
    device.run(|rec| {
        tone_map.record(rec, &source, &source, UVec2::ZERO);
    });
    tone_map
}

/// The user interface: nothing, or a translucent box over the left half.
fn interface(context: &Arc<Context>, overlay: &mut Overlay, is_empty: bool) -> UiFrame {
    let ui = egui::Context::default();
    let screen = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(64.0, 48.0));
    let input = egui::RawInput {
        screen_rect: Some(screen),
        ..egui::RawInput::default()
    };
    let output = ui.run_ui(input, |ui| {
        let half = egui::Rect::from_min_size(egui::Pos2::ZERO, egui::vec2(32.0, 48.0));
        if !is_empty {
            let colour = egui::Color32::from_rgba_premultiplied(90, 60, 20, 150);
            ui.ctx()
                .debug_painter()
                .rect_filled(half, egui::CornerRadius::ZERO, colour);
        }
    });
    context.wait_idle().expect("idle");
    overlay.update(output.textures_delta).expect("textures");
    UiFrame {
        primitives: ui.tessellate(output.shapes, 1.0),
        pixels_per_point: 1.0,
    }
}

/// What a window of this output shows, the values of the signal.
fn shown(device: &mut Device, display: &Image, output: Output, is_empty: bool) -> Vec<DVec3> {
    let context = device.context.clone();
    let format = interface_format(output);
    let mut present = Present::new(&context, output, format).expect("a pass");
    let mut overlay = Overlay::new(&context, format).expect("an overlay");
    let ui = interface(&context, &mut overlay, is_empty);
    let desc = ImageDesc::flat("screen", output.format, SIZE);
    let screen = Image::new(&context, &desc).expect("an image");
    device.run(|rec| {
        let drawn = present.record(rec, display, &mut overlay, &ui, &screen);
        drawn.expect("drawn");
    });
    let texels = device.read(&screen).into_iter();
    let texels = texels.map(|t| DVec3::new(t[0].into(), t[1].into(), t[2].into()));
    texels.collect()
}

/// Whether a device can draw to images of this format, which windows may have and others need not.
fn is_known(device: &Device, format: Format) -> bool {
    let known = device.context.can_draw(format);
    if !known {
        println!("{format:?}: skipped, the device does not draw to it");
    }
    known
}

#[test]
fn every_sdr_format_shows_the_bytes_of_the_file() {
    let mut device = Device::new();
    let tone_map = tone_mapped(&mut device, &colours(), settings(None));
    let file: Vec<DVec3> = device
        .read(tone_map.image())
        .iter()
        .map(|t| DVec3::new(t[0].into(), t[1].into(), t[2].into()))
        .collect();
    let mut seen = 0;
    for (format, encoding, steps) in [
        (Format::R8G8B8A8_SRGB, Encoding::ByFormat, 255.0),
        (Format::B8G8R8A8_SRGB, Encoding::ByFormat, 255.0),
        (Format::R8G8B8A8_UNORM, Encoding::Srgb, 255.0),
        (Format::B8G8R8A8_UNORM, Encoding::Srgb, 255.0),
        (Format::A2B10G10R10_UNORM_PACK32, Encoding::Srgb, 1023.0),
        (Format::A2R10G10B10_UNORM_PACK32, Encoding::Srgb, 1023.0),
        (Format::R16G16B16A16_SFLOAT, Encoding::Srgb, 1023.0),
    ] {
        if !is_known(&device, format) {
            continue;
        }
        seen += 1;
        let output = Output::new(format, encoding);
        let found = shown(&mut device, tone_map.image(), output, true);
        // Half a step for rounding; a device that encodes may be 0.6 steps off.
        let mut worst = Worst::new("display values, steps", 1.0);
        for (i, (found, file)) in found.iter().zip(&file).enumerate() {
            let difference = (*found - *file).abs().max_element() * steps;
            worst.see(difference, format!("{format:?} {i}"));
        }
        worst.finish();
    }
    assert!(seen >= 4, "{seen}");
}

#[test]
fn the_panel_looks_the_same_where_the_shader_encodes() {
    let mut device = Device::new();
    let tone_map = tone_mapped(&mut device, &colours(), settings(None));
    let [by_format, by_shader] = [
        Output::new(Format::R8G8B8A8_SRGB, Encoding::ByFormat),
        Output::new(Format::R8G8B8A8_UNORM, Encoding::Srgb),
    ]
    .map(|output| shown(&mut device, tone_map.image(), output, false));
    let bare = device.read(tone_map.image());
    // The interface's own values are rounded to 8 bits before they are blended.
    let mut worst = Worst::new("the panel over the picture, steps", 2.0);
    for (i, (a, b)) in by_format.iter().zip(&by_shader).enumerate() {
        worst.see((*a - *b).abs().max_element() * 255.0, i);
    }
    worst.finish();
    // It is there: light colours are darkened by the box, to what blending in linear light gives.
    let (pixel, beside) = (40 * 64 + 4, 40 * 64 + 60);
    let under = srgb_eotf(f64::from(bare[pixel][0]));
    let over = (90.0f64 / 255.0).powf(2.2);
    let expected = srgb_oetf(over + under * (1.0 - 150.0 / 255.0));
    assert!((by_shader[pixel].x - expected).abs() < 2.5 / 255.0);
    assert!((by_shader[beside].x - f64::from(bare[beside][0])).abs() < 0.6 / 255.0);
}

#[test]
fn an_hdr_screen_shows_luminances_in_proportion_up_to_its_peak() {
    let mut device = Device::new();
    for peak in [400.0, 1000.0, 4000.0] {
        let tone_map = tone_mapped(&mut device, &colours(), settings(Some(peak)));
        let output = Output::new(Format::R16G16B16A16_SFLOAT, Encoding::ScRgb);
        let found = shown(&mut device, tone_map.image(), output, true);
        // Display values and signal are half floats.
        let mut worst = Worst::new("scRGB, relative", 2.1 * HALF_ROUNDOFF);
        for (found, colour) in found.iter().zip(colours()) {
            // 1000 cd/m² are the white of paper, 203 cd/m².
            let expected = scrgb(bounded(colour * 1e-3, peak / 203.0));
            let error = ((*found - expected) / expected.max(DVec3::splat(1e-3))).abs();
            worst.see(error.max_element(), format!("{peak} {colour}"));
            // In cd/m²: what is below the peak is shown at 0.203 of its luminance.
            if 0.203 * colour.max_element() < peak {
                let error = (found.x * 80.0 / (0.203 * colour.x) - 1.0).abs();
                assert!(error < 0.01 || colour.x < 1.0, "{colour} {found}");
            }
            assert!(found.max_element() * 80.0 <= peak * 1.001, "{found}");
        }
        worst.finish();
    }
}

#[test]
fn hdr10_is_the_cpus_signal_dithered() {
    let mut device = Device::new();
    let tone_map = tone_mapped(&mut device, &colours(), settings(Some(1000.0)));
    // Steps of 10 bits, largest and mean: the dither is one, its rounding half, half floats of the display values are 0.1 (lavapipe cuts them off).
    // Lavapipe's own rounding to 10 bits is a quarter of a step off.
    for (format, most, mean_most) in [
        (Format::R32G32B32A32_SFLOAT, 1.65, 0.1),
        (Format::A2B10G10R10_UNORM_PACK32, 1.9, 0.3),
    ] {
        if !is_known(&device, format) {
            continue;
        }
        let output = Output::new(format, Encoding::Hdr10);
        let found = shown(&mut device, tone_map.image(), output, true);
        let mut worst = Worst::new("HDR10, steps of 10 bits", most);
        let mut sum = [DVec3::ZERO; 2];
        for (found, colour) in found.iter().zip(colours()) {
            let expected = hdr10(bounded(colour * 1e-3, 1000.0 / PAPER_WHITE));
            let steps = (*found - expected) * 1023.0;
            worst.see(steps.abs().max_element(), format!("{colour}: {expected}"));
            sum[0] += steps;
            sum[1] += steps.abs();
        }
        worst.finish();
        let [mean, spread] = sum.map(|sum| sum / f64::from(SIZE[0] * SIZE[1]));
        println!("{format:?}: mean error {mean} steps, mean of its size {spread}");
        assert!(mean.abs().max_element() < mean_most, "{mean}");
        // Without the dither it would be at most a quarter of a step.
        assert!(spread.min_element() > 0.3, "{spread}");
    }
}

#[test]
fn quantities_keep_their_values_on_an_hdr_screen() {
    let mut device = Device::new();
    let albedo = ToneSettings {
        show: Show::Albedo,
        ..settings(Some(1000.0))
    };
    let values: Vec<DVec3> = (0..SIZE[0] * SIZE[1])
        .map(|i| DVec3::splat(f64::from(i % 64) / 63.0) * 1e3)
        .collect();
    let tone_map = tone_mapped(&mut device, &values, albedo);
    let output = Output::new(Format::R16G16B16A16_SFLOAT, Encoding::ScRgb);
    let found = shown(&mut device, tone_map.image(), output, true);
    let mut worst = Worst::new("albedo as scRGB", 4e-3);
    for (found, value) in found.iter().zip(values) {
        worst.see(found.x - scrgb(value * 1e-3).x, value);
    }
    worst.finish();
}
