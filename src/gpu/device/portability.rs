//! Drivers on top of another interface, as MoltenVK on Metal: they lack some of Vulkan and say so.

use std::ffi::CStr;

use ash::{khr, vk};

/// The extension of a device that lacks some of Vulkan; a device that offers it demands that it is enabled.
pub(in crate::gpu) const SUBSET: &CStr = khr::portability_subset::NAME;

/// The extension of instances without which the loader hides such drivers.
pub(in crate::gpu) const ENUMERATION: &CStr = khr::portability_enumeration::NAME;

/// Alignment of the strides of vertices, bytes.
const STRIDE_ALIGNMENT: u32 = 4;

/// What such a device lacks.
pub(in crate::gpu) struct Lacks {
    /// What the program needs.
    pub(in crate::gpu) needed: Option<String>,
    /// Names of other features.
    pub(in crate::gpu) unused: Vec<&'static str>,
}

/// What a device with these extensions lacks of Vulkan; `None` if it has all of it.
pub(in crate::gpu) fn missing(
    instance: &ash::Instance,
    handle: vk::PhysicalDevice,
    extensions: &[String],
) -> Option<Lacks> {
    let is_subset = extensions.iter().any(|e| Ok(e.as_str()) == SUBSET.to_str());
    if !is_subset {
        return None;
    }
    let mut subset = vk::PhysicalDevicePortabilitySubsetFeaturesKHR::default();
    let mut features = vk::PhysicalDeviceFeatures2::default().push_next(&mut subset);
    let mut limits = vk::PhysicalDevicePortabilitySubsetPropertiesKHR::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut limits);
    // SAFETY: `handle` comes from this instance and has the extension; the chains live on this stack.
    unsafe {
        instance.get_physical_device_features2(handle, &mut features);
        instance.get_physical_device_properties2(handle, &mut properties);
    }
    let stride = limits.min_vertex_input_binding_stride_alignment;
    let is_wide = stride > STRIDE_ALIGNMENT;
    Some(Lacks {
        needed: is_wide.then(|| {
            format!("vertices of {STRIDE_ALIGNMENT} bytes (it has multiples of {stride})")
        }),
        unused: unused(&subset),
    })
}

/// The features of the extension that are off. The program uses none of them.
fn unused(has: &vk::PhysicalDevicePortabilitySubsetFeaturesKHR<'_>) -> Vec<&'static str> {
    [
        (
            "constantAlphaColorBlendFactors",
            has.constant_alpha_color_blend_factors,
        ),
        ("events", has.events),
        (
            "imageViewFormatReinterpretation",
            has.image_view_format_reinterpretation,
        ),
        ("imageViewFormatSwizzle", has.image_view_format_swizzle),
        ("imageView2DOn3DImage", has.image_view2_d_on3_d_image),
        ("multisampleArrayImage", has.multisample_array_image),
        ("mutableComparisonSamplers", has.mutable_comparison_samplers),
        ("pointPolygons", has.point_polygons),
        ("samplerMipLodBias", has.sampler_mip_lod_bias),
        ("separateStencilMaskRef", has.separate_stencil_mask_ref),
        (
            "shaderSampleRateInterpolationFunctions",
            has.shader_sample_rate_interpolation_functions,
        ),
        ("tessellationIsolines", has.tessellation_isolines),
        ("tessellationPointMode", has.tessellation_point_mode),
        ("triangleFans", has.triangle_fans),
        (
            "vertexAttributeAccessBeyondStride",
            has.vertex_attribute_access_beyond_stride,
        ),
    ]
    .into_iter()
    .filter(|(_, present)| *present == vk::FALSE)
    .map(|(name, _)| name)
    .collect()
}
