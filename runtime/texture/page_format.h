// The formats of texture pages: how many textures, of what, and what the encoder makes. Which channel lies
// where is in shaders/texture/page_format.h.
#pragma once

#include <cstdint>
#include <vector>

#include <vulkan/vulkan_core.h>

#include "runtime/gpu/resources.h"
#include "shaders/texture/page_format.h"

namespace loam {

enum class PageFormat {
    bc1x3,  // three BC1 textures: 1.5 bytes a texel
    bc3x2,  // two BC3: 2 bytes a texel, each normal component apart from what it is not like
    rgba8   // the same channels as bc1x3 uncompressed: the comparison, and fast on software devices
};

struct PageTextures {
    PageFormat format = PageFormat::bc1x3;
    int count = 3;
    VkFormat vk_format = VK_FORMAT_BC1_RGB_UNORM_BLOCK;
    uint32_t layout = kPageRows;  // of the channels, as the shaders take it
    uint32_t placement = 0;       // of the optional channels, likewise
    int unit_texels = 4;          // side of what the encoder writes at once: a block, or a texel
    int unit_bytes = 8;
    int first_encoded_mip = 0;  // mip 0 of uncompressed pages is a copy of scratch
    int scratch_layers = 3;
};

[[nodiscard]] PageTextures page_textures(PageFormat format);
[[nodiscard]] bool is_compressed(PageFormat format);

using PageAtlas = std::vector<gpu::Image>;  // PageTextures::count of them
[[nodiscard]] Result<PageAtlas> make_page_atlas(gpu::Device& device, const PageTextures& textures,
                                                uint32_t pages_x, uint32_t pages_y);

}  // namespace loam
