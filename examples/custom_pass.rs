//! A pass of your own over an image of the frame: `cargo run --release --example custom_pass`.
//!
//! A fragment shader reads the irradiance that the frame has drawn and marks what has at least 10 000 lux. What it reads and writes is declared once; the recorder
//! finds the barriers.

use glam::UVec2;
use skylight::daylight::sky::{Conditions, Daylight};
use skylight::frame::{Frame, FrameSettings};
use skylight::gpu::{
    Binding, BindingKind, Blend, Context, ContextOptions, Depth, Format, Image, ImageDesc, Load,
    Pipeline, PipelineDesc, Recorder, Sampler, Shader, Stage, Timing, read_back, shaders,
};
use skylight::passes::light::lighting::Show;
use skylight::scene::{Camera, LoadOptions, load};

const SOURCE: &str = "#version 460
layout(set = 0, binding = 0) uniform sampler2D irradiance; // klx
layout(location = 0) out vec4 is_bright;
void main() {
    vec3 e = texelFetch(irradiance, ivec2(gl_FragCoord.xy), 0).rgb;
    is_bright = vec4(step(10.0, dot(e, vec3(0.2126, 0.7152, 0.0722))));
}";

const FORMAT: Format = Format::R32G32B32A32_SFLOAT;

/// The stage, for the rest of the program.
fn stage() -> Result<&'static Shader, Box<dyn std::error::Error>> {
    let compiler = shaderc::Compiler::new()?;
    let kind = shaderc::ShaderKind::Fragment;
    let code = compiler.compile_into_spirv(SOURCE, kind, "bright.frag", "main", None)?;
    let words = Box::leak(code.as_binary().to_vec().into_boxed_slice());
    Ok(Box::leak(Box::new(Shader {
        bindings: &[Binding {
            name: "irradiance",
            binding: 0,
            kind: BindingKind::SampledImage,
            fields: &[],
        }],
        outputs: 1,
        ..Shader::new("bright.frag", Stage::Fragment, words)
    })))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let scene = load("colonnade".as_ref(), &LoadOptions::default())?.scene;
    let camera = Camera::framing(&scene.bounds, 40.0, 16.0 / 9.0);
    let daylight = Daylight::new(&Conditions::default());
    let size = UVec2::new(320, 180);

    let context = Context::new(&ContextOptions::default())?;
    let stages = [&shaders::FULLSCREEN_VERT, stage()?];
    let desc = PipelineDesc {
        name: "bright",
        stages: &stages,
        vertex: &[],
        colors: &[FORMAT],
        depth: Depth::Off,
        blend: Blend::Off,
        constants: &[],
    };
    let pipeline = Pipeline::new(&context, &desc)?;
    let image = Image::new(
        &context,
        &ImageDesc::flat("bright", FORMAT, size.to_array()),
    )?;

    let mut recorder = Recorder::new(&context, Timing::Off)?;
    recorder.begin()?;
    let settings = FrameSettings {
        size,
        ..FrameSettings::default()
    }
    .showing(Show::Irradiance);
    let mut frame = Frame::new(&mut recorder, &scene, settings)?;
    frame.record(&mut recorder, &daylight, &camera, 0);
    recorder
        .pass("bright", &pipeline)
        .sample("irradiance", frame.radiance(), Sampler::Nearest)
        .color(&image, Load::Discard)
        .draw();
    recorder.finish()?;

    let texels = read_back(&mut recorder, &image)?.rgba();
    let bright = texels.iter().filter(|texel| texel[0] > 0.5).count();
    println!(
        "{:.1} % of the picture has 10 000 lux or more",
        1e2 * bright as f64 / texels.len() as f64
    );
    Ok(())
}
