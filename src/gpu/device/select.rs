//! Device enumeration and selection.

use std::ffi::{CStr, c_char};

use ash::vk;

use crate::gpu::device::memory_heaps::{Heap, heaps};
use crate::gpu::device::optional::{Offered, Optional};
use crate::gpu::device::surface::RawSurface;
use crate::gpu::device::{needs, portability};
use crate::gpu::error::{During, GpuError, Result, list_with_verb};
use crate::gpu::record::timings::Timing;

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
    /// Maximum edge of an image that is drawn, pixels: the least of the limits on images, framebuffers and viewports.
    pub max_image_edge: u32,
    /// Bits of the grid in a pixel to which corners of triangles are moved.
    pub sub_pixel_bits: u32,
    /// Bits of the timestamps that count; 0: there are none.
    pub timestamp_bits: u32,
    /// Its memory.
    pub memory: Vec<Heap>,
    /// For a driver on top of another interface (MoltenVK): features of Vulkan that it lacks. None of them is used.
    pub portability: Option<Vec<&'static str>>,
}

impl DeviceSummary {
    /// Whether this optional feature is used.
    pub fn has(&self, optional: Optional) -> bool {
        self.optional.contains(&(optional, true))
    }

    /// Step of the grid to which corners of triangles are moved, pixels.
    pub fn corner_step(&self) -> f32 {
        (-(self.sub_pixel_bits as f32)).exp2()
    }

    /// Whether the device is a software rasterizer on the CPU.
    pub fn is_software(&self) -> bool {
        self.kind == SOFTWARE
    }

    /// How its passes are timed: software drivers attribute timestamps to the wrong pass, and some queues have none.
    pub fn timing(&self) -> Timing {
        if self.is_software() || !self.has(Optional::Timestamps) {
            Timing::Isolated
        } else {
            Timing::Timestamps
        }
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
    let queue = needs::queue(instance, handle, surface)?;
    let portability = portability::missing(instance, handle, &extensions);
    let mut missing = Vec::new();
    if version < vk::API_VERSION_1_3 {
        missing.push("Vulkan 1.3".to_owned());
    } else {
        missing.extend(needs::missing_features(instance, handle));
    }
    missing.extend(needs::missing_formats(instance, handle));
    missing.extend(portability.iter().flat_map(|p| p.needed.clone()));
    let mut lacks_for_window = Vec::new();
    if let Err(lack) = &queue {
        let list = if lack.is_for_window {
            &mut lacks_for_window
        } else {
            &mut missing
        };
        list.push(lack.what.to_owned());
    }
    if surface.is_some() && !extensions.iter().any(|e| e == "VK_KHR_swapchain") {
        lacks_for_window.push("VK_KHR_swapchain".to_owned());
    }
    let timestamp_bits = queue.as_ref().map_or(0, |queue| queue.timestamp_bits);
    let offered = Offered {
        instance,
        handle,
        extensions: &extensions,
        timestamp_bits,
        driver: driver.driver_id,
    };
    missing.extend(lacks_for_window.iter().cloned());
    let summary = DeviceSummary {
        index,
        name: text(&properties.device_name),
        kind,
        api: version_text(version),
        driver: driver_text(&driver),
        missing,
        optional: offered.list(without),
        max_image_edge: needs::largest_target(&properties.limits),
        sub_pixel_bits: properties.limits.sub_pixel_precision_bits,
        timestamp_bits,
        memory: heaps(instance, handle, &extensions),
        portability: portability.map(|p| p.unused),
    };
    Ok(Candidate {
        handle,
        summary,
        queue_family: queue.map_or(0, |queue| queue.family),
        lacks_for_window,
        rank,
    })
}

fn driver_text(driver: &vk::PhysicalDeviceDriverProperties<'_>) -> String {
    let [name, info] = [text(&driver.driver_name), text(&driver.driver_info)];
    format!("{name} {info}")
}

fn version_text(version: u32) -> String {
    let major = vk::api_version_major(version);
    let (minor, patch) = (
        vk::api_version_minor(version),
        vk::api_version_patch(version),
    );
    format!("{major}.{minor}.{patch}")
}

fn extensions(instance: &ash::Instance, handle: vk::PhysicalDevice) -> Result<Vec<String>> {
    // SAFETY: `handle` comes from this instance.
    let list = unsafe { instance.enumerate_device_extension_properties(handle) }
        .during("list device extensions")?;
    Ok(list.iter().map(|e| text(&e.extension_name)).collect())
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

    fn fake(index: usize, name: &str, rank: u32, missing: &[&str]) -> Candidate {
        Candidate {
            handle: vk::PhysicalDevice::null(),
            queue_family: 0,
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
                sub_pixel_bits: 8,
                timestamp_bits: 64,
                memory: Vec::new(),
                portability: None,
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
}
