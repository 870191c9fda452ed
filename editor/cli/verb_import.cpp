#include <cmath>

#include <nlohmann/json.hpp>

#include "editor/cli/progress_line.h"
#include "editor/cli/verb.h"
#include "editor/import.h"

namespace loam::cli {

namespace {

Result<ImportRequest> request_of(const Args& args) {
    ImportRequest request;
    request.heights = args.positional(0);
    request.project = args.positional(1);
    request.spacing_m = args.number("--spacing", 1);
    if (!(request.spacing_m > 0)) return error("--spacing {} must be above 0", request.spacing_m);
    if (args.has("--range")) {
        request.scale.has_range = true;
        request.scale.range_low_m = args.number("--range", 0, 0);
        request.scale.range_high_m = args.number("--range", 0, 1);
    }
    request.scale.has_step = args.has("--step") || args.has("--offset");
    request.scale.step_m = args.number("--step", 1);
    request.scale.offset_m = args.number("--offset", 0);
    if (args.has("--fill-nan")) request.fill_nan_m = args.number("--fill-nan", 0);
    if (args.has("--crop")) {
        const std::vector<double> v = args.numbers("--crop");
        if (v.size() != 4) return error("--crop has {} numbers, expected x,y,width,height", v.size());
        for (const double n : v)
            if (n != std::floor(n) || std::abs(n) > 1e6)
                return error("--crop {} is not a count of samples", n);
        request.crop = SampleCrop{int(v[0]), int(v[1]), int(v[2]), int(v[3])};
    }
    request.layer_size_texels = args.integer("--layer-size", 1024);
    request.seed = static_cast<uint32_t>(args.integer("--seed", 1));
    return request;
}

Status run(const Args& args) {
    auto request = request_of(args);
    if (!request) return request.error();
    Result<ImportReport> report = [&] {
        ProgressLine progress;
        return import_heights(*request, progress.callback());
    }();
    if (!report) return report.error();
    if (args.has("--json")) {
        const nlohmann::ordered_json json = {{"samples", {report->width, report->height}},
                                             {"spacing_m", report->spacing_m},
                                             {"offset_m", report->scale.offset_m},
                                             {"step_m", report->scale.step_m},
                                             {"min_m", report->min_m},
                                             {"max_m", report->max_m},
                                             {"notes", report->diagnosis.notes},
                                             {"warnings", report->diagnosis.warnings}};
        fmt::print("{}\n", json.dump(2));
        return {};
    }
    for (const std::string& note : report->diagnosis.notes) fmt::print("{}\n", note);
    for (const std::string& warning : report->diagnosis.warnings) fmt::print("warning: {}\n", warning);
    fmt::print("{} is ready: loam edit {}\n", args.positional(1), args.positional(1));
    return {};
}

}  // namespace

Verb import_verb() {
    return {.name = "import",
            .summary = "makes a project from a picture of heights",
            .positionals = {{"HEIGHTS", "16-bit PNG, or TIFF or EXR of floats in metres; row 0 is north"},
                            {"PROJECT", "folder to create"}},
            .options = {{"--spacing", ValueKind::number, "M", "metres between samples; default 1"},
                        {"--range", ValueKind::number, "LOW HIGH",
                         "metres of the smallest and the largest sample value", 2},
                        {"--step", ValueKind::number, "M", "metres a unit: height = offset + sample * step"},
                        {"--offset", ValueKind::number, "M", "height of sample value 0"},
                        {"--fill-nan", ValueKind::number, "M", "height of samples that are NaN or infinite"},
                        {"--crop", ValueKind::numbers, "X,Y,W,H",
                         "this part of the picture, in samples from the upper left corner"},
                        {"--layer-size", ValueKind::integer, "N",
                         "texels a side of the layers' textures; default 1024, 0: no layers"},
                        {"--seed", ValueKind::integer, "N", "of the layers' textures; default 1"},
                        {"--json", ValueKind::none, "", "print what was found as JSON"}},
            .run = run,
            .notes = "Integer samples need --range (the metres of 0 and 65535) or --step and --offset."};
}

}  // namespace loam::cli
