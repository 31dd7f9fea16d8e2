//! Buffers.

use std::cell::Cell;
use std::sync::Arc;

use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};

use crate::gpu::device::context::Context;
use crate::gpu::device::fault::Call;
use crate::gpu::error::{During, Result};
use crate::gpu::record::access::{self, BufferAccess, MemoryBarrier};

/// Usage of a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BufferKind {
    /// Vertex data in device memory, also read by shaders.
    Vertex,
    /// Index data in device memory, also read by shaders.
    Index,
    /// Storage buffer in device memory.
    Storage,
    /// Written by the CPU, source of copies to the device.
    Staging,
    /// Written by the device, read by the CPU.
    ReadBack,
    /// Uniform blocks, written by the CPU every frame.
    Uniform,
}

impl BufferKind {
    const fn usage(self) -> vk::BufferUsageFlags {
        let target = vk::BufferUsageFlags::TRANSFER_DST;
        let stored = vk::BufferUsageFlags::from_raw(
            target.as_raw() | vk::BufferUsageFlags::STORAGE_BUFFER.as_raw(),
        );
        match self {
            Self::Vertex => vk::BufferUsageFlags::from_raw(
                stored.as_raw() | vk::BufferUsageFlags::VERTEX_BUFFER.as_raw(),
            ),
            Self::Index => vk::BufferUsageFlags::from_raw(
                stored.as_raw() | vk::BufferUsageFlags::INDEX_BUFFER.as_raw(),
            ),
            Self::Storage => stored,
            Self::Staging => vk::BufferUsageFlags::TRANSFER_SRC,
            Self::ReadBack => target,
            Self::Uniform => vk::BufferUsageFlags::UNIFORM_BUFFER,
        }
    }

    /// How a buffer of this kind is accessed after a copy into it.
    pub(in crate::gpu) const fn read_access(self) -> Option<BufferAccess> {
        match self {
            Self::Vertex => Some(BufferAccess::Vertex),
            Self::Index => Some(BufferAccess::Index),
            Self::Storage => Some(BufferAccess::StorageRead),
            Self::ReadBack => Some(BufferAccess::HostRead),
            Self::Staging | Self::Uniform => None,
        }
    }

    const fn location(self) -> MemoryLocation {
        match self {
            Self::Vertex | Self::Index | Self::Storage => MemoryLocation::GpuOnly,
            Self::Staging | Self::Uniform => MemoryLocation::CpuToGpu,
            Self::ReadBack => MemoryLocation::GpuToCpu,
        }
    }
}

/// A buffer and its memory, freed on drop.
///
/// Like an image, it tracks its last access: only one thread at a time may record commands that use it.
pub struct Buffer {
    context: Arc<Context>,
    raw: vk::Buffer,
    allocation: Option<Allocation>,
    size: u64,
    /// The last access that a later one may have to wait for.
    last_access: Cell<Option<BufferAccess>>,
}

impl Buffer {
    /// Creates a buffer of `size` bytes, at least one.
    ///
    /// # Errors
    /// When device memory is exhausted.
    pub fn new(context: &Arc<Context>, name: &str, kind: BufferKind, size: u64) -> Result<Self> {
        let size = size.max(4);
        let info = vk::BufferCreateInfo::default()
            .size(size)
            .usage(kind.usage());
        context.faults.at(Call::Buffer).during("create a buffer")?;
        // SAFETY: the info has no pointers; the handle goes into its owner at once.
        let raw = unsafe { context.raw().create_buffer(&info, None) }.during("create a buffer")?;
        let mut buffer = Self {
            context: context.clone(),
            raw,
            allocation: None,
            size,
            last_access: Cell::new(None),
        };
        context.name(raw, name);
        // SAFETY: `raw` was just created by this device.
        let requirements = unsafe { context.raw().get_buffer_memory_requirements(raw) };
        let allocation = context.allocate(&AllocationCreateDesc {
            name,
            requirements,
            location: kind.location(),
            linear: true,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        })?;
        // SAFETY: the allocation was made for these requirements and is owned by the buffer.
        let bound = unsafe {
            context
                .raw()
                .bind_buffer_memory(raw, allocation.memory(), allocation.offset())
        };
        buffer.allocation = Some(allocation);
        bound.during("bind buffer memory")?;
        Ok(buffer)
    }

    /// Size in bytes.
    pub fn size(&self) -> u64 {
        self.size
    }

    /// Contents of a buffer that the CPU reads; empty for other kinds.
    pub fn bytes(&self) -> &[u8] {
        let slice = self
            .allocation
            .as_ref()
            .and_then(Allocation::mapped_slice)
            .unwrap_or(&[]);
        &slice[..slice.len().min(self.size as usize)]
    }

    /// Contents of a buffer that the CPU writes; empty for other kinds.
    pub fn bytes_mut(&mut self) -> &mut [u8] {
        let size = self.size as usize;
        let slice = self
            .allocation
            .as_mut()
            .and_then(Allocation::mapped_slice_mut)
            .unwrap_or(&mut []);
        let size = slice.len().min(size);
        &mut slice[..size]
    }

    /// Contents, if the memory is mapped and coherent.
    pub(in crate::gpu) fn coherent_bytes_mut(&mut self) -> Option<&mut [u8]> {
        let wanted = vk::MemoryPropertyFlags::HOST_COHERENT;
        let properties = self.allocation.as_ref()?.memory_properties();
        let bytes = properties.contains(wanted).then(|| self.bytes_mut())?;
        (!bytes.is_empty()).then_some(bytes)
    }

    /// Tracks the next access and returns the barrier between the last one and it, if one is needed.
    pub(in crate::gpu) fn next(&self, next: BufferAccess) -> Option<MemoryBarrier> {
        let last = self.last_access.replace(Some(next))?;
        access::buffer_barrier(last, next)
    }

    pub(in crate::gpu) fn raw(&self) -> vk::Buffer {
        self.raw
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        let Some(raw) = self.context.freeing() else {
            return;
        };
        // SAFETY: recorders wait for their work before they release resources.
        unsafe { raw.destroy_buffer(self.raw, None) };
        if let Some(allocation) = self.allocation.take() {
            // Freeing fails only for memory from another allocator.
            let _ = self.context.allocator().free(allocation);
        }
    }
}
