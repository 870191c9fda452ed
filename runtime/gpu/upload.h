// Convenience over upload slices: copy bytes of the CPU into an image or a buffer, barrier included.
// Each call is a copy of its own behind a write barrier; many small ones are better batched by hand.
#pragma once

#include <cstddef>
#include <span>

#include "runtime/gpu/frame_ring.h"

namespace loam::gpu {

// `data`: rows of the rectangle, tightly packed. Block-compressed formats: x and y are multiples of the
// block, width and height too except at the mip's edge, and the rows are rows of blocks.
void upload_to_image(FrameRing& ring, Commands& commands, Image& image, uint32_t mip, uint32_t layer,
                     uint32_t x, uint32_t y, uint32_t width, uint32_t height,
                     std::span<const std::byte> data);

void upload_to_buffer(FrameRing& ring, Commands& commands, Buffer& buffer, uint64_t offset,
                      std::span<const std::byte> data);

}  // namespace loam::gpu
