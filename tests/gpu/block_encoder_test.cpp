// The block encoders in compute give the blocks that the same code gives as C++, on ordinary and on hard
// texels.
#include <cstring>
#include <limits>
#include <random>

#include "runtime/base/check.h"
#include "runtime/gpu/frame_ring.h"
#include "runtime/gpu/upload.h"
#include "runtime/texture/block_decoder.h"
#include "shaders/texture/astc.h"
#include "shaders/texture/bc1_fine.h"
#include "shaders/texture/bc3.h"
#include "tests/gpu/test_device.h"

namespace {

using namespace loam;
using Words = std::vector<uint32_t>;
using Page = std::vector<glm::vec4>;

constexpr int kSide = 256;
constexpr glm::vec3 kWeights(0.7f, 1.0f, 0.4f);

template <typename T>
T need(Result<T> result) {
    LOAM_CHECK(result.ok(), result.ok() ? "" : result.message());
    return std::move(result.value());
}
void need(const Status& status) {
    LOAM_CHECK(status.ok(), status.ok() ? "" : status.message());
}

Words on_gpu(BlockFormat format, const Page& page) {
    gpu::Device& device = gpu::test_device();
    const BlockEncoder encoder = need(BlockEncoder::create(device, format));
    auto ring = need(gpu::FrameRing::create(device, 2));
    auto image = need(gpu::Image::create(device, {.name = "page",
                                                  .format = VK_FORMAT_R32G32B32A32_SFLOAT,
                                                  .width = kSide,
                                                  .height = kSide,
                                                  .usage = VK_IMAGE_USAGE_SAMPLED_BIT}));
    const glm::ivec2 size(kSide);
    auto blocks = need(gpu::Buffer::create(device, {.name = "blocks",
                                                    .size_bytes = encoder.bytes_of(size),
                                                    .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}));
    Words words(encoder.bytes_of(size) / 4);
    gpu::Frame* frame = need(ring->begin());
    gpu::upload_to_image(*ring, frame->commands, image, 0, 0, 0, 0, kSide, kSide,
                         std::as_bytes(std::span(page)));
    encoder.cmd_encode(frame->commands, image, size, blocks, kWeights);
    ring->read_back(frame->commands, blocks, 0, words.size() * 4, [&](std::span<const std::byte> bytes) {
        std::memcpy(words.data(), bytes.data(), bytes.size());
    });
    need(ring->finish(*frame));
    return words;
}

Words on_cpu(BlockFormat format, const Page& page) {
    const int side = shape_of(format).side_texels, blocks = (kSide + side - 1) / side;
    Words words;
    const auto put = [&words](auto bits) {
        for (int i = 0; i < bits.length(); ++i) words.push_back(bits[i]);
    };
    for (int by = 0; by < blocks; ++by)
        for (int bx = 0; bx < blocks; ++bx) {
            if (format == BlockFormat::astc4x4 || format == BlockFormat::astc6x6) {
                shared::AstcEncoder encoder{};
                for (int i = 0; i < side * side; ++i) {
                    const int x = std::min(bx * side + i % side, kSide - 1),
                              y = std::min(by * side + i / side, kSide - 1);
                    encoder.astc_texels[i] = page[size_t(y * kSide + x)];
                }
                put(encoder.astc_encode(side, kWeights));
                continue;
            }
            glm::vec4 texels[16];
            glm::vec3 colours[16];
            float reds[16];
            for (int i = 0; i < 16; ++i) {
                texels[i] = page[size_t((by * 4 + i / 4) * kSide + bx * 4 + i % 4)];
                colours[i] = glm::vec3(texels[i]);
                reds[i] = texels[i].x;
            }
            switch (format) {
                case BlockFormat::bc1:
                    put(shared::bc1_encode(colours, kWeights));
                    break;
                case BlockFormat::bc1_fine:
                    put(shared::bc1_encode_fine(colours, kWeights));
                    break;
                case BlockFormat::bc3:
                    put(shared::bc3_encode(texels, kWeights));
                    break;
                case BlockFormat::bc4:
                    put(shared::bc4_encode(reds));
                    break;
                case BlockFormat::astc4x4:
                case BlockFormat::astc6x6:
                    break;
            }
        }
    return words;
}

// Blocks of 8² texels of each kind: flat, two colours, one outlier at each place, alternating extremes, all
// 0, all 1, smooth, noise, what is no number.
Page hard_page(uint32_t seed) {
    std::mt19937 random(seed);
    const auto byte = [&] { return float(random() % 256) / 255.0f; };
    const auto colour = [&] { return glm::vec4(byte(), byte(), byte(), byte()); };
    constexpr float kBad[4] = {std::numeric_limits<float>::quiet_NaN(),
                               std::numeric_limits<float>::infinity(),
                               -std::numeric_limits<float>::infinity(), -2.5f};
    Page page(kSide * kSide);
    for (int ty = 0; ty < kSide; ty += 8)
        for (int tx = 0; tx < kSide; tx += 8) {
            const int kind = (tx / 8 + ty / 8 * 3) % 9;
            const glm::vec4 a = colour(), b = colour(), c = colour();
            const int outlier = (tx / 8 + ty / 8) % 16;
            for (int i = 0; i < 64; ++i) {
                const int x = i % 8, y = i / 8;
                glm::vec4& texel = page[size_t((ty + y) * kSide + tx + x)];
                switch (kind) {
                    case 0:
                        texel = a;
                        break;
                    case 1:
                        texel = random() % 2 ? a : b;
                        break;
                    case 2:
                        texel = (y % 4) * 4 + x % 4 == outlier ? a : b;
                        break;
                    case 3:
                        texel = glm::vec4(float((x + y) % 2));
                        break;
                    case 4:
                        texel = glm::vec4(float(tx / 8 % 2));
                        break;
                    case 5:
                        texel = a + (b - a) * (float(x) / 7) + (c - a) * (float(y) / 14);
                        break;
                    case 6:
                        texel = colour();
                        break;
                    case 7:
                        texel = a * 0.9f + colour() * 0.05f;
                        break;
                    default:
                        texel = colour(), texel[int(random() % 4)] = kBad[random() % 4];
                        break;
                }
            }
        }
    return page;
}

// Mean of the channels' weighted squared errors in steps of 255, of decoded blocks.
double mean_error(BlockFormat format, const Words& words, const Page& page) {
    glm::vec4 weights(kWeights, format == BlockFormat::bc1 || format == BlockFormat::bc1_fine ? 0.0f : 1.0f);
    if (format == BlockFormat::bc4) weights = {1, 0, 0, 0};
    const BlockShape shape = shape_of(format);
    const int side = shape.side_texels, row = (kSide + side - 1) / side;
    double sum = 0;
    std::vector<glm::vec4> shown(size_t(side * side));
    for (size_t block = 0; block * size_t(shape.bytes) < words.size() * 4; ++block) {
        decode_block(format, reinterpret_cast<const uint8_t*>(words.data()) + block * size_t(shape.bytes),
                     shown.data());
        for (int i = 0; i < side * side; ++i) {
            const int x = int(block) % row * side + i % side, y = int(block) / row * side + i / side;
            if (x >= kSide || y >= kSide) continue;
            const glm::vec4& texel = page[size_t(y * kSide + x)];
            const glm::vec4 clean(shared::block_unit3(texel), shared::block_unit(texel.w));
            const glm::vec4 d = shown[size_t(i)] - clean;
            sum += double(glm::dot(d * d, weights)) * 255 * 255;
        }
    }
    return sum / (kSide * kSide);
}

class EachFormat : public gpu::GpuTest, public ::testing::WithParamInterface<BlockFormat> {};

TEST_P(EachFormat, GivesTheBlocksOfTheSameCodeAsCpp) {
    const Page page = hard_page(1);
    Page changed = page;
    for (glm::vec4& texel : changed) texel = glm::vec4(texel.y, texel.x, texel.z, texel.w * 0.5f);
    const Words got = on_gpu(GetParam(), page), expected = on_cpu(GetParam(), page),
                other = on_cpu(GetParam(), changed);
    ASSERT_EQ(got.size(), expected.size());
    const size_t words = size_t(shape_of(GetParam()).bytes) / 4;
    size_t different = 0, control = 0;
    for (size_t i = 0; i < got.size(); i += words) {
        different += std::memcmp(&got[i], &expected[i], words * 4) != 0;
        control += std::memcmp(&got[i], &other[i], words * 4) != 0;
    }
    // Where two attempts are equally good or an endpoint lies between two steps, the last bit of a sum
    // decides, and compilers may sum in another order: such blocks are few and no worse.
    EXPECT_LE(different, got.size() / words / 200);
    const double error = mean_error(GetParam(), got, page), other_error = mean_error(GetParam(), other, page);
    EXPECT_NEAR(error, mean_error(GetParam(), expected, page), error * 1e-4);
    EXPECT_GT(other_error, error * 1.1);
    EXPECT_GT(control, got.size() / words / 2) << "other texels give other blocks";
}

const char* name_of(BlockFormat format) {
    switch (format) {
        case BlockFormat::bc1:
            return "Bc1";
        case BlockFormat::bc1_fine:
            return "Bc1Fine";
        case BlockFormat::bc3:
            return "Bc3";
        case BlockFormat::bc4:
            return "Bc4";
        case BlockFormat::astc4x4:
            return "Astc4x4";
        case BlockFormat::astc6x6:
            return "Astc6x6";
    }
    return "Unknown";
}

INSTANTIATE_TEST_SUITE_P(BlockEncoder, EachFormat,
                         ::testing::Values(BlockFormat::bc1, BlockFormat::bc1_fine, BlockFormat::bc3,
                                           BlockFormat::bc4, BlockFormat::astc4x4, BlockFormat::astc6x6),
                         [](const auto& format) { return std::string(name_of(format.param)); });

}  // namespace
