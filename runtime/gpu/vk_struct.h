// Vulkan's structs, zeroed and tagged. Internal to runtime/gpu.
#pragma once

#include <vulkan/vulkan_core.h>

namespace loam::gpu {

template <typename T>
[[nodiscard]] constexpr T vk_struct(VkStructureType type) {
    T zeroed{};
    zeroed.sType = type;
    return zeroed;
}

}  // namespace loam::gpu
