#include "runtime/texture/page_format.h"

#include <algorithm>

#include "shaders/texture/texture_io.h"

namespace loam {

namespace {

size_t room(PageFormat format) {
    return format == PageFormat::bc3x2 ? 0 : format == PageFormat::bc1x3 ? 1 : kMostChannels;
}

}  // namespace

static_assert(kChannelNames.size() == kChannelCount && kMostChannelsOfAMap == kMostChannels);

// In the order of Channel, whatever the order in the project.
uint32_t channel_placement(std::span<const Channel> channels) {
    uint32_t placement = 0, place = 0;
    for (uint32_t c = 0; c < kChannelCount; ++c)
        if (std::find(channels.begin(), channels.end(), Channel(c)) != channels.end())
            placement |= ++place << (4 * c);
    return placement;
}

const char* page_format_name(PageFormat format) {
    static constexpr const char* kNames[] = {"bc1", "bc1x4", "bc3", "rgba8"};
    return kNames[size_t(format)];
}

PageFormat format_with_room(PageFormat preferred, size_t channel_count) {
    return preferred == PageFormat::bc1x3 && channel_count > room(preferred) ? PageFormat::bc1x4 : preferred;
}

Result<PageTextures> page_textures(PageFormat format, std::span<const Channel> channels) {
    if (channels.size() > room(format))
        return error("pages of the format {} hold {} optional channel{}, this map's [texture] has {}; use {}",
                     page_format_name(format), room(format), room(format) == 1 ? "" : "s", channels.size(),
                     channels.size() > 1 ? "bc1x4 or rgba8" : "bc1, bc1x4 or rgba8");
    const bool fourth = channels.size() > 1;
    PageTextures t{.format = format,
                   .count = fourth ? 4 : 3,
                   .placement = channel_placement(channels),
                   .scratch_layers = fourth ? 4 : 3};
    if (format == PageFormat::bc3x2) {
        t.count = 2;
        t.vk_format = VK_FORMAT_BC3_UNORM_BLOCK;
        t.layout = kPagePairs;
        t.block_bytes = 16;
    }
    if (!is_compressed(format)) t.vk_format = VK_FORMAT_R8G8B8A8_UNORM;
    return t;
}

bool is_compressed(PageFormat format) {
    return format != PageFormat::rgba8;
}

Result<PageAtlas> make_page_atlas(gpu::Device& device, const PageTextures& textures, uint32_t pages_x,
                                  uint32_t pages_y) {
    static constexpr const char* kNames[kMaxPageTextures] = {"page texture 0", "page texture 1",
                                                             "page texture 2", "page texture 3"};
    // The encoder of blocks writes to a buffer, that of plain texels into the texture.
    const VkImageUsageFlags written =
        is_compressed(textures.format) ? VkImageUsageFlags(0) : VK_IMAGE_USAGE_STORAGE_BIT;
    PageAtlas atlas;
    for (int i = 0; i < textures.count; ++i) {
        auto image = gpu::Image::create(
            device, {.name = kNames[i],
                     .format = textures.vk_format,
                     .width = pages_x * kPageTexels,
                     .height = pages_y * kPageTexels,
                     .mip_count = 2,
                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                              VK_IMAGE_USAGE_TRANSFER_DST_BIT | written});
        if (!image.ok()) return image.error();
        atlas.push_back(std::move(*image));
    }
    return atlas;
}

}  // namespace loam
