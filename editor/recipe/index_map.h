// Which layer lies where: rules from height, slope, curvature, flow and deposits, with borders ragged at 1–10
// m, and a tint that varies gently over hundreds of metres.
#pragma once

#include <cstdint>
#include <vector>

#include "editor/recipe/ground.h"
#include "runtime/store/index_texel.h"

namespace loam {

enum class Climate { alpine, temperate, desert };

struct IndexRequest {
    const GroundMaps* maps = nullptr;
    Climate climate = Climate::alpine;
    uint32_t seed = 1;
    double spacing_m = 1;  // of index texels; texel (i, j) covers [i, i+1) × [j, j+1) spacings
    int width = 0, height = 0;
};

// 2^k metres, the finest (from 0.25) with which `size_m` needs at most 4,200 texels a side.
[[nodiscard]] double recipe_index_spacing_m(double size_m);
[[nodiscard]] Climate recipe_climate(const std::string& recipe);

// Layers are numbered as in layer_recipe_names(). Prepares what rows share once; rows may then be asked for
// in any order.
class IndexPainter {
  public:
    explicit IndexPainter(const IndexRequest& request);
    void paint_rows(int first_row, int row_count, IndexTexel* out) const;

  private:
    IndexRequest request_;
    float snow_line_m_ = 1e9f, tree_line_m_ = 1e9f;
    std::vector<float> wet_;    // log2 of the catchment in units of 100 m², spread over some metres
    std::vector<float> steep_;  // slope, spread
    [[nodiscard]] IndexTexel texel_at(float x_m, float y_m) const;
};

}  // namespace loam
