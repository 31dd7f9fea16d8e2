//! Images, which track their last access, and samplers.

use std::cell::Cell;
use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use crate::gpu::device::context::Context;
use crate::gpu::device::fault::Call;
use crate::gpu::error::{During, GpuError, Result};
use crate::gpu::record::access::{self, ImageAccess};
use crate::gpu::record::screen::Route;

/// Shape of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageKind {
    /// One layer.
    Flat,
    /// Six layers, sampled as a cube, rendered to as an array (+X −X +Y −Y +Z −Z).
    Cube,
}

/// Description of an [`Image`].
#[derive(Debug, Clone, Copy)]
pub struct ImageDesc<'a> {
    /// Name shown in messages and captures: the quantity stored.
    pub name: &'a str,
    /// Texel format.
    pub format: vk::Format,
    /// Width and height, texels.
    pub size: [u32; 2],
    /// Shape.
    pub kind: ImageKind,
    /// Mip levels, at least one.
    pub levels: u32,
    /// What writes to it.
    pub written: Written,
}

/// What writes to an image. Devices may compress an image that less can happen to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Written {
    /// Uploads alone: a texture.
    Once,
    /// Rendering.
    Drawn,
    /// Rendering or compute shaders.
    Stored,
}

impl<'a> ImageDesc<'a> {
    /// A 2D image with one mip level.
    pub fn flat(name: &'a str, format: vk::Format, size: [u32; 2]) -> Self {
        Self {
            name,
            format,
            size,
            kind: ImageKind::Flat,
            levels: 1,
            written: Written::Drawn,
        }
    }

    /// A 2D image with one mip level that is uploaded, see [`crate::gpu::upload_texture`].
    pub fn texture(name: &'a str, format: vk::Format, size: [u32; 2]) -> Self {
        Self {
            written: Written::Once,
            ..Self::flat(name, format, size)
        }
    }

    /// A cube map with one mip level and `edge` x `edge` faces.
    pub fn cube(name: &'a str, format: vk::Format, edge: u32) -> Self {
        Self {
            name,
            format,
            size: [edge, edge],
            kind: ImageKind::Cube,
            levels: 1,
            // Devices without geometry shaders write cubes from compute shaders.
            written: Written::Stored,
        }
    }

    /// Same, writable by compute shaders.
    pub fn stored(self) -> Self {
        Self {
            written: Written::Stored,
            ..self
        }
    }

    /// Same, as a target of full-screen passes by this route.
    pub fn target_by(self, route: Route) -> Self {
        match route {
            Route::Fragment => self,
            Route::Compute => self.stored(),
        }
    }

    /// Same, with a full mip chain down to one texel.
    pub fn mipmapped(self) -> Self {
        let edge = self.size[0].max(self.size[1]).max(1);
        Self {
            levels: edge.ilog2() + 1,
            ..self
        }
    }

    const fn layers(&self) -> u32 {
        match self.kind {
            ImageKind::Flat => 1,
            ImageKind::Cube => 6,
        }
    }
}

/// An image, its memory and views, freed on drop.
///
/// The image tracks its last [`ImageAccess`], from which the next barrier is derived, so only one thread at a time may record
/// commands that use it.
pub struct Image {
    context: Arc<Context>,
    raw: vk::Image,
    /// Whether the image belongs to a swapchain, which destroys it.
    is_borrowed: bool,
    allocation: Option<Allocation>,
    sampled_view: vk::ImageView,
    attachment_view: vk::ImageView,
    format: vk::Format,
    size: [u32; 2],
    layers: u32,
    levels: u32,
    last_access: Cell<ImageAccess>,
    /// Whether the barrier to `last_access` was recorded ahead of that access.
    is_prepared: Cell<bool>,
    name: String,
}

pub(in crate::gpu) fn is_depth(format: vk::Format) -> bool {
    matches!(format, vk::Format::D32_SFLOAT | vk::Format::D16_UNORM)
}

fn usage(desc: &ImageDesc<'_>) -> vk::ImageUsageFlags {
    let uploaded = vk::ImageUsageFlags::SAMPLED | vk::ImageUsageFlags::TRANSFER_DST;
    let drawn = uploaded | vk::ImageUsageFlags::TRANSFER_SRC;
    match desc.written {
        Written::Once => uploaded,
        _ if is_depth(desc.format) => drawn | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT,
        Written::Drawn => drawn | vk::ImageUsageFlags::COLOR_ATTACHMENT,
        Written::Stored => {
            drawn | vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::STORAGE
        }
    }
}

impl Image {
    /// Creates an image with undefined contents.
    ///
    /// # Errors
    /// When it is larger than the device supports or device memory is exhausted.
    pub fn new(context: &Arc<Context>, desc: &ImageDesc<'_>) -> Result<Self> {
        let limit = match desc.written {
            Written::Once => context.limits.max_image_dimension2_d,
            Written::Drawn | Written::Stored => context.summary().max_image_edge,
        };
        let asked = desc.size[0].max(desc.size[1]);
        if asked > limit {
            let device = context.summary().name.clone();
            return Err(GpuError::TooLarge {
                what: desc.name.into(),
                asked,
                limit,
                device,
            });
        }
        let flags = match desc.kind {
            ImageKind::Flat => vk::ImageCreateFlags::empty(),
            ImageKind::Cube => vk::ImageCreateFlags::CUBE_COMPATIBLE,
        };
        let info = vk::ImageCreateInfo::default()
            .flags(flags)
            .image_type(vk::ImageType::TYPE_2D)
            .format(desc.format)
            .extent(vk::Extent3D {
                width: desc.size[0],
                height: desc.size[1],
                depth: 1,
            })
            .mip_levels(desc.levels)
            .array_layers(desc.layers())
            .samples(vk::SampleCountFlags::TYPE_1)
            .usage(usage(desc));
        context.faults.at(Call::Image).during("create an image")?;
        // SAFETY: the info has no pointers; the handle goes into its owner at once.
        let raw = unsafe { context.raw().create_image(&info, None) }.during("create an image")?;
        let mut image = Self {
            context: context.clone(),
            raw,
            is_borrowed: false,
            allocation: None,
            sampled_view: vk::ImageView::null(),
            attachment_view: vk::ImageView::null(),
            format: desc.format,
            size: desc.size,
            layers: desc.layers(),
            levels: desc.levels,
            last_access: Cell::new(ImageAccess::Undefined),
            is_prepared: Cell::new(false),
            name: desc.name.to_owned(),
        };
        context.name(raw, desc.name);
        image.allocate()?;
        let sampled = match desc.kind {
            ImageKind::Flat => vk::ImageViewType::TYPE_2D,
            ImageKind::Cube => vk::ImageViewType::CUBE,
        };
        image.sampled_view = image.view(sampled, desc.levels)?;
        if desc.written != Written::Once {
            image.attachment_view = image.view(vk::ImageViewType::TYPE_2D_ARRAY, 1)?;
        }
        Ok(image)
    }

    /// Wraps a swapchain image. The swapchain must outlive it.
    #[cfg(feature = "window")]
    pub(in crate::gpu) fn of_swapchain(
        context: &Arc<Context>,
        raw: vk::Image,
        format: vk::Format,
        size: [u32; 2],
    ) -> Result<Self> {
        let mut image = Self {
            context: context.clone(),
            raw,
            is_borrowed: true,
            allocation: None,
            sampled_view: vk::ImageView::null(),
            attachment_view: vk::ImageView::null(),
            format,
            size,
            layers: 1,
            levels: 1,
            last_access: Cell::new(ImageAccess::Undefined),
            is_prepared: Cell::new(false),
            name: "window".to_owned(),
        };
        image.attachment_view = image.view(vk::ImageViewType::TYPE_2D, 1)?;
        Ok(image)
    }

    fn allocate(&mut self) -> Result<()> {
        // SAFETY: `raw` was just created by this device.
        let requirements = unsafe { self.context.raw().get_image_memory_requirements(self.raw) };
        let allocation = self.context.allocate(&AllocationCreateDesc {
            name: &self.name,
            requirements,
            location: MemoryLocation::GpuOnly,
            linear: false,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        })?;
        // SAFETY: the allocation was made for these requirements and is owned by the image.
        let bound = unsafe {
            self.context
                .raw()
                .bind_image_memory(self.raw, allocation.memory(), allocation.offset())
        };
        self.allocation = Some(allocation);
        bound.during("bind image memory")
    }

    fn view(&self, kind: vk::ImageViewType, levels: u32) -> Result<vk::ImageView> {
        let info = vk::ImageViewCreateInfo::default()
            .image(self.raw)
            .view_type(kind)
            .format(self.format)
            .subresource_range(vk::ImageSubresourceRange {
                level_count: levels,
                ..self.whole()
            });
        // SAFETY: the image is alive and of this device.
        unsafe { self.context.raw().create_image_view(&info, None) }.during("create an image view")
    }

    /// Texel format.
    pub fn format(&self) -> vk::Format {
        self.format
    }

    /// Width and height, texels.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Number of layers: six for a cube.
    pub fn layers(&self) -> u32 {
        self.layers
    }

    /// Number of mip levels.
    pub fn levels(&self) -> u32 {
        self.levels
    }

    /// Name given at creation: the quantity stored.
    pub fn name(&self) -> &str {
        &self.name
    }

    pub(in crate::gpu) fn raw(&self) -> vk::Image {
        self.raw
    }

    pub(in crate::gpu) fn sampled_view(&self) -> vk::ImageView {
        self.sampled_view
    }

    pub(in crate::gpu) fn attachment_view(&self) -> vk::ImageView {
        self.attachment_view
    }

    pub(in crate::gpu) fn aspect(&self) -> vk::ImageAspectFlags {
        if is_depth(self.format) {
            vk::ImageAspectFlags::DEPTH
        } else {
            vk::ImageAspectFlags::COLOR
        }
    }

    pub(in crate::gpu) fn whole(&self) -> vk::ImageSubresourceRange {
        vk::ImageSubresourceRange {
            aspect_mask: self.aspect(),
            base_mip_level: 0,
            level_count: self.levels,
            base_array_layer: 0,
            layer_count: self.layers,
        }
    }

    /// Tracks the next access and returns its barrier, unless [`Image::prepare`] already returned it.
    pub(in crate::gpu) fn next(
        &self,
        next: ImageAccess,
    ) -> Option<vk::ImageMemoryBarrier2<'static>> {
        let last = self.last_access.replace(next);
        if self.is_prepared.take() && last == next {
            return None;
        }
        self.barrier(last, next, self.whole())
    }

    /// Returns the barrier for the next access ahead of that access.
    pub(in crate::gpu) fn prepare(
        &self,
        next: ImageAccess,
    ) -> Option<vk::ImageMemoryBarrier2<'static>> {
        let barrier = self.next(next);
        self.is_prepared.set(true);
        barrier
    }

    /// Sets the access with which the swapchain hands an image over.
    #[cfg(feature = "window")]
    pub(in crate::gpu) fn set_last_access(&self, last: ImageAccess) {
        self.last_access.set(last);
    }

    fn barrier(
        &self,
        from: ImageAccess,
        to: ImageAccess,
        range: vk::ImageSubresourceRange,
    ) -> Option<vk::ImageMemoryBarrier2<'static>> {
        let barrier = access::barrier(from, to)?;
        Some(
            vk::ImageMemoryBarrier2::default()
                .src_stage_mask(barrier.memory.src_stage)
                .src_access_mask(barrier.memory.src_access)
                .dst_stage_mask(barrier.memory.dst_stage)
                .dst_access_mask(barrier.memory.dst_access)
                .old_layout(barrier.old_layout)
                .new_layout(barrier.new_layout)
                .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .image(self.raw)
                .subresource_range(range),
        )
    }

    /// The last access.
    pub fn last_access(&self) -> ImageAccess {
        self.last_access.get()
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        let Some(raw) = self.context.freeing() else {
            return;
        };
        // SAFETY: recorders wait for their work before they release resources; null views are ignored.
        unsafe {
            raw.destroy_image_view(self.sampled_view, None);
            raw.destroy_image_view(self.attachment_view, None);
            if !self.is_borrowed {
                raw.destroy_image(self.raw, None);
            }
        }
        if let Some(allocation) = self.allocation.take() {
            // Freeing fails only for memory from another allocator.
            let _ = self.context.allocator().free(allocation);
        }
    }
}

/// Filtering and addressing mode.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Sampler {
    /// Nearest texel, clamped to the edge.
    Nearest,
    /// Bilinear (seamless across cube faces), trilinear between mip levels, clamped to the edge.
    Linear,
    /// Trilinear, for surface textures, with what is outside of the picture along u and v.
    Surface(Outside, Outside),
}

/// What a surface texture shows outside of its picture, along one side.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Outside {
    /// The picture again.
    Repeat,
    /// The picture mirrored, then again.
    Mirror,
    /// The edge.
    Clamp,
}

const SAMPLERS: [Sampler; 11] = {
    use Outside::{Clamp, Mirror, Repeat};
    [
        Sampler::Nearest,
        Sampler::Linear,
        Sampler::Surface(Repeat, Repeat),
        Sampler::Surface(Repeat, Mirror),
        Sampler::Surface(Repeat, Clamp),
        Sampler::Surface(Mirror, Repeat),
        Sampler::Surface(Mirror, Mirror),
        Sampler::Surface(Mirror, Clamp),
        Sampler::Surface(Clamp, Repeat),
        Sampler::Surface(Clamp, Mirror),
        Sampler::Surface(Clamp, Clamp),
    ]
};

impl Sampler {
    /// Number of samplers.
    pub(in crate::gpu) const COUNT: usize = SAMPLERS.len();

    /// Its place among all samplers.
    pub(in crate::gpu) fn index(self) -> usize {
        match self {
            Self::Nearest => 0,
            Self::Linear => 1,
            Self::Surface(u, v) => 2 + 3 * u as usize + v as usize,
        }
    }
}

/// Creates all samplers, in the order of [`Sampler`].
pub(in crate::gpu) fn create_samplers(
    device: &ash::Device,
) -> Result<[vk::Sampler; Sampler::COUNT]> {
    let mut samplers = [vk::Sampler::null(); Sampler::COUNT];
    for (slot, kind) in samplers.iter_mut().zip(SAMPLERS) {
        // SAFETY: the info has no pointers.
        *slot = unsafe { device.create_sampler(&sampler_info(kind), None) }
            .during("create a sampler")?;
    }
    Ok(samplers)
}

fn sampler_info(sampler: Sampler) -> vk::SamplerCreateInfo<'static> {
    let (filter, mipmap) = match sampler {
        Sampler::Nearest => (vk::Filter::NEAREST, vk::SamplerMipmapMode::NEAREST),
        Sampler::Linear | Sampler::Surface(..) => {
            (vk::Filter::LINEAR, vk::SamplerMipmapMode::LINEAR)
        }
    };
    let [u, v] = match sampler {
        Sampler::Surface(u, v) => [u, v].map(|outside| match outside {
            Outside::Repeat => vk::SamplerAddressMode::REPEAT,
            Outside::Mirror => vk::SamplerAddressMode::MIRRORED_REPEAT,
            Outside::Clamp => vk::SamplerAddressMode::CLAMP_TO_EDGE,
        }),
        Sampler::Nearest | Sampler::Linear => [vk::SamplerAddressMode::CLAMP_TO_EDGE; 2],
    };
    vk::SamplerCreateInfo::default()
        .mag_filter(filter)
        .min_filter(filter)
        .mipmap_mode(mipmap)
        .address_mode_u(u)
        .address_mode_v(v)
        .address_mode_w(v)
        .max_lod(vk::LOD_CLAMP_NONE)
}
