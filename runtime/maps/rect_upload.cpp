#include "runtime/maps/rect_upload.h"

#include <cstring>
#include <vector>

namespace loam {

Status cmd_upload_rects(gpu::FrameRing& ring, gpu::Commands& commands, gpu::Image& image, UploadUnit unit,
                        std::span<const RectUpload> uploads) {
    const auto aligned = [](uint64_t bytes) { return (bytes + 15) & ~uint64_t(15); };
    uint64_t total_bytes = 0;
    for (const RectUpload& upload : uploads)
        total_bytes += aligned(uint64_t(upload.rect.area()) * unit.bytes);
    if (total_bytes == 0) return {};
    const gpu::UploadSlice slice = ring.upload(total_bytes);
    if (!slice.data) return error("no memory for an upload of {} bytes", total_bytes);

    const int side = unit.side_texels, row_units = int(image.width()) / side;
    std::vector<VkBufferImageCopy> copies;
    uint64_t offset = 0;
    for (const RectUpload& upload : uploads) {
        if (upload.rect.empty()) continue;
        const TexelRect& rect = upload.rect;
        const size_t row_bytes = size_t(rect.width()) * unit.bytes;
        auto* to = static_cast<std::byte*>(slice.data) + offset;
        for (int y = rect.y0; y < rect.y1; ++y, to += row_bytes) {
            const size_t from = (size_t(y) * size_t(row_units) + size_t(rect.x0)) * unit.bytes;
            std::memcpy(to, static_cast<const std::byte*>(upload.units) + from, row_bytes);
        }
        VkBufferImageCopy& copy = copies.emplace_back();
        copy.bufferOffset = slice.offset + offset;
        copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, upload.layer, 1};
        copy.imageOffset = {rect.x0 * side, rect.y0 * side, 0};
        copy.imageExtent = {uint32_t(rect.width() * side), uint32_t(rect.height() * side), 1};
        offset += aligned(uint64_t(rect.area()) * unit.bytes);
    }
    commands.use({{image, gpu::Access::copy_target}});
    vkCmdCopyBufferToImage(commands.handle(), slice.buffer->handle(), image.handle(),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, uint32_t(copies.size()), copies.data());
    return {};
}

}  // namespace loam
