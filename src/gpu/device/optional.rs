//! Features that are used if a device has them.

use ash::vk;

/// Features that are used if available but not required.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Optional {
    /// Extension VK_KHR_push_descriptor. Fallback: descriptor pools.
    PushDescriptor,
    /// Feature geometryShader. Fallback: compute shaders write the sky and irradiance cubes.
    GeometryShader,
    /// Feature pipelineStatisticsQuery. Without it the benchmark omits those columns.
    PipelineStatistics,
    /// Linear filter of 32-bit floats. Fallback: shaders take nearest texels and filter them.
    FloatFilter,
    /// Blending into 32-bit floats. Without it pictures of 32-bit floats have no stars.
    FloatBlend,
    /// Timestamps of the queue. Fallback: each pass is submitted alone and timed by the clock of the wall.
    Timestamps,
}

impl Optional {
    /// All optional features.
    pub const ALL: [Self; 6] = [
        Self::PushDescriptor,
        Self::GeometryShader,
        Self::PipelineStatistics,
        Self::FloatFilter,
        Self::FloatBlend,
        Self::Timestamps,
    ];

    /// Name in the Vulkan specification, with the format it is asked of.
    pub fn name(self) -> &'static str {
        match self {
            Self::PushDescriptor => "VK_KHR_push_descriptor",
            Self::GeometryShader => "geometryShader",
            Self::PipelineStatistics => "pipelineStatisticsQuery",
            Self::FloatFilter => "linear filter of R32G32B32A32_SFLOAT",
            Self::FloatBlend => "blending of R32G32B32A32_SFLOAT",
            Self::Timestamps => "timestamps",
        }
    }

    /// What is done without it, if a user should know.
    pub fn fallback(self) -> Option<&'static str> {
        match self {
            Self::GeometryShader => {
                Some("no geometry shaders; compute shaders draw the cubes of sky and irradiance")
            }
            Self::FloatFilter => Some("no linear filter of 32-bit floats; shaders filter the sky"),
            Self::FloatBlend => {
                Some("no blending of 32-bit floats; dark skies and .exr files have no stars")
            }
            Self::PushDescriptor | Self::PipelineStatistics | Self::Timestamps => None,
        }
    }
}

/// The format of sky, irradiance and air, whose filter and blending are optional in Vulkan.
pub(in crate::gpu) const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// What tells which optional features a device has.
pub(in crate::gpu) struct Offered<'a> {
    pub(in crate::gpu) instance: &'a ash::Instance,
    pub(in crate::gpu) handle: vk::PhysicalDevice,
    pub(in crate::gpu) extensions: &'a [String],
    /// Of the queue, see [`super::needs::Queue`].
    pub(in crate::gpu) timestamp_bits: u32,
}

impl Offered<'_> {
    /// All optional features, and whether each is used; those in `without` count as absent.
    pub(in crate::gpu) fn list(&self, without: &[Optional]) -> Vec<(Optional, bool)> {
        // SAFETY: the handle comes from this instance.
        let (core, floats) = unsafe {
            (
                self.instance.get_physical_device_features(self.handle),
                self.instance
                    .get_physical_device_format_properties(self.handle, FLOATS),
            )
        };
        let floats = floats.optimal_tiling_features;
        let filter = vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
        let blend = vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
        let present = |optional: Optional| match optional {
            Optional::PushDescriptor => self.extensions.iter().any(|e| e == optional.name()),
            Optional::GeometryShader => core.geometry_shader == vk::TRUE,
            Optional::PipelineStatistics => core.pipeline_statistics_query == vk::TRUE,
            Optional::FloatFilter => floats.contains(filter),
            Optional::FloatBlend => floats.contains(blend),
            Optional::Timestamps => self.timestamp_bits > 0,
        };
        Optional::ALL
            .map(|o| (o, present(o) && !without.contains(&o)))
            .to_vec()
    }
}
