// Sizes and aspects of the formats Loam uses.
#pragma once

#include <cstdint>

#include <vulkan/vulkan_core.h>

namespace loam::gpu {

struct FormatInfo {
    uint32_t block_bytes = 0;  // bytes of a texel, or of a block of compressed formats; 0: unknown format
    uint32_t block_size_texel = 1;
};

[[nodiscard]] FormatInfo format_info(VkFormat format);
[[nodiscard]] VkImageAspectFlags format_aspect(VkFormat format);
[[nodiscard]] bool has_stencil(VkFormat format);
// Bytes of a tightly packed rectangle; partial blocks count whole.
[[nodiscard]] uint64_t image_bytes(VkFormat format, uint32_t width, uint32_t height);

}  // namespace loam::gpu
