// Mips of a layer's textures: 2x2 boxes, colours in linear light, normals by their vector mean. What the mean
// lost in length is spread of direction, which goes into the gloss, so that distant ground does not glitter.
// Source: the Infinite Warfare talk ("Texture Packer"); how much is shaders/texture/layer_math.h.
#include <algorithm>
#include <cmath>

#include "runtime/base/check.h"
#include "runtime/base/srgb.h"
#include "runtime/store/layer_file.h"
#include "shaders/texture/layer_math.h"

namespace loam {

namespace {

uint8_t byte_of(double share) {
    return uint8_t(std::clamp(share, 0.0, 1.0) * 255.0 + 0.5);
}

// The four texels under texel (x, y) of a mip of `side` texels.
struct Quad {
    size_t at[4];
    Quad(int x, int y, int side) {
        for (int i = 0; i < 4; ++i) at[i] = size_t(2 * y + i / 2) * size_t(2 * side) + size_t(2 * x + i % 2);
    }
};

void shrink_albedo(const uint8_t* fine, uint8_t* coarse, const Quad& quad) {
    for (size_t channel = 0; channel < 3; ++channel) {
        double sum = 0;
        for (const size_t at : quad.at) sum += linear_of_srgb8(fine[4 * at + channel]);
        coarse[channel] = srgb8_of_linear(sum / 4);
    }
    int reveal = 0;
    for (const size_t at : quad.at) reveal += fine[4 * at + 3];
    coarse[3] = uint8_t((reveal + 2) / 4);
}

void shrink_normal(const uint8_t* fine, uint8_t* coarse, const Quad& quad) {
    double x = 0, y = 0, z = 0, alpha2 = 0;
    int occlusion = 0;
    for (const size_t at : quad.at) {
        const uint8_t* t = fine + 4 * at;
        const shared::vec3 n = shared::layer_normal_of_xy(
            {shared::layer_decode_signed(float(t[0]) / 255), shared::layer_decode_signed(float(t[1]) / 255)});
        x += n.x / 4;
        y += n.y / 4;
        z += n.z / 4;
        alpha2 += shared::layer_alpha2_of_gloss(float(t[2]) / 255) / 4;
        occlusion += t[3];
    }
    const double length = std::min(1.0, std::sqrt(x * x + y * y + z * z));
    if (length < 1 - 1e-5) alpha2 += shared::layer_spread_alpha2(float(length));
    const double scale = length > 1e-6 ? 1 / length : 0;
    coarse[0] = byte_of(shared::layer_encode_signed(float(x * scale)));
    coarse[1] = byte_of(shared::layer_encode_signed(float(y * scale)));
    coarse[2] = byte_of(shared::layer_gloss_of_alpha2(float(alpha2)));
    coarse[3] = uint8_t((occlusion + 2) / 4);
}

void shrink_metal(const uint8_t* fine, uint8_t* coarse, const Quad& quad) {
    int sum = 0;
    for (const size_t at : quad.at) sum += fine[at];
    *coarse = uint8_t((sum + 2) / 4);
}

}  // namespace

void build_layer_mips(LayerTextures& textures) {
    const int size = textures.size_texels;
    LOAM_CHECK(size >= 4 && size <= 4096 && (size & (size - 1)) == 0,
               "layer size must be a power of two, 4 … 4096");
    LOAM_CHECK(!textures.albedo_reveal.empty() && !textures.normal_gloss_occlusion.empty() &&
                   !textures.metalness.empty(),
               "mip 0 of a layer is missing");
    const size_t texels = size_t(size) * size_t(size);
    LOAM_CHECK(textures.albedo_reveal[0].size() == 4 * texels &&
                   textures.normal_gloss_occlusion[0].size() == 4 * texels &&
                   textures.metalness[0].size() == texels,
               "mip 0 of a layer has a wrong size");
    textures.mip_count = 1;
    while (size >> textures.mip_count > 0) ++textures.mip_count;
    const size_t mips = size_t(textures.mip_count);
    textures.albedo_reveal.resize(mips);
    textures.normal_gloss_occlusion.resize(mips);
    textures.metalness.resize(mips);
    for (size_t mip = 1; mip < mips; ++mip) {
        const int side = size >> mip;
        const size_t count = size_t(side) * size_t(side);
        textures.albedo_reveal[mip].resize(4 * count);
        textures.normal_gloss_occlusion[mip].resize(4 * count);
        textures.metalness[mip].resize(count);
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x) {
                const Quad quad(x, y, side);
                const size_t to = size_t(y) * size_t(side) + size_t(x);
                shrink_albedo(textures.albedo_reveal[mip - 1].data(), &textures.albedo_reveal[mip][4 * to],
                              quad);
                shrink_normal(textures.normal_gloss_occlusion[mip - 1].data(),
                              &textures.normal_gloss_occlusion[mip][4 * to], quad);
                shrink_metal(textures.metalness[mip - 1].data(), &textures.metalness[mip][to], quad);
            }
    }
    textures.has_metal = std::any_of(textures.metalness[0].begin(), textures.metalness[0].end(),
                                     [](uint8_t m) { return m > 0; });
}

}  // namespace loam
