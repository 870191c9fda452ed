#include "editor/cli/progress_line.h"
#include "editor/cli/verb.h"
#include "editor/new_project.h"

namespace loam::cli {

namespace {

Status run(const Args& args) {
    NewProjectRequest request;
    request.project = args.positional(0);
    request.recipe.name = args.text("--recipe", "valley");
    request.recipe.size_m = args.number("--size", 4096);
    request.recipe.seed = static_cast<uint32_t>(args.integer("--seed", 1));
    request.layer_size_texels = args.integer("--layer-size", 1024);
    ProgressLine progress;
    return create_project(request, progress.callback());
}

std::string recipe_notes() {
    std::string notes = "Recipes:";
    for (const RecipeName& recipe : ground_recipe_names())
        notes += fmt::format("\n  {:<8} {}", recipe.name, recipe.description);
    return notes;
}

}  // namespace

Verb new_verb() {
    static const std::string notes = recipe_notes();
    return {
        .name = "new",
        .summary = "makes an example project from a recipe",
        .positionals = {{"PROJECT", "folder to create"}},
        .options = {{"--recipe", ValueKind::text, "NAME", "which ground; default valley"},
                    {"--size", ValueKind::number, "M", "side of the map in metres, 64 … 16800; default 4096"},
                    {"--seed", ValueKind::integer, "N", "another number, another ground; default 1"},
                    {"--layer-size", ValueKind::integer, "N",
                     "texels a side of the layers' textures, a power of two from 64; default 1024"}},
        .run = run,
        .notes = notes.c_str()};
}

}  // namespace loam::cli
