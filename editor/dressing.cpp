#include "editor/dressing.h"

#include <algorithm>
#include <cmath>

#include "editor/recipe/layers.h"
#include "runtime/base/check.h"

namespace loam {

double choose_index_spacing_m(double map_side_m, double height_spacing_m) {
    constexpr double kMostTexels = 4200; // 17 million texels: a few seconds to make
    double spacing_m = 0.25;
    while (spacing_m < 64 && (spacing_m < height_spacing_m / 4 || map_side_m / spacing_m > kMostTexels)) spacing_m *= 2;
    return spacing_m;
}

Status make_layer_files(const std::filesystem::path& folder, ProjectSettings& settings, int size_texels, uint32_t seed,
                        const Progress& progress) {
    if (size_texels == 0) return {};
    LOAM_TRY(step_progress(progress, 0.0, "making layers"));
    auto layers = make_layers_for(folder, seed, size_texels);
    if (!layers) return layers.error();
    settings.layers = *layers;
    return step_progress(progress, 1.0, "making layers");
}

} // namespace loam
