// A whole example project: ground, layers, index map, written into a new folder.
#pragma once

#include <filesystem>

#include "editor/recipe/ground.h"
#include "editor/recipe/layers.h"
#include "editor/recipe/progress.h"
#include "runtime/base/result.h"

namespace loam {

class Document;

// `folder` must not hold a project yet (Document::create refuses).
[[nodiscard]] Status make_project(const std::filesystem::path& folder, const RecipeRequest& request,
                                  const Progress& progress, int layer_size_texels = kRecipeLayerSize);

// Gives a document (an imported height map) the index map that the recipes' rules make of its heights. Its
// layers must be those of layer_recipe_names(), in that order (make_layers_for).
[[nodiscard]] Status make_index_from_heights(Document& document, const Progress& progress);

}  // namespace loam
