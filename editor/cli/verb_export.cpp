#include <nlohmann/json.hpp>

#include "editor/cli/verb.h"
#include "editor/import.h"

namespace loam::cli {

namespace {

Status run(const Args& args) {
    ExportRequest request;
    request.file = args.positional(1);
    const std::string what = args.text("--what", "heights");
    if (what != "heights" && what != "base")
        return error("unknown --what \"{}\", expected heights or base", what);
    request.what = what == "base" ? ExportWhat::base : ExportWhat::heights;
    if (args.has("--range") && args.has("--step")) return error("--range and --step exclude each other");
    if (args.has("--range")) {
        const double low = args.number("--range", 0, 0), high = args.number("--range", 0, 1);
        if (!(low < high)) return error("--range {} {} is empty, expected LOW below HIGH", low, high);
        request.scale = HeightScale{low, (high - low) / 65535.0};
    } else if (args.has("--step") || args.has("--offset")) {
        request.scale = HeightScale{args.number("--offset", 0), args.number("--step", 1)};
        if (request.scale->step_m == 0) return error("--step must not be 0");
    }
    auto document = Document::open(args.positional(0), OpenMode::read_only);
    if (!document) return document.error();
    auto report = export_heights(**document, request);
    if (!report) return report.error();
    const std::optional<HeightScale>& scale = report->scale;
    if (args.has("--json")) {
        nlohmann::ordered_json json = {
            {"samples", {report->width, report->height}}, {"min_m", report->min_m}, {"max_m", report->max_m}};
        if (scale) {
            json["offset_m"] = scale->offset_m;
            json["step_m"] = scale->step_m;
            json["range_m"] = {scale->offset_m, scale->height_m(65535)};
            json["clipped"] = report->clipped;
        }
        fmt::print("{}\n", json.dump(2));
        return {};
    }
    fmt::print("{}x{} samples, {:.3f} … {:.3f} m\n", report->width, report->height, report->min_m,
               report->max_m);
    if (scale)
        fmt::print("--range {} {} (steps of {} m)\n", scale->offset_m, scale->height_m(65535), scale->step_m);
    if (report->clipped)
        fmt::print("warning: {} samples are outside the range and were cut off\n", report->clipped);
    return {};
}

}  // namespace

Verb export_verb() {
    return {
        .name = "export",
        .summary = "writes a project's heights as a picture",
        .positionals = {{"PROJECT", "project folder"},
                        {"FILE",
                         ".png (16 bits), .tif or .exr (floats in metres), .raw (the same without a head)"}},
        .options = {{"--what", ValueKind::text, "WHAT",
                     "heights (with craters and the like; default) or base"},
                    {"--range", ValueKind::number, "LOW HIGH",
                     "png: metres of black and white; default: what the map needs", 2},
                    {"--step", ValueKind::number, "M", "png: metres a unit"},
                    {"--offset", ValueKind::number, "M", "png: height of sample value 0"},
                    {"--json", ValueKind::none, "", "print figures as JSON"}},
        .run = run};
}

}  // namespace loam::cli
