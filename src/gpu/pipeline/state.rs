//! The fixed state of graphics pipelines, from what passes say: vertex streams, depth test.

use ash::vk;

use crate::gpu::pipeline::Depth;

pub(in crate::gpu) fn vertex_streams(
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
        other => unreachable!("vertex format {other:?} has no size here"),
    }
}

pub(in crate::gpu) fn rasterization(
    depth: Depth,
) -> vk::PipelineRasterizationStateCreateInfo<'static> {
    let base = vk::PipelineRasterizationStateCreateInfo::default()
        .polygon_mode(vk::PolygonMode::FILL)
        .cull_mode(vk::CullModeFlags::NONE)
        .line_width(1.0);
    match depth {
        Depth::Write { slope_bias, .. } if slope_bias != 0.0 => {
            // Reversed depth: away from the viewer is down.
            base.depth_bias_enable(true)
                .depth_bias_slope_factor(-slope_bias)
        }
        _ => base,
    }
}

pub(in crate::gpu) fn depth_state(
    depth: Depth,
) -> vk::PipelineDepthStencilStateCreateInfo<'static> {
    let compare = match depth {
        // A full-screen triangle has depth 0, which is less than that of any surface.
        Depth::Surface(_) => vk::CompareOp::LESS,
        Depth::Background(_) => vk::CompareOp::EQUAL,
        Depth::Off | Depth::Write { .. } => vk::CompareOp::GREATER,
    };
    vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(depth != Depth::Off)
        .depth_write_enable(matches!(depth, Depth::Write { .. }))
        .depth_compare_op(compare)
}
