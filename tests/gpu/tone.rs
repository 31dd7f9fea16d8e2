//! The tone curves of the shader against `shared/reference`, in 32-bit floats,
//! and false colours against the CPU's. Seen to fail with the white of Reinhard's curve left out, and with the rows of AgX's inset matrix transposed.

use crate::common::{Table, Worst};
use crate::gpu::Device;
use skylight::daylight::colour::srgb_oetf;
use skylight::daylight::false_colour::Range;
use skylight::daylight::tone_curve::ToneCurve;
use skylight::gpu::{
    Depth, Format, Image, ImageDesc, Load, Pipeline, PipelineDesc, Sampler, read_back, shaders,
    upload_texture,
};
use skylight::passes::light::lighting::Show;
use skylight::passes::picture::tone_map::{Push, Scale, ToneMap, ToneSettings};

/// A column of the reference, and how the shader is set to compute it.
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
    let format = Format::R32G32B32A32_SFLOAT;
    let desc = ImageDesc::flat("colours", format, [inputs.len() as u32, 1]);
    let source = device
        .run(|rec| upload_texture(rec, &desc, &[bytemuck::cast_slice(inputs)]).expect("uploaded"));
    let mut constants = vec![("GAMMA", u32::from(case.gamma.is_some()))];
    constants.extend(case.constant.map(|name| (name, 1)));
    let pipeline = Pipeline::new(
        &device.context,
        &PipelineDesc {
            name: "tone map",
            stages: &[&shaders::FULLSCREEN_VERT, &shaders::TONE_MAP_FRAG],
            vertex: &[],
            colors: &[format],
            depth: Depth::Off,
            constants: &constants,
        },
    )
    .expect("a pipeline");
    let target = Image::new(&device.context, &desc).expect("an image");
    let push = Push {
        exposure: case.exposure,
        offset: 0.0,
        white: case.white,
        inverse_gamma: case.gamma.map_or(1.0, f32::recip),
    };
    device.run(|rec| {
        rec.pass("tone map", &pipeline)
            .sample("radiance", &source, Sampler::Nearest)
            .sample("average_luminance", &source, Sampler::Nearest)
            .push(&push)
            .color(&target, Load::Discard)
            .draw();
    });
    device.read(&target)
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
        // What the reference data allow; AgX comes nearest to it, whose polynomial multiplies the error of `log2`.
        let mut worst = Worst::new(case.column, 1e-5);
        let outputs = mapped(&mut device, &inputs, &case);
        for (row, output) in table.rows().zip(&outputs) {
            for (channel, end) in ["r", "g", "b"].into_iter().enumerate() {
                // What is displayed is cut to 0..1.
                let expected = row.get(&format!("{}_{end}", case.column)).clamp(0.0, 1.0);
                worst.see(f64::from(output[channel]) - expected, row.index);
            }
        }
        worst.finish();
    }
}

#[test]
fn the_false_colours_are_those_of_the_cpu() {
    let mut device = Device::new();
    let range = Range {
        min: 20.0,
        max: 5e4,
    };
    // From far below the range to far above it, and no light at all; cd/m².
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
        scale: Scale::Average(0.36),
        white: 3.0,
        gamma: Some(2.2),
        depth_scale: 1.0,
        false_colour: Some(range),
    };
    let mut tone_map = ToneMap::new(&device.context, size, settings).expect("a pass");
    let source = device
        .run(|rec| upload_texture(rec, &desc, &[bytemuck::cast_slice(&texels)]).expect("uploaded"));
    device.run(|rec| {
        tone_map.record(rec, &source, &source);
    });
    let bytes = read_back(&mut device.recorder, tone_map.image())
        .expect("read")
        .bytes;
    // Half a step of rounding, and what an encoding to sRGB may be off.
    let mut worst = Worst::new("false colours, 8 bits", 1.0);
    for (value, pixel) in values.iter().zip(bytes.chunks_exact(4)) {
        let expected = range
            .colour(*value)
            .to_array()
            .map(|c| 255.0 * srgb_oetf(c));
        for (byte, expected) in pixel.iter().zip(expected) {
            worst.see(f64::from(*byte) - expected, value);
        }
    }
    worst.finish();
}
