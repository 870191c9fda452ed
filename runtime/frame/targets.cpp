#include "runtime/frame/targets.h"

#include <algorithm>

namespace loam {

Status FrameTargets::ensure(gpu::Device& device, glm::uvec2 extent) {
    if (picture && picture.width() >= extent.x && picture.height() >= extent.y) return {};
    const uint32_t width = std::max(extent.x, picture ? picture.width() : 1u);
    const uint32_t height = std::max(extent.y, picture ? picture.height() : 1u);
    constexpr VkImageUsageFlags color =
        VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
    struct Entry {
        gpu::Image* image;
        const char* name;
        VkFormat format;
        VkImageUsageFlags usage;
    };
    const Entry entries[] = {
        {&depth, "depth", device.caps().depth_stencil,
         VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT |
             VK_IMAGE_USAGE_TRANSFER_SRC_BIT},
        {&gbuffer, "g-buffer", kGbufferFormat, color},
        {&occlusion, "occlusion", kOcclusionFormat, color},
        {&picture, "picture", kPictureFormat, color},
    };
    for (const Entry& e : entries) {
        auto image = gpu::Image::create(
            device, {.name = e.name, .format = e.format, .width = width, .height = height, .usage = e.usage});
        if (!image) return image.error();
        *e.image = std::move(*image);
    }
    return {};
}

uint64_t FrameTargets::bytes() const {
    return depth.bytes() + gbuffer.bytes() + occlusion.bytes() + picture.bytes();
}

}  // namespace loam
