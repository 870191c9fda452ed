#include "runtime/texture/page_format.h"

#include "runtime/base/check.h"
#include "shaders/texture/texture_io.h"

namespace loam {

PageTextures page_textures(PageFormat format) {
    switch (format) {
        case PageFormat::bc1x3:
            return {};
        case PageFormat::bc3x2:
            return {.format = format,
                    .count = 2,
                    .vk_format = VK_FORMAT_BC3_UNORM_BLOCK,
                    .layout = kPagePairs,
                    .unit_bytes = 16};
        case PageFormat::rgba8:
            return {.format = format,
                    .vk_format = VK_FORMAT_R8G8B8A8_UNORM,
                    .unit_texels = 1,
                    .unit_bytes = 4,
                    .first_encoded_mip = 1};
    }
    LOAM_CHECK(false, "a page format without textures");
}

bool is_compressed(PageFormat format) {
    return format != PageFormat::rgba8;
}

Result<PageAtlas> make_page_atlas(gpu::Device& device, const PageTextures& textures, uint32_t pages_x,
                                  uint32_t pages_y) {
    static constexpr const char* kNames[kMaxPageTextures] = {"page texture 0", "page texture 1",
                                                             "page texture 2", "page texture 3"};
    PageAtlas atlas;
    for (int i = 0; i < textures.count; ++i) {
        auto image = gpu::Image::create(
            device, {.name = kNames[i],
                     .format = textures.vk_format,
                     .width = pages_x * kPageTexels,
                     .height = pages_y * kPageTexels,
                     .mip_count = 2,
                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
                              VK_IMAGE_USAGE_TRANSFER_DST_BIT});
        if (!image.ok()) return image.error();
        atlas.push_back(std::move(*image));
    }
    return atlas;
}

}  // namespace loam
