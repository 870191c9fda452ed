#include "editor/bench/bench.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

namespace loam::bench {

namespace fs = std::filesystem;

const std::vector<BenchName>& benches() {
    static const std::vector<BenchName> table = {
        {"compose", "pages and rectangles composed; the parts of an edit's cost", bench_compose},
        {"converge", "share of the picture at its wanted mip after jumps, in a turn and a dolly",
         bench_converge},
        {"cost", "frames with the virtual texture against direct shading, by layers and decals", bench_cost},
        {"crater", "one crater on a 1 km and on a 16 km map: pages, milliseconds, memory", bench_crater},
        {"edits", "from a dab's command to the picture, and what that takes, still and in flight",
         bench_edits},
        {"encoders", "quality of the page encoder beside other block compressors", bench_encoders},
        {"events", "events, prints and lives: cost, memory, what it depends on, approximations",
         bench_events},
        {"feedback", "analysis of a feedback buffer on one core", bench_feedback},
        {"filter", "ways to filter the virtual texture: milliseconds, error against the reference",
         bench_filter},
        {"flat", "a flight over the same ground on maps of 1, 4 and 16 km", bench_flat},
        {"frame", "a fly-through with painting: milliseconds a frame, render scale", bench_frame},
        {"functions", "decals that are functions against a flat colour; from a text to the ground",
         bench_functions},
        {"ground", "slopes and curvatures of the recipes and of real elevation data (--dem)", bench_ground},
        {"materials",
         "pages by layers and features; how tile hiding hides; transitions against authored ones",
         bench_materials},
        {"pop", "steps between the frames of a slow approach against the reference's own", bench_pop},
        {"quality",
         "quality levels and page formats: milliseconds, memory, error against the reference by cause",
         bench_quality},
        {"resolve", "the resolve alone against three bilinear samples with the same light", bench_resolve},
        {"start", "from the command to the first picture, with warm and with empty shader caches",
         bench_start},
    };
    return table;
}

std::string to_text(const BenchReport& report) {
    std::string text;
    for (const BenchTable& table : report) {
        text += (text.empty() ? "" : "\n") + table.title + "\n";
        if (table.rows.empty()) continue;
        std::vector<std::vector<std::string>> cells(1);
        for (const auto& [key, value] : table.rows[0].items()) cells[0].push_back(key);
        for (const Json& row : table.rows) {
            cells.emplace_back();
            for (const std::string& key : cells[0]) {
                const Json value = row.value(key, Json());
                cells.back().push_back(value.is_string() ? value.get<std::string>()
                                       : value.is_null() ? "-"
                                                         : value.dump());
            }
        }
        for (const auto& row : cells) {
            text += "|";
            for (size_t c = 0; c < row.size(); ++c) {
                size_t width = 0;
                for (const auto& other : cells) width = std::max(width, other[c].size());
                text += fmt::format(" {:<{}} |", row[c], width);
            }
            text += "\n";
            if (&row == &cells.front()) {  // Markdown's rule, so that the tables can be pasted
                text += "|";
                for (size_t c = 0; c < row.size(); ++c) text += " --- |";
                text += "\n";
            }
        }
    }
    return text;
}

Json to_json(const BenchReport& report) {
    Json json = Json::array();
    for (const BenchTable& table : report) json.push_back({{"title", table.title}, {"rows", table.rows}});
    return json;
}

double now_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

double rounded(double value, int decimals) {
    const double scale = std::pow(10.0, decimals);
    return std::isfinite(value) ? std::round(value * scale) / scale : value;
}

Spread spread_of(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    return {values[values.size() / 2], values[std::min(values.size() - 1, values.size() * 95 / 100)],
            values.back()};
}

double percentile(std::vector<double> values, double share) {
    if (values.empty()) return 0;
    std::sort(values.begin(), values.end());
    return values[std::min(values.size() - 1,
                           static_cast<size_t>(static_cast<double>(values.size()) * share))];
}

FrameSettings moving_frame(float render_scale) {
    FrameSettings settings;
    settings.render_scale = render_scale;
    settings.at_rest = false;
    return settings;
}

FrameSettings still_frame() {
    return {};
}

FrameSettings trilinear_frame() {
    FrameSettings settings;
    settings.filter = Filter::trilinear;
    return settings;
}

// --- temporary projects ---

Result<TemporaryProject> TemporaryProject::make_folder() {
    std::string pattern = (fs::temp_directory_path() / "loam-bench-XXXXXX").string();
    if (!::mkdtemp(pattern.data()))
        return error("cannot create a temporary folder in {}", fs::temp_directory_path().string());
    TemporaryProject project;
    project.path_ = pattern;
    return project;
}

Result<TemporaryProject> TemporaryProject::create_flat(const fs::path& like, double side_m) {
    auto settings = load_project(like);
    if (!settings) return settings.error();
    auto project = make_folder();
    if (!project) return project;
    std::error_code code;
    if (fs::exists(like / "layers"))
        fs::copy(like / "layers", project->path_ / "layers", fs::copy_options::recursive, code);
    if (code) return error("cannot copy the layers of {}: {}", like.string(), code.message());
    settings->height_spacing_m = 1;
    settings->height_samples_x = settings->height_samples_y = static_cast<int>(side_m) + 1;
    settings->refine = default_refine(1);
    settings->index_spacing_m = 1;
    settings->default_height_mm = 100'000;
    auto document = Document::create(project->path_, *settings);
    if (!document) return document.error();
    return project;
}

Result<TemporaryProject> TemporaryProject::create_copy(const fs::path& of) {
    auto project = make_folder();
    if (!project) return project;
    std::error_code code;
    fs::copy(of, project->path_, fs::copy_options::recursive | fs::copy_options::overwrite_existing, code);
    if (code) return error("cannot copy {}: {}", of.string(), code.message());
    return project;
}

Result<TemporaryProject> TemporaryProject::create_import(ImportRequest request, const fs::path& like) {
    auto project = make_folder();
    if (!project) return project;
    fs::remove(project->path_);  // an import makes its folder
    request.project = project->path_;
    auto report = import_heights(request, {});
    if (!report) return report.error();
    auto settings = load_project(project->path_);
    if (!settings) return settings.error();
    for (const LayerEntry& layer : settings->layers) {
        std::error_code code;
        if (fs::exists(like / layer.file, code))
            fs::copy_file(like / layer.file, project->path_ / layer.file,
                          fs::copy_options::overwrite_existing, code);
        if (code) return error("cannot copy {}: {}", (like / layer.file).string(), code.message());
    }
    return project;
}

TemporaryProject::TemporaryProject(TemporaryProject&& other) noexcept
    : path_(std::exchange(other.path_, {})) {}

TemporaryProject::~TemporaryProject() {
    std::error_code code;
    if (!path_.empty()) fs::remove_all(path_, code);
}

}  // namespace loam::bench
