// A Vulkan driver that forwards to DRIVER and hides that it can present: its list of instance extensions has none of window systems.

#include <dlfcn.h>
#include <stdint.h>
#include <string.h>

typedef void (*function)(void);
typedef struct {
    char name[256];
    uint32_t version;
} extension;
typedef int (*enumerate)(const char *layer, uint32_t *count, extension *list);

static void *symbol(const char *name) {
    static void *driver;
    if (!driver) driver = dlopen(DRIVER, RTLD_NOW | RTLD_LOCAL);
    return driver ? dlsym(driver, name) : 0;
}

static function of_driver(void *instance, const char *name) {
    return ((function(*)(void *, const char *))symbol("vk_icdGetInstanceProcAddr"))(instance, name);
}

// VK_INCOMPLETE is 5.
static int list_extensions(const char *layer, uint32_t *count, extension *list) {
    extension all[256];
    uint32_t have = 256, kept = 0;
    int result = ((enumerate)of_driver(0, "vkEnumerateInstanceExtensionProperties"))(layer, &have, all);
    if (result < 0) return result;
    for (uint32_t i = 0; i < have; i++) {
        if (strstr(all[i].name, "surface") || strstr(all[i].name, "display")) continue;
        if (list && kept == *count) return 5;
        if (list) list[kept] = all[i];
        kept++;
    }
    *count = kept;
    return 0;
}

int vk_icdNegotiateLoaderICDInterfaceVersion(uint32_t *version) {
    int (*negotiate)(uint32_t *) = (int (*)(uint32_t *))symbol("vk_icdNegotiateLoaderICDInterfaceVersion");
    return negotiate ? negotiate(version) : 0;
}

function vk_icdGetInstanceProcAddr(void *instance, const char *name) {
    if (!strcmp(name, "vkEnumerateInstanceExtensionProperties")) return (function)list_extensions;
    return of_driver(instance, name);
}

function vk_icdGetPhysicalDeviceProcAddr(void *instance, const char *name) {
    function (*get)(void *, const char *) = (function(*)(void *, const char *))symbol("vk_icdGetPhysicalDeviceProcAddr");
    return get ? get(instance, name) : 0;
}
