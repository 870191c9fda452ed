// Heights out of a project: the samples of the base map, with or without the operators on top.
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>

#include "editor/import.h"
#include "runtime/base/units.h"

namespace loam {

namespace {

// Rows north to south, metres.
std::vector<double> read_heights(const Document& document, ExportWhat what) {
    const ProjectSettings& settings = document.settings();
    const int width = settings.height_samples_x, height = settings.height_samples_y;
    std::vector<double> out(static_cast<size_t>(width) * static_cast<size_t>(height));
    std::vector<int32_t> mm(static_cast<size_t>(width));
    const auto lock = document.read_lock();
    std::vector<const Operator*> operators;
    for (int row = 0; row < height; ++row) {
        document.read_heights_mm(0, 0, row, width, 1, mm.data());
        double* target = out.data() + static_cast<size_t>(height - 1 - row) * static_cast<size_t>(width);
        for (int i = 0; i < width; ++i) target[i] = height_m_from_mm(mm[static_cast<size_t>(i)]);
        if (what == ExportWhat::base) continue;
        const double y_m = row * settings.height_spacing_m;
        operators.clear();
        document.operators_over_height({0, y_m, settings.bounds().max_x, y_m}, settings.height_spacing_m,
                                       operators);
        const SampleGrid<double> grid{target, width, 1, width, 0, y_m, settings.height_spacing_m};
        for (const Operator* op : operators) apply_height(*op, grid);
    }
    return out;
}

// Steps of 1 mm where 65,535 of them reach from the lowest to the highest place, else the whole range.
HeightScale whole_range(double min_m, double max_m) {
    return {min_m, std::max(kHeightStep_m, (max_m - min_m) / 65535.0)};
}

Status write_raw(const std::filesystem::path& file, const std::vector<float>& heights) {
    std::ofstream stream(file, std::ios::binary);
    stream.write(reinterpret_cast<const char*>(heights.data()),
                 static_cast<std::streamsize>(heights.size() * sizeof(float)));
    stream.close();
    if (!stream) return error("cannot write {}: {}", file.string(), std::strerror(errno));
    return {};
}

}  // namespace

Result<ExportReport> export_heights(const Document& document, const ExportRequest& request) {
    std::string extension = request.file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](char c) { return static_cast<char>(std::tolower(c)); });
    const bool is_png = extension == ".png";
    if (!is_png && extension != ".tif" && extension != ".tiff" && extension != ".exr" && extension != ".raw")
        return error("cannot export to {}: the name must end in .png, .tif, .exr or .raw",
                     request.file.string());

    const std::vector<double> heights = read_heights(document, request.what);
    ExportReport report;
    report.width = document.settings().height_samples_x;
    report.height = document.settings().height_samples_y;
    const auto [low, high] = std::minmax_element(heights.begin(), heights.end());
    report.min_m = *low;
    report.max_m = *high;
    if (!is_png) {
        const std::vector<float> floats(heights.begin(), heights.end());
        LOAM_TRY(extension == ".raw"
                     ? write_raw(request.file, floats)
                     : write_samples_float(request.file, report.width, report.height, floats));
        return report;
    }
    const HeightScale scale = request.scale.value_or(whole_range(report.min_m, report.max_m));
    report.scale = scale;
    std::vector<uint16_t> samples(heights.size());
    for (size_t i = 0; i < heights.size(); ++i) {
        const double sample = std::nearbyint((heights[i] - scale.offset_m) / scale.step_m);
        if (sample < 0 || sample > 65535) ++report.clipped;
        samples[i] = static_cast<uint16_t>(std::clamp(sample, 0.0, 65535.0));
    }
    LOAM_TRY(write_samples_u16(request.file, report.width, report.height, samples));
    return report;
}

}  // namespace loam
