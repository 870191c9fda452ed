// Dresses bare heights: the recipe layers' texture files and an index map from slope, height, curvature and flow.
#pragma once

#include <filesystem>
#include <span>
#include <vector>

#include "editor/recipe/progress.h"
#include "runtime/base/result.h"
#include "runtime/document/operator.h"
#include "runtime/store/project.h"

namespace loam {

struct HeightField {
    int width = 0, height = 0; // samples, row 0 south
    double spacing_m = 1;
    std::span<const float> height_m;
    std::span<const float> flow_m2, deposit_m; // what a recipe knows besides; empty for imported heights
};

// The finest 2^k m from 0.25 to 64 that is no finer than a quarter of the heights' spacing and needs at most ~4,200 texels a side.
[[nodiscard]] double choose_index_spacing_m(double map_side_m, double height_spacing_m);

// Writes FOLDER/layers/*.layer and enters them in `settings`. Size 0: no layers.
Status make_layer_files(const std::filesystem::path& folder, ProjectSettings& settings, int size_texels, uint32_t seed,
                        const Progress& progress);
// The whole index map, `width` x `height` texels of settings.index_spacing_m, row 0 south.
Result<std::vector<IndexTexel>> make_index_texels(const ProjectSettings& settings, const HeightField& ground, int width,
                                                  int height, uint32_t seed, const Progress& progress);

} // namespace loam
