//! The heaps of a device's memory, and how much of them a program may use (VK_EXT_memory_budget).

use ash::vk;

/// A heap of memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Heap {
    /// Size, bytes.
    pub bytes: u64,
    /// Whether it is the device's own.
    pub is_local: bool,
    /// What this process may use of it at the moment, bytes; `None` where the driver does not tell.
    pub budget: Option<u64>,
}

/// The heaps of a device, in the driver's order.
pub(in crate::gpu) fn heaps(
    instance: &ash::Instance,
    handle: vk::PhysicalDevice,
    extensions: &[String],
) -> Vec<Heap> {
    let has_budget = extensions.iter().any(|e| e == "VK_EXT_memory_budget");
    let mut budget = vk::PhysicalDeviceMemoryBudgetPropertiesEXT::default();
    let mut properties = vk::PhysicalDeviceMemoryProperties2::default();
    if has_budget {
        properties = properties.push_next(&mut budget);
    }
    // SAFETY: `handle` comes from this instance; the chain lives on this stack and has what the driver knows.
    unsafe { instance.get_physical_device_memory_properties2(handle, &mut properties) };
    let memory = properties.memory_properties;
    let heaps = memory.memory_heaps_as_slice().iter();
    heaps
        .zip(budget.heap_budget)
        .map(|(heap, budget)| Heap {
            bytes: heap.size,
            is_local: heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL),
            budget: has_budget.then_some(budget),
        })
        .collect()
}
