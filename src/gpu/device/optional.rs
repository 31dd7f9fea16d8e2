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
    /// Storage images of the formats of pictures. Fallback: fragment shaders run full-screen passes.
    StoredPictures,
    /// Timestamps of the queue. Fallback: each pass is submitted alone and timed by the clock of the wall.
    Timestamps,
    /// Extension VK_EXT_hdr_metadata: a window tells an HDR screen how bright it gets. Fallback: the screen assumes it.
    HdrMetadata,
}

impl Optional {
    /// All optional features.
    pub const ALL: [Self; 8] = [
        Self::PushDescriptor,
        Self::GeometryShader,
        Self::PipelineStatistics,
        Self::FloatFilter,
        Self::FloatBlend,
        Self::StoredPictures,
        Self::Timestamps,
        Self::HdrMetadata,
    ];

    /// Name in the Vulkan specification, with the format it is asked of.
    pub fn name(self) -> &'static str {
        match self {
            Self::PushDescriptor => "VK_KHR_push_descriptor",
            Self::GeometryShader => "geometryShader",
            Self::PipelineStatistics => "pipelineStatisticsQuery",
            Self::FloatFilter => "linear filter of R32G32B32A32_SFLOAT",
            Self::FloatBlend => "blending of R32G32B32A32_SFLOAT",
            Self::StoredPictures => "storing of R16G16B16A16_SFLOAT, R8G8B8A8_UNORM and R32_UINT",
            Self::Timestamps => "timestamps",
            Self::HdrMetadata => "VK_EXT_hdr_metadata",
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
            Self::StoredPictures => {
                Some("no storing of the pictures' formats; fragment shaders run full-screen passes")
            }
            Self::PushDescriptor
            | Self::PipelineStatistics
            | Self::Timestamps
            | Self::HdrMetadata => None,
        }
    }
}

/// The format of sky, irradiance and air, whose filter and blending are optional in Vulkan.
pub(in crate::gpu) const FLOATS: vk::Format = vk::Format::R32G32B32A32_SFLOAT;

/// The formats of pictures that compute shaders write, besides those that every device must store ([`super::needs`]). The specification
/// demands these too.
const STORED: [vk::Format; 3] = [
    vk::Format::R16G16B16A16_SFLOAT,
    vk::Format::R8G8B8A8_UNORM,
    vk::Format::R32_UINT,
];

/// What tells which optional features a device has.
pub(in crate::gpu) struct Offered<'a> {
    pub(in crate::gpu) instance: &'a ash::Instance,
    pub(in crate::gpu) handle: vk::PhysicalDevice,
    pub(in crate::gpu) extensions: &'a [String],
    /// Of the queue, see [`super::needs::Queue`].
    pub(in crate::gpu) timestamp_bits: u32,
    pub(in crate::gpu) driver: vk::DriverId,
}

/// Whether a driver's linear filter is good enough for means. SwiftShader's loses 1 to 3 % of a cube of the sky between its coarse levels, the
/// more the coarser they are; shaders that filter for it lose nothing.
fn filters_well(driver: vk::DriverId) -> bool {
    driver != vk::DriverId::GOOGLE_SWIFTSHADER
}

impl Offered<'_> {
    /// What images of a format can be used for.
    fn uses(&self, format: vk::Format) -> vk::FormatFeatureFlags {
        // SAFETY: the handle comes from this instance.
        let properties = unsafe {
            self.instance
                .get_physical_device_format_properties(self.handle, format)
        };
        properties.optimal_tiling_features
    }

    /// All optional features, and whether each is used; those in `without` count as absent.
    pub(in crate::gpu) fn list(&self, without: &[Optional]) -> Vec<(Optional, bool)> {
        // SAFETY: the handle comes from this instance.
        let core = unsafe { self.instance.get_physical_device_features(self.handle) };
        let floats = self.uses(FLOATS);
        let storage = vk::FormatFeatureFlags::STORAGE_IMAGE;
        let filter = vk::FormatFeatureFlags::SAMPLED_IMAGE_FILTER_LINEAR;
        let blend = vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND;
        let present = |optional: Optional| match optional {
            Optional::PushDescriptor | Optional::HdrMetadata => {
                self.extensions.iter().any(|e| e == optional.name())
            }
            Optional::GeometryShader => core.geometry_shader == vk::TRUE,
            Optional::PipelineStatistics => core.pipeline_statistics_query == vk::TRUE,
            Optional::FloatFilter => floats.contains(filter) && filters_well(self.driver),
            Optional::FloatBlend => floats.contains(blend),
            Optional::StoredPictures => STORED.iter().all(|f| self.uses(*f).contains(storage)),
            Optional::Timestamps => self.timestamp_bits > 0,
        };
        Optional::ALL
            .map(|o| (o, present(o) && !without.contains(&o)))
            .to_vec()
    }
}
