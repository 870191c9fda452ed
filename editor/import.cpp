#include "editor/import.h"

#include <algorithm>
#include <cmath>

#include "editor/project_folder.h"
#include "editor/recipe/layers.h"
#include "editor/recipe/make_project.h"
#include "runtime/base/units.h"

namespace loam {

namespace {

constexpr int kRowsAtOnce = 64;

Result<SampleImage> cropped(SampleImage image, const SampleCrop& crop) {
    if (crop.width < 2 || crop.height < 2 || crop.x < 0 || crop.y < 0 || crop.x + crop.width > image.width ||
        crop.y + crop.height > image.height)
        return error("--crop {},{},{},{} is not inside the picture of {}x{} samples", crop.x, crop.y,
                     crop.width, crop.height, image.width, image.height);
    std::vector<float> samples;
    samples.reserve(static_cast<size_t>(crop.width) * static_cast<size_t>(crop.height));
    for (int row = crop.y; row < crop.y + crop.height; ++row) {
        const auto begin = image.samples.begin() + static_cast<ptrdiff_t>(row) * image.width + crop.x;
        samples.insert(samples.end(), begin, begin + crop.width);
    }
    image.samples = std::move(samples);
    image.width = crop.width;
    image.height = crop.height;
    return image;
}

// Rows are turned so that row 0 is south.
std::vector<int32_t> heights_of(const SampleImage& image, const HeightScale& scale, double fill_m) {
    const auto width = static_cast<size_t>(image.width);
    std::vector<int32_t> mm(image.samples.size());
    for (int row = 0; row < image.height; ++row) {
        const float* source = image.samples.data() + static_cast<size_t>(row) * width;
        int32_t* target = mm.data() + static_cast<size_t>(image.height - 1 - row) * width;
        for (size_t i = 0; i < width; ++i)
            target[i] = height_mm_from_m(std::isfinite(source[i]) ? scale.height_m(source[i]) : fill_m);
    }
    return mm;
}

// No finer than a quarter of the heights' spacing, and at most 4,200 texels a side: a few seconds to make.
double choose_index_spacing_m(double map_side_m, double height_spacing_m) {
    constexpr double kMostTexels = 4200, kFinest_m = 0.25, kCoarsest_m = 64;
    double spacing_m = kFinest_m;
    while (spacing_m < kCoarsest_m &&
           (spacing_m < height_spacing_m / 4 || map_side_m / spacing_m > kMostTexels))
        spacing_m *= 2;
    return spacing_m;
}

ProjectSettings settings_for(const ImportRequest& request, int width, int height) {
    ProjectSettings settings;
    settings.name = std::filesystem::absolute(request.project).lexically_normal().filename().string();
    if (settings.name.empty()) settings.name = request.heights.stem().string();
    settings.height_samples_x = width;
    settings.height_samples_y = height;
    settings.height_spacing_m = request.spacing_m;
    settings.refine = default_refine(request.spacing_m);
    settings.index_spacing_m =
        choose_index_spacing_m((std::max(width, height) - 1) * request.spacing_m, request.spacing_m);
    return settings;
}

Status write_heights(Document& document, const std::vector<int32_t>& mm, const Progress& progress) {
    BulkWriter writer(document);
    const auto width = static_cast<size_t>(document.settings().height_samples_x);
    const int height = document.settings().height_samples_y;
    for (int row = 0; row < height; row += kRowsAtOnce) {
        const int rows = std::min(kRowsAtOnce, height - row);
        LOAM_TRY(writer.write_height_rows(
            row, rows,
            std::span(mm).subspan(static_cast<size_t>(row) * width, static_cast<size_t>(rows) * width)));
        LOAM_TRY(step_progress(progress, static_cast<double>(row) / height, "writing heights"));
    }
    return writer.finish();
}

}  // namespace

Result<ImportReport> import_heights(const ImportRequest& request, const Progress& progress) {
    LOAM_TRY(step_progress(progress, 0.0, "reading"));
    auto image = read_samples(request.heights, request.crop ? 4 * kMaxImportSide : kMaxImportSide);
    if (!image) return image.error();
    if (request.crop) {
        image = cropped(std::move(*image), *request.crop);
        if (!image) return image.error();
    }
    const SampleSurvey survey = survey_samples(*image);
    if (auto status = check_importable(*image, survey, request.spacing_m, request.fill_nan_m.has_value());
        !status.ok())
        return error("{}: {}", request.heights.string(), status.message());
    auto scale = choose_scale(*image, survey, request.scale);
    if (!scale) return error("{}: {}", request.heights.string(), scale.message());

    ImportReport report;
    report.diagnosis = diagnose(*image, survey, *scale, request.spacing_m);
    report.scale = *scale;
    report.width = image->width;
    report.height = image->height;
    report.spacing_m = request.spacing_m;
    report.min_m = std::min(scale->height_m(survey.min), scale->height_m(survey.max));
    report.max_m = std::max(scale->height_m(survey.min), scale->height_m(survey.max));

    ProjectSettings settings = settings_for(request, image->width, image->height);
    LOAM_TRY(check_settings(settings));
    auto folder = NewFolder::create(request.project);
    if (!folder) return folder.error();
    if (request.layer_size_texels > 0) {
        LOAM_TRY(step_progress(progress, 0.1, "making layers"));
        auto layers = make_layers_for(folder->path(), request.seed, request.layer_size_texels);
        if (!layers) return layers.error();
        settings.layers = *layers;
    }
    {
        auto document = Document::create(folder->path(), settings);
        if (!document) return document.error();
        const std::vector<int32_t> mm = heights_of(*image, *scale, request.fill_nan_m.value_or(0.0));
        LOAM_TRY(write_heights(**document, mm, part_of(progress, 0.5, 0.6)));
        if (!settings.layers.empty())
            LOAM_TRY(make_index_from_heights(**document, part_of(progress, 0.6, 1.0)));
    }
    LOAM_TRY(folder->keep());
    return report;
}

}  // namespace loam
