//! Creation of graphics and compute pipelines, including the fixed-function state.

use ash::vk;

use crate::gpu::device::context::Context;
use crate::gpu::pipeline::{Blend, Depth, PipelineDesc};

type Created = Result<vk::Pipeline, vk::Result>;

/// Creates a compute pipeline.
pub(super) fn compute(
    context: &Context,
    layout: vk::PipelineLayout,
    stage: vk::PipelineShaderStageCreateInfo<'_>,
) -> Created {
    let info = [vk::ComputePipelineCreateInfo::default()
        .stage(stage)
        .layout(layout)];
    let (raw, cache) = (context.raw(), context.pipeline_cache());
    // SAFETY: `stage` borrows what it points to; the layout is alive.
    let created = unsafe { raw.create_compute_pipelines(cache, &info, None) };
    created.map(|p| p[0]).map_err(|(_, result)| result)
}

/// Creates a graphics pipeline with dynamic viewport and scissor. Pipelines that draw geometry also have dynamic cull mode and front
/// face; full-screen triangles are never culled.
pub(super) fn graphics(
    context: &Context,
    layout: vk::PipelineLayout,
    stages: &[vk::PipelineShaderStageCreateInfo<'_>],
    desc: &PipelineDesc<'_>,
) -> Created {
    let (vertex_bindings, vertex_attributes) = vertex_streams(desc.vertex);
    let vertex = vk::PipelineVertexInputStateCreateInfo::default()
        .vertex_binding_descriptions(&vertex_bindings)
        .vertex_attribute_descriptions(&vertex_attributes);
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
        .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport = vk::PipelineViewportStateCreateInfo::default()
        .viewport_count(1)
        .scissor_count(1);
    let multisample = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(vk::SampleCountFlags::TYPE_1);
    let rasterization = rasterization();
    let depth = depth_state(desc.depth);
    let blends = vec![blend_state(desc.blend); desc.colors.len()];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let dynamic =
        vk::PipelineDynamicStateCreateInfo::default().dynamic_states(dynamic_states(desc.culls()));
    let mut rendering = vk::PipelineRenderingCreateInfo::default()
        .color_attachment_formats(desc.colors)
        .depth_attachment_format(desc.depth.format().unwrap_or(vk::Format::UNDEFINED));
    let info = [vk::GraphicsPipelineCreateInfo::default()
        .stages(stages)
        .vertex_input_state(&vertex)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&rasterization)
        .multisample_state(&multisample)
        .depth_stencil_state(&depth)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut rendering)];
    let (raw, cache) = (context.raw(), context.pipeline_cache());
    // SAFETY: everything that `info` points to lives on this stack.
    let created = unsafe { raw.create_graphics_pipelines(cache, &info, None) };
    created.map(|p| p[0]).map_err(|(_, result)| result)
}

fn blend_state(blend: Blend) -> vk::PipelineColorBlendAttachmentState {
    let all = vk::PipelineColorBlendAttachmentState::default()
        .color_write_mask(vk::ColorComponentFlags::RGBA)
        .blend_enable(blend != Blend::Off);
    let (zero, one) = (vk::BlendFactor::ZERO, vk::BlendFactor::ONE);
    let (colour, alpha) = (vk::BlendFactor::SRC_COLOR, vk::BlendFactor::SRC_ALPHA);
    match blend {
        Blend::Off => all,
        Blend::Add => all
            .src_color_blend_factor(one)
            .dst_color_blend_factor(one)
            .src_alpha_blend_factor(one)
            .dst_alpha_blend_factor(one),
        Blend::Multiply | Blend::MultiplyAndMost => all
            .src_color_blend_factor(zero)
            .dst_color_blend_factor(colour)
            .src_alpha_blend_factor(zero)
            .dst_alpha_blend_factor(alpha)
            .alpha_blend_op(if blend == Blend::Multiply {
                vk::BlendOp::ADD
            } else {
                vk::BlendOp::MAX
            }),
    }
}

fn dynamic_states(culls: bool) -> &'static [vk::DynamicState] {
    const ALL: &[vk::DynamicState] = &[
        vk::DynamicState::VIEWPORT,
        vk::DynamicState::SCISSOR,
        vk::DynamicState::CULL_MODE,
        vk::DynamicState::FRONT_FACE,
    ];
    if culls { ALL } else { &ALL[..2] }
}

fn vertex_streams(
    formats: &[vk::Format],
) -> (
    Vec<vk::VertexInputBindingDescription>,
    Vec<vk::VertexInputAttributeDescription>,
) {
    let stream = |(i, format): (usize, &vk::Format)| {
        let index = i as u32;
        let binding = vk::VertexInputBindingDescription {
            binding: index,
            stride: vertex_size(*format),
            input_rate: vk::VertexInputRate::VERTEX,
        };
        let attribute = vk::VertexInputAttributeDescription {
            location: index,
            binding: index,
            format: *format,
            offset: 0,
        };
        (binding, attribute)
    };
    formats.iter().enumerate().map(stream).unzip()
}

fn vertex_size(format: vk::Format) -> u32 {
    match format {
        vk::Format::R32G32B32A32_SFLOAT => 16,
        vk::Format::R32G32B32_SFLOAT => 12,
        vk::Format::R32G32_SFLOAT => 8,
        vk::Format::R16G16_SNORM => 4,
        vk::Format::R16G16B16A16_UNORM | vk::Format::R16G16B16A16_SNORM => 8,
        other => unreachable!("no vertex stream has the format {other:?}"),
    }
}

fn rasterization() -> vk::PipelineRasterizationStateCreateInfo<'static> {
    vk::PipelineRasterizationStateCreateInfo::default()
        .polygon_mode(vk::PolygonMode::FILL)
        .cull_mode(vk::CullModeFlags::NONE)
        .line_width(1.0)
}

fn depth_state(depth: Depth) -> vk::PipelineDepthStencilStateCreateInfo<'static> {
    let compare = match depth {
        // A full-screen triangle has depth 0, less than any surface.
        Depth::Surface(_) => vk::CompareOp::LESS,
        Depth::Background(_) => vk::CompareOp::EQUAL,
        Depth::Off | Depth::Test(_) | Depth::Write(_) => vk::CompareOp::GREATER,
    };
    vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(depth != Depth::Off)
        .depth_write_enable(matches!(depth, Depth::Write(_)))
        .depth_compare_op(compare)
}
