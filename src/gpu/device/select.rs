//! Device enumeration and selection.

use std::ffi::{CStr, c_char};

use ash::vk;

use crate::gpu::device::surface::RawSurface;
use crate::gpu::error::{During, GpuError, Result, list_with_verb};

/// Description of a device, including whether the renderer can use it.
#[derive(Debug, Clone)]
pub struct DeviceSummary {
    /// Index in the driver's order, for `--device`.
    pub index: usize,
    /// Device name.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// Vulkan version, for instance `1.3.230`.
    pub api: String,
    /// Name and version of the driver.
    pub driver: String,
    /// Missing required features, extensions and formats; empty for a usable device.
    pub missing: Vec<String>,
    /// Optional features, and whether each is used.
    pub optional: Vec<(Optional, bool)>,
    /// Maximum size of a 2D image, pixels.
    pub max_image_edge: u32,
}

/// Features that are used if available but not required.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Optional {
    /// Extension VK_KHR_push_descriptor. Fallback: descriptor pools.
    PushDescriptor,
    /// Feature geometryShader. Fallback: compute shaders write the sky and irradiance cubes.
    GeometryShader,
    /// Feature pipelineStatisticsQuery. Without it the benchmark omits those columns.
    PipelineStatistics,
}

impl Optional {
    /// All optional features.
    pub const ALL: [Self; 3] = [
        Self::PushDescriptor,
        Self::GeometryShader,
        Self::PipelineStatistics,
    ];

    /// Name in the Vulkan specification.
    pub fn name(self) -> &'static str {
        match self {
            Self::PushDescriptor => "VK_KHR_push_descriptor",
            Self::GeometryShader => "geometryShader",
            Self::PipelineStatistics => "pipelineStatisticsQuery",
        }
    }
}

impl DeviceSummary {
    /// Whether this optional feature is used.
    pub fn has(&self, optional: Optional) -> bool {
        self.optional.contains(&(optional, true))
    }

    /// Whether the device is a software rasterizer on the CPU.
    pub fn is_software(&self) -> bool {
        self.kind == SOFTWARE
    }
}

/// [`DeviceSummary::kind`] of devices that run on the CPU.
const SOFTWARE: &str = "software";

/// A device under consideration.
pub(in crate::gpu) struct Candidate {
    pub(in crate::gpu) handle: vk::PhysicalDevice,
    pub(in crate::gpu) summary: DeviceSummary,
    pub(in crate::gpu) queue_family: u32,
    /// What it lacks to present to the window, if there is one.
    lacks_for_window: Vec<String>,
    /// Whether compute shaders can write images of any format.
    pub(in crate::gpu) stores_without_format: bool,
    rank: u32,
}

/// The optional extension that replaces descriptor pools.
pub(in crate::gpu) const PUSH_DESCRIPTORS: &CStr = ash::khr::push_descriptor::NAME;

fn text(chars: &[c_char]) -> String {
    let bytes: Vec<u8> = chars
        .iter()
        .take_while(|c| **c != 0)
        .map(|c| c.cast_unsigned())
        .collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

fn kind_and_rank(kind: vk::PhysicalDeviceType) -> (&'static str, u32) {
    match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => ("discrete", 0),
        vk::PhysicalDeviceType::INTEGRATED_GPU => ("integrated", 1),
        vk::PhysicalDeviceType::VIRTUAL_GPU => ("virtual", 2),
        vk::PhysicalDeviceType::CPU => (SOFTWARE, 3),
        _ => ("other", 4),
    }
}

/// The candidates in driver order. With a window, presentation support is required. Features in `without` count as absent.
pub(in crate::gpu) fn candidates(
    instance: &ash::Instance,
    surface: Option<&RawSurface>,
    without: &[Optional],
) -> Result<Vec<Candidate>> {
    // SAFETY: the instance is alive for the whole call.
    let handles =
        unsafe { instance.enumerate_physical_devices() }.during("enumerate Vulkan devices")?;
    handles
        .into_iter()
        .enumerate()
        .map(|(i, handle)| candidate(instance, i, handle, surface, without))
        .collect()
}

fn candidate(
    instance: &ash::Instance,
    index: usize,
    handle: vk::PhysicalDevice,
    surface: Option<&RawSurface>,
    without: &[Optional],
) -> Result<Candidate> {
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
    // SAFETY: `handle` comes from this instance; the chain lives on this stack.
    unsafe { instance.get_physical_device_properties2(handle, &mut properties) };
    let properties = properties.properties;
    let (kind, rank) = kind_and_rank(properties.device_type);
    let version = properties.api_version;
    let extensions = extensions(instance, handle)?;
    let queue_family = graphics_queue(instance, handle, surface)?;
    let mut missing = Vec::new();
    if version < vk::API_VERSION_1_3 {
        missing.push("Vulkan 1.3".to_owned());
    } else {
        missing.extend(missing_features(instance, handle));
    }
    let buffers = properties.limits.max_per_stage_descriptor_storage_buffers;
    if buffers < STORAGE_BUFFERS {
        missing.push(format!(
            "{STORAGE_BUFFERS} storage buffers in a shader (it has {buffers})"
        ));
    }
    let mut lacks_for_window = Vec::new();
    match (queue_family, surface) {
        (None, Some(_)) => {
            lacks_for_window.push("a graphics queue that presents to this window".to_owned());
        }
        (None, None) => missing.push("a graphics queue".to_owned()),
        _ => {}
    }
    if surface.is_some() && !extensions.iter().any(|e| e == "VK_KHR_swapchain") {
        lacks_for_window.push("VK_KHR_swapchain".to_owned());
    }
    missing.extend(lacks_for_window.iter().cloned());
    let summary = DeviceSummary {
        index,
        name: text(&properties.device_name),
        kind,
        api: format!(
            "{}.{}.{}",
            vk::api_version_major(version),
            vk::api_version_minor(version),
            vk::api_version_patch(version)
        ),
        driver: format!(
            "{} {}",
            text(&driver.driver_name),
            text(&driver.driver_info)
        ),
        missing,
        optional: optional(instance, handle, &extensions, without),
        max_image_edge: properties.limits.max_image_dimension2_d,
    };
    // SAFETY: `handle` comes from this instance.
    let core = unsafe { instance.get_physical_device_features(handle) };
    Ok(Candidate {
        handle,
        summary,
        stores_without_format: core.shader_storage_image_write_without_format == vk::TRUE,
        queue_family: queue_family.unwrap_or(0),
        lacks_for_window,
        rank,
    })
}

fn optional(
    instance: &ash::Instance,
    handle: vk::PhysicalDevice,
    extensions: &[String],
    without: &[Optional],
) -> Vec<(Optional, bool)> {
    // SAFETY: `handle` comes from this instance.
    let core = unsafe { instance.get_physical_device_features(handle) };
    let present = |optional: &Optional| match optional {
        Optional::PushDescriptor => extensions.iter().any(|e| e == optional.name()),
        Optional::GeometryShader => core.geometry_shader == vk::TRUE,
        Optional::PipelineStatistics => core.pipeline_statistics_query == vk::TRUE,
    };
    Optional::ALL
        .iter()
        .map(|o| (*o, present(o) && !without.contains(o)))
        .collect()
}

fn extensions(instance: &ash::Instance, handle: vk::PhysicalDevice) -> Result<Vec<String>> {
    // SAFETY: `handle` comes from this instance.
    let list = unsafe { instance.enumerate_device_extension_properties(handle) }
        .during("list device extensions")?;
    Ok(list.iter().map(|e| text(&e.extension_name)).collect())
}

fn graphics_queue(
    instance: &ash::Instance,
    handle: vk::PhysicalDevice,
    surface: Option<&RawSurface>,
) -> Result<Option<u32>> {
    // SAFETY: `handle` comes from this instance.
    let families = unsafe { instance.get_physical_device_queue_family_properties(handle) };
    for (family, properties) in (0u32..).zip(&families) {
        let draws = properties.queue_flags.contains(vk::QueueFlags::GRAPHICS);
        if draws && surface.map_or(Ok(true), |s| s.is_supported(handle, family))? {
            return Ok(Some(family));
        }
    }
    Ok(None)
}

/// Largest number of storage buffers that a shader of this program uses; Vulkan guarantees four.
const STORAGE_BUFFERS: u32 = 7;

fn missing_features(instance: &ash::Instance, handle: vk::PhysicalDevice) -> Vec<String> {
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default();
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
    let mut features = vk::PhysicalDeviceFeatures2::default()
        .push_next(&mut v12)
        .push_next(&mut v13);
    // SAFETY: `handle` comes from this instance; the chain lives on this stack.
    unsafe { instance.get_physical_device_features2(handle, &mut features) };
    let core = features.features;
    // Cube maps are written by geometry shaders, or by compute shaders as a fallback.
    let cubes = core.geometry_shader | core.shader_storage_image_write_without_format;
    [
        (
            "geometryShader or shaderStorageImageWriteWithoutFormat",
            cubes,
        ),
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

/// The device the user asked for (index or part of the name), otherwise the best usable one: discrete, then integrated, then
/// software.
pub(in crate::gpu) fn choose(
    candidates: Vec<Candidate>,
    wanted: Option<&str>,
) -> Result<Candidate> {
    let Some(first) = candidates.first() else {
        return Err(GpuError::NoDevice);
    };
    if candidates.iter().all(|c| !c.lacks_for_window.is_empty()) {
        return Err(GpuError::CannotPresent(first.lacks_for_window.clone()));
    }
    let summaries: Vec<&DeviceSummary> = candidates.iter().map(|c| &c.summary).collect();
    let index = match wanted {
        Some(text) => named(&summaries, text)?,
        None => best(&candidates)?,
    };
    let chosen = candidates
        .into_iter()
        .nth(index)
        .ok_or(GpuError::NoDevice)?;
    usable(&chosen.summary)?;
    Ok(chosen)
}

fn usable(summary: &DeviceSummary) -> Result<()> {
    if summary.missing.is_empty() {
        return Ok(());
    }
    Err(GpuError::Unsupported {
        missing: list_with_verb(&summary.missing),
        device: summary.name.clone(),
    })
}

fn best(candidates: &[Candidate]) -> Result<usize> {
    let able = candidates
        .iter()
        .enumerate()
        .filter(|(_, c)| c.summary.missing.is_empty());
    match able.min_by_key(|(_, c)| c.rank) {
        Some((index, _)) => Ok(index),
        // None is usable: the error lists what the first one lacks.
        None => usable(&candidates[0].summary).map(|()| 0),
    }
}

fn named(summaries: &[&DeviceSummary], wanted: &str) -> Result<usize> {
    let lower = wanted.to_lowercase();
    let by_index = wanted
        .parse::<usize>()
        .ok()
        .filter(|i| *i < summaries.len());
    let by_name = || {
        summaries
            .iter()
            .position(|s| s.name.to_lowercase().contains(&lower))
    };
    by_index
        .or_else(by_name)
        .ok_or_else(|| GpuError::NoSuchDevice {
            wanted: wanted.to_owned(),
            present: summaries
                .iter()
                .map(|s| format!("{} \"{}\"", s.index, s.name))
                .collect::<Vec<_>>()
                .join(", "),
        })
}

/// All devices of this machine, including unusable ones. Features in `without` count as absent.
///
/// # Errors
/// When there is no Vulkan loader or the driver fails.
pub fn devices(without: &[Optional]) -> Result<Vec<DeviceSummary>> {
    let entry = crate::gpu::device::instance::load()?;
    let instance = crate::gpu::device::instance::InstanceGuard::new(&entry, false, &[])?;
    Ok(candidates(&instance.raw, None, without)?
        .into_iter()
        .map(|c| c.summary)
        .collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::pipeline::shader::{BindingKind, Shader, compiled};

    fn fake(index: usize, name: &str, rank: u32, missing: &[&str]) -> Candidate {
        Candidate {
            handle: vk::PhysicalDevice::null(),
            queue_family: 0,
            stores_without_format: true,
            lacks_for_window: Vec::new(),
            rank,
            summary: DeviceSummary {
                index,
                name: name.into(),
                kind: "other",
                api: "1.3.0".into(),
                driver: String::new(),
                missing: missing.iter().map(|m| (*m).to_owned()).collect(),
                optional: Vec::new(),
                max_image_edge: 16384,
            },
        }
    }

    fn three() -> Vec<Candidate> {
        vec![
            fake(0, "llvmpipe", 3, &[]),
            fake(1, "Integrated One", 1, &[]),
            fake(2, "Discrete Two", 0, &["geometryShader"]),
        ]
    }

    #[test]
    fn the_best_able_device_wins() {
        assert_eq!(choose(three(), None).expect("one").summary.index, 1);
    }

    #[test]
    fn by_name_and_by_index() {
        assert_eq!(choose(three(), Some("LLVM")).expect("one").summary.index, 0);
        assert_eq!(choose(three(), Some("1")).expect("one").summary.index, 1);
    }

    #[test]
    fn missing_features_and_names_are_named() {
        let lacking = choose(three(), Some("two")).map(|_| ()).expect_err("lacks");
        assert_eq!(
            lacking.to_string(),
            "geometryShader is not supported by \"Discrete Two\"; choose another with --device"
        );
        let unknown = choose(three(), Some("9")).map(|_| ()).expect_err("unknown");
        assert!(
            unknown
                .to_string()
                .contains("\"9\"; there are: 0 \"llvmpipe\""),
            "{unknown}"
        );
        assert!(matches!(choose(Vec::new(), None), Err(GpuError::NoDevice)));
    }

    #[test]
    fn where_none_presents_the_line_points_to_render() {
        let headless = |index, name| Candidate {
            lacks_for_window: vec!["VK_KHR_swapchain".to_owned()],
            ..fake(index, name, 0, &["VK_KHR_swapchain"])
        };
        let none = choose(vec![headless(0, "A"), headless(1, "B")], Some("B"));
        assert_eq!(
            none.map(|_| ()).expect_err("lacks").to_string(),
            "no driver here can present to this window (VK_KHR_swapchain is missing); \
             skylight render writes pictures without one"
        );
        let one = choose(vec![headless(0, "A"), fake(1, "B", 3, &[])], None);
        assert_eq!(one.expect("B").summary.name, "B");
    }

    #[test]
    fn when_none_will_do_the_first_says_why() {
        let lacking = choose(vec![fake(0, "Old", 0, &["Vulkan 1.3"])], None).map(|_| ());
        assert!(
            lacking
                .expect_err("lacks")
                .to_string()
                .contains("Vulkan 1.3")
        );
    }

    #[test]
    fn the_limit_of_storage_buffers_is_what_the_shaders_use() {
        let buffers = |shader: &&Shader| {
            let bindings = shader.bindings.iter();
            bindings
                .filter(|b| b.kind == BindingKind::StorageBuffer)
                .count()
        };
        let most = compiled::ALL.iter().map(buffers).max();
        assert_eq!(most, Some(STORAGE_BUFFERS as usize));
    }
}
