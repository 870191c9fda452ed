#include "runtime/texture/layer_arrays.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <vector>

namespace loam {

namespace {

// Copies begin at multiples of a texel.
constexpr uint64_t kAlignment = 16;

int mip_count(const LayerArraysDesc& desc) {
    return std::bit_width(uint32_t(std::max(1, desc.size_texels >> desc.first_level)));
}

int side(const LayerArraysDesc& desc, int mip) {
    return std::max(1, desc.size_texels >> (desc.first_level + mip));
}

// A call a mip of each texture: (texture, mip, bytes from the slot's first).
template <typename Visit>
uint64_t visit_parts(const LayerArraysDesc& desc, const Visit& visit) {
    uint64_t at = 0;
    for (int texture = 0; texture < (desc.has_metal ? 3 : 2); ++texture)
        for (int mip = 0; mip < mip_count(desc); ++mip) {
            visit(texture, mip, at);
            const uint64_t bytes =
                uint64_t(side(desc, mip)) * uint64_t(side(desc, mip)) * (texture < 2 ? 4 : 1);
            at += (bytes + kAlignment - 1) / kAlignment * kAlignment;
        }
    return at;
}

// The layer's own level that lies in a level of the common size: a larger layer drops its finest ones.
int own_level(int own_size, int size, int level) {
    return level + std::max(0, std::countr_zero(uint32_t(own_size)) - std::countr_zero(uint32_t(size)));
}

// A smaller layer is repeated. Its coarsest mips stay at its own 1x1.
void write_mip(const std::vector<std::vector<uint8_t>>& mips, int own_size, int level, int side,
               int texel_bytes, uint8_t* out) {
    const size_t own = std::min(mips.size() - 1, size_t(level));
    const int own_side = std::max(1, own_size >> own);
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; x += own_side) {
            const int run = std::min(own_side, side - x);
            std::memcpy(out + size_t(y * side + x) * size_t(texel_bytes),
                        &mips[own][size_t(y % own_side) * size_t(own_side) * size_t(texel_bytes)],
                        size_t(run) * size_t(texel_bytes));
        }
}

}  // namespace

Result<LayerArrays> LayerArrays::create(gpu::Device& device, const LayerArraysDesc& desc) {
    LayerArrays arrays;
    arrays.desc_ = desc;
    const auto make = [&](gpu::Image& out, const char* name, VkFormat format, bool used) -> Status {
        const uint32_t texels = used ? uint32_t(side(desc, 0)) : 1;
        auto image = gpu::Image::create(
            device, {.name = name,
                     .format = format,
                     .width = texels,
                     .height = texels,
                     .mip_count = used ? uint32_t(mip_count(desc)) : 1,
                     .layer_count = uint32_t(desc.slot_count),
                     .array_view = true,
                     .usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT});
        if (!image.ok()) return image.error();
        out = std::move(*image);
        return {};
    };
    LOAM_TRY(make(arrays.albedo_reveal, "layer albedo", VK_FORMAT_R8G8B8A8_SRGB, true));
    LOAM_TRY(make(arrays.normal_gloss_occlusion, "layer normal", VK_FORMAT_R8G8B8A8_UNORM, true));
    LOAM_TRY(make(arrays.metalness, "layer metalness", VK_FORMAT_R8_UNORM, desc.has_metal));
    return arrays;
}

uint64_t LayerArrays::slot_bytes(const LayerArraysDesc& desc) {
    return visit_parts(desc, [](int, int, uint64_t) {});
}

void LayerArrays::write_slot(const LayerTextures& layer, uint8_t* out) const {
    visit_parts(desc_, [&](int texture, int mip, uint64_t at) {
        const auto& mips = texture == 0   ? layer.albedo_reveal
                           : texture == 1 ? layer.normal_gloss_occlusion
                                          : layer.metalness;
        write_mip(mips, layer.size_texels,
                  own_level(layer.size_texels, desc_.size_texels, desc_.first_level + mip), side(desc_, mip),
                  texture < 2 ? 4 : 1, out + at);
    });
}

void LayerArrays::cmd_fill(gpu::Commands& commands, const gpu::Buffer& from, uint64_t offset,
                           uint32_t slot) const {
    visit_parts(desc_, [&](int texture, int mip, uint64_t at) {
        const gpu::Image& image = texture == 0   ? albedo_reveal
                                  : texture == 1 ? normal_gloss_occlusion
                                                 : metalness;
        const uint32_t texels = uint32_t(side(desc_, mip));
        const VkBufferImageCopy region{
            .bufferOffset = offset + at,
            .bufferRowLength = 0,
            .bufferImageHeight = 0,
            .imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, uint32_t(mip), slot, 1},
            .imageOffset = {},
            .imageExtent = {texels, texels, 1}};
        vkCmdCopyBufferToImage(commands.handle(), from.handle(), image.handle(),
                               VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
    });
}

}  // namespace loam
