//! The Vulkan loader and the instance.

use std::ffi::{CStr, c_char};

use ash::{ext, vk};

use crate::gpu::device::validation::LAYER;
use crate::gpu::error::{During, GpuError, Result};

/// An instance destroyed on drop.
pub(in crate::gpu) struct InstanceGuard {
    pub(in crate::gpu) raw: ash::Instance,
}

impl InstanceGuard {
    /// `windows` are the extensions that a window system asks for.
    pub(in crate::gpu) fn new(
        entry: &ash::Entry,
        validate: bool,
        windows: &[*const c_char],
    ) -> Result<Self> {
        let app = vk::ApplicationInfo::default()
            .application_name(c"skylight")
            .engine_name(c"skylight")
            .api_version(vk::API_VERSION_1_3);
        let mut extensions = windows.to_vec();
        if has_instance_extension(entry, None, ext::debug_utils::NAME)? {
            extensions.push(ext::debug_utils::NAME.as_ptr());
        }
        let mut layers = Vec::new();
        let sync = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&sync);
        let mut info = vk::InstanceCreateInfo::default().application_info(&app);
        if validate {
            if !has_layer(entry)? {
                return Err(GpuError::NoValidationLayer);
            }
            layers.push(LAYER.as_ptr());
            if has_instance_extension(entry, Some(LAYER), ext::validation_features::NAME)? {
                extensions.push(ext::validation_features::NAME.as_ptr());
                info = info.push_next(&mut features);
            }
        }
        let info = info
            .enabled_extension_names(&extensions)
            .enabled_layer_names(&layers);
        // SAFETY: all pointers of `info` live on this stack.
        let raw = unsafe { entry.create_instance(&info, None) }.map_err(|result| match result {
            vk::Result::ERROR_INCOMPATIBLE_DRIVER => GpuError::NoDevice,
            result => GpuError::Vulkan {
                what: "create the Vulkan instance",
                result,
            },
        })?;
        Ok(Self { raw })
    }
}

impl Drop for InstanceGuard {
    fn drop(&mut self) {
        // SAFETY: children were destroyed before (field order of Context).
        unsafe { self.raw.destroy_instance(None) };
    }
}

pub(in crate::gpu) fn load() -> Result<ash::Entry> {
    // SAFETY: the system's Vulkan loader runs its initialisers; nothing can be assumed but that it is one.
    unsafe { ash::Entry::load() }.map_err(|e| GpuError::NoLoader(e.to_string()))
}

fn has_layer(entry: &ash::Entry) -> Result<bool> {
    // SAFETY: no arguments to be wrong.
    let layers =
        unsafe { entry.enumerate_instance_layer_properties() }.during("list Vulkan layers")?;
    Ok(layers
        .iter()
        .any(|l| l.layer_name_as_c_str().is_ok_and(|n| n == LAYER)))
}

pub(in crate::gpu) fn has_instance_extension(
    entry: &ash::Entry,
    layer: Option<&CStr>,
    name: &CStr,
) -> Result<bool> {
    // SAFETY: `layer` is a terminated string.
    let list = unsafe { entry.enumerate_instance_extension_properties(layer) }
        .during("list Vulkan extensions")?;
    Ok(list
        .iter()
        .any(|e| e.extension_name_as_c_str().is_ok_and(|n| n == name)))
}
