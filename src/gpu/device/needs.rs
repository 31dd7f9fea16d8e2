//! What every device must have: features, formats, limits, a queue.

use ash::vk;
use vk::FormatFeatureFlags as Use;

use crate::gpu::device::optional::FLOATS;
use crate::gpu::device::surface::RawSurface;
use crate::gpu::error::Result;

/// The queue that does all the work.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::gpu) struct Queue {
    pub(in crate::gpu) family: u32,
    /// Bits of its timestamps that count; 0: it has none.
    pub(in crate::gpu) timestamp_bits: u32,
}

/// The first family of queues that does graphics and compute, and presents to the surface.
///
/// # Errors
/// What is missing, if there is none.
pub(in crate::gpu) fn queue(
    instance: &ash::Instance,
    handle: vk::PhysicalDevice,
    surface: Option<&RawSurface>,
) -> Result<std::result::Result<Queue, MissingQueue>> {
    // SAFETY: `handle` comes from this instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(handle) };
    for (family, properties) in (0u32..).zip(&families) {
        let works = properties.queue_flags.contains(BOTH);
        if works && surface.map_or(Ok(true), |s| s.is_supported(handle, family))? {
            return Ok(Ok(Queue {
                family,
                timestamp_bits: properties.timestamp_valid_bits,
            }));
        }
    }
    let flags: Vec<_> = families.iter().map(|f| f.queue_flags).collect();
    Ok(Err(missing_queue(&flags, surface.is_some())))
}

const BOTH: vk::QueueFlags =
    vk::QueueFlags::from_raw(vk::QueueFlags::GRAPHICS.as_raw() | vk::QueueFlags::COMPUTE.as_raw());

/// Why a device has no queue for the renderer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::gpu) struct MissingQueue {
    /// What is missing.
    pub(in crate::gpu) what: &'static str,
    /// Whether it is the window alone that none presents to.
    pub(in crate::gpu) is_for_window: bool,
}

fn missing_queue(families: &[vk::QueueFlags], presents: bool) -> MissingQueue {
    let any = |wanted| families.iter().any(|f: &vk::QueueFlags| f.contains(wanted));
    let is_for_window = any(BOTH) && presents;
    let what = if is_for_window {
        "a graphics queue that presents to this window"
    } else if any(vk::QueueFlags::GRAPHICS) {
        "a queue for graphics and compute together (it has them apart)"
    } else {
        "a graphics queue"
    };
    MissingQueue {
        what,
        is_for_window,
    }
}

/// Formats with their uses. The specification demands all of these but the depth attachment, where it leaves a choice.
fn formats() -> [(vk::Format, Use, &'static str); 9] {
    let target = Use::COLOR_ATTACHMENT | Use::SAMPLED_IMAGE;
    let stored = target | Use::STORAGE_IMAGE;
    let depth = Use::DEPTH_STENCIL_ATTACHMENT | Use::SAMPLED_IMAGE;
    let filtered = Use::SAMPLED_IMAGE | Use::SAMPLED_IMAGE_FILTER_LINEAR;
    [
        (vk::Format::D32_SFLOAT, depth, "depth"),
        (FLOATS, stored, "storing and rendering"),
        (
            vk::Format::R32G32B32A32_UINT,
            stored,
            "storing and rendering",
        ),
        (vk::Format::R32_SFLOAT, stored, "storing and rendering"),
        (vk::Format::R32G32_UINT, target, "rendering"),
        (vk::Format::R32_UINT, target, "rendering"),
        (
            vk::Format::R16G16B16A16_SFLOAT,
            target | Use::COLOR_ATTACHMENT_BLEND,
            "rendering and blending",
        ),
        (
            vk::Format::R8G8B8A8_UNORM,
            target | filtered,
            "rendering and filtering",
        ),
        (vk::Format::R8G8B8A8_SRGB, filtered, "filtering"),
    ]
}

/// Formats of vertices.
const VERTICES: [vk::Format; 4] = [
    vk::Format::R32G32B32_SFLOAT,
    vk::Format::R32G32_SFLOAT,
    vk::Format::R16G16B16A16_UNORM,
    vk::Format::R16G16B16A16_SNORM,
];

/// The uses of formats that a device does not support.
pub(in crate::gpu) fn missing_formats(
    instance: &ash::Instance,
    handle: vk::PhysicalDevice,
) -> Vec<String> {
    // SAFETY: `handle` comes from this instance.
    let of = |format| unsafe { instance.get_physical_device_format_properties(handle, format) };
    let images = formats().into_iter().filter_map(|(format, uses, what)| {
        let offered = of(format).optimal_tiling_features;
        (!offered.contains(uses)).then(|| format!("{what} of {format:?}"))
    });
    let vertices = VERTICES.into_iter().filter_map(|format| {
        let offered = of(format).buffer_features.contains(Use::VERTEX_BUFFER);
        (!offered).then(|| format!("the vertex format {format:?}"))
    });
    images.chain(vertices).collect()
}

/// The features that a device of Vulkan 1.3 does not support.
pub(in crate::gpu) fn missing_features(
    instance: &ash::Instance,
    handle: vk::PhysicalDevice,
) -> Vec<String> {
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut features = vk::PhysicalDeviceFeatures2::default()
        .push_next(&mut v12)
        .push_next(&mut v13);
    // SAFETY: `handle` comes from this instance; the chain lives on this stack.
    unsafe { instance.get_physical_device_features2(handle, &mut features) };
    [
        ("scalarBlockLayout", v12.scalar_block_layout),
        ("hostQueryReset", v12.host_query_reset),
        ("dynamicRendering", v13.dynamic_rendering),
        ("synchronization2", v13.synchronization2),
        ("shaderTerminateInvocation", v13.shader_terminate_invocation),
    ]
    .into_iter()
    .filter(|(_, present)| *present == vk::FALSE)
    .map(|(name, _)| name.to_owned())
    .collect()
}

/// Largest edge of an image that can be rendered to, pixels.
pub(in crate::gpu) fn largest_target(limits: &vk::PhysicalDeviceLimits) -> u32 {
    let [width, height] = limits.max_viewport_dimensions;
    limits
        .max_image_dimension2_d
        .min(limits.max_framebuffer_width)
        .min(limits.max_framebuffer_height)
        .min(width)
        .min(height)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_of_the_limits_bounds_targets() {
        let all = vk::PhysicalDeviceLimits {
            max_image_dimension2_d: 9,
            max_framebuffer_width: 8,
            max_framebuffer_height: 8,
            max_viewport_dimensions: [8, 8],
            ..Default::default()
        };
        assert_eq!(largest_target(&all), 8);
        let narrow = [
            vk::PhysicalDeviceLimits {
                max_image_dimension2_d: 4,
                ..all
            },
            vk::PhysicalDeviceLimits {
                max_framebuffer_width: 4,
                ..all
            },
            vk::PhysicalDeviceLimits {
                max_framebuffer_height: 4,
                ..all
            },
            vk::PhysicalDeviceLimits {
                max_viewport_dimensions: [4, 8],
                ..all
            },
            vk::PhysicalDeviceLimits {
                max_viewport_dimensions: [8, 4],
                ..all
            },
        ];
        assert!(narrow.iter().all(|limits| largest_target(limits) == 4));
    }

    #[test]
    fn a_missing_queue_is_named() {
        use vk::QueueFlags as Q;
        assert_eq!(
            missing_queue(&[Q::TRANSFER, Q::COMPUTE], false).what,
            "a graphics queue"
        );
        let apart = missing_queue(&[Q::GRAPHICS, Q::COMPUTE], true).what;
        assert!(apart.contains("apart"), "{apart}");
        let elsewhere = missing_queue(&[BOTH], true).what;
        assert!(elsewhere.contains("this window"), "{elsewhere}");
    }
}
