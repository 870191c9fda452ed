#include "runtime/texture/block_encoder.h"

namespace loam {

BlockShape shape_of(BlockFormat format) {
    switch (format) {
        case BlockFormat::bc1:
        case BlockFormat::bc1_fine:
        case BlockFormat::bc4:
            return {4, 8};
        case BlockFormat::bc3:
        case BlockFormat::astc4x4:
            return {4, 16};
        case BlockFormat::astc6x6:
            return {6, 16};
    }
    LOAM_CHECK(false, "a block format that does not exist");
    return {};
}

Result<BlockEncoder> BlockEncoder::create(gpu::Device& device, BlockFormat format) {
    BlockEncoder encoder;
    encoder.format_ = format;
    auto nearest = gpu::Sampler::create(device, {.filter = VK_FILTER_NEAREST});
    if (!nearest) return nearest.error();
    encoder.nearest_ = std::move(*nearest);
    auto pipeline = gpu::Pipeline::create(
        device, gpu::ComputeDesc{.name = "encode image",
                                 .shader = "texture/encode_image.comp",
                                 .bindings = {gpu::sampled_image(0), gpu::storage_buffer(1)},
                                 .push_bytes = sizeof(shared::EncodeImagePush),
                                 .constants = {{0, uint32_t(format)}}});
    if (!pipeline) return pipeline.error();
    encoder.pipeline_ = std::move(*pipeline);
    return encoder;
}

glm::ivec2 BlockEncoder::blocks_of(glm::ivec2 size_texels) const {
    const int side = shape_of(format_).side_texels;
    return (size_texels + side - 1) / side;
}

uint64_t BlockEncoder::bytes_of(glm::ivec2 size_texels) const {
    const glm::ivec2 blocks = blocks_of(size_texels);
    return uint64_t(blocks.x) * uint64_t(blocks.y) * uint64_t(shape_of(format_).bytes);
}

void BlockEncoder::cmd_encode(gpu::Commands& commands, gpu::Image& image, glm::ivec2 size_texels,
                              gpu::Buffer& blocks, glm::vec3 weights) const {
    const glm::ivec2 count = blocks_of(size_texels);
    auto pass = commands.pass(
        "encode image", {{image, gpu::Access::compute_sampled}, {blocks, gpu::Access::compute_storage}});
    commands.bind(pipeline_, {{0, image.view(), nearest_}, {1, blocks}});
    commands.push(shared::EncodeImagePush{size_texels, count, weights});
    commands.dispatch(uint32_t(count.x + 7) / 8, uint32_t(count.y));
}

}  // namespace loam
