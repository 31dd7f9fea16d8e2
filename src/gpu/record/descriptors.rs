//! Descriptor sets of one frame, for devices without push descriptors.

use std::sync::Arc;

use ash::vk;

use crate::gpu::device::context::Context;
use crate::gpu::device::fault::Call;
use crate::gpu::error::{During, Result};

/// Sets per pool.
const POOL_SETS: u32 = 1024;

/// Descriptor pools, added on demand and reused after a reset.
pub(in crate::gpu) struct DescriptorPools {
    context: Arc<Context>,
    pools: Vec<vk::DescriptorPool>,
    /// Index of the current pool.
    current: usize,
    /// Sets allocated from the current pool.
    taken: u32,
}

impl DescriptorPools {
    /// Starts empty: pools are created when sets are allocated.
    pub(in crate::gpu) fn new(context: &Arc<Context>) -> Self {
        Self {
            context: context.clone(),
            pools: Vec::new(),
            current: 0,
            taken: 0,
        }
    }

    /// Frees all sets. No pending submission may use them.
    pub(in crate::gpu) fn reset(&mut self) -> Result<()> {
        for pool in &self.pools {
            let flags = vk::DescriptorPoolResetFlags::empty();
            // SAFETY: guaranteed by the caller.
            unsafe { self.context.raw().reset_descriptor_pool(*pool, flags) }
                .during("reset a descriptor pool")?;
        }
        (self.current, self.taken) = (0, 0);
        Ok(())
    }

    /// Allocates a set that is valid until the next reset.
    pub(in crate::gpu) fn allocate(
        &mut self,
        layout: vk::DescriptorSetLayout,
    ) -> Result<vk::DescriptorSet> {
        loop {
            if self.current == self.pools.len() {
                self.pools.push(self.create()?);
            }
            if self.taken < POOL_SETS {
                match self.allocate_from(self.pools[self.current], layout) {
                    // A pool may run out of one descriptor type before it runs out of sets.
                    Err(
                        vk::Result::ERROR_OUT_OF_POOL_MEMORY | vk::Result::ERROR_FRAGMENTED_POOL,
                    ) if self.taken > 0 => {}
                    result => {
                        self.taken += 1;
                        return result.during("allocate a descriptor set");
                    }
                }
            }
            self.current += 1;
            self.taken = 0;
        }
    }

    fn allocate_from(
        &self,
        pool: vk::DescriptorPool,
        layout: vk::DescriptorSetLayout,
    ) -> std::result::Result<vk::DescriptorSet, vk::Result> {
        self.context.faults.at(Call::Descriptors)?;
        let layouts = [layout];
        let info = vk::DescriptorSetAllocateInfo::default()
            .descriptor_pool(pool)
            .set_layouts(&layouts);
        // SAFETY: the pool is alive and not used by another thread.
        Ok(unsafe { self.context.raw().allocate_descriptor_sets(&info) }?[0])
    }

    fn create(&self) -> Result<vk::DescriptorPool> {
        let size = |ty, per_set| vk::DescriptorPoolSize {
            ty,
            descriptor_count: per_set * POOL_SETS,
        };
        let sizes = [
            size(vk::DescriptorType::COMBINED_IMAGE_SAMPLER, 8),
            size(vk::DescriptorType::UNIFORM_BUFFER, 2),
            size(vk::DescriptorType::STORAGE_BUFFER, 2),
            size(vk::DescriptorType::STORAGE_IMAGE, 1),
        ];
        let info = vk::DescriptorPoolCreateInfo::default()
            .max_sets(POOL_SETS)
            .pool_sizes(&sizes);
        // SAFETY: `sizes` outlives the call.
        unsafe { self.context.raw().create_descriptor_pool(&info, None) }
            .during("create a descriptor pool")
    }
}

impl Drop for DescriptorPools {
    fn drop(&mut self) {
        let Some(raw) = self.context.freeing() else {
            return;
        };
        for pool in &self.pools {
            // SAFETY: the recorder that owns the pools has waited for its work.
            unsafe { raw.destroy_descriptor_pool(*pool, None) };
        }
    }
}
