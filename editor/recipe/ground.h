// Example grounds by recipe: a name, a size and a seed become heights, and beside them what the making knew
// about flow and deposits, which the index map wants (index_map.h). The same request gives the same bits on
// one machine, with any number of threads.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "editor/recipe/progress.h"
#include "runtime/base/result.h"

namespace loam {

struct RecipeRequest {
    std::string name = "valley";
    double size_m = 4096;  // side of the square, 64 … 16,800
    uint32_t seed = 1;
};

// Square grids, row 0 south, sample (i, j) at (i, j) * spacing_m.
struct GroundMaps {
    int size = 0;  // samples a side
    double spacing_m = 1;
    std::vector<float> height_m;
    std::vector<float> flow_m2;    // catchment of each sample
    std::vector<float> deposit_m;  // loose material laid down: fans, floors, scree
    std::vector<float> slope;      // rise over run
    std::vector<float> curvature;  // 1/m, > 0 in hollows
};

struct RecipeName {
    const char* name;
    const char* description;
};
[[nodiscard]] const std::vector<RecipeName>& ground_recipe_names();

// 0.5, 1, 2, 4 or 8 m: the finest with which `size_m` needs no more than 2,101 samples a side, so that 16.8
// km cost as much as 4 km.
[[nodiscard]] double recipe_spacing_m(double size_m);

[[nodiscard]] Result<GroundMaps> make_ground(const RecipeRequest& request, const Progress& progress);

}  // namespace loam
