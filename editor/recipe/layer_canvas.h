// The buffer that layer recipes draw on: height and albedo, wrapped at its edges, twice as fine as the layer
// so that blades and stones get smooth edges when it is averaged down.
//
// All lengths are in tile units (1 = the whole tile), heights too: the recipe does not know the size in
// texels.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "editor/recipe/noise.h"
#include "runtime/store/layer_file.h"

namespace loam::recipe {

class Canvas {
  public:
    explicit Canvas(int size);

    [[nodiscard]] int size() const { return size_; }
    struct Texel {
        float height = -1;
        float gloss = 0;
        glm::vec3 albedo{0};  // linear
    };
    [[nodiscard]] Texel& at(int i, int j) {
        return texels_[static_cast<size_t>(j & mask_) * size_ + (i & mask_)];
    }
    // Sets every texel to f(u, v), 0 <= u, v < 1.
    template <typename F>
    void fill(F&& f) {
        const float step = 1.0f / static_cast<float>(size_);
        for (int j = 0; j < size_; ++j)
            for (int i = 0; i < size_; ++i)
                at(i, j) = f((static_cast<float>(i) + 0.5f) * step, (static_cast<float>(j) + 0.5f) * step);
    }
    // For every texel within `radius` of (x, y): f(dx, dy, texel) with the offset from the centre; wraps.
    template <typename F>
    void around(float x, float y, float radius, F&& f) {
        const float n = static_cast<float>(size_);
        const int reach = static_cast<int>(radius * n) + 1, ci = static_cast<int>(x * n),
                  cj = static_cast<int>(y * n);
        for (int j = cj - reach; j <= cj + reach; ++j)
            for (int i = ci - reach; i <= ci + reach; ++i)
                f((static_cast<float>(i) + 0.5f) / n - x, (static_cast<float>(j) + 0.5f) / n - y, at(i, j));
    }

    // A blade, needle or twig: from (x, y) in direction `angle`, bending by `bend` radians over its length,
    // tapering.
    struct Stroke {
        float x, y, angle, bend, length, width;
        float root_height, tip_height;  // and an arch between them
        float arch = 0;
        glm::vec3 root_colour, tip_colour;
        float gloss = 0.3f;
        float taper = 1;  // 1: ends in a point, 0: blunt
        float keel = 0;   // > 0: folded along the middle (grass), 0: round (twig)
    };
    void draw(const Stroke& stroke);

    // An angular stone: cut from a disc by planes, with a tilted, faceted top.
    struct Stone {
        float x, y, radius, bottom, thickness;
        glm::vec3 colour;
        float gloss = 0.25f;
        float roundness = 0;  // 0 angular, 1 a pebble
        uint32_t seed = 0;
    };
    void draw(const Stone& stone);

    // A fallen leaf: outline with lobes, midrib and veins, curled and tilted.
    struct Leaf {
        float x, y, angle, length, width, bottom;
        float lobes = 0;  // 0: smooth outline; else lobes a side, as of an oak
        float curl = 0.2f;
        glm::vec3 colour;
        uint32_t seed = 0;
    };
    void draw(const Leaf& leaf);

  private:
    int size_, mask_;
    std::vector<Texel> texels_;
};

struct Finish {
    float relief = 1;       // heights are multiplied by this for normal and occlusion
    float cavity = 0.45f;   // how much occlusion darkens the albedo (light bounced among grains)
    float flatten = 0.85f;  // share of the brightness' blotches larger than 1/8 of the tile that is removed
    glm::vec3 mean_albedo{0.2f};  // linear; the result's mean
    float contrast = 1;           // of albedo around its mean
};
// Averages down, derives normal, occlusion and reveal, builds the mips.
[[nodiscard]] LayerTextures finished(Canvas& canvas, const Finish& finish);

// One function a layer (layers_plants.cpp, layers_stones.cpp, layers_fine.cpp); `size` is the layer's.
LayerTextures layer_grass(uint32_t seed, int size);
LayerTextures layer_dry_grass(uint32_t seed, int size);
LayerTextures layer_forest_floor(uint32_t seed, int size);
LayerTextures layer_dirt(uint32_t seed, int size);
LayerTextures layer_scree(uint32_t seed, int size);
LayerTextures layer_rock(uint32_t seed, int size);
LayerTextures layer_sand(uint32_t seed, int size);
LayerTextures layer_snow(uint32_t seed, int size);

}  // namespace loam::recipe
