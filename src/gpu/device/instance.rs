//! The Vulkan loader and the instance.

use std::ffi::{CStr, c_char};

use ash::{ext, vk};

use crate::gpu::device::portability;
use crate::gpu::device::validation::{LAYER, SyncRequest, sync_setting};
use crate::gpu::error::{During, GpuError, Result};

/// An instance destroyed on drop.
pub(in crate::gpu) struct InstanceGuard {
    pub(in crate::gpu) raw: ash::Instance,
}

impl InstanceGuard {
    /// Creates an instance. `windows` lists the extensions required by the window system.
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
        // Without it the loader hides drivers such as MoltenVK.
        let mut flags = vk::InstanceCreateFlags::empty();
        if has_instance_extension(entry, None, portability::ENUMERATION)? {
            extensions.push(portability::ENUMERATION.as_ptr());
            flags |= vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR;
        }
        let mut layers = Vec::new();
        let settings = [sync_setting(&vk::TRUE)];
        let mut settings = vk::LayerSettingsCreateInfoEXT::default().settings(&settings);
        let sync = [vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION];
        let mut features = vk::ValidationFeaturesEXT::default().enabled_validation_features(&sync);
        let mut info = vk::InstanceCreateInfo::default()
            .application_info(&app)
            .flags(flags);
        if validate {
            let request = SyncRequest::of_layer(entry)?;
            layers.push(LAYER.as_ptr());
            extensions.push(ext::debug_utils::NAME.as_ptr());
            extensions.extend(request.map(|request| request.extension().as_ptr()));
            info = match request {
                Some(SyncRequest::LayerSettings) => info.push_next(&mut settings),
                Some(SyncRequest::ValidationFeatures) => info.push_next(&mut features),
                None => info,
            };
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
        // SAFETY: its children are destroyed before it (order of the fields of Context).
        unsafe { self.raw.destroy_instance(None) };
    }
}

pub(in crate::gpu) fn load() -> Result<ash::Entry> {
    // SAFETY: this runs the initialisers of the system's Vulkan loader, which are trusted.
    unsafe { ash::Entry::load() }.map_err(|e| GpuError::NoLoader(e.to_string()))
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
