// Block compression of an image on the GPU, a format a pipeline: for baking and exporting pages. (Live pages
// go through the composer, which calls the same encoders on its scratch.) The algorithms are in
// shaders/texture/bc1.h, bc3.h, bc4.h, astc.h.
#pragma once

#include <cstdint>

#include "runtime/gpu/commands.h"
#include "shaders/texture/encode_io.h"

namespace loam {

enum class BlockFormat {
    bc1 = kEncodeBc1,
    bc1_fine = kEncodeBc1Fine,  // the same format, dearer and nearer
    bc3 = kEncodeBc3,
    bc4 = kEncodeBc4,
    astc4x4 = kEncodeAstc4x4,
    astc6x6 = kEncodeAstc6x6,
};
struct BlockShape {
    int side_texels = 4;
    int bytes = 8;
};
[[nodiscard]] BlockShape shape_of(BlockFormat format);

class BlockEncoder {
  public:
    static Result<BlockEncoder> create(gpu::Device& device, BlockFormat format);
    // Blocks of the image, as many as cover it: blocks that reach over the edge repeat its texels.
    [[nodiscard]] glm::ivec2 blocks_of(glm::ivec2 size_texels) const;
    [[nodiscard]] uint64_t bytes_of(glm::ivec2 size_texels) const;
    // Mip 0 of `image` (sampled, channels 0…1) to `blocks`, row by row. `weights`: of the colour channels'
    // squared errors.
    void cmd_encode(gpu::Commands& commands, gpu::Image& image, glm::ivec2 size_texels, gpu::Buffer& blocks,
                    glm::vec3 weights) const;

  private:
    BlockFormat format_ = BlockFormat::bc1;
    gpu::Pipeline pipeline_;
    gpu::Sampler nearest_;
};

}  // namespace loam
