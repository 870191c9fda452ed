// Rectangles of CPU pages into layers of an array image: one piece of upload memory and one copy command for
// all of them.
#pragma once

#include <cstddef>
#include <span>

#include "runtime/base/rect.h"
#include "runtime/base/result.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/gpu/resources.h"

namespace loam {

// In units: texels, or blocks of a compressed format.
struct RectUpload {
    TexelRect rect;
    uint32_t layer = 0;
    const void* units = nullptr;  // of the whole page, image.width() / unit.side_texels a row
};
struct UploadUnit {
    uint32_t bytes = 4;
    int side_texels = 1;
};

// Leaves the image in use as Access::copy_target. The rectangles of one layer must not overlap.
Status cmd_upload_rects(gpu::FrameRing& ring, gpu::Commands& commands, gpu::Image& image, UploadUnit unit,
                        std::span<const RectUpload> uploads);

}  // namespace loam
