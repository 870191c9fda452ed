#include "runtime/gpu/upload.h"

#include <cstring>

#include "runtime/base/check.h"
#include "runtime/gpu/format.h"

namespace loam::gpu {

void upload_to_image(FrameRing& ring, Commands& commands, Image& image, uint32_t mip, uint32_t layer,
                     uint32_t x, uint32_t y, uint32_t width, uint32_t height,
                     std::span<const std::byte> data) {
    const uint64_t needed = image_bytes(image.format(), width, height);
    LOAM_CHECK(needed > 0 && data.size() == needed,
               fmt::format("{} x {} texels of format {} are {} bytes, got {}", width, height,
                           static_cast<int>(image.format()), needed, data.size()));
    const UploadSlice slice = ring.upload(needed);
    std::memcpy(slice.data, data.data(), data.size());
    commands.use({{image, Access::copy_target}});
    VkBufferImageCopy region{};
    region.bufferOffset = slice.offset;
    region.imageSubresource = {image.aspect(), mip, layer, 1};
    region.imageOffset = {static_cast<int32_t>(x), static_cast<int32_t>(y), 0};
    region.imageExtent = {width, height, 1};
    vkCmdCopyBufferToImage(commands.handle(), slice.buffer->handle(), image.handle(),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

void upload_to_buffer(FrameRing& ring, Commands& commands, Buffer& buffer, uint64_t offset,
                      std::span<const std::byte> data) {
    LOAM_CHECK(offset + data.size() <= buffer.size_bytes(),
               fmt::format("{} bytes at {} of {}", data.size(), offset, buffer.size_bytes()));
    if (data.empty()) return;
    const UploadSlice slice = ring.upload(data.size());
    std::memcpy(slice.data, data.data(), data.size());
    commands.use({{buffer, Access::copy_target}});
    const VkBufferCopy region{slice.offset, offset, data.size()};
    vkCmdCopyBuffer(commands.handle(), slice.buffer->handle(), buffer.handle(), 1, &region);
}

}  // namespace loam::gpu
