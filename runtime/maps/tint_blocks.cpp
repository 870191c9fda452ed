#include "runtime/maps/tint_blocks.h"

#include <cmath>

#include <glm/geometric.hpp>

#include "runtime/base/check.h"
#include "shaders/texture/bc1.h"

namespace loam {

namespace {

constexpr int kBlockTexels = kTintBlockTexels * kTintBlockTexels;

// bc1_encode with one start and one refinement: tints vary little, and pages of them are made in frames.
glm::uvec2 encode(const glm::vec3 (&tints)[kBlockTexels]) {
    const glm::vec3 even(1);
    glm::vec3 sum(0);
    for (const glm::vec3& tint : tints) sum += tint;
    const glm::vec3 mean = sum / float(kBlockTexels), axis = shared::bc1_axis(tints, mean, even);
    float nearest = INFINITY, farthest = -INFINITY;
    glm::vec3 ends[2] = {mean, mean};
    for (const glm::vec3& tint : tints) {
        const float along = glm::dot(tint - mean, axis);
        if (along < nearest) nearest = along, ends[0] = tint;
        if (along > farthest) farthest = along, ends[1] = tint;
    }
    const shared::Bc1Try first =
        shared::bc1_try(tints, shared::bc1_pack565(ends[0]), shared::bc1_pack565(ends[1]), even);
    const shared::Bc1Try best =
        shared::bc1_better(shared::bc1_flat(tints, mean, even), shared::bc1_refine(tints, first, sum, even));
    return shared::bc1_finish(shared::bc1_better(best, first));
}

}  // namespace

TexelRect tint_blocks_of(const TexelRect& texels) {
    if (texels.empty()) return {};
    constexpr int kLast = kTintBlockTexels - 1;
    return {texels.x0 / kTintBlockTexels, texels.y0 / kTintBlockTexels,
            (texels.x1 + kLast) / kTintBlockTexels, (texels.y1 + kLast) / kTintBlockTexels};
}

WorldRect tint_block_rect(const WorldRect& rect, double spacing_m) {
    constexpr double kHair = 1e-6;  // of a block: for a texel that rounding puts short of its block
    const double block_m = spacing_m * kTintBlockTexels, last_m = block_m - spacing_m;
    const auto block_low_m = [&](double metres) { return std::floor(metres / block_m + kHair) * block_m; };
    return {block_low_m(rect.min_x), block_low_m(rect.min_y), block_low_m(rect.max_x) + last_m,
            block_low_m(rect.max_y) + last_m};
}

void encode_tint_blocks(std::span<const IndexTexel> texels, int side_texels, const TexelRect& rect,
                        std::span<glm::uvec2> blocks) {
    const int across = side_texels / kTintBlockTexels;
    LOAM_CHECK(side_texels % kTintBlockTexels == 0 &&
                   texels.size() == size_t(side_texels) * size_t(side_texels) &&
                   blocks.size() == size_t(across) * size_t(across),
               "a page of tints is whole blocks");
    // Most ground is of one tint over many blocks: those of one colour cost a comparison.
    uint32_t flat_key = 0xffffffffu;
    glm::uvec2 flat_block(0);
    for (int y = rect.y0; y < rect.y1; ++y)
        for (int x = rect.x0; x < rect.x1; ++x) {
            glm::vec3 tints[kTintBlockTexels * kTintBlockTexels];
            uint32_t first = 0;
            bool flat = true;
            for (int i = 0; i < kTintBlockTexels * kTintBlockTexels; ++i) {
                const IndexTexel& t =
                    texels[size_t(y * kTintBlockTexels + i / kTintBlockTexels) * size_t(side_texels) +
                           size_t(x * kTintBlockTexels + i % kTintBlockTexels)];
                const uint32_t key = uint32_t(t.tint[0]) << 16 | uint32_t(t.tint[1]) << 8 | t.tint[2];
                if (i == 0) first = key;
                flat = flat && key == first;
                tints[i] = glm::vec3(t.tint[0], t.tint[1], t.tint[2]) / 255.0f;
            }
            glm::uvec2& block = blocks[size_t(y) * size_t(across) + size_t(x)];
            if (flat && first == flat_key) {
                block = flat_block;
                continue;
            }
            block = encode(tints);
            if (flat) {
                flat_key = first;
                flat_block = block;
            }
        }
}

glm::vec3 shown_tint(glm::uvec2 block, int i) {
    return shared::bc1_decode(block, i);
}

}  // namespace loam
