// Example materials by recipe: eight tileable layers. Each is built as height first (things laid on a wrapped
// height buffer, the highest wins), and everything else follows from it: normal, occlusion, reveal. Albedo
// comes from what lies there.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string_view>
#include <vector>

#include "runtime/base/result.h"
#include "runtime/store/layer_file.h"
#include "runtime/store/project.h"

namespace loam {

struct LayerRecipe {
    const char* name;
    const char* description;
    double tile_m;                                        // world size of one repeat
    double softness;                                      // underfoot
    std::array<double, kChannelNames.size()> channels{};  // seen on maps that choose them
};
[[nodiscard]] const std::vector<LayerRecipe>& layer_recipe_names();

inline constexpr int kRecipeLayerSize = 1024;

// `size` is a power of two, 64 … 2048. The same name, seed and size give the same bytes.
[[nodiscard]] Result<LayerTextures> make_layer(std::string_view name, uint32_t seed,
                                               int size = kRecipeLayerSize);

// Makes all eight and writes folder/layers/NAME.layer; returns their entries in the order of
// layer_recipe_names().
[[nodiscard]] Result<std::vector<LayerEntry>> make_layers_for(const std::filesystem::path& folder,
                                                              uint32_t seed = 1, int size = kRecipeLayerSize);

}  // namespace loam
