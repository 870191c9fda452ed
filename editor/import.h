// Height pictures become projects, and projects' heights become pictures.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "editor/import_doctor.h"
#include "editor/recipe/progress.h"
#include "runtime/base/result.h"
#include "runtime/document/document.h"

namespace loam {

struct SampleCrop {
    int x = 0, y = 0, width = 0, height = 0;  // in samples from the upper left corner
};

struct ImportRequest {
    std::filesystem::path heights, project;
    double spacing_m = 1;
    ScaleRequest scale;
    std::optional<double> fill_nan_m;
    std::optional<SampleCrop> crop;
    int layer_size_texels = 1024;  // of the layers' textures; 0: no layers
    uint32_t seed = 1;             // of the layers
};

struct ImportReport {
    Diagnosis diagnosis;
    HeightScale scale;
    int width = 0, height = 0;
    double spacing_m = 1;
    double min_m = 0, max_m = 0;
};

// The project appears whole or not at all.
[[nodiscard]] Result<ImportReport> import_heights(const ImportRequest& request, const Progress& progress);

enum class ExportWhat { heights, base };  // with operators, or the painted map alone
struct ExportRequest {
    std::filesystem::path
        file;  // png: 16 bits; tif, tiff, exr: metres as floats; raw: the same, little endian, no head
    ExportWhat what = ExportWhat::heights;
    std::optional<HeightScale> scale;  // png; none: the whole range, in steps of 1 mm where that fits
};
struct ExportReport {
    int width = 0, height = 0;
    double min_m = 0, max_m = 0;
    std::optional<HeightScale> scale;  // png only
    uint64_t clipped = 0;              // png: samples outside the scale's range
};
[[nodiscard]] Result<ExportReport> export_heights(const Document& document, const ExportRequest& request);

}  // namespace loam
