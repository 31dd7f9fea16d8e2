//! Images that know their last use.

use std::cell::Cell;
use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use crate::gpu::device::context::Context;
use crate::gpu::device::fault::Call;
use crate::gpu::error::{During, GpuError, Result};
use crate::gpu::record::access::{self, Use};

/// Shape of an image.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ImageKind {
    /// One layer.
    Flat,
    /// Six layers, sampled as a cube, rendered to as an array (+X −X +Y −Y +Z −Z).
    Cube,
}

/// What to make.
#[derive(Debug, Clone, Copy)]
pub struct ImageDesc<'a> {
    /// Name in messages and captures: the quantity held.
    pub name: &'a str,
    /// Texel format.
    pub format: vk::Format,
    /// Width and height, texels.
    pub size: [u32; 2],
    /// Shape.
    pub kind: ImageKind,
    /// Mip levels, at least one.
    pub levels: u32,
    /// Whether compute shaders may write it.
    pub is_stored: bool,
}

impl<'a> ImageDesc<'a> {
    /// A flat image with one level.
    pub fn flat(name: &'a str, format: vk::Format, size: [u32; 2]) -> Self {
        Self {
            name,
            format,
            size,
            kind: ImageKind::Flat,
            levels: 1,
            is_stored: false,
        }
    }

    /// A cube with one level and faces of `edge` texels.
    pub fn cube(name: &'a str, format: vk::Format, edge: u32) -> Self {
        Self {
            name,
            format,
            size: [edge, edge],
            kind: ImageKind::Cube,
            levels: 1,
            // On devices without geometry shaders.
            is_stored: true,
        }
    }

    /// The same for compute shaders to write.
    pub fn stored(self) -> Self {
        Self {
            is_stored: true,
            ..self
        }
    }

    /// The same with all mip levels down to one texel.
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
/// It remembers its last [`Use`], from which the next barrier is derived; for that it may be recorded by one
/// thread at a time.
pub struct Image {
    context: Arc<Context>,
    raw: vk::Image,
    /// Images of a swapchain are not ours to destroy.
    is_borrowed: bool,
    allocation: Option<Allocation>,
    sampled_view: vk::ImageView,
    attachment_view: vk::ImageView,
    format: vk::Format,
    size: [u32; 2],
    layers: u32,
    levels: u32,
    last_use: Cell<Use>,
    /// Whether it was brought to `last_use` ahead, and not used since.
    is_prepared: Cell<bool>,
    name: String,
}

pub(in crate::gpu) fn is_depth(format: vk::Format) -> bool {
    matches!(format, vk::Format::D32_SFLOAT | vk::Format::D16_UNORM)
}

fn is_block_or_srgb_texture(format: vk::Format) -> bool {
    format == vk::Format::R8G8B8A8_SRGB
}

fn usage(desc: &ImageDesc<'_>) -> vk::ImageUsageFlags {
    let (format, levels) = (desc.format, desc.levels);
    let common = vk::ImageUsageFlags::SAMPLED
        | vk::ImageUsageFlags::TRANSFER_SRC
        | vk::ImageUsageFlags::TRANSFER_DST;
    if is_depth(format) {
        common | vk::ImageUsageFlags::DEPTH_STENCIL_ATTACHMENT
    } else if levels > 1 && is_block_or_srgb_texture(format) {
        common
    } else if desc.is_stored {
        common | vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::STORAGE
    } else {
        common | vk::ImageUsageFlags::COLOR_ATTACHMENT
    }
}

impl Image {
    /// Makes an image without content.
    ///
    /// # Errors
    /// When it is larger than the device supports or memory is out.
    pub fn new(context: &Arc<Context>, desc: &ImageDesc<'_>) -> Result<Self> {
        let limit = context.limits.max_image_dimension2_d;
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
            last_use: Cell::new(Use::Undefined),
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
        image.attachment_view = image.view(vk::ImageViewType::TYPE_2D_ARRAY, 1)?;
        Ok(image)
    }

    /// An image of a swapchain, which outlives it.
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
            last_use: Cell::new(Use::Undefined),
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

    /// The quantity held, as named at creation.
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

    /// Remembers the next use and gives the barrier that it needs: none where [`Image::prepare`] gave it already.
    pub(in crate::gpu) fn next(&self, next: Use) -> Option<vk::ImageMemoryBarrier2<'static>> {
        let last = self.last_use.replace(next);
        if self.is_prepared.take() && last == next {
            return None;
        }
        self.barrier(last, next, self.whole())
    }

    /// Gives the barrier of the next use ahead of it.
    pub(in crate::gpu) fn prepare(&self, next: Use) -> Option<vk::ImageMemoryBarrier2<'static>> {
        let barrier = self.next(next);
        self.is_prepared.set(true);
        barrier
    }

    /// The barrier of one mip level. The caller leaves all levels in one use at the end, and says which.
    pub(in crate::gpu) fn level_barrier(
        &self,
        level: u32,
        from: Use,
        to: Use,
    ) -> Option<vk::ImageMemoryBarrier2<'static>> {
        let range = vk::ImageSubresourceRange {
            base_mip_level: level,
            level_count: 1,
            ..self.whole()
        };
        self.barrier(from, to, range)
    }

    /// Notes the use that a sequence of level barriers ended in.
    pub(in crate::gpu) fn set_last_use(&self, last: Use) {
        self.last_use.set(last);
    }

    fn barrier(
        &self,
        from: Use,
        to: Use,
        range: vk::ImageSubresourceRange,
    ) -> Option<vk::ImageMemoryBarrier2<'static>> {
        let barrier = access::barrier(from, to)?;
        Some(
            vk::ImageMemoryBarrier2::default()
                .src_stage_mask(barrier.src_stage)
                .src_access_mask(barrier.src_access)
                .dst_stage_mask(barrier.dst_stage)
                .dst_access_mask(barrier.dst_access)
                .old_layout(barrier.old_layout)
                .new_layout(barrier.new_layout)
                .src_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .dst_queue_family_index(vk::QUEUE_FAMILY_IGNORED)
                .image(self.raw)
                .subresource_range(range),
        )
    }

    /// What it was last used for.
    pub fn last_use(&self) -> Use {
        self.last_use.get()
    }
}

impl Drop for Image {
    fn drop(&mut self) {
        // SAFETY: recorders wait for their work before they let go of resources; null views are ignored.
        unsafe {
            self.context
                .raw()
                .destroy_image_view(self.sampled_view, None);
            self.context
                .raw()
                .destroy_image_view(self.attachment_view, None);
            if !self.is_borrowed {
                self.context.raw().destroy_image(self.raw, None);
            }
        }
        if let Some(allocation) = self.allocation.take() {
            // Freeing fails only for a foreign allocation.
            let _ = self.context.allocator().free(allocation);
        }
    }
}
