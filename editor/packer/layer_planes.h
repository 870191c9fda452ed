// A layer's textures before they are rounded to bytes: what the packer measures formats against.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

#include "runtime/store/layer_file.h"

namespace loam {

struct LayerPlanes {  // row 0 is south
    int size_texels = 0;
    std::vector<glm::vec3> albedo;  // linear; with metalness, the metal's colour too
    std::vector<glm::vec3> normal;  // unit, z ≥ 0
    std::vector<float> gloss, occlusion, reveal, metalness;
};

// With mips.
[[nodiscard]] LayerTextures textures_of(const LayerPlanes& planes);
// Of mip 0.
[[nodiscard]] LayerPlanes planes_of(const LayerTextures& textures);

}  // namespace loam
