#include "editor/import.h"

#include <algorithm>
#include <cmath>

#include "editor/dressing.h"
#include "editor/project_folder.h"
#include "runtime/base/units.h"

namespace loam {

namespace {

constexpr int kRowsAtOnce = 64;

Result<SampleImage> cropped(SampleImage image, const SampleCrop& crop) {
    if (crop.width < 2 || crop.height < 2 || crop.x < 0 || crop.y < 0 || crop.x + crop.width > image.width ||
        crop.y + crop.height > image.height)
        return error("--crop {},{},{},{} is not inside the picture of {}x{} samples", crop.x, crop.y, crop.width,
                     crop.height, image.width, image.height);
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

// Samples become metres in place, rows turned so that row 0 is south.
void samples_to_heights(SampleImage& image, const HeightScale& scale, double fill_m, std::vector<int32_t>& mm) {
    const auto width = static_cast<size_t>(image.width);
    mm.resize(image.samples.size());
    for (int row = 0; row < image.height; ++row) {
        const float* source = image.samples.data() + static_cast<size_t>(row) * width;
        int32_t* target = mm.data() + static_cast<size_t>(image.height - 1 - row) * width;
        for (size_t i = 0; i < width; ++i)
            target[i] = height_mm_from_m(std::isfinite(source[i]) ? scale.height_m(source[i]) : fill_m);
    }
    for (size_t i = 0; i < mm.size(); ++i) image.samples[i] = static_cast<float>(height_m_from_mm(mm[i]));
}

ProjectSettings settings_for(const ImportRequest& request, int width, int height) {
    ProjectSettings settings;
    settings.name = request.heights.stem().string();
    settings.height_samples_x = width;
    settings.height_samples_y = height;
    settings.height_spacing_m = request.spacing_m;
    settings.refine = default_refine(request.spacing_m);
    settings.index_spacing_m = choose_index_spacing_m((std::max(width, height) - 1) * request.spacing_m, request.spacing_m);
    return settings;
}

Status write_maps(Document& document, const std::vector<int32_t>& mm, const HeightField& ground, uint32_t seed,
                  bool has_layers, const Progress& progress) {
    BulkWriter writer(document);
    const ProjectSettings& settings = document.settings();
    const auto width = static_cast<size_t>(settings.height_samples_x);
    for (int row = 0; row < settings.height_samples_y; row += kRowsAtOnce) {
        const int rows = std::min(kRowsAtOnce, settings.height_samples_y - row);
        LOAM_TRY(writer.write_height_rows(row, rows, std::span(mm).subspan(static_cast<size_t>(row) * width,
                                                                           static_cast<size_t>(rows) * width)));
        LOAM_TRY(step_progress(progress, 0.4 * row / settings.height_samples_y, "writing heights"));
    }
    if (has_layers) {
        const glm::ivec2 size = document.index_size_texels();
        auto texels = make_index_texels(settings, ground, size.x, size.y, seed, part_of(progress, 0.4, 0.8));
        if (!texels) return texels.error();
        LOAM_TRY(writer.write_index_rows(0, size.y, *texels));
    }
    LOAM_TRY(step_progress(progress, 0.9, "saving"));
    return writer.finish();
}

} // namespace

Result<ImportReport> import_heights(const ImportRequest& request, const Progress& progress) {
    LOAM_TRY(step_progress(progress, 0.0, "reading"));
    auto image = read_samples(request.heights, request.crop ? 4 * kMaxImportSide : kMaxImportSide);
    if (!image) return image.error();
    if (request.crop) {
        image = cropped(std::move(*image), *request.crop);
        if (!image) return image.error();
    }
    const SampleSurvey survey = survey_samples(*image);
    if (auto status = check_importable(*image, survey, request.spacing_m, request.fill_nan_m.has_value()); !status.ok())
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
    std::vector<int32_t> mm;
    samples_to_heights(*image, *scale, request.fill_nan_m.value_or(0.0), mm);
    LOAM_TRY(make_layer_files(folder->path(), settings, request.layer_size_texels, request.seed, part_of(progress, 0.05, 0.5)));
    {
        auto document = Document::create(folder->path(), settings);
        if (!document) return document.error();
        const HeightField ground{image->width, image->height, request.spacing_m, image->samples, {}, {}};
        LOAM_TRY(write_maps(**document, mm, ground, request.seed, !settings.layers.empty(), part_of(progress, 0.5, 1.0)));
    }
    LOAM_TRY(folder->keep());
    return report;
}

} // namespace loam
