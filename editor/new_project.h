// `loam new`: an example project from a recipe.
#pragma once

#include <filesystem>

#include "editor/recipe/ground.h"

namespace loam {

struct NewProjectRequest {
    std::filesystem::path project;
    RecipeRequest recipe;
    int layer_size_texels = 1024; // 0: no layers
};
// The project appears whole or not at all.
[[nodiscard]] Status make_project(const NewProjectRequest& request, const Progress& progress);

} // namespace loam
