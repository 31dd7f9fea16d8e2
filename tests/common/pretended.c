// A Vulkan layer that pretends another device: the one of PRETENCE (a source file, macro), and more words of FAKE.
//   apple   answers also for the extension VK_KHR_portability_subset: no features, strides of 4 bytes; wide: of 16
//   apart   a family of queues that draws but does not compute stands before the device's own
//   less    has less than Vulkan guarantees: 4 bytes of push constants, one sampled image a stage
// Faults of drivers:
//   nearest samplers that should filter do not
//   short   the last column of every dispatch's workgroups is missing
//   deep    the depth test of what writes depth lets everything pass
//   plain   compute shaders have the default values of their constants
//   hang    waits for fences end with a timeout; after that a wait for the whole device is told on stderr, and what frees a window's images
#define vkNegotiateLoaderLayerInterfaceVersion negotiate_pretence
#include PRETENCE
#undef vkNegotiateLoaderLayerInterfaceVersion

static VkBaseOutStructure *in_chain(void *first, VkStructureType type) {
    VkBaseOutStructure *at = first;
    while (at && at->sType != type) at = at->pNext;
    return at;
}

// The subset's features follow type and chain as 15 booleans.
static void VKAPI_CALL features2(VkPhysicalDevice device, VkPhysicalDeviceFeatures2 *features) {
    Feat2(device, features);
    VkBaseOutStructure *subset = in_chain(features->pNext, (VkStructureType)1000163000);
    if (subset) memset(subset + 1, 0, 15 * sizeof(VkBool32));
}

static void lessen(VkPhysicalDeviceLimits *limits) {
    if (!on("less")) return;
    limits->maxPushConstantsSize = 4;
    limits->maxPerStageDescriptorSampledImages = 1;
}

static void VKAPI_CALL properties(VkPhysicalDevice device, VkPhysicalDeviceProperties *properties) {
    Props(device, properties);
    lessen(&properties->limits);
}

static void VKAPI_CALL properties2(VkPhysicalDevice device, VkPhysicalDeviceProperties2 *properties) {
    Props2(device, properties);
    lessen(&properties->properties.limits);
    VkBaseOutStructure *subset = in_chain(properties->pNext, (VkStructureType)1000163001);
    if (subset) *(uint32_t *)(subset + 1) = on("wide") ? 16 : 4;
}

static void VKAPI_CALL families(VkPhysicalDevice device, uint32_t *count, VkQueueFamilyProperties *list) {
    uint32_t more = on("apart"), own = list && *count > more ? *count - more : 0;
    QF(device, &own, list && own ? list + more : 0);
    if (list && more) {
        list[0] = list[1];
        list[0].queueFlags = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_TRANSFER_BIT;
    }
    *count = own + more;
}

static void VKAPI_CALL families2(VkPhysicalDevice device, uint32_t *count, VkQueueFamilyProperties2 *list) {
    uint32_t more = on("apart"), own = list && *count > more ? *count - more : 0;
    QF2(device, &own, list && own ? list + more : 0);
    if (list && more) {
        list[0].queueFamilyProperties = list[1].queueFamilyProperties;
        list[0].queueFamilyProperties.queueFlags = VK_QUEUE_GRAPHICS_BIT | VK_QUEUE_TRANSFER_BIT;
    }
    *count = own + more;
}

// The functions that the pretence calls, of the next layer or the driver. They are asked for while the instance is created: later the
// last layer gets those of the first one from older loaders.
static struct {
    const char *name;
    PFN_vkVoidFunction function;
} next[] = {
    {"vkGetPhysicalDeviceProperties"}, {"vkGetPhysicalDeviceProperties2"},
    {"vkGetPhysicalDeviceFeatures"}, {"vkGetPhysicalDeviceFeatures2"},
    {"vkGetPhysicalDeviceFormatProperties"}, {"vkGetPhysicalDeviceFormatProperties2"},
    {"vkGetPhysicalDeviceImageFormatProperties"}, {"vkGetPhysicalDeviceImageFormatProperties2"},
    {"vkGetPhysicalDeviceQueueFamilyProperties"}, {"vkGetPhysicalDeviceQueueFamilyProperties2"},
    {"vkGetPhysicalDeviceMemoryProperties"}, {"vkGetPhysicalDeviceMemoryProperties2"},
    {"vkGetPhysicalDeviceSurfaceSupportKHR"}, {"vkEnumerateDeviceExtensionProperties"},
};
enum { NEXT = sizeof next / sizeof *next };
static PFN_vkGetInstanceProcAddr next_of_instances;

static PFN_vkVoidFunction VKAPI_CALL next_function(VkInstance instance, const char *name) {
    for (int i = 0; i < NEXT; ++i) if (next[i].function && !strcmp(name, next[i].name)) return next[i].function;
    return next_of_instances(instance, name);
}

static VkResult VKAPI_CALL create_instance(const VkInstanceCreateInfo *info, const VkAllocationCallbacks *allocator, VkInstance *instance) {
    VkResult result = CI(info, allocator, instance);
    next_of_instances = gipa;
    if (result == VK_SUCCESS) for (int i = 0; i < NEXT; ++i) next[i].function = gipa(*instance, next[i].name);
    gipa = next_function;
    return result;
}

static VkResult VKAPI_CALL create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo *info, const VkAllocationCallbacks *allocator, VkDevice *device) {
    VkDeviceCreateInfo own = *info;
    VkDeviceQueueCreateInfo queues[4];
    for (uint32_t i = 0; i < own.queueCreateInfoCount && i < 4; ++i) {
        queues[i] = info->pQueueCreateInfos[i];
        if (on("apart")) queues[i].queueFamilyIndex -= 1;
    }
    own.pQueueCreateInfos = queues;
    return CD(physical, &own, allocator, device);
}

static void VKAPI_CALL device_queue(VkDevice device, uint32_t family, uint32_t index, VkQueue *queue) {
    ((PFN_vkGetDeviceQueue)gdpa(device, "vkGetDeviceQueue"))(device, family - on("apart"), index, queue);
}

static VkResult VKAPI_CALL command_pool(VkDevice device, const VkCommandPoolCreateInfo *info, const VkAllocationCallbacks *allocator, VkCommandPool *pool) {
    VkCommandPoolCreateInfo own = *info;
    own.queueFamilyIndex -= on("apart");
    return ((PFN_vkCreateCommandPool)gdpa(device, "vkCreateCommandPool"))(device, &own, allocator, pool);
}

static VkResult VKAPI_CALL surface_support(VkPhysicalDevice device, uint32_t family, VkSurfaceKHR surface, VkBool32 *presents) {
    uint32_t own = family ? family - on("apart") : family;
    return N(vkGetPhysicalDeviceSurfaceSupportKHR)(device, own, surface, presents);
}

static int has_hung;

static VkResult VKAPI_CALL wait_for_fences(VkDevice device, uint32_t count, const VkFence *fences, VkBool32 all, uint64_t timeout) {
    VkResult result = ((PFN_vkWaitForFences)gdpa(device, "vkWaitForFences"))(device, count, fences, all, timeout);
    has_hung |= on("hang");
    return on("hang") ? VK_TIMEOUT : result;
}

static VkResult VKAPI_CALL device_wait_idle(VkDevice device) {
    if (has_hung) fprintf(stderr, "the device that hangs is waited for\n");
    return ((PFN_vkDeviceWaitIdle)gdpa(device, "vkDeviceWaitIdle"))(device);
}

#define D(name) ((PFN_##name)gdpa(device, #name))

static void VKAPI_CALL destroy_swapchain(VkDevice device, VkSwapchainKHR swapchain, const VkAllocationCallbacks *allocator) {
    if (has_hung) fprintf(stderr, "the images of the window are freed on a device that hangs\n");
    D(vkDestroySwapchainKHR)(device, swapchain, allocator);
}

static void VKAPI_CALL destroy_semaphore(VkDevice device, VkSemaphore semaphore, const VkAllocationCallbacks *allocator) {
    if (has_hung) fprintf(stderr, "a semaphore is freed on a device that hangs\n");
    D(vkDestroySemaphore)(device, semaphore, allocator);
}

static VkResult VKAPI_CALL create_sampler(VkDevice device, const VkSamplerCreateInfo *info, const VkAllocationCallbacks *allocator, VkSampler *sampler) {
    VkSamplerCreateInfo own = *info;
    if (on("nearest")) own.magFilter = own.minFilter = VK_FILTER_NEAREST;
    return D(vkCreateSampler)(device, &own, allocator, sampler);
}

static VkResult VKAPI_CALL compute_pipelines(VkDevice device, VkPipelineCache cache, uint32_t count, const VkComputePipelineCreateInfo *infos, const VkAllocationCallbacks *allocator, VkPipeline *pipelines) {
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < count && result == VK_SUCCESS; ++i) {
        VkComputePipelineCreateInfo own = infos[i];
        if (on("plain")) own.stage.pSpecializationInfo = 0;
        result = D(vkCreateComputePipelines)(device, cache, 1, &own, allocator, pipelines + i);
    }
    return result;
}

static VkResult VKAPI_CALL graphics_pipelines(VkDevice device, VkPipelineCache cache, uint32_t count, const VkGraphicsPipelineCreateInfo *infos, const VkAllocationCallbacks *allocator, VkPipeline *pipelines) {
    VkResult result = VK_SUCCESS;
    for (uint32_t i = 0; i < count && result == VK_SUCCESS; ++i) {
        VkGraphicsPipelineCreateInfo own = infos[i];
        VkPipelineDepthStencilStateCreateInfo depth;
        if (on("deep") && own.pDepthStencilState && own.pDepthStencilState->depthWriteEnable) {
            depth = *own.pDepthStencilState;
            depth.depthCompareOp = VK_COMPARE_OP_ALWAYS;
            own.pDepthStencilState = &depth;
        }
        result = D(vkCreateGraphicsPipelines)(device, cache, 1, &own, allocator, pipelines + i);
    }
    return result;
}

static VkDevice device_of_commands;

static void VKAPI_CALL dispatch(VkCommandBuffer commands, uint32_t x, uint32_t y, uint32_t z) {
    VkDevice device = device_of_commands;
    D(vkCmdDispatch)(commands, on("short") && x > 1 ? x - 1 : x, y, z);
}

#define INSTEAD(text, function) if (!strcmp(name, text)) return (PFN_vkVoidFunction)function;

static PFN_vkVoidFunction VKAPI_CALL device_function(VkDevice device, const char *name) {
    device_of_commands = device;
    INSTEAD("vkCreateSampler", create_sampler)
    INSTEAD("vkCreateComputePipelines", compute_pipelines)
    INSTEAD("vkCreateGraphicsPipelines", graphics_pipelines)
    INSTEAD("vkCmdDispatch", dispatch)
    INSTEAD("vkGetDeviceProcAddr", device_function)
    INSTEAD("vkGetDeviceQueue", device_queue)
    INSTEAD("vkCreateCommandPool", command_pool)
    INSTEAD("vkWaitForFences", wait_for_fences)
    INSTEAD("vkDeviceWaitIdle", device_wait_idle)
    INSTEAD("vkDestroySwapchainKHR", destroy_swapchain)
    INSTEAD("vkDestroySemaphore", destroy_semaphore)
    return FakeGdpa(device, name);
}

static PFN_vkVoidFunction VKAPI_CALL instance_function(VkInstance instance, const char *name) {
    INSTEAD("vkGetInstanceProcAddr", instance_function)
    INSTEAD("vkGetDeviceProcAddr", device_function)
    INSTEAD("vkCreateInstance", create_instance)
    INSTEAD("vkCreateDevice", create_device)
    INSTEAD("vkGetPhysicalDeviceProperties", properties)
    INSTEAD("vkGetPhysicalDeviceFeatures2", features2)
    INSTEAD("vkGetPhysicalDeviceFeatures2KHR", features2)
    INSTEAD("vkGetPhysicalDeviceProperties2", properties2)
    INSTEAD("vkGetPhysicalDeviceProperties2KHR", properties2)
    INSTEAD("vkGetPhysicalDeviceQueueFamilyProperties", families)
    INSTEAD("vkGetPhysicalDeviceQueueFamilyProperties2", families2)
    INSTEAD("vkGetPhysicalDeviceQueueFamilyProperties2KHR", families2)
    INSTEAD("vkGetPhysicalDeviceSurfaceSupportKHR", surface_support)
    return FakeGipa(instance, name);
}

__attribute__((visibility("default"))) VkResult VKAPI_CALL vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *version) {
    VkResult result = negotiate_pretence(version);
    version->pfnGetInstanceProcAddr = instance_function;
    version->pfnGetDeviceProcAddr = device_function;
    return result;
}
