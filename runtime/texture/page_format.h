// The formats of texture pages: how many textures, of what, and what the encoder makes. Which channel lies
// where is in shaders/texture/page_format.h.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "runtime/base/result.h"
#include "runtime/gpu/resources.h"
#include "runtime/store/project.h"
#include "shaders/texture/page_format.h"

namespace loam {

enum class PageFormat {
    bc1x3,  // three BC1 textures: 1.5 bytes a texel, one optional channel
    bc1x4,  // a fourth for up to four optional channels; three where the map has no more than one
    bc3x2,  // two BC3: 2 bytes a texel, each normal component apart from what it is not like; no optional
            // channel
    rgba8   // the channels of BC1 uncompressed: the comparison, and fast on software devices; up to four
            // optional channels
};

struct PageTextures {
    PageFormat format = PageFormat::bc1x3;
    int count = 3;
    VkFormat vk_format = VK_FORMAT_BC1_RGB_UNORM_BLOCK;
    uint32_t layout = kPageRows;  // of the channels, as the shaders take it
    uint32_t placement = 0;       // of the optional channels, likewise
    int block_bytes = 8;          // of compressed pages
    int scratch_layers = 3;
};

// Refused where the format cannot hold the map's optional channels.
[[nodiscard]] Result<PageTextures> page_textures(PageFormat format, std::span<const Channel> channels);
// The word that says where in a page each channel is (shaders/texture/page_format.h).
[[nodiscard]] uint32_t channel_placement(std::span<const Channel> channels);
// bc1x4 for bc1x3 where one optional channel is not enough.
[[nodiscard]] PageFormat format_with_room(PageFormat preferred, size_t channel_count);
[[nodiscard]] const char* page_format_name(PageFormat format);  // as --format takes it
[[nodiscard]] bool is_compressed(PageFormat format);

using PageAtlas = std::vector<gpu::Image>;  // PageTextures::count of them
[[nodiscard]] Result<PageAtlas> make_page_atlas(gpu::Device& device, const PageTextures& textures,
                                                uint32_t pages_x, uint32_t pages_y);

}  // namespace loam
