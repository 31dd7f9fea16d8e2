//! The surface of a window, to which a swapchain presents.

use std::ffi::{CStr, c_char};
use std::sync::Arc;

use ash::{ext, khr, vk};
use raw_window_handle::{HasDisplayHandle, HasWindowHandle};

use crate::gpu::device::context::Context;
use crate::gpu::device::fault::Call;
use crate::gpu::device::instance::{InstanceGuard, has_instance_extension};
use crate::gpu::error::{During, GpuError, Result};

/// A window from any windowing library.
pub trait WindowHandles: HasDisplayHandle + HasWindowHandle {}

impl<W: HasDisplayHandle + HasWindowHandle> WindowHandles for W {}

/// The window of a surface.
pub(in crate::gpu) type Window = Arc<dyn WindowHandles>;

fn refused(error: &raw_window_handle::HandleError) -> GpuError {
    GpuError::Window(error.to_string())
}

/// Instance extensions to present to this window: those that the window system needs, and the one of colour spaces if there is one.
///
/// # Errors
/// When a required one is missing.
pub(in crate::gpu) fn instance_extensions(
    entry: &ash::Entry,
    window: &Window,
) -> Result<Vec<*const c_char>> {
    let display = window.display_handle().map_err(|e| refused(&e))?;
    let needed = ash_window::enumerate_required_extensions(display.as_raw())
        .during("list the extensions of the window system")?;
    // SAFETY: `ash_window` lists names of extensions, which are static and terminated.
    let names = needed.iter().map(|name| unsafe { CStr::from_ptr(*name) });
    let mut missing = Vec::new();
    for name in names {
        if !has_instance_extension(entry, None, name)? {
            missing.push(name.to_string_lossy().into_owned());
        }
    }
    if !missing.is_empty() {
        // Without any driver that is what to tell of.
        InstanceGuard::new(entry, false, &[])?;
        return Err(GpuError::CannotPresent(missing));
    }
    let mut extensions = needed.to_vec();
    let spaces = ext::swapchain_colorspace::NAME;
    if has_instance_extension(entry, None, spaces)? {
        extensions.push(spaces.as_ptr());
    }
    Ok(extensions)
}

/// A surface, which keeps its window alive. It must be dropped before the instance.
pub(in crate::gpu) struct RawSurface {
    loader: khr::surface::Instance,
    handle: vk::SurfaceKHR,
    window: Window,
}

impl RawSurface {
    pub(in crate::gpu) fn new(
        entry: &ash::Entry,
        instance: &ash::Instance,
        window: Window,
    ) -> Result<Self> {
        let display_handle = window.display_handle().map_err(|e| refused(&e))?;
        let window_handle = window.window_handle().map_err(|e| refused(&e))?;
        // SAFETY: the instance has the extensions of this window system, and the window lives as long as the surface.
        let handle = unsafe {
            ash_window::create_surface(
                entry,
                instance,
                display_handle.as_raw(),
                window_handle.as_raw(),
                None,
            )
        }
        .during("create the window's surface")?;
        Ok(Self {
            loader: khr::surface::Instance::new(entry, instance),
            handle,
            window: window.clone(),
        })
    }

    /// Whether a queue family can present to this surface.
    pub(in crate::gpu) fn is_supported(
        &self,
        device: vk::PhysicalDevice,
        family: u32,
    ) -> Result<bool> {
        // SAFETY: device and surface belong to one instance.
        unsafe {
            self.loader
                .get_physical_device_surface_support(device, family, self.handle)
        }
        .during("ask whether the device presents to the window")
    }
}

impl Drop for RawSurface {
    fn drop(&mut self) {
        // SAFETY: the swapchain, declared before it in the same struct, is destroyed already; null is ignored.
        unsafe { self.loader.destroy_surface(self.handle, None) };
    }
}

/// The surface of a window.
pub struct Surface {
    surface: RawSurface,
    context: Arc<Context>,
}

impl Surface {
    pub(in crate::gpu) fn new(context: Arc<Context>, surface: RawSurface) -> Self {
        Self { surface, context }
    }

    pub(in crate::gpu) fn context(&self) -> &Arc<Context> {
        &self.context
    }

    pub(in crate::gpu) fn handle(&self) -> vk::SurfaceKHR {
        self.surface.handle
    }

    /// Leaves the surface to the end of the process, with the swapchain of a device that hangs.
    pub(in crate::gpu) fn leave(&mut self) {
        self.surface.handle = vk::SurfaceKHR::null();
    }

    /// Recreates a lost surface. Its swapchain must have been destroyed.
    pub(in crate::gpu) fn recreate(&mut self) -> Result<()> {
        let window = self.surface.window.clone();
        self.surface = RawSurface::new(self.context.entry(), self.context.instance(), window)?;
        Ok(())
    }

    pub(in crate::gpu) fn capabilities(
        &self,
    ) -> std::result::Result<vk::SurfaceCapabilitiesKHR, vk::Result> {
        self.context.faults.at(Call::Surface)?;
        // SAFETY: device and surface belong to one instance.
        unsafe {
            self.surface
                .loader
                .get_physical_device_surface_capabilities(self.context.physical, self.handle())
        }
    }

    /// The pairs of format and colour space that the surface offers.
    pub(in crate::gpu) fn formats(&self) -> Result<Vec<vk::SurfaceFormatKHR>> {
        // SAFETY: device and surface belong to one instance.
        unsafe {
            self.surface
                .loader
                .get_physical_device_surface_formats(self.context.physical, self.handle())
        }
        .during("list the formats of the window")
    }
}
