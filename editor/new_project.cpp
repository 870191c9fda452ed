#include "editor/new_project.h"

#include <algorithm>

#include "editor/dressing.h"
#include "editor/project_folder.h"
#include "runtime/base/units.h"
#include "runtime/document/document.h"

namespace loam {

namespace {

constexpr int kRowsAtOnce = 64;

ProjectSettings settings_for(const NewProjectRequest& request, const GroundMaps& ground) {
    ProjectSettings settings;
    settings.name = request.recipe.name;
    settings.height_samples_x = settings.height_samples_y = ground.size;
    settings.height_spacing_m = ground.spacing_m;
    settings.refine = default_refine(ground.spacing_m);
    settings.index_spacing_m = choose_index_spacing_m((ground.size - 1) * ground.spacing_m, ground.spacing_m);
    return settings;
}

Status write_heights(BulkWriter& writer, const GroundMaps& ground) {
    const auto width = static_cast<size_t>(ground.size);
    std::vector<int32_t> mm;
    for (int row = 0; row < ground.size; row += kRowsAtOnce) {
        const int rows = std::min(kRowsAtOnce, ground.size - row);
        mm.resize(width * static_cast<size_t>(rows));
        const float* source = ground.height_m.data() + width * static_cast<size_t>(row);
        std::transform(source, source + mm.size(), mm.begin(), [](float m) { return height_mm_from_m(m); });
        LOAM_TRY(writer.write_height_rows(row, rows, mm));
    }
    return {};
}

} // namespace

Status make_project(const NewProjectRequest& request, const Progress& progress) {
    // The folder first: a place that cannot be written is said before a minute of erosion.
    auto folder = NewFolder::create(request.project);
    if (!folder) return folder.error();
    auto ground = make_ground(request.recipe, part_of(progress, 0.0, 0.55));
    if (!ground) return ground.error();
    ProjectSettings settings = settings_for(request, *ground);
    LOAM_TRY(make_layer_files(folder->path(), settings, request.layer_size_texels, request.recipe.seed, part_of(progress, 0.55, 0.85)));
    {
        auto document = Document::create(folder->path(), settings);
        if (!document) return document.error();
        BulkWriter writer(**document);
        LOAM_TRY(write_heights(writer, *ground));
        if (!settings.layers.empty()) {
            const glm::ivec2 size = (*document)->index_size_texels();
            const HeightField field{ground->size,     ground->size,    ground->spacing_m,
                                    ground->height_m, ground->flow_m2, ground->deposit_m};
            auto texels = make_index_texels(settings, field, size.x, size.y, request.recipe.seed, part_of(progress, 0.85, 0.95));
            if (!texels) return texels.error();
            LOAM_TRY(writer.write_index_rows(0, size.y, *texels));
        }
        LOAM_TRY(step_progress(progress, 0.95, "saving"));
        LOAM_TRY(writer.finish());
    }
    LOAM_TRY(step_progress(progress, 1.0, "done"));
    return folder->keep();
}

} // namespace loam
