// Pictures as block-compressed textures: .astc for mobile devices, .dds elsewhere. The blocks come from the
// GPU encoder that baking uses; what they lose is measured by decoding them again on the CPU.
#pragma once

#include <filesystem>
#include <span>
#include <string_view>

#include "editor/image_file.h"
#include "runtime/texture/block_encoder.h"

namespace loam {

inline constexpr int kMaxEncodeSide = 16384;

[[nodiscard]] Result<BlockFormat> parse_block_format(std::string_view name);  // bc1, bc1-fine, bc3, … astc6x6

// Row 0 of the picture is the first row of blocks.
struct EncodedImage {
    BlockFormat format = BlockFormat::bc1;
    int width = 0, height = 0;
    std::vector<uint8_t> blocks;
    double encode_ms = 0;         // submit to fence, upload and download included
    glm::dvec4 mean_square{0.0};  // of each channel's error, in steps of 255
};
// Encodes in bands of rows, so that a large picture takes no more device memory than a small one.
[[nodiscard]] Result<EncodedImage> encode_image(gpu::Device& device, const RgbaImage& image,
                                                BlockFormat format, glm::vec3 weights);
[[nodiscard]] RgbaImage decode_image(const EncodedImage& encoded);

// ASTC to .astc, the others to .dds; another extension is refused.
[[nodiscard]] Status check_texture_name(const std::filesystem::path& file, BlockFormat format);
[[nodiscard]] Status write_texture(const std::filesystem::path& file, const EncodedImage& encoded);

}  // namespace loam
