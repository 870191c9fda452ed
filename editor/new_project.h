// `loam new`: an example project from a recipe, whole or not at all.
#pragma once

#include <filesystem>

#include "editor/recipe/make_project.h"

namespace loam {

struct NewProjectRequest {
    std::filesystem::path project;
    RecipeRequest recipe;
    int layer_size_texels = kRecipeLayerSize;  // a power of two, 64 … 2048
};
[[nodiscard]] Status create_project(const NewProjectRequest& request, const Progress& progress);

}  // namespace loam
