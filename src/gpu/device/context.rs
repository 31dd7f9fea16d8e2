//! The context: instance, device, queue, allocator and samplers.

use std::mem::ManuallyDrop;
use std::path::PathBuf;
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use ash::{ext, khr, vk};
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, Allocator, AllocatorCreateDesc};

use crate::gpu::device::fault::{Call, Faults};
use crate::gpu::device::instance::{InstanceGuard, load};
use crate::gpu::device::optional::{FLOATS, Optional};
use crate::gpu::device::portability;
use crate::gpu::device::select::{self, DeviceSummary};
use crate::gpu::device::startup::{Startup, Step};
use crate::gpu::device::surface::{self, RawSurface, Window};
#[cfg(feature = "window")]
use crate::gpu::device::surface::{Surface, WindowHandles};
use crate::gpu::device::validation::{Log, Messenger};
use crate::gpu::error::{During, GpuError, Result};
use crate::gpu::memory::image::{Sampler, create_samplers};
use crate::gpu::pipeline::cache::{CacheState, Key, PipelineCache};
use crate::gpu::pipeline::kept::Kept;
use crate::gpu::pipeline::route::DeviceRoute;
use crate::gpu::record::screen::Route;

/// Options for opening a [`Context`].
#[derive(Debug, Clone, Default)]
pub struct ContextOptions {
    /// Index of the device or part of its name. Default: the best device.
    pub device: Option<String>,
    /// Enables the validation layer, including synchronization validation.
    pub validate: bool,
    /// Optional features to leave unused even if the device supports them.
    pub without: Vec<Optional>,
    /// Folder where the driver's pipeline cache is kept between runs. Without it the cache is not stored.
    pub cache_folder: Option<PathBuf>,
    /// Route of full-screen passes, where the device has both. Default: the faster one, see [`Context::settle_route`].
    pub route: Option<Route>,
    /// For tests: a call that should fail, for instance `submit@3=device-lost`.
    pub fault: Option<String>,
    /// For tests: always upload through staging buffers, even if the CPU can map device memory.
    pub stage_uploads: bool,
}

/// A logical device destroyed on drop.
struct DeviceGuard {
    raw: ash::Device,
}

impl Drop for DeviceGuard {
    fn drop(&mut self) {
        // SAFETY: every resource holds the context, so none is alive, and its drop has waited for the device.
        unsafe { self.raw.destroy_device(None) };
    }
}

/// Function tables of the enabled extensions.
pub(in crate::gpu) struct Extensions {
    pub(in crate::gpu) push_descriptor: Option<khr::push_descriptor::Device>,
    #[cfg(feature = "window")]
    pub(in crate::gpu) swapchain: Option<khr::swapchain::Device>,
    #[cfg(feature = "window")]
    pub(in crate::gpu) hdr_metadata: Option<ext::hdr_metadata::Device>,
    /// Names and labels for the messages of the validation layer.
    pub(in crate::gpu) debug: Option<ext::debug_utils::Device>,
}

impl Extensions {
    fn load(
        instance: &ash::Instance,
        device: &ash::Device,
        summary: &DeviceSummary,
        validates: bool,
        #[cfg(feature = "window")] presents: bool,
    ) -> Self {
        Self {
            push_descriptor: summary
                .has(Optional::PushDescriptor)
                .then(|| khr::push_descriptor::Device::new(instance, device)),
            #[cfg(feature = "window")]
            swapchain: presents.then(|| khr::swapchain::Device::new(instance, device)),
            #[cfg(feature = "window")]
            hdr_metadata: (presents && summary.has(Optional::HdrMetadata))
                .then(|| ext::hdr_metadata::Device::new(instance, device)),
            debug: validates.then(|| ext::debug_utils::Device::new(instance, device)),
        }
    }
}

/// A device with its queue, allocator, samplers and caches. Every resource keeps it alive.
pub struct Context {
    // `Drop` destroys the members without a destructor; the remaining fields are then dropped in this order.
    allocator: ManuallyDrop<Arc<Mutex<Allocator>>>,
    samplers: [vk::Sampler; Sampler::COUNT],
    cache: PipelineCache,
    pub(in crate::gpu) kept: Kept,
    pub(in crate::gpu) route: DeviceRoute,
    pub(in crate::gpu) faults: Faults,
    /// Whether the device has not answered in time: nothing waits for it any more.
    pub(in crate::gpu::device) is_hung: AtomicBool,
    pub(in crate::gpu) stage_uploads: bool,
    pub(in crate::gpu) startup: Startup,
    device: DeviceGuard,
    pub(in crate::gpu) extensions: Extensions,
    /// Used by one thread at a time: see [`Context::queue`].
    queue: Mutex<vk::Queue>,
    pub(in crate::gpu) queue_family: u32,
    pub(in crate::gpu) physical: vk::PhysicalDevice,
    pub(in crate::gpu) limits: vk::PhysicalDeviceLimits,
    summary: DeviceSummary,
    #[cfg(feature = "hot-reload")]
    pub(in crate::gpu) reloaded: crate::gpu::pipeline::hot_reload::Reloaded,
    messenger: Option<Messenger>,
    instance: InstanceGuard,
    #[cfg_attr(
        not(feature = "window"),
        expect(dead_code, reason = "keeps the loader's library loaded")
    )]
    entry: ash::Entry,
}

impl Context {
    /// Opens a device.
    ///
    /// # Errors
    /// When there is no Vulkan loader or no (matching) device, the device lacks a required feature, or the driver fails.
    pub fn new(options: &ContextOptions) -> Result<Arc<Self>> {
        Ok(Self::open(options, None)?.0)
    }

    /// Opens a device that can present to a window.
    ///
    /// # Errors
    /// As [`Context::new`]; also when no device can present to this window.
    #[cfg(feature = "window")]
    pub fn for_window(
        options: &ContextOptions,
        window: Arc<dyn WindowHandles>,
    ) -> Result<(Arc<Self>, Surface)> {
        let (context, surface) = Self::open(options, Some(window))?;
        let surface = surface.ok_or(GpuError::NoDevice)?;
        Ok((context.clone(), Surface::new(context, surface)))
    }

    fn open(
        options: &ContextOptions,
        window: Option<Window>,
    ) -> Result<(Arc<Self>, Option<RawSurface>)> {
        let mut startup = Startup::new();
        let faults = Faults::new(options.fault.as_deref())?;
        let entry = load()?;
        startup.done("Vulkan loader");
        let (instance, messenger, surface) = open_instance(&entry, options.validate, window)?;
        startup.done("instance");
        let chosen = select::choose(
            select::candidates(&instance.raw, surface.as_ref(), &options.without)?,
            options.device.as_deref(),
        )?;
        startup.done("choice of the device");
        let device = create_device(&instance.raw, &chosen, surface.is_some())?;
        // SAFETY: `chosen` comes from this instance; the queue family was found on it.
        let (queue, properties) = unsafe {
            (
                device.raw.get_device_queue(chosen.queue_family, 0),
                instance.raw.get_physical_device_properties(chosen.handle),
            )
        };
        startup.done("device");
        let extensions = Extensions::load(
            &instance.raw,
            &device.raw,
            &chosen.summary,
            options.validate,
            #[cfg(feature = "window")]
            surface.is_some(),
        );
        let allocator = create_allocator(&instance.raw, &device.raw, chosen.handle)?;
        let samplers = create_samplers(&device.raw)?;
        startup.done("memory, samplers");
        let key = Key::new(&properties);
        let folder = options.cache_folder.as_deref();
        let cache = PipelineCache::new(&device.raw, key, folder)?;
        let route = DeviceRoute::new(&chosen.summary, key, folder, options.route);
        startup.done("pipeline cache");
        let context = Arc::new(Self {
            allocator: ManuallyDrop::new(Arc::new(Mutex::new(allocator))),
            samplers,
            cache,
            kept: Kept::default(),
            route,
            faults,
            is_hung: AtomicBool::new(false),
            stage_uploads: options.stage_uploads,
            startup,
            device,
            extensions,
            queue: Mutex::new(queue),
            queue_family: chosen.queue_family,
            physical: chosen.handle,
            limits: properties.limits,
            summary: chosen.summary,
            #[cfg(feature = "hot-reload")]
            reloaded: Default::default(),
            messenger,
            instance,
            entry,
        });
        Ok((context, surface))
    }

    #[cfg(feature = "window")]
    pub(in crate::gpu) fn entry(&self) -> &ash::Entry {
        &self.entry
    }

    #[cfg(feature = "window")]
    pub(in crate::gpu) fn instance(&self) -> &ash::Instance {
        &self.instance.raw
    }

    /// The allocator, shared with renderers that manage their own buffers. It must be dropped before the context.
    #[cfg(feature = "window")]
    pub(in crate::gpu) fn shared_allocator(&self) -> Arc<Mutex<Allocator>> {
        Arc::clone(&self.allocator)
    }

    /// Name, type and features of the device.
    pub fn summary(&self) -> &DeviceSummary {
        &self.summary
    }

    /// Size of the largest storage buffer that shaders can read as a whole, bytes.
    pub fn largest_storage_buffer(&self) -> u64 {
        self.limits.max_storage_buffer_range.into()
    }

    /// Whether pipeline statistics are available.
    pub(in crate::gpu) fn counts_work(&self) -> bool {
        self.summary.has(Optional::PipelineStatistics)
    }

    pub(in crate::gpu) fn pipeline_cache(&self) -> vk::PipelineCache {
        self.cache.raw
    }

    /// Outcome of loading the pipeline cache from disk.
    pub fn cache_state(&self) -> CacheState {
        self.cache.state
    }

    /// Steps of opening the device, with their times.
    pub fn opening(&self) -> &[Step] {
        &self.startup.steps
    }

    /// All pipelines created so far, with their creation times; several may have been created in parallel.
    pub fn pipelines(&self) -> Vec<Step> {
        self.startup.pipelines()
    }

    /// Errors and warnings from the validation layer so far, each once with its identifier and count; empty if validation is
    /// off.
    pub fn validation_messages(&self) -> Vec<String> {
        let log = self.messenger.as_ref().map(Messenger::log);
        log.map(Log::read).unwrap_or_default()
    }

    /// Fails if the validation layer has reported an error or a warning.
    ///
    /// # Errors
    /// Lists each message once.
    pub fn check_validation(&self) -> Result<()> {
        let messages = self.validation_messages();
        if messages.is_empty() {
            Ok(())
        } else {
            Err(GpuError::Validation(messages))
        }
    }

    /// Whether a pipeline may combine fragments with images of `format`, see [`crate::gpu::Blend`].
    pub fn can_blend(&self, format: vk::Format) -> bool {
        let is_offered = format != FLOATS || self.summary.has(Optional::FloatBlend);
        is_offered && self.can(format, vk::FormatFeatureFlags::COLOR_ATTACHMENT_BLEND)
    }

    /// Whether the device can draw to images of `format` and sample them.
    pub fn can_draw(&self, format: vk::Format) -> bool {
        let target = vk::FormatFeatureFlags::COLOR_ATTACHMENT;
        self.can(format, target | vk::FormatFeatureFlags::SAMPLED_IMAGE)
    }

    /// The sampler to bind for a sampler that is asked for: shaders filter 32-bit floats where the device cannot, see
    /// `include/filtered.glsl`.
    pub(in crate::gpu) fn sampler_of(&self, format: vk::Format, asked: Sampler) -> vk::Sampler {
        let is_filtered = format != FLOATS || self.summary.has(Optional::FloatFilter);
        let kind = if is_filtered { asked } else { Sampler::Nearest };
        self.samplers[kind.index()]
    }

    /// Specialization constants that tell shaders of the device.
    pub(in crate::gpu) fn constants(&self) -> [(&'static str, u32); 1] {
        [("FILTERED", self.summary.has(Optional::FloatFilter).into())]
    }

    fn can(&self, format: vk::Format, needed: vk::FormatFeatureFlags) -> bool {
        // SAFETY: the physical device belongs to the instance.
        let properties = unsafe {
            self.instance
                .raw
                .get_physical_device_format_properties(self.physical, format)
        };
        properties.optimal_tiling_features.contains(needed)
    }

    /// For tests: replaces the planned fault ([`ContextOptions::fault`]), or removes it. Call counts restart at zero.
    ///
    /// # Errors
    /// When the text does not describe a fault.
    pub fn plan_fault(&self, fault: Option<&str>) -> Result<()> {
        self.faults.plan(fault)
    }

    pub(in crate::gpu) fn raw(&self) -> &ash::Device {
        &self.device.raw
    }

    /// The queue, for this thread alone as long as the guard lives. Whoever waits for the whole device needs it too.
    pub(in crate::gpu) fn queue(&self) -> MutexGuard<'_, vk::Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(in crate::gpu) fn allocator(&self) -> MutexGuard<'_, Allocator> {
        // After a panic inside the allocator, further use can at worst leak memory.
        self.allocator
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
    }

    /// Allocates memory for a buffer or an image, which takes ownership.
    pub(in crate::gpu) fn allocate(&self, desc: &AllocationCreateDesc<'_>) -> Result<Allocation> {
        let refused = |reason: String| GpuError::Memory {
            what: desc.name.into(),
            reason,
        };
        self.faults.at(Call::Memory).map_err(|fault| match fault {
            vk::Result::ERROR_OUT_OF_DEVICE_MEMORY => refused("out of device memory".into()),
            result => GpuError::Vulkan {
                what: "allocate memory",
                result,
            },
        })?;
        self.allocator()
            .allocate(desc)
            .map_err(|e| refused(e.to_string().trim_end_matches('.').to_lowercase()))
    }

    /// Sets the debug name of a handle, shown in validation messages and captures.
    pub(in crate::gpu) fn name<H: vk::Handle>(&self, handle: H, name: &str) {
        let Some(debug) = &self.extensions.debug else {
            return;
        };
        let Ok(name) = std::ffi::CString::new(name) else {
            return;
        };
        let info = vk::DebugUtilsObjectNameInfoEXT::default()
            .object_handle(handle)
            .object_name(&name);
        // SAFETY: the handle belongs to this device. Failing to set a name is harmless.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }

    /// Bytes of device memory in use.
    pub fn allocated_bytes(&self) -> u64 {
        self.allocator().generate_report().total_allocated_bytes
    }
}

impl Drop for Context {
    fn drop(&mut self) {
        self.settle();
        self.kept.destroy(&self.device.raw);
        // SAFETY: no resource is alive (each holds an Arc of the context); the allocator is dropped once, before the device.
        unsafe {
            self.cache.save_and_destroy(&self.device.raw);
            for sampler in self.samplers {
                self.device.raw.destroy_sampler(sampler, None);
            }
            ManuallyDrop::drop(&mut self.allocator);
        }
    }
}

/// The instance, the debug messenger if validation is on, and the surface if there is a window.
fn open_instance(
    entry: &ash::Entry,
    validate: bool,
    window: Option<Window>,
) -> Result<(InstanceGuard, Option<Messenger>, Option<RawSurface>)> {
    let windows = window.as_ref().map_or(Ok(Vec::new()), |window| {
        surface::instance_extensions(entry, window)
    })?;
    let instance = InstanceGuard::new(entry, validate, &windows)?;
    let messenger = validate
        .then(|| Messenger::new(entry, &instance.raw))
        .transpose()?;
    let surface = window
        .map(|window| RawSurface::new(entry, &instance.raw, window))
        .transpose()?;
    Ok((instance, messenger, surface))
}

fn create_device(
    instance: &ash::Instance,
    chosen: &select::Candidate,
    presents: bool,
) -> Result<DeviceGuard> {
    let priority = [1.0];
    let queues = [vk::DeviceQueueCreateInfo::default()
        .queue_family_index(chosen.queue_family)
        .queue_priorities(&priority)];
    let mut extensions = Vec::new();
    if chosen.summary.portability.is_some() {
        extensions.push(portability::SUBSET.as_ptr());
    }
    if chosen.summary.has(Optional::PushDescriptor) {
        extensions.push(select::PUSH_DESCRIPTORS.as_ptr());
    }
    if presents {
        extensions.push(khr::swapchain::NAME.as_ptr());
        if chosen.summary.has(Optional::HdrMetadata) {
            extensions.push(ext::hdr_metadata::NAME.as_ptr());
        }
    }
    let core = vk::PhysicalDeviceFeatures::default()
        .geometry_shader(chosen.summary.has(Optional::GeometryShader))
        .pipeline_statistics_query(chosen.summary.has(Optional::PipelineStatistics));
    let mut v12 = vk::PhysicalDeviceVulkan12Features::default()
        .scalar_block_layout(true)
        .host_query_reset(true);
    let mut v13 = vk::PhysicalDeviceVulkan13Features::default()
        .dynamic_rendering(true)
        .synchronization2(true)
        .shader_terminate_invocation(true);
    let info = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&extensions)
        .enabled_features(&core)
        .push_next(&mut v12)
        .push_next(&mut v13);
    // SAFETY: all pointers of `info` live on this stack; the features were checked by `select`.
    let raw = unsafe { instance.create_device(chosen.handle, &info, None) }
        .during("create the Vulkan device")?;
    Ok(DeviceGuard { raw })
}

fn create_allocator(
    instance: &ash::Instance,
    device: &ash::Device,
    physical_device: vk::PhysicalDevice,
) -> Result<Allocator> {
    let mut debug_settings = gpu_allocator::AllocatorDebugSettings::default();
    debug_settings.log_leaks_on_shutdown = false;
    Allocator::new(&AllocatorCreateDesc {
        instance: instance.clone(),
        device: device.clone(),
        physical_device,
        debug_settings,
        buffer_device_address: false,
        allocation_sizes: gpu_allocator::AllocationSizes::default(),
    })
    .map_err(|e| GpuError::Memory {
        what: "the allocator".into(),
        reason: e.to_string(),
    })
}
