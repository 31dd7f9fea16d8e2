//! The shader's tone curves against `shared/reference` in 32-bit floats; exposure and false colours against the CPU.
//!
//! Verified to fail without the white of Reinhard's curve, with the rows of AgX's inset matrix transposed, and without the dither.

use crate::common::{Table, Worst};
use crate::gpu::Device;
use glam::{DVec3, UVec2, Vec3};
use skylight::daylight::colour::{luminance, srgb_oetf};
use skylight::daylight::exposure::{adaptation, robust_log_average};
use skylight::daylight::false_colour::{ColourMap, Colours, Range};
use skylight::daylight::sky::{Conditions, Daylight, SkyModel};
use skylight::daylight::sun_position::direction;
use skylight::daylight::tone_curve::{ToneCurve, encode};
use skylight::gpu::{Format, Image, ImageDesc, read_back, upload_texture};
use skylight::passes::light::lighting::Show;
use skylight::passes::picture::exposure::Exposure;
use skylight::passes::picture::tone_map::{Scale, ToneMap, ToneSettings};
use skylight::validate::picture::{self, Curve};

/// A column of the reference, and the shader settings that reproduce it.
struct Case {
    column: &'static str,
    constant: Option<&'static str>,
    exposure: f32,
    white: f32,
    gamma: Option<f32>,
}

const fn case(column: &'static str, constant: Option<&'static str>, exposure: f32) -> Case {
    Case {
        column,
        constant,
        exposure,
        white: 3.0,
        gamma: None,
    }
}

/// Parameters from the file's comment line: k 0.7, gamma 2.2, L_avg 0.6, key 0.18, L_logavg 0.4, L_white 3.
fn cases() -> [Case; 7] {
    [
        Case {
            gamma: Some(2.2),
            ..case("linear_gamma", None, 0.7)
        },
        case("ferschin_perchannel", Some("EXPONENTIAL"), 1.0 / 0.6),
        case(
            "ferschin_luminance",
            Some("EXPONENTIAL_LUMINANCE"),
            1.0 / 0.6,
        ),
        case("reinhard_lum_white", Some("REINHARD"), 0.18 / 0.4),
        case("khronos_neutral", Some("NEUTRAL"), 1.0),
        case("agx_base_linear", Some("AGX"), 1.0),
        case("aces_hill", Some("ACES"), 1.0),
    ]
}

fn mapped(device: &mut Device, inputs: &[[f32; 4]], case: &Case) -> Vec<[f32; 4]> {
    let curve = Curve {
        constant: case.constant,
        exposure: case.exposure,
        white: case.white,
        gamma: case.gamma,
    };
    let format = Format::R32G32B32A32_SFLOAT;
    picture::mapped(device, inputs, curve, format).expect("drawn")
}

#[test]
fn the_shaders_curves_meet_the_reference() {
    let Some(table) = Table::read("tonemap_reference.csv") else {
        return;
    };
    let inputs: Vec<[f32; 4]> = table
        .rows()
        .map(|row| {
            let c = row.get3(["in_r", "in_g", "in_b"]).as_vec3();
            [c.x, c.y, c.z, 1.0]
        })
        .collect();
    let mut device = Device::new();
    for case in cases() {
        // Tolerance of the reference data. AgX comes closest to it: its polynomial amplifies the error of `log2`.
        let mut worst = Worst::new(case.column, 1e-5);
        let outputs = mapped(&mut device, &inputs, &case);
        for (row, output) in table.rows().zip(&outputs) {
            for (channel, end) in ["r", "g", "b"].into_iter().enumerate() {
                // Displayed values are clamped to 0..1.
                let expected = row.get(&format!("{}_{end}", case.column)).clamp(0.0, 1.0);
                worst.see(f64::from(output[channel]) - expected, row.index);
            }
        }
        worst.finish();
    }
}

#[test]
fn the_false_colours_are_those_of_the_cpu() {
    for map in [ColourMap::Turbo, ColourMap::Viridis, ColourMap::Cividis] {
        false_colours_are_those_of_the_cpu(map);
    }
}

fn false_colours_are_those_of_the_cpu(map: ColourMap) {
    let mut device = Device::new();
    let range = Range {
        min: 20.0,
        max: 5e4,
    };
    let colours = Colours { range, map };
    // From far below to far above the range, and zero; cd/m².
    let mut values: Vec<f64> = (0..2000)
        .map(|i| 10f64.powf(-3.0 + f64::from(i) / 200.0))
        .collect();
    values.push(0.0);
    let kilo = |v: &f64| [(v / 1e3) as f32; 4];
    let texels: Vec<[f32; 4]> = values.iter().map(kilo).collect();
    let size = [texels.len() as u32, 1];
    let desc = ImageDesc::flat("luminances", Format::R32G32B32A32_SFLOAT, size);
    let settings = ToneSettings {
        show: Show::Beauty,
        curve: ToneCurve::Agx,
        scale: Scale::Average {
            key: 0.36,
            least: 0.0,
        },
        white: 3.0,
        gamma: Some(2.2),
        depth_scale: 1.0,
        false_colour: Some(colours),
        hours: 1.0,
        peak: None,
    };
    let tone_map = ToneMap::new(&device.context, size, settings).expect("a pass");
    let source = device
        .run(|rec| upload_texture(rec, &desc, &[bytemuck::cast_slice(&texels)]).expect("uploaded"));
    device.run(|rec| {
        tone_map.record(rec, &source, &source, UVec2::ZERO);
    });
    let bytes = read_back(&mut device.recorder, tone_map.image())
        .expect("read")
        .bytes;
    // Vulkan lets a device round to 8 bits with an error of 0.6 steps.
    let mut worst = Worst::new("false colours, 8 bits", 0.61);
    for (value, pixel) in values.iter().zip(bytes.chunks_exact(4)) {
        let expected = colours
            .colour(*value)
            .to_array()
            .map(|c| 255.0 * srgb_oetf(c));
        for (byte, expected) in pixel.iter().zip(expected) {
            worst.see(f64::from(*byte) - expected, value);
        }
    }
    worst.finish();
}

/// Tone settings of a picture of light, exposed by `factor` per cd/m².
fn exposed(factor: f64, gamma: Option<f64>) -> ToneSettings {
    ToneSettings {
        show: Show::Beauty,
        curve: ToneCurve::Neutral,
        scale: Scale::Fixed(factor),
        white: 3.0,
        gamma,
        depth_scale: 1.0,
        false_colour: None,
        hours: 1.0,
        peak: None,
    }
}

/// The 8 bits of a picture of radiances, cd/m².
fn shown(
    device: &mut Device,
    size: [u32; 2],
    picture: &[DVec3],
    tone: ToneSettings,
    origin: UVec2,
) -> Vec<[f64; 3]> {
    let texels: Vec<[f32; 4]> = picture
        .iter()
        .map(|rgb| (*rgb * 1e-3).as_vec3().extend(1.0).to_array())
        .collect();
    let source = uploaded(device, size, &texels);
    let tone_map = ToneMap::new(&device.context, size, tone).expect("a pass");
    device.run(|rec| {
        tone_map.record(rec, &source, &source, origin);
    });
    let pixels = read_back(&mut device.recorder, tone_map.image()).expect("read");
    let pixels = pixels.bytes.chunks_exact(4);
    pixels.map(|p| [p[0], p[1], p[2]].map(f64::from)).collect()
}

/// The sky of a moonless night's dusk, from the horizon up to 30 degrees, over a quarter of the azimuths, cd/m².
fn dusk(size: [u32; 2]) -> Vec<DVec3> {
    let day = Daylight::new(&Conditions {
        model: SkyModel::Atmosphere,
        sun_elevation_deg: -17.0,
        ..Conditions::default()
    });
    let at = |i: u32| {
        let (x, y) = (f64::from(i % size[0]), f64::from(i / size[0]));
        day.radiance(direction(180.0 + 0.35 * x, 30.0 - 0.15 * y))
    };
    (0..size[0] * size[1]).map(at).collect()
}

#[test]
fn smooth_dark_pictures_have_no_bands() {
    let mut device = Device::new();
    let size = [256, 192];
    let picture = dusk(size);
    let mut worst = Worst::new("mean of 16x16 pixels against the curve, steps", 0.15);
    // From a picture of middle grey to one of a few steps.
    for factor in [1.0e3, 1.0e2, 1.0e1, 2.0] {
        for gamma in [None, Some(2.2)] {
            let tone = exposed(factor, gamma);
            let found = shown(&mut device, size, &picture, tone, UVec2::ZERO);
            let mut means = vec![[[0.0; 2]; 3]; 16 * 12];
            for (i, (pixel, radiance)) in found.iter().zip(&picture).enumerate() {
                let block = i / 16 % 16 + i / (256 * 16) * 16;
                let curve = tone.curve.apply(*radiance * factor);
                let expected = encode(curve, gamma).to_array();
                for (mean, (found, expected)) in
                    means[block].iter_mut().zip(pixel.iter().zip(expected))
                {
                    mean[0] += found / 256.0;
                    mean[1] += expected * 255.0 / 256.0;
                }
            }
            for (block, mean) in means.iter().enumerate() {
                for [found, expected] in mean {
                    worst.see(
                        found - expected,
                        format!("{factor} {gamma:?} {block}: {expected}"),
                    );
                }
            }
        }
    }
    worst.finish();
}

#[test]
fn the_dither_keeps_black_white_and_grey_and_is_the_same_in_tiles() {
    let mut device = Device::new();
    let size = [64, 64];
    let tone = ToneSettings {
        curve: ToneCurve::Linear,
        ..exposed(1e-3, None)
    };
    for (level, byte) in [(0.0, 0.0), (1e6, 255.0)] {
        let flat = vec![DVec3::splat(level); 64 * 64];
        let found = shown(&mut device, size, &flat, tone, UVec2::ZERO);
        assert!(found.iter().all(|p| *p == [byte; 3]), "{level}");
    }
    let ramp: Vec<DVec3> = (0..64 * 64)
        .map(|i| DVec3::splat(f64::from(i) / 8.0))
        .collect();
    let whole = shown(&mut device, size, &ramp, tone, UVec2::ZERO);
    assert!(whole.iter().all(|[r, g, b]| r == g && g == b));
    let lower = shown(
        &mut device,
        [64, 32],
        &ramp[64 * 32..],
        tone,
        UVec2::new(0, 32),
    );
    assert_eq!(lower, whole[64 * 32..]);
}

#[test]
fn a_lowest_exposure_leaves_dark_pictures_dark_alone() {
    let mut device = Device::new();
    let auto = |least| ToneSettings {
        scale: Scale::Average { key: 0.36, least },
        curve: ToneCurve::Linear,
        ..exposed(1.0, None)
    };
    let mean = |device: &mut Device, level: f64, least| {
        let flat = vec![DVec3::splat(level); 64 * 64];
        let found = shown(device, [64, 64], &flat, auto(least), UVec2::ZERO);
        found.iter().map(|p| p[1]).sum::<f64>() / found.len() as f64
    };
    for (level, least, expected) in [(2.0, 0.0, 0.36), (2.0, 1.0, 0.36), (2.0, 8.0, 0.09)] {
        let found = mean(&mut device, level, least);
        let expected = 255.0 * srgb_oetf(expected);
        assert!(
            (found - expected).abs() < 0.6,
            "{least}: {found} {expected}"
        );
    }
}

/// Size of the grid on which the device samples luminance: with this size every pixel is a sample.
const GRID: [u32; 2] = [128, 72];

/// A deterministic value in 0..1 for a pixel.
fn noise(pixel: u32) -> f32 {
    (pixel.wrapping_mul(2_654_435_761) >> 8) as f32 / (1 << 24) as f32
}

fn uploaded(device: &mut Device, size: [u32; 2], texels: &[[f32; 4]]) -> Image {
    let desc = ImageDesc::flat("picture", Format::R32G32B32A32_SFLOAT, size);
    device.run(|rec| upload_texture(rec, &desc, &[bytemuck::cast_slice(texels)]).expect("uploaded"))
}

/// Average luminance of a picture as computed by the device, cd/m².
fn average(device: &mut Device, exposure: &Exposure, picture: &Image) -> f64 {
    device.run(|rec| {
        exposure.record(rec, picture);
    });
    f64::from(device.read(exposure.image())[0][0]) * 1e3
}

#[test]
fn the_automatic_exposure_is_that_of_the_cpu() {
    type Texel = fn(f32) -> [f32; 3];
    let scenes: [(&str, Texel); 6] = [
        ("grey", |_| [2.0; 3]),
        ("12 stops", |x| [(12.0 * x - 6.0).exp2(), 1e-3, 2e-3]),
        ("a third black", |x| {
            [if x < 1.0 / 3.0 { 0.0 } else { x }; 3]
        }),
        ("nearly black, and the sun", |x| match x {
            x if x < 0.6 => [1e-4 * x; 3],
            x if x > 0.999 => [1.6e6; 3],
            x => [3.0, 4.0 * x, 5.0],
        }),
        ("a night", |x| [1e-6 * (1.0 + x), 1e-6, 2e-6]),
        ("no numbers", |x| match x {
            x if x < 0.1 => [f32::NAN; 3],
            x if x < 0.2 => [f32::INFINITY; 3],
            x if x < 0.3 => [-1.0; 3],
            x => [x * x, x, 1.0],
        }),
    ];
    let mut device = Device::new();
    let exposure = Exposure::new(&device.context).expect("a pass");
    // Rounding of the sum of 9216 floats.
    let mut worst = Worst::new("automatic exposure, stops", 2e-4);
    for (name, texel) in scenes {
        let colours: Vec<[f32; 3]> = (0..GRID[0] * GRID[1]).map(|i| texel(noise(i))).collect();
        let texels: Vec<[f32; 4]> = colours.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect();
        let picture = uploaded(&mut device, GRID, &texels);
        let device_average = average(&mut device, &exposure, &picture);
        let of_colour = |c: &[f32; 3]| luminance(Vec3::from(*c).as_dvec3()) * 1e3;
        let luminances: Vec<f64> = colours.iter().map(of_colour).collect();
        let expected = robust_log_average(&luminances).expect("light");
        worst.see((device_average / expected).log2(), name);
    }
    worst.finish();
}

#[test]
fn pictures_of_any_size_are_metered_and_black_ones_too() {
    let mut device = Device::new();
    for size in [[1, 1], [3, 2], [1000, 1], [1, 1000], [640, 360]] {
        let mut exposure = Exposure::new(&device.context).expect("a pass");
        let grey = vec![[2.5; 4]; (size[0] * size[1]) as usize];
        let picture = uploaded(&mut device, size, &grey);
        let value = average(&mut device, &exposure, &picture);
        assert!((value / 2500.0 - 1.0).abs() < 1e-5, "{size:?} {value}");
        // A black picture keeps the current exposure; without one, it counts as 1000 cd/m².
        let black = uploaded(&mut device, size, &vec![[0.0; 4]; grey.len()]);
        exposure.set_share(0.5);
        let kept = average(&mut device, &exposure, &black);
        assert!((kept / 2500.0 - 1.0).abs() < 1e-5, "{size:?} {kept}");
        let first = Exposure::new(&device.context).expect("a pass");
        assert_eq!(average(&mut device, &first, &black), 1e3);
    }
}

#[test]
fn the_exposure_adapts_along_the_cpus_curve_both_ways() {
    let mut device = Device::new();
    let mut exposure = Exposure::new(&device.context).expect("a pass");
    let [dark, bright] = [0.25, 64.0].map(|l| uploaded(&mut device, [4, 4], &[[l; 4]; 16]));
    let mut worst = Worst::new("adaptation, stops", 1e-4);
    // The first picture sets the exposure without adaptation.
    exposure.set_share(0.0);
    worst.see(
        (average(&mut device, &exposure, &dark) / 250.0).log2(),
        "at first",
    );
    let mut log = 250f64.log2();
    for (picture, luminance) in [(&bright, 64e3f64), (&dark, 250.0)] {
        for seconds in [0.0, 0.01, 0.1, 0.03, 0.36] {
            let share = adaptation(seconds);
            exposure.set_share(share as f32);
            log += (luminance.log2() - log) * share;
            let value = average(&mut device, &exposure, picture);
            worst.see(value.log2() - log, seconds);
        }
        assert!((log - luminance.log2()).abs() < 0.85, "a tenth of 8 stops");
        exposure.set_share(1.0);
        log = luminance.log2();
        worst.see(
            average(&mut device, &exposure, picture).log2() - log,
            "at once",
        );
    }
    worst.finish();
}
