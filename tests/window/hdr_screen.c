// A Vulkan layer that pretends an HDR10 screen. Surfaces offer A2B10G10R10 in the colour space of HDR10 besides what they offer anyway; the images
// are those of the true surface, with 8 bits, so that a screenshot shows the signal. What the screen is told of the content goes to stderr. The
// true driver's pipelines must not depend on the format of what they draw to (those of Mesa's software driver do not).

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#define TRUE_FORMAT VK_FORMAT_B8G8R8A8_UNORM
#define PRETENDED VK_FORMAT_A2B10G10R10_UNORM_PACK32
#define MOST 256

static PFN_vkGetInstanceProcAddr of_instance;
static PFN_vkGetDeviceProcAddr of_device;
static VkInstance instance;
// Asked for while the instance is created: later older loaders answer with the first layer's, which may be this one's.
static PFN_vkEnumerateDeviceExtensionProperties true_extensions;
static PFN_vkGetPhysicalDeviceSurfaceFormatsKHR true_formats;

static VkResult create_instance(const VkInstanceCreateInfo *info, const VkAllocationCallbacks *allocator, VkInstance *created) {
    VkLayerInstanceCreateInfo *link = (void *)info->pNext;
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO) link = (void *)link->pNext;
    of_instance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    VkResult result = ((PFN_vkCreateInstance)of_instance(0, "vkCreateInstance"))(info, allocator, created);
    instance = *created;
    true_extensions = (PFN_vkEnumerateDeviceExtensionProperties)of_instance(instance, "vkEnumerateDeviceExtensionProperties");
    true_formats = (PFN_vkGetPhysicalDeviceSurfaceFormatsKHR)of_instance(instance, "vkGetPhysicalDeviceSurfaceFormatsKHR");
    return result;
}

static int is_metadata(const char *name) { return !strcmp(name, VK_EXT_HDR_METADATA_EXTENSION_NAME); }

static VkResult create_device(VkPhysicalDevice physical, const VkDeviceCreateInfo *info, const VkAllocationCallbacks *allocator, VkDevice *created) {
    VkLayerDeviceCreateInfo *link = (void *)info->pNext;
    while (link->sType != VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO || link->function != VK_LAYER_LINK_INFO) link = (void *)link->pNext;
    PFN_vkGetInstanceProcAddr next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    of_device = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const char *names[MOST];
    VkDeviceCreateInfo own = *info;
    own.ppEnabledExtensionNames = names;
    own.enabledExtensionCount = 0;
    for (uint32_t i = 0; i < info->enabledExtensionCount && i < MOST; ++i)
        if (!is_metadata(info->ppEnabledExtensionNames[i])) names[own.enabledExtensionCount++] = info->ppEnabledExtensionNames[i];
    return ((PFN_vkCreateDevice)next(instance, "vkCreateDevice"))(physical, &own, allocator, created);
}

// Answers with `have` entries of `size` bytes in `all` as Vulkan's lists do.
static VkResult answer(const void *all, uint32_t have, size_t size, uint32_t *count, void *list) {
    uint32_t fits = !list || *count > have ? have : *count;
    if (list) memcpy(list, all, fits * size);
    *count = fits;
    return fits < have ? VK_INCOMPLETE : VK_SUCCESS;
}

static VkResult extensions(VkPhysicalDevice physical, const char *layer, uint32_t *count, VkExtensionProperties *list) {
    static VkExtensionProperties all[MOST + 1];
    uint32_t have = MOST;
    VkResult result = true_extensions(physical, layer, &have, all);
    if (result < 0) return result;
    all[have] = (VkExtensionProperties){VK_EXT_HDR_METADATA_EXTENSION_NAME, VK_EXT_HDR_METADATA_SPEC_VERSION};
    return answer(all, have + 1, sizeof *all, count, list);
}

static VkResult formats(VkPhysicalDevice physical, VkSurfaceKHR surface, uint32_t *count, VkSurfaceFormatKHR *list) {
    static VkSurfaceFormatKHR all[MOST + 1];
    uint32_t have = MOST;
    VkResult result = true_formats(physical, surface, &have, all);
    if (result < 0) return result;
    all[have] = (VkSurfaceFormatKHR){PRETENDED, VK_COLOR_SPACE_HDR10_ST2084_EXT};
    return answer(all, have + 1, sizeof *all, count, list);
}

static VkResult create_swapchain(VkDevice device, const VkSwapchainCreateInfoKHR *info, const VkAllocationCallbacks *allocator, VkSwapchainKHR *created) {
    VkSwapchainCreateInfoKHR own = *info;
    if (own.imageColorSpace == VK_COLOR_SPACE_HDR10_ST2084_EXT) {
        own.imageFormat = TRUE_FORMAT;
        own.imageColorSpace = VK_COLOR_SPACE_SRGB_NONLINEAR_KHR;
    }
    return ((PFN_vkCreateSwapchainKHR)of_device(device, "vkCreateSwapchainKHR"))(device, &own, allocator, created);
}

static VkResult create_view(VkDevice device, const VkImageViewCreateInfo *info, const VkAllocationCallbacks *allocator, VkImageView *created) {
    VkImageViewCreateInfo own = *info;
    if (own.format == PRETENDED) own.format = TRUE_FORMAT;
    return ((PFN_vkCreateImageView)of_device(device, "vkCreateImageView"))(device, &own, allocator, created);
}

static void set_metadata(VkDevice device, uint32_t count, const VkSwapchainKHR *swapchains, const VkHdrMetadataEXT *metadata) {
    (void)device, (void)swapchains;
    for (uint32_t i = 0; i < count; ++i)
        fprintf(stderr, "metadata: green %.3f %.3f, white %.4f %.4f, at most %g, at least %g, brightest %g, mean %g\n", metadata[i].displayPrimaryGreen.x,
                metadata[i].displayPrimaryGreen.y, metadata[i].whitePoint.x, metadata[i].whitePoint.y, metadata[i].maxLuminance, metadata[i].minLuminance,
                metadata[i].maxContentLightLevel, metadata[i].maxFrameAverageLightLevel);
}

#define INSTEAD(text, function) if (!strcmp(name, text)) return (PFN_vkVoidFunction)function;

static PFN_vkVoidFunction device_function(VkDevice device, const char *name) {
    INSTEAD("vkGetDeviceProcAddr", device_function)
    INSTEAD("vkCreateSwapchainKHR", create_swapchain)
    INSTEAD("vkCreateImageView", create_view)
    INSTEAD("vkSetHdrMetadataEXT", set_metadata)
    return of_device(device, name);
}

static PFN_vkVoidFunction instance_function(VkInstance of, const char *name) {
    INSTEAD("vkGetInstanceProcAddr", instance_function)
    INSTEAD("vkGetDeviceProcAddr", device_function)
    INSTEAD("vkCreateInstance", create_instance)
    INSTEAD("vkCreateDevice", create_device)
    INSTEAD("vkEnumerateDeviceExtensionProperties", extensions)
    INSTEAD("vkGetPhysicalDeviceSurfaceFormatsKHR", formats)
    return of_instance ? of_instance(of, name) : 0;
}

__attribute__((visibility("default"))) VkResult vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface *version) {
    version->loaderLayerInterfaceVersion = 2;
    version->pfnGetInstanceProcAddr = instance_function;
    version->pfnGetDeviceProcAddr = device_function;
    version->pfnGetPhysicalDeviceProcAddr = 0;
    return VK_SUCCESS;
}
