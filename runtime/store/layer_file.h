// A layer's textures, packed for composition: one file a layer, each mip a zstd frame with checksum, so that
// it loads fast and a cut or changed byte is found. Sizes are powers of two, square, 4 … 4096.
//
// | texture | format | channels |
// | --- | --- | --- |
// | albedo_reveal | RGBA8 | albedo sRGB-encoded in RGB, reveal (height-like blend map, linear) in A |
// | normal_gloss_occlusion | RGBA8 | normal X, normal Y (tangent space, green up, 128 + 127 n), gloss (1 - roughness),
// occlusion | | metalness | R8 | metalness |
//
// Mips are box-filtered in linear light; normals are averaged and their shortening lowers the mip's gloss
// (Infinite Warfare talk, "Texture Packer").
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "runtime/base/result.h"

namespace loam {

struct LayerTextures {
    int size_texels = 0;
    int mip_count = 0;                                         // down to 1x1
    // [mip], 4 bytes a texel, row 0 south; those that were not loaded are empty.
    std::vector<std::vector<uint8_t>> albedo_reveal;
    std::vector<std::vector<uint8_t>> normal_gloss_occlusion;  // [mip], 4 bytes a texel
    std::vector<std::vector<uint8_t>> metalness;               // [mip], 1 byte a texel
    bool has_metal = false;                                    // any texel of metalness > 0
};

// Fills mips 1… of textures whose mip 0 is set (size_texels given).
void build_layer_mips(LayerTextures& textures);
[[nodiscard]] Status save_layer(const std::filesystem::path& file, const LayerTextures& textures);
// Mips finer than first_mip are passed over without reading them, but for the finest metalness, which says
// whether there is any.
[[nodiscard]] Result<LayerTextures> load_layer(const std::filesystem::path& file, int first_mip = 0);
// Texels a side, from the file's head alone.
[[nodiscard]] Result<int> layer_size(const std::filesystem::path& file);

}  // namespace loam
