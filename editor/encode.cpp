// File heads: .astc is Arm's (magic, block size, size in 24 bits each); .dds is Microsoft's DDS_HEADER with a
// four-character code.
#include "editor/encode.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <cstring>
#include <fstream>

#include "runtime/gpu/upload.h"
#include "runtime/texture/block_decoder.h"

namespace loam {

namespace {

constexpr int kBandTexels = 1 << 20;  // a band's, about: 4 MB up, 1 MB down

bool is_astc(BlockFormat format) {
    return format == BlockFormat::astc4x4 || format == BlockFormat::astc6x6;
}

Status encode_band(gpu::FrameRing& ring, const BlockEncoder& encoder, const RgbaImage& image, int first_row,
                   int rows, glm::vec3 weights, uint8_t* out, double& ms) {
    gpu::Device& device = ring.device();
    const glm::ivec2 size(image.width, rows);
    auto texels = gpu::Image::create(device, {.name = "picture",
                                              .format = VK_FORMAT_R8G8B8A8_UNORM,
                                              .width = static_cast<uint32_t>(size.x),
                                              .height = static_cast<uint32_t>(size.y),
                                              .usage = VK_IMAGE_USAGE_SAMPLED_BIT});
    if (!texels) return texels.error();
    const uint64_t bytes = encoder.bytes_of(size);
    auto blocks = gpu::Buffer::create(
        device, {.name = "blocks", .size_bytes = bytes, .usage = VK_BUFFER_USAGE_STORAGE_BUFFER_BIT});
    if (!blocks) return blocks.error();
    auto frame = ring.begin();
    if (!frame) return frame.error();
    const auto start = std::chrono::steady_clock::now();
    const size_t row_bytes = static_cast<size_t>(image.width) * 4;
    gpu::upload_to_image(ring, (*frame)->commands, *texels, 0, 0, 0, 0, static_cast<uint32_t>(size.x),
                         static_cast<uint32_t>(size.y),
                         std::as_bytes(std::span(image.rgba)
                                           .subspan(static_cast<size_t>(first_row) * row_bytes,
                                                    static_cast<size_t>(rows) * row_bytes)));
    encoder.cmd_encode((*frame)->commands, *texels, size, *blocks, weights);
    ring.read_back((*frame)->commands, *blocks, 0, bytes,
                   [out](std::span<const std::byte> got) { std::memcpy(out, got.data(), got.size()); });
    LOAM_TRY(ring.finish(**frame));
    ms += std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    return {};
}

void put_u32(std::vector<uint8_t>& out, uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) out.push_back(static_cast<uint8_t>(value >> shift));
}

std::vector<uint8_t> astc_head(const EncodedImage& encoded) {
    const auto side = static_cast<uint8_t>(shape_of(encoded.format).side_texels);
    std::vector<uint8_t> head = {0x13, 0xab, 0xa1, 0x5c, side, side, 1};
    for (const int value : {encoded.width, encoded.height, 1})
        for (int shift = 0; shift < 24; shift += 8) head.push_back(static_cast<uint8_t>(value >> shift));
    return head;
}

std::vector<uint8_t> dds_head(const EncodedImage& encoded) {
    constexpr uint32_t kCapsHeightWidthPixelFormatLinearSize = 0x81007, kFourCharacters = 4,
                       kTexture = 0x1000;
    const std::string_view code = encoded.format == BlockFormat::bc3   ? "DXT5"
                                  : encoded.format == BlockFormat::bc4 ? "ATI1"
                                                                       : "DXT1";
    std::vector<uint8_t> head = {'D', 'D', 'S', ' '};
    for (const uint32_t value :
         {124u, kCapsHeightWidthPixelFormatLinearSize, static_cast<uint32_t>(encoded.height),
          static_cast<uint32_t>(encoded.width), static_cast<uint32_t>(encoded.blocks.size()), 0u, 1u})
        put_u32(head, value);
    for (int i = 0; i < 11; ++i) put_u32(head, 0);
    put_u32(head, 32);
    put_u32(head, kFourCharacters);
    head.insert(head.end(), code.begin(), code.end());
    for (int i = 0; i < 5; ++i) put_u32(head, 0);
    put_u32(head, kTexture);
    for (int i = 0; i < 4; ++i) put_u32(head, 0);
    return head;
}

}  // namespace

Result<BlockFormat> parse_block_format(std::string_view name) {
    if (name == "bc1") return BlockFormat::bc1;
    if (name == "bc1-fine") return BlockFormat::bc1_fine;
    if (name == "bc3") return BlockFormat::bc3;
    if (name == "bc4") return BlockFormat::bc4;
    if (name == "astc4x4") return BlockFormat::astc4x4;
    if (name == "astc6x6") return BlockFormat::astc6x6;
    return error("unknown format \"{}\", expected bc1, bc1-fine, bc3, bc4, astc4x4 or astc6x6", name);
}

Result<EncodedImage> encode_image(gpu::Device& device, const RgbaImage& image, BlockFormat format,
                                  glm::vec3 weights) {
    auto encoder = BlockEncoder::create(device, format);
    if (!encoder) return encoder.error();
    auto ring = gpu::FrameRing::create(device, 2);
    if (!ring) return ring.error();
    const int side = shape_of(format).side_texels;
    EncodedImage encoded{.format = format, .width = image.width, .height = image.height, .blocks = {}};
    encoded.blocks.resize(encoder->bytes_of({image.width, image.height}));
    const int band = std::max(1, kBandTexels / image.width / side) * side;
    for (int row = 0; row < image.height; row += band)
        LOAM_TRY(encode_band(**ring, *encoder, image, row, std::min(band, image.height - row), weights,
                             &encoded.blocks[encoder->bytes_of({image.width, row})], encoded.encode_ms));
    encoded.mean_square = mean_square_errors(format, encoded.blocks, image.rgba, {image.width, image.height});
    return encoded;
}

RgbaImage decode_image(const EncodedImage& encoded) {
    RgbaImage image{encoded.width, encoded.height, {}};
    image.rgba.resize(static_cast<size_t>(encoded.width) * static_cast<size_t>(encoded.height) * 4);
    const BlockShape shape = shape_of(encoded.format);
    const int side = shape.side_texels, row = (encoded.width + side - 1) / side;
    std::array<glm::vec4, 36> texels;
    for (size_t block = 0; block * static_cast<size_t>(shape.bytes) < encoded.blocks.size(); ++block) {
        decode_block(encoded.format, &encoded.blocks[block * static_cast<size_t>(shape.bytes)],
                     texels.data());
        for (int i = 0; i < side * side; ++i) {
            const int x = static_cast<int>(block) % row * side + i % side,
                      y = static_cast<int>(block) / row * side + i / side;
            if (x >= encoded.width || y >= encoded.height) continue;
            for (int c = 0; c < 4; ++c)
                image.rgba[(static_cast<size_t>(y) * static_cast<size_t>(encoded.width) +
                            static_cast<size_t>(x)) *
                               4 +
                           static_cast<size_t>(c)] =
                    static_cast<uint8_t>(std::lround(texels[static_cast<size_t>(i)][c] * 255.0f));
        }
    }
    return image;
}

Status check_texture_name(const std::filesystem::path& file, BlockFormat format) {
    const std::string_view wanted = is_astc(format) ? ".astc" : ".dds";
    if (file.extension() != wanted)
        return error("cannot write {}: the name must end in {} for this format", file.string(), wanted);
    return {};
}

Status write_texture(const std::filesystem::path& file, const EncodedImage& encoded) {
    LOAM_TRY(check_texture_name(file, encoded.format));
    const std::vector<uint8_t> head = is_astc(encoded.format) ? astc_head(encoded) : dds_head(encoded);
    std::ofstream stream(file, std::ios::binary);
    for (const std::vector<uint8_t>* part : {&head, &encoded.blocks})
        stream.write(reinterpret_cast<const char*>(part->data()), static_cast<std::streamsize>(part->size()));
    stream.close();
    if (!stream) return error("cannot write {}: {}", file.string(), std::strerror(errno));
    return {};
}

}  // namespace loam
