//! Uploads of buffers and textures, and descriptor pools that grow.

use crate::gpu::Device;
use skylight::gpu::{
    Blend, BufferKind, ContextOptions, Depth, Format, Image, ImageDesc, Load, Optional, Outside,
    Pipeline, PipelineDesc, Recorder, Sampler, Timing, shaders, upload_buffer, upload_texture,
};
use skylight::passes::picture::accumulate;
use skylight::passes::sun_shadow::map::CutOutPush;

/// Edge of the targets, pixels.
const EDGE: u32 = 8;

/// An RGBA texture with all mip levels, opaque in only one of them.
fn opaque_in_level(recorder: &mut Recorder, size: u32, level: u32) -> Image {
    let desc = ImageDesc::flat("levels", Format::R8G8B8A8_SRGB, [size; 2]).mipmapped();
    let texels = |k: u32| ((size >> k).max(1) * (size >> k).max(1)) as usize;
    let fill = |k: u32| [10, 20, 30, if k == level { 255 } else { 0 }].repeat(texels(k));
    let levels: Vec<Vec<u8>> = (0..desc.levels).map(fill).collect();
    let levels: Vec<&[u8]> = levels.iter().map(Vec::as_slice).collect();
    upload_texture(recorder, &desc, &levels).expect("a texture")
}

/// Uploads a quad and a texture of `size` texels and draws them in the same submission; alpha testing keeps the texels that
/// are opaque. Returns the depth of every pixel.
fn draw_uploaded_quad(device: &mut Device, size: u32, opaque: u32) -> Vec<f32> {
    let formats = [Format::R32G32B32_SFLOAT, Format::R32G32_SFLOAT];
    let depth_format = Format::D32_SFLOAT;
    let desc = PipelineDesc {
        name: "quad",
        stages: &[&shaders::SHADOW_CUT_OUT_VERT, &shaders::SHADOW_CUT_OUT_FRAG],
        vertex: &formats,
        colors: &[],
        blend: skylight::gpu::Blend::Off,
        depth: Depth::Write(depth_format),
        constants: &[],
    };
    let pipeline = Pipeline::new(&device.context, &desc).expect("a pipeline");
    let target = ImageDesc::flat("depth", depth_format, [EDGE; 2]);
    let target = Image::new(&device.context, &target).expect("an image");
    let corners: [[f32; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let positions = corners.map(|[u, v]| [2.0 * u - 1.0, 2.0 * v - 1.0, 0.5]);
    let indices: [u32; 6] = [0, 1, 2, 2, 1, 3];
    let push = CutOutPush {
        shadow_from_world: glam::Mat4::IDENTITY.to_cols_array_2d(),
        cutoff: 0.5,
    };
    // Resources must outlive the submission.
    let kept = device.run(|rec| {
        let mut vertices =
            |name, bytes| upload_buffer(rec, name, BufferKind::Vertex, bytes).expect("a buffer");
        let positions = vertices("positions", bytemuck::bytes_of(&positions));
        let uvs = vertices("uvs", bytemuck::bytes_of(&corners));
        let bytes = bytemuck::bytes_of(&indices);
        let indices = upload_buffer(rec, "indices", BufferKind::Index, bytes).expect("a buffer");
        let texture = opaque_in_level(rec, size, opaque);
        rec.pass("quad", &pipeline)
            .push(&push)
            .depth(&target, Load::Clear([0.0; 4]))
            .draws(|draws| {
                draws.texture(
                    "diffuse_map",
                    &texture,
                    Sampler::Surface(Outside::Repeat, Outside::Repeat),
                );
                draws.geometry(&[&positions, &uvs], &indices);
                draws.indexed(0, 6);
            });
        (positions, uvs, indices, texture)
    });
    drop(kept);
    device.read(&target).iter().map(|texel| texel[0]).collect()
}

/// The validation layer reports a read after a copy without a barrier, and a device test fails on any message.
#[test]
fn staged_uploads_are_visible_to_draws_of_the_same_submission() {
    let mut device = Device::with(&ContextOptions {
        stage_uploads: true,
        ..ContextOptions::default()
    });
    assert_eq!(draw_uploaded_quad(&mut device, EDGE, 0), [0.5; 64]);
    device.context.check_validation().expect("no message");
}

/// Coarser levels would fill the holes of leaves, or empty the leaves.
#[test]
fn shadow_maps_look_cut_outs_up_at_their_finest_level() {
    let mut device = Device::new();
    // The quad covers EDGE pixels, so each doubling of the texture's size would select the next mip level.
    for doublings in 0..4 {
        for opaque in 0..4 {
            let depth = if opaque == 0 { 0.5 } else { 0.0 };
            let drawn = draw_uploaded_quad(&mut device, EDGE << doublings, opaque);
            assert_eq!(
                drawn, [depth; 64],
                "{doublings} doublings, opaque in level {opaque}"
            );
        }
    }
}

#[test]
fn a_texture_of_many_levels_takes_one_staging_buffer() {
    // The first two buffers are the uniforms of the recorders, the third is the staging buffer.
    let mut device = Device::with(&ContextOptions {
        fault: Some("buffer@4=out-of-device-memory".into()),
        ..ContextOptions::default()
    });
    let mut recorder = Recorder::new(&device.context, Timing::Off).expect("a recorder");
    recorder.begin().expect("begun");
    let image = opaque_in_level(&mut recorder, 64, 0);
    recorder.finish().expect("finished");
    assert_eq!(image.levels(), 7);
    // The fault has not been triggered yet.
    device.recorder.begin().expect("begun");
    let fourth = upload_buffer(&mut device.recorder, "fourth", BufferKind::Staging, &[0; 4]);
    assert!(fourth.is_err(), "fewer buffers than expected");
    device.recorder.finish().expect("finished");
}

/// Draws `draws` times with two textures alternately, each time with a new descriptor set; returns the last colour.
fn draw_in_turn(device: &mut Device, draws: usize) -> [f32; 4] {
    let format = Format::R32G32B32A32_SFLOAT;
    let desc = PipelineDesc {
        name: "in turn",
        stages: &[&shaders::FULLSCREEN_VERT, &shaders::ACCUMULATE_FRAG],
        vertex: &[],
        colors: &[format],
        depth: Depth::Off,
        blend: Blend::Off,
        constants: &[],
    };
    let pipeline = Pipeline::new(&device.context, &desc).expect("a pipeline");
    let texel = ImageDesc::flat("texel", format, [1, 1]);
    let target = Image::new(&device.context, &texel).expect("an image");
    let mut uploaded = |value: f32| {
        let color = [value; 4];
        let bytes: &[u8] = bytemuck::bytes_of(&color);
        device.run(|rec| upload_texture(rec, &texel, &[bytes]).expect("a texture"))
    };
    let textures = [uploaded(1.0), uploaded(2.0)];
    device.run(|rec| {
        rec.pass("in turn", &pipeline)
            .sample("previous_mean", &textures[0], Sampler::Nearest)
            .push(&accumulate::Push { count: 1 })
            .color(&target, Load::Discard)
            .draws(|record| {
                for k in 1..=draws {
                    record.texture("frame", &textures[k % 2], Sampler::Nearest);
                    record.triangle();
                }
            });
    });
    device.read(&target)[0]
}

#[test]
fn ten_thousand_descriptor_sets_fit_a_frame() {
    let mut device = Device::with(&ContextOptions {
        without: vec![Optional::PushDescriptor],
        ..ContextOptions::default()
    });
    // Twice: the second run reuses the pools of the first.
    for draws in [10_000, 10_001] {
        let expected = if draws % 2 == 0 { 1.0 } else { 2.0 };
        assert_eq!(draw_in_turn(&mut device, draws)[0], expected, "{draws}");
    }
}

#[test]
fn a_descriptor_pool_that_is_exhausted_early_is_followed_by_another() {
    let mut device = Device::with(&ContextOptions {
        without: vec![Optional::PushDescriptor],
        fault: Some("descriptors@3=out-of-pool-memory".into()),
        ..ContextOptions::default()
    });
    assert_eq!(draw_in_turn(&mut device, 6)[0], 1.0);
}
