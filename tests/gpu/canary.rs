//! Checks that the validation layer reports an error and is otherwise silent; selection of a device; push descriptors and
//! descriptor pools draw the same picture.

use std::process::{Command, Output};

use crate::gpu::{Device, Model, camera, clear_day, matt, settings};
use skylight::gpu::{
    CacheState, Context, ContextOptions, Depth, Format, GpuError, Image, ImageDesc, Load, Optional,
    Pipeline, PipelineDesc, Recorder, Sampler, Timing, read_back, shaders,
};
use skylight::passes::occlusion::ssao::SsaoSettings;
use skylight::passes::picture::accumulate::Push;
use skylight::scene::Material;

/// Samples an image in the pass that writes it (a feedback loop): no layout is valid for both.
fn draw_from_itself(recorder: &mut Recorder, no_feedback: bool) {
    let context = recorder.context().clone();
    let format = Format::R32G32B32A32_SFLOAT;
    let pipeline = Pipeline::new(
        &context,
        &PipelineDesc {
            name: "canary",
            stages: &[&shaders::FULLSCREEN_VERT, &shaders::ACCUMULATE_FRAG],
            vertex: &[],
            colors: &[format],
            adds: false,
            depth: Depth::Off,
            constants: &[],
        },
    )
    .expect("a pipeline");
    let image = |name| Image::new(&context, &ImageDesc::flat(name, format, [8, 8]));
    let (target, other) = (
        image("target").expect("made"),
        image("other").expect("made"),
    );
    let source = if no_feedback { &other } else { &target };
    recorder.begin().expect("begun");
    recorder
        .pass("canary", &pipeline)
        .sample("frame", source, Sampler::Nearest)
        .sample("previous_mean", source, Sampler::Nearest)
        .push(&Push { count: 1 })
        .color(&target, Load::Discard)
        .draw();
    recorder.finish().expect("finished");
}

fn canary(no_feedback: bool) -> Result<(), GpuError> {
    let options = ContextOptions {
        device: std::env::var("SKYLIGHT_TEST_DEVICE").ok(),
        validate: true,
        ..ContextOptions::default()
    };
    let context = Context::new(&options).unwrap_or_else(|e| panic!("{e}"));
    let mut recorder = Recorder::new(&context, Timing::Off).expect("a recorder");
    draw_from_itself(&mut recorder, no_feedback);
    context.check_validation()
}

#[test]
fn a_wrong_use_is_reported() {
    let error = canary(false).expect_err("the layer must object");
    println!("{error}");
    assert!(
        matches!(&error, GpuError::Validation(messages) if !messages.is_empty()),
        "{error}"
    );
    let text = error.to_string();
    assert!(
        text.contains("VUID") || text.contains("layout") || text.contains("SYNC"),
        "{text}"
    );
}

#[test]
fn the_same_with_another_image_is_not() {
    canary(true).expect("silence");
}

#[test]
#[should_panic(expected = "validation message")]
fn a_test_device_fails_its_test() {
    let mut device = Device::new();
    draw_from_itself(&mut device.recorder, false);
}

#[test]
fn a_right_frame_reports_nothing() {
    let mut device = Device::new();
    let frame = draw_everything(&mut device);
    println!("{} bytes", frame.len());
    assert_eq!(device.context.validation_messages(), Vec::<String>::new());
}

/// Draws a frame in which every pass runs. Returns its display values, then its radiance.
fn draw_everything(device: &mut Device) -> Vec<u8> {
    let glossy = Material {
        specular: [0.3; 3],
        shininess: 20.0,
        ..matt(0.4)
    };
    let scene = Model::default()
        .ground(5.0, &glossy)
        .cube([0.0, 0.6, 0.0], 0.5, &matt(0.7))
        .build();
    let mut set = settings(160, 90).with_occlusion(SsaoSettings::default());
    set.samples = 4;
    let frame = device.frame(
        &scene,
        set,
        &clear_day(200.0, 40.0),
        &camera([2.0, 2.0, 3.0], [0.0; 3]),
    );
    let mut bytes = read_back(&mut device.recorder, frame.display())
        .expect("read")
        .bytes;
    bytes.extend(
        read_back(&mut device.recorder, frame.radiance())
            .expect("read")
            .bytes,
    );
    bytes
}

#[test]
fn descriptor_pools_draw_what_push_descriptors_draw() {
    let mut pushed = Device::new();
    let mut pooled = Device::with(&ContextOptions {
        without: vec![Optional::PushDescriptor],
        ..ContextOptions::default()
    });
    let (a, b) = (draw_everything(&mut pushed), draw_everything(&mut pooled));
    let different = a.iter().zip(&b).filter(|(a, b)| a != b).count();
    println!("{} bytes, {different} differ", a.len());
    assert!(a.len() == b.len() && different == 0);
    assert!(a.iter().any(|byte| *byte != a[0]), "an empty picture");
}

#[test]
fn a_picture_needs_no_geometry_shader() {
    let mut with = Device::new();
    let mut without = Device::with(&ContextOptions {
        without: vec![Optional::GeometryShader],
        ..ContextOptions::default()
    });
    let (a, b) = (draw_everything(&mut with), draw_everything(&mut without));
    // Display values come first, a byte each: they differ by one step at most. Then half floats, compared as their bits.
    let shown = a.len() / 3;
    let far = a[..shown]
        .iter()
        .zip(&b)
        .filter(|(a, b)| a.abs_diff(**b) > 1);
    assert_eq!((a.len(), far.count()), (b.len(), 0));
    assert!(a.iter().any(|byte| *byte != a[0]), "an empty picture");
}

#[test]
fn a_damaged_pipeline_cache_is_refused_and_made_anew() {
    let folder = tempfile::tempdir().expect("a folder");
    let options = ContextOptions {
        cache_folder: Some(folder.path().join("cache")),
        ..ContextOptions::default()
    };
    let state = || {
        let mut device = Device::with(&options);
        draw_everything(&mut device);
        device.context.cache_state()
    };
    assert_eq!(state(), CacheState::New);
    let mut files = std::fs::read_dir(folder.path().join("cache")).expect("a folder");
    let path = files.next().expect("one file").expect("an entry").path();
    assert!(files.next().is_none(), "nothing else is left behind");
    let whole = std::fs::read(&path).expect("written");
    assert!(matches!(state(), CacheState::Read(bytes) if bytes >= 32 && bytes < whole.len()));
    let mut flipped = whole.clone();
    *flipped.last_mut().expect("bytes") ^= 1;
    for damaged in [&whole[..whole.len() - 1], &flipped, b"", b"no cache at all"] {
        std::fs::write(&path, damaged).expect("written");
        assert_eq!(state(), CacheState::Refused, "{} bytes", damaged.len());
        assert!(matches!(state(), CacheState::Read(_)), "made anew");
    }
}

#[test]
fn an_unknown_device_is_named_with_those_that_exist() {
    let options = ContextOptions {
        device: Some("no such card".into()),
        ..ContextOptions::default()
    };
    let error = Context::new(&options)
        .map(|_| ())
        .expect_err("no such card");
    let text = error.to_string();
    println!("{text}");
    assert!(text.starts_with("no device matches \"no such card\"; there are: 0 \""));
}

fn skylight(arguments: &[&str], environment: &[(&str, &str)]) -> Output {
    let folder = tempfile::tempdir().expect("a folder");
    Command::new(env!("CARGO_BIN_EXE_skylight"))
        .args(arguments)
        .envs(environment.iter().copied())
        .current_dir(folder.path())
        .output()
        .expect("skylight runs")
}

/// Checks for exit code 1, an empty stdout, and one line on stderr that contains all of `wanted`.
fn fails_with(output: &Output, wanted: &[&str]) {
    let text = String::from_utf8_lossy(&output.stderr);
    println!("{text}");
    assert_eq!(output.status.code(), Some(1), "{text}");
    assert!(output.stdout.is_empty());
    assert_eq!(text.lines().count(), 1, "{text}");
    for words in wanted {
        assert!(text.contains(words), "{text}");
    }
}

#[test]
fn the_program_says_which_device_is_unknown() {
    let output = skylight(
        &[
            "render",
            "-o",
            "x.png",
            "--quiet",
            "--device",
            "no such card",
        ],
        &[],
    );
    fails_with(&output, &["\"no such card\"", "there are: 0 \""]);
}

#[test]
fn without_a_driver_the_program_names_the_package() {
    // The loader finds no driver; older loaders read the second variable.
    let nowhere = [
        ("VK_DRIVER_FILES", "/nonexistent.json"),
        ("VK_ICD_FILENAMES", "/nonexistent.json"),
    ];
    let output = skylight(&["render", "-o", "x.png", "--quiet"], &nowhere);
    fails_with(&output, &["no Vulkan device", "mesa-vulkan-drivers"]);
    assert_eq!(
        GpuError::NoDevice.to_string().lines().count(),
        1,
        "one line"
    );
}
