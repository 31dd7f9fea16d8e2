//! Tone curves of the device, and the formats that images are drawn to and read back from.

use glam::UVec2;

use super::check::Check;
use super::device::{Device, rgb};
use crate::daylight::colour::srgb_oetf;
use crate::daylight::tone_curve::{REINHARD_WHITE, ToneCurve};
use crate::gpu::{
    Blend, Depth, Format, Image, ImageDesc, Load, Pipeline, PipelineDesc, Result, Sampler, shaders,
    upload_texture,
};
use crate::passes::picture::tone_map::Push;

/// Settings of the shader of tone curves.
#[derive(Debug, Clone, Copy)]
pub struct Curve {
    /// The constant that selects the curve; `None`: linear.
    pub constant: Option<&'static str>,
    /// Factor before the curve.
    pub exposure: f32,
    /// White of Reinhard's curve, exposed.
    pub white: f32,
    /// Gamma of the encoding; `None`: linear.
    pub gamma: Option<f32>,
}

/// Draws colours by the shader of tone curves to an image of a format and reads them back. Display values are 0 to 1.
///
/// # Errors
/// The device fails.
pub fn mapped(
    device: &mut Device,
    inputs: &[[f32; 4]],
    curve: Curve,
    format: Format,
) -> Result<Vec<[f32; 4]>> {
    let size = [inputs.len() as u32, 1];
    let desc = ImageDesc::flat("colours", Format::R32G32B32A32_SFLOAT, size);
    let source =
        device.run(|rec| upload_texture(rec, &desc, &[bytemuck::cast_slice(inputs)]))??;
    let mut constants = vec![("GAMMA", u32::from(curve.gamma.is_some()))];
    constants.extend(curve.constant.map(|name| (name, 1)));
    let pipeline = Pipeline::new(
        &device.context,
        &PipelineDesc {
            name: "tone map",
            stages: &[&shaders::FULLSCREEN_VERT, &shaders::TONE_MAP_FRAG],
            vertex: &[],
            colors: &[format],
            depth: Depth::Off,
            blend: Blend::Off,
            constants: &constants,
        },
    )?;
    let target = Image::new(&device.context, &ImageDesc::flat("mapped", format, size))?;
    let push = Push {
        exposure: curve.exposure,
        offset: 0.0,
        white: curve.white,
        inverse_gamma: curve.gamma.map_or(1.0, f32::recip),
        least: 0.0,
        peak: 1.0,
        origin: UVec2::ZERO,
    };
    device.run(|rec| {
        rec.pass("tone map", &pipeline)
            .sample("radiance", &source, Sampler::Nearest)
            .sample("average_luminance", &source, Sampler::Nearest)
            .push(&push)
            .color(&target, Load::Discard)
            .draw();
    })?;
    device.read(&target)
}

/// The curves, and the constants of the shader that select them.
const CURVES: [(ToneCurve, Option<&str>); 7] = [
    (ToneCurve::Linear, None),
    (ToneCurve::Exponential, Some("EXPONENTIAL")),
    (
        ToneCurve::ExponentialLuminance,
        Some("EXPONENTIAL_LUMINANCE"),
    ),
    (ToneCurve::Reinhard, Some("REINHARD")),
    (ToneCurve::Agx, Some("AGX")),
    (ToneCurve::Neutral, Some("NEUTRAL")),
    (ToneCurve::Aces, Some("ACES")),
];

/// Greys from black to beyond white, and saturated colours.
fn colours() -> Vec<[f32; 4]> {
    let greys = (0..48).map(|i| [(i as f32 / 12.0).exp2() / 4.0 - 0.25; 3]);
    let colours = (0..48).map(|i: i32| {
        let part = |k: i32| ((i * k) % 16) as f32 / 15.0;
        [part(1), part(7), part(11)].map(|c| c * c * 3.0)
    });
    greys
        .chain(colours)
        .map(|[r, g, b]| [r, g, b, 1.0])
        .collect()
}

/// Every tone curve.
///
/// # Errors
/// The device fails.
pub fn curves(device: &mut Device) -> Result<Vec<Check>> {
    let mut check = Check::absolute("tone curves, seven", "CPU, f64", "", 1e-5);
    let inputs = colours();
    for (curve, constant) in CURVES {
        let settings = Curve {
            constant,
            exposure: 1.0,
            white: REINHARD_WHITE as f32,
            gamma: None,
        };
        let outputs = mapped(device, &inputs, settings, Format::R32G32B32A32_SFLOAT)?;
        for (input, output) in inputs.iter().zip(outputs) {
            let expected = curve.apply(rgb(*input));
            check.see_colour(rgb(output), expected, 1.0, || {
                format!("{curve:?} of {input:?}")
            });
        }
    }
    Ok(vec![check])
}

/// A format: its channels, and the largest error of a value in 0..=1 that is stored in it.
type Stored = (Format, usize, f64, Encode);

/// What a format stores of a value.
type Encode = fn(f64) -> f64;

const fn plain(value: f64) -> f64 {
    value
}

/// Formats that pictures and layers are drawn to. Vulkan lets a device round either way: a whole step of integers, 2^-11 of half floats below 1.
const FORMATS: [Stored; 12] = [
    (Format::R8_UNORM, 1, 1.0 / 255.0, plain),
    (Format::R8G8B8A8_UNORM, 3, 1.0 / 255.0, plain),
    (Format::B8G8R8A8_UNORM, 3, 1.0 / 255.0, plain),
    (Format::R8G8B8A8_SRGB, 3, 1.0 / 255.0, srgb_oetf),
    (Format::B8G8R8A8_SRGB, 3, 1.0 / 255.0, srgb_oetf),
    (Format::A2B10G10R10_UNORM_PACK32, 3, 1.0 / 1023.0, plain),
    (Format::R16G16_SNORM, 2, 1.0 / 32767.0, plain),
    (Format::R16_SFLOAT, 1, 1.0 / 1024.0, plain),
    (Format::R16G16_SFLOAT, 2, 1.0 / 1024.0, plain),
    (Format::R16G16B16A16_SFLOAT, 3, 1.0 / 1024.0, plain),
    (Format::R32_SFLOAT, 1, 1e-7, plain),
    (Format::R32G32B32A32_SFLOAT, 3, 1e-7, plain),
];

/// Values in steps of 1/96, each channel with its own, so that exchanged channels show.
fn steps() -> Vec<[f32; 4]> {
    let value = |i: u32| (i % 97) as f32 / 96.0;
    (0..97)
        .map(|i| [value(i), value(i * 5 + 31), value(i * 7 + 62), 1.0])
        .collect()
}

/// Every format that is drawn to, read back. Formats that this device does not draw to are left out.
///
/// # Errors
/// The device fails.
pub fn formats(device: &mut Device) -> Result<Vec<Check>> {
    let mut check = Check::absolute("formats, drawn and read back", "CPU", "steps", 1.05);
    let inputs = steps();
    let linear = Curve {
        constant: None,
        exposure: 1.0,
        white: 1.0,
        gamma: None,
    };
    for (format, channels, step, encode) in FORMATS {
        if !device.context.can_draw(format) {
            continue;
        }
        let outputs = mapped(device, &inputs, linear, format)?;
        for (input, output) in inputs.iter().zip(outputs) {
            let stored = rgb(*input).to_array().map(encode);
            let found = rgb(output).to_array().into_iter();
            for (found, stored) in found.zip(stored).take(channels) {
                let at = || format!("{format:?}, {input:?}");
                check.see(found / step, stored / step, 1.0, at);
            }
        }
    }
    Ok(vec![check])
}
