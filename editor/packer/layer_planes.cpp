#include "editor/packer/layer_planes.h"

#include <algorithm>
#include <cmath>

#include "runtime/base/srgb.h"
#include "shaders/texture/layer_math.h"

namespace loam {

namespace {

uint8_t byte_of(float share) {
    return static_cast<uint8_t>(std::lround(std::clamp(share, 0.0f, 1.0f) * 255.0f));
}

}  // namespace

LayerTextures textures_of(const LayerPlanes& planes) {
    const size_t count = planes.albedo.size();
    LayerTextures textures;
    textures.size_texels = planes.size_texels;
    textures.albedo_reveal.assign(1, std::vector<uint8_t>(4 * count));
    textures.normal_gloss_occlusion.assign(1, std::vector<uint8_t>(4 * count));
    textures.metalness.assign(1, std::vector<uint8_t>(count));
    for (size_t i = 0; i < count; ++i) {
        uint8_t* color = &textures.albedo_reveal[0][4 * i];
        for (int c = 0; c < 3; ++c) color[c] = byte_of(srgb_of_linear(planes.albedo[i][c]));
        color[3] = byte_of(planes.reveal[i]);
        uint8_t* surface = &textures.normal_gloss_occlusion[0][4 * i];
        surface[0] = byte_of(shared::layer_encode_signed(planes.normal[i].x));
        surface[1] = byte_of(shared::layer_encode_signed(planes.normal[i].y));
        surface[2] = byte_of(planes.gloss[i]);
        surface[3] = byte_of(planes.occlusion[i]);
        textures.metalness[0][i] = byte_of(planes.metalness[i]);
    }
    build_layer_mips(textures);
    return textures;
}

LayerPlanes planes_of(const LayerTextures& textures) {
    const size_t count = textures.metalness[0].size();
    LayerPlanes planes;
    planes.size_texels = textures.size_texels;
    planes.albedo.resize(count);
    planes.normal.resize(count);
    for (auto* plane : {&planes.gloss, &planes.occlusion, &planes.reveal, &planes.metalness})
        plane->resize(count);
    for (size_t i = 0; i < count; ++i) {
        const uint8_t* color = &textures.albedo_reveal[0][4 * i];
        for (int c = 0; c < 3; ++c) planes.albedo[i][c] = linear_of_srgb(static_cast<float>(color[c]) / 255);
        planes.reveal[i] = static_cast<float>(color[3]) / 255;
        const uint8_t* surface = &textures.normal_gloss_occlusion[0][4 * i];
        const float x = shared::layer_decode_signed(static_cast<float>(surface[0]) / 255);
        const float y = shared::layer_decode_signed(static_cast<float>(surface[1]) / 255);
        planes.normal[i] = shared::layer_normal_of_xy(shared::vec2(x, y));
        planes.gloss[i] = static_cast<float>(surface[2]) / 255;
        planes.occlusion[i] = static_cast<float>(surface[3]) / 255;
        planes.metalness[i] = static_cast<float>(textures.metalness[0][i]) / 255;
    }
    return planes;
}

}  // namespace loam
