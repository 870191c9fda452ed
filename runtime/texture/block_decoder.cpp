#include "runtime/texture/block_decoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include "runtime/texture/astc_decoder.h"
#include "shaders/texture/bc1.h"
#include "shaders/texture/bc4.h"

namespace loam {

namespace {

// In the mode of three colours, whose first endpoint is the smaller, index 3 is black.
glm::vec3 bc1_texel(glm::uvec2 block, int i) {
    const uint32_t c0 = block.x & 0xffffu, c1 = block.x >> 16u, index = block.y >> uint32_t(i * 2) & 3u;
    if (c0 > c1 || index < 2) return shared::bc1_decode(block, i);
    return index == 2 ? (shared::bc1_unpack565(c0) + shared::bc1_unpack565(c1)) * 0.5f : glm::vec3(0);
}

}  // namespace

void decode_block(BlockFormat format, const uint8_t* block, glm::vec4* texels) {
    std::array<uint32_t, 4> words{};
    const BlockShape shape = shape_of(format);
    std::memcpy(words.data(), block, size_t(shape.bytes));
    if (format == BlockFormat::astc4x4 || format == BlockFormat::astc6x6) {
        astc_decode_block(words, shape.side_texels, texels);
        return;
    }
    for (int i = 0; i < 16; ++i) switch (format) {
            case BlockFormat::bc3:
                texels[i] = glm::vec4(shared::bc1_decode({words[2], words[3]}, i),
                                      shared::bc4_decode({words[0], words[1]}, i));
                break;
            case BlockFormat::bc4:
                texels[i] = glm::vec4(shared::bc4_decode({words[0], words[1]}, i), 0, 0, 1);
                break;
            default:
                texels[i] = glm::vec4(bc1_texel({words[0], words[1]}, i), 1);
        }
}

glm::dvec4 mean_square_errors(BlockFormat format, std::span<const uint8_t> blocks,
                              std::span<const uint8_t> rgba, glm::ivec2 size_texels) {
    const BlockShape shape = shape_of(format);
    const glm::ivec2 count = (size_texels + shape.side_texels - 1) / shape.side_texels;
    glm::dvec4 sum(0);
    std::array<glm::vec4, 36> texels;
    for (int by = 0; by < count.y; ++by)
        for (int bx = 0; bx < count.x; ++bx) {
            decode_block(format, &blocks[(size_t(by) * size_t(count.x) + size_t(bx)) * size_t(shape.bytes)],
                         texels.data());
            for (int i = 0; i < shape.side_texels * shape.side_texels; ++i) {
                const int x = bx * shape.side_texels + i % shape.side_texels,
                          y = by * shape.side_texels + i / shape.side_texels;
                if (x >= size_texels.x || y >= size_texels.y) continue;
                const uint8_t* at = &rgba[(size_t(y) * size_t(size_texels.x) + size_t(x)) * 4];
                const glm::dvec4 d =
                    glm::dvec4(texels[size_t(i)]) * 255.0 - glm::dvec4(at[0], at[1], at[2], at[3]);
                sum += d * d;
            }
        }
    return sum / (double(size_texels.x) * size_texels.y);
}

double decibels(double mean_square_error) {
    return mean_square_error > 0 ? std::min(99.0, 10 * std::log10(255.0 * 255.0 / mean_square_error)) : 99.0;
}

}  // namespace loam
