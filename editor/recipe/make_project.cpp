#include "editor/recipe/make_project.h"

#include <algorithm>
#include <system_error>
#include <vector>

#include "editor/recipe/erosion.h"
#include "editor/recipe/index_map.h"
#include "runtime/base/job_queue.h"
#include "runtime/base/units.h"
#include "runtime/document/document.h"

namespace loam {

namespace {

constexpr int kRows = 128;  // rows a write: a strip of pages at a time

Status write_index(BulkWriter& writer, const IndexRequest& request, const Progress& progress) {
    const IndexPainter painter(request);
    std::vector<IndexTexel> rows(static_cast<size_t>(request.width) * kRows);
    for (int row = 0; row < request.height; row += kRows) {
        LOAM_TRY(
            step_progress(progress, static_cast<double>(row) / request.height, "painting the index map"));
        const int count = std::min(kRows, request.height - row);
        painter.paint_rows(row, count, rows.data());
        LOAM_TRY(
            writer.write_index_rows(row, count, {rows.data(), static_cast<size_t>(request.width) * count}));
    }
    return {};
}

}  // namespace

Status make_project(const std::filesystem::path& folder, const RecipeRequest& request,
                    const Progress& progress, int layer_size_texels) {
    std::error_code code;  // before a minute of erosion, and before another project's layers are overwritten
    if (std::filesystem::exists(folder / "project.toml", code))
        return error("{} already holds a project; choose another folder", folder.string());
    auto maps = make_ground(request, part_of(progress, 0, 0.45));
    if (!maps) return maps.error();

    LOAM_TRY(step_progress(progress, 0.45, "making layers"));
    auto layers = make_layers_for(folder, request.seed, layer_size_texels);
    if (!layers) return layers.error();

    LOAM_TRY(step_progress(progress, 0.65, "writing heights"));
    ProjectSettings settings;
    settings.name = folder.filename().empty() ? request.name : folder.filename().string();
    settings.height_samples_x = settings.height_samples_y = maps->size;
    settings.height_spacing_m = maps->spacing_m;
    settings.refine = default_refine(maps->spacing_m);
    settings.index_spacing_m = recipe_index_spacing_m(request.size_m);
    settings.layers = *layers;
    auto document = Document::create(folder, settings);
    if (!document) return document.error();
    BulkWriter writer(**document);
    std::vector<int32_t> rows(static_cast<size_t>(maps->size) * kRows);
    for (int row = 0; row < maps->size; row += kRows) {
        const int count = std::min(kRows, maps->size - row);
        for (size_t k = 0; k < static_cast<size_t>(maps->size) * count; ++k)
            rows[k] = height_mm_from_m(maps->height_m[static_cast<size_t>(row) * maps->size + k]);
        LOAM_TRY(
            writer.write_height_rows(row, count, {rows.data(), static_cast<size_t>(maps->size) * count}));
    }
    const glm::ivec2 size = (*document)->index_size_texels();
    LOAM_TRY(write_index(writer,
                         {.maps = &*maps,
                          .climate = recipe_climate(request.name),
                          .seed = request.seed,
                          .spacing_m = settings.index_spacing_m,
                          .width = size.x,
                          .height = size.y},
                         part_of(progress, 0.7, 0.95)));
    LOAM_TRY(step_progress(progress, 0.95, "building mips"));
    LOAM_TRY(writer.finish());
    return step_progress(progress, 1.0, "project made");
}

Status make_index_from_heights(Document& document, const Progress& progress) {
    const ProjectSettings settings = document.settings();
    if (settings.layers.size() < layer_recipe_names().size())
        return error("the project has {} layers; the rules need the {} of the recipes",
                     settings.layers.size(), layer_recipe_names().size());
    LOAM_TRY(step_progress(progress, 0.0, "reading heights"));
    // A square that covers the map (beyond its edge the nearest sample is read), of at most 2,101 samples a
    // side.
    int mip = 0;
    const int longer = std::max(settings.height_samples_x, settings.height_samples_y);
    while (mip + 1 < document.height_mip_count() && ((longer - 1) >> mip) + 1 > 2101) ++mip;
    GroundMaps maps;
    maps.size = ((longer - 1) >> mip) + 1;
    maps.spacing_m = settings.height_spacing_m * static_cast<double>(1 << mip);
    recipe::Grid height(maps.size);
    {
        const Document::ReadLock lock = document.read_lock();
        std::vector<int32_t> row(static_cast<size_t>(maps.size));
        for (int j = 0; j < maps.size; ++j) {
            document.read_heights_mm(mip, 0, j, maps.size, 1, row.data());
            for (int i = 0; i < maps.size; ++i)
                height.at(i, j) = static_cast<float>(height_m_from_mm(row[static_cast<size_t>(i)]));
        }
    }
    LOAM_TRY(step_progress(progress, 0.1, "following the water"));
    maps.flow_m2 = recipe::route(height, maps.spacing_m, recipe::Outlets::all_edges, 1).area_m2.v;
    maps.slope = recipe::slope_of(height, maps.spacing_m).v;
    const recipe::Grid curvature = recipe::curvature_of(height, maps.spacing_m);
    // Nobody saw the debris come down: it is taken to lie where the ground is hollow over some 20 m.
    recipe::Grid deposit = recipe::blurred(curvature, std::max(1, static_cast<int>(10 / maps.spacing_m)), 2);
    for (float& v : deposit.v) v = std::clamp(v * 120.0f, 0.0f, 3.0f);
    maps.curvature = curvature.v;
    maps.deposit_m = std::move(deposit.v);
    maps.height_m = std::move(height.v);

    const glm::ivec2 size = document.index_size_texels();
    BulkWriter writer(document);
    LOAM_TRY(write_index(writer,
                         {.maps = &maps,
                          .climate = Climate::alpine,
                          .seed = 1,
                          .spacing_m = settings.index_spacing_m,
                          .width = size.x,
                          .height = size.y},
                         part_of(progress, 0.3, 0.95)));
    LOAM_TRY(writer.finish());
    return step_progress(progress, 1.0, "index map made");
}

}  // namespace loam
