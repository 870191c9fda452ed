#include "editor/recipe/layers.h"

#include <bit>
#include <optional>
#include <string>
#include <system_error>

#include "editor/recipe/layer_canvas.h"
#include "runtime/base/job_queue.h"

namespace loam {

namespace {

using LayerFunction = LayerTextures (*)(uint32_t seed, int size);
constexpr LayerFunction kFunctions[] = {
    recipe::layer_grass, recipe::layer_dry_grass, recipe::layer_forest_floor,
    recipe::layer_dirt,  recipe::layer_scree,     recipe::layer_rock,
    recipe::layer_sand,  recipe::layer_snow};  // as layer_recipe_names()

}  // namespace

const std::vector<LayerRecipe>& layer_recipe_names() {
    static const std::vector<LayerRecipe> names = {
        {"grass", "green sward with clover", 2, 0.1},
        {"dry_grass", "straw-coloured grass over soil", 2, 0.08},
        {"forest_floor", "fallen leaves, needles and twigs", 2, 0.2},
        {"dirt", "trodden soil with clods and pebbles", 2, 0.25},
        {"scree", "angular stones of all sizes", 3, 0.03},
        {"rock", "fractured beds with cracks and lichen", 4, 0},
        {"sand", "wind-rippled sand", 2, 0.6, {0, 0, 0, 0.4}},
        {"snow", "wind-packed snow", 3, 1, {0.8, 0, 0, 0.7}},
    };
    return names;
}

Result<LayerTextures> make_layer(std::string_view name, uint32_t seed, int size) {
    if (size < 64 || size > 2048 || !std::has_single_bit(static_cast<unsigned>(size)))
        return error("a layer size of {} is not a power of two from 64 to 2048", size);
    const auto& names = layer_recipe_names();
    for (size_t k = 0; k < names.size(); ++k)
        if (name == names[k].name) return kFunctions[k](recipe::hash(seed, static_cast<uint32_t>(k)), size);
    std::string known;
    for (const LayerRecipe& n : names) known += (known.empty() ? "" : ", ") + std::string(n.name);
    return error("there is no layer recipe \"{}\"; there are {}", name, known);
}

Result<std::vector<LayerEntry>> make_layers_for(const std::filesystem::path& folder, uint32_t seed,
                                                int size) {
    std::error_code code;
    std::filesystem::create_directories(folder / "layers", code);
    if (code) return error("cannot make folder {}: {}", (folder / "layers").string(), code.message());
    const auto& names = layer_recipe_names();
    std::vector<LayerEntry> entries;
    for (const LayerRecipe& n : names)
        entries.push_back({.name = n.name,
                           .file = "layers/" + std::string(n.name) + ".layer",
                           .tile_m = n.tile_m,
                           .channels = n.channels,
                           .softness = n.softness});
    std::vector<std::optional<Error>> faults(names.size());
    const int count = static_cast<int>(names.size());
    parallel_ranges(count, 1, [&](int begin, int end) {
        for (int k = begin; k < end; ++k) {
            const size_t at = static_cast<size_t>(k);
            auto textures = make_layer(names[at].name, seed, size);
            const Status saved =
                textures ? save_layer(folder / entries[at].file, *textures) : Status(textures.error());
            if (!saved) faults[at] = saved.error();
        }
    });
    for (auto& fault : faults)
        if (fault) return *fault;
    return entries;
}

}  // namespace loam
