#include "runtime/gpu/device.h"

namespace loam::gpu {

namespace {

std::string result_text(VkResult result) {
    switch (result) {
        case VK_SUCCESS:
            return "success";
        case VK_NOT_READY:
            return "not ready";
        case VK_TIMEOUT:
            return "timed out";
        case VK_ERROR_OUT_OF_HOST_MEMORY:
            return "out of host memory";
        case VK_ERROR_OUT_OF_DEVICE_MEMORY:
            return "out of device memory";
        case VK_ERROR_INITIALIZATION_FAILED:
            return "initialisation failed";
        case VK_ERROR_DEVICE_LOST:
            return "the graphics device was lost (driver crash or reset), restart the program";
        case VK_ERROR_MEMORY_MAP_FAILED:
            return "memory map failed";
        case VK_ERROR_LAYER_NOT_PRESENT:
            return "a layer is not installed";
        case VK_ERROR_EXTENSION_NOT_PRESENT:
            return "an extension is not supported";
        case VK_ERROR_FEATURE_NOT_PRESENT:
            return "a feature is not supported";
        case VK_ERROR_INCOMPATIBLE_DRIVER:
            return "no Vulkan driver is installed";
        case VK_ERROR_TOO_MANY_OBJECTS:
            return "too many objects";
        case VK_ERROR_FORMAT_NOT_SUPPORTED:
            return "format not supported";
        case VK_ERROR_FRAGMENTED_POOL:
            return "fragmented pool";
        case VK_ERROR_OUT_OF_POOL_MEMORY:
            return "out of pool memory";
        case VK_ERROR_SURFACE_LOST_KHR:
            return "the window's surface is gone";
        case VK_ERROR_NATIVE_WINDOW_IN_USE_KHR:
            return "the window is in use by another program";
        case VK_ERROR_OUT_OF_DATE_KHR:
            return "the window has changed";
        case VK_ERROR_INVALID_SHADER_NV:
            return "the driver rejects the shader";
        default:
            return fmt::format("error {}", static_cast<int>(result));
    }
}

}  // namespace

Error vk_error(std::string_view what, VkResult result) {
    return error("{} failed: {}", what, result_text(result));
}

}  // namespace loam::gpu
