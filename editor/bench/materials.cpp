// What the ground's materials cost and what they are worth: a page by the number of layers on the map and by
// what is on; how well tile hiding hides a repeat; how far a transition is from the same blend authored at
// full resolution.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <set>
#include <utility>

#include "editor/bench/bench.h"
#include "editor/bench/stage.h"
#include "editor/picture.h"
#include "runtime/base/srgb.h"
#include "runtime/base/units.h"
#include "runtime/document/imagery.h"
#include "runtime/store/layer_file.h"
#include "runtime/texture/composer.h"
#include "shaders/texture/ompv.h"
#include "shaders/texture/tile_hiding.h"

namespace loam::bench {

namespace {

constexpr double kMap_m = 256, kMosaic_m = 4;
constexpr int kPictureWidth = 320, kPictureHeight = 180;
const PageId kPage{{true, 1, 1}, 3, 3, 3};  // 8 m, texels of 3 cm

struct Feature {
    const char* name;
    void (*turn_on)(ProjectSettings&);
};

// The second half of the layers becomes transitions between the first half's neighbours in the list.
void make_half_transitions(ProjectSettings& s) {
    const size_t half = s.layers.size() / 2;
    for (size_t i = half; i < s.layers.size() && half > 1; ++i) {
        s.layers[i].file.clear();
        s.layers[i].blend =
            LayerEntry::Blend{s.layers[i - half].name, s.layers[(i - half + 1) % half].name, 0.5};
    }
}

// Both lookups in the page that is timed.
void turn_vista_on(ProjectSettings& s) {
    s.ground.vista_scale = 8;
    s.ground.vista_distance_m = 20;
}

// Of any colours, in the page that is timed too.
void turn_imagery_on(ProjectSettings& s) {
    s.imagery = {.file = "imagery/bench.imagery", .strength = 1, .distance_m = 20};
}

Status write_imagery(const std::filesystem::path& project, const ProjectSettings& settings) {
    const std::filesystem::path file = project / settings.imagery.file;
    std::error_code failure;
    std::filesystem::create_directories(file.parent_path(), failure);
    const ImageryShape shape = imagery_shape(settings, settings.index_spacing_m / 2);
    auto writer = ImageryWriter::create(file, shape);
    if (!writer) return writer.error();
    std::vector<glm::vec4> row(static_cast<size_t>(shape.width));
    for (int y = shape.height - 1; y >= 0; --y) {
        for (int x = 0; x < shape.width; ++x)
            row[static_cast<size_t>(x)] = {static_cast<float>(x % 61) / 60, static_cast<float>(y % 53) / 52,
                                           static_cast<float>((x + y) % 89) / 88, 1};
        LOAM_TRY((*writer)->append_row(row));
    }
    return (*writer)->finish();
}

constexpr Feature kFeatures[] = {
    {"plain", [](ProjectSettings&) {}},
    {"distortion", [](ProjectSettings& s) { s.ground.distortion_amplitude_m = 0.6 * s.index_spacing_m; }},
    {"tile hiding", [](ProjectSettings& s) { s.ground.tile_hiding = true; }},
    {"vista", turn_vista_on},
    {"transitions", make_half_transitions},
    {"imagery", turn_imagery_on},
    {"all", [](ProjectSettings& s) {
         s.ground.distortion_amplitude_m = 0.6 * s.index_spacing_m;
         s.ground.tile_hiding = true;
         turn_vista_on(s);
         make_half_transitions(s);
     }}};

// Layers looked up a texel of the page, by what meets in its squares of four vertices.
double lookups_a_texel(const Stage& stage, const IndexTexel* texels, const ComposeJob& job) {
    const WorldRect square = texture_layout(stage.document.bounds()).square(job.page);
    const WorldRect index_square = stage.index->map().page_rect(job.index_page);
    const double spacing_m = stage.index->map().spacing_m(job.index_page.level);
    const int x0 = int((square.min_x - index_square.min_x) / spacing_m),
              side = int(square.width() / spacing_m);
    const int y0 = int((square.min_y - index_square.min_y) / spacing_m);
    const glm::ivec2 corner = glm::ivec2(job.index_page.x, job.index_page.y) * kIndexPayload;
    int64_t sum = 0;
    for (int y = y0; y < y0 + side; ++y)
        for (int x = x0; x < x0 + side; ++x) {
            std::set<uint32_t> keys;
            for (int k = 0; k < 4; ++k) {
                const int i = x + k % 2, j = y + k / 2;
                const uint32_t layer = texels[(j + kIndexBorder) * kIndexTexels + i + kIndexBorder].layer;
                keys.insert(shared::tile_key(layer, stage.layers->ground.tile_hiding ? corner.x + i : 0,
                                             stage.layers->ground.tile_hiding ? corner.y + j : 0,
                                             job.index_page.level));
            }
            for (const uint32_t key : keys) sum += stage.layers->is_transition(key >> kKeyLayerShift) ? 2 : 1;
        }
    return double(sum) / double(side * side);
}

struct PageCost {
    double ms = 0, lookups = 0;
    uint64_t layer_bytes = 0;
};

Result<PageCost> page_cost(const std::filesystem::path& project, gpu::Device& device, int repeats) {
    auto document = Document::open(project, OpenMode::read_only);
    if (!document) return document.error();
    auto stage = Stage::create(device, **document);
    if (!stage) return stage.error();
    auto maker = stage->page_maker(PageFormat::rgba8, (*document)->settings().channels, 2, 2, false);
    if (!maker) return maker.error();
    auto job = stage->whole_page(kPage);
    if (!job) return job.error();
    auto ms = stage->page_ms(*maker, *job, repeats);
    if (!ms) return ms.error();
    return PageCost{*ms, lookups_a_texel(*stage, stage->index->resident_page(job->index_page), *job),
                    stage->layers->gpu_bytes()};
}

// Against the reference, which evaluates the same functions per pixel, supersampled.
Result<double> picture_psnr(const BenchRequest& request, const std::filesystem::path& project) {
    auto session = open_read_only(project, request.session);
    if (!session) return session.error();
    const glm::dvec2 at(kMap_m * 0.3, kMap_m * 0.25);
    auto ground = (*session)->height_m(at.x, at.y);
    if (!ground) return ground.error();
    auto ahead = (*session)->height_m(at.x + 12, at.y + 16);
    if (!ahead) return ahead.error();
    RenderRequest wanted;
    wanted.camera = Camera::look_at({at, *ground + 4}, {at.x + 12, at.y + 16, *ahead}, 0.9);
    wanted.width = kPictureWidth;
    wanted.height = kPictureHeight;
    wanted.supersample = 2;
    auto picture = (*session)->render(wanted);
    if (!picture) return picture.error();
    wanted.reference = true;
    auto truth = (*session)->render(wanted);
    if (!truth) return truth.error();
    return psnr_db(*picture, *truth);
}

Status add_costs(const BenchRequest& request, gpu::Device& device, BenchTable& table) {
    for (const int layers : request.quick ? std::vector{1, 4} : std::vector{1, 4, 32, 256})
        for (const Feature& feature : kFeatures) {
            const bool blends =
                feature.turn_on == make_half_transitions || std::strcmp(feature.name, "all") == 0;
            if (blends && layers < 4) continue;
            auto project = TemporaryProject::create_part({.of = request.project,
                                                          .part_m = kMap_m,
                                                          .side_m = kMap_m,
                                                          .layers = layers,
                                                          .mosaic_m = kMosaic_m});
            if (!project) return project.error();
            {
                auto document = Document::open(project->path(), OpenMode::read_write);
                if (!document) return document.error();
                ProjectSettings settings = (*document)->settings();
                feature.turn_on(settings);
                if (settings.imagery.is_on()) LOAM_TRY(write_imagery(project->path(), settings));
                LOAM_TRY((*document)->change_settings(settings));
            }
            auto cost = page_cost(project->path(), device, request.quick ? 3 : 9);
            if (!cost) return cost.error();
            Json psnr = "-";
            if (!request.quick) {
                auto db = picture_psnr(request, project->path());
                if (!db) return db.error();
                psnr = rounded(*db, 2);
            }
            table.rows.push_back({{"layers", layers},
                                  {"with", feature.name},
                                  {"a page ms", rounded(cost->ms, 2)},
                                  {"layer lookups a texel", rounded(cost->lookups, 2)},
                                  {"PSNR dB", psnr},
                                  {"layer textures MB", rounded(double(cost->layer_bytes) / 1e6, 1)}});
        }
    return {};
}

// --- tile hiding ---

// The largest normalised autocorrelation of a square image at lags from half a tile to one and a half.
double autocorrelation_peak(const std::vector<double>& values, int side, double tile_texels) {
    double mean = 0, power = 0, peak = 0;
    for (const double v : values) mean += v / double(values.size());
    for (const double v : values) power += (v - mean) * (v - mean) / double(values.size());
    const int reach = int(std::ceil(1.5 * tile_texels));
    for (int dy = 0; dy <= reach; ++dy)
        for (int dx = -reach; dx <= reach; ++dx) {
            const double lag = std::hypot(dx, dy);
            if (lag < 0.5 * tile_texels || lag > 1.5 * tile_texels) continue;
            double sum = 0;
            int64_t count = 0;
            for (int y = 0; y + dy < side; ++y)
                for (int x = std::max(0, -dx); x + std::max(0, dx) < side; ++x, ++count)
                    sum += (values[size_t(y * side + x)] - mean) *
                           (values[size_t((y + dy) * side + x + dx)] - mean);
            peak = std::max(peak, sum / double(count) / std::max(power, 1e-12));
        }
    return peak;
}

Status add_tile_hiding(const BenchRequest& request, gpu::Device& device, BenchTable& table) {
    auto source = load_project(request.project);
    if (!source) return source.error();
    for (size_t layer = 0; layer < source->layers.size() && layer < (request.quick ? 1 : 8); ++layer) {
        if (source->layers[layer].blend) continue;
        Json row = {{"layer", source->layers[layer].name}, {"tile m", source->layers[layer].tile_m}};
        for (const bool hiding : {false, true}) {
            auto project = TemporaryProject::create_flat(request.project, kMap_m);
            if (!project) return project.error();
            ProjectSettings settings = load_project(project->path()).value();
            settings.ground = {.tile_hiding = hiding};
            std::swap(settings.layers[0], settings.layers[layer]);  // the map is all of number 0
            LOAM_TRY(save_project(project->path(), settings));
            auto document = Document::open(project->path(), OpenMode::read_only);
            if (!document) return document.error();
            auto stage = Stage::create(device, **document);
            if (!stage) return stage.error();
            auto maker = stage->page_maker(PageFormat::rgba8, settings.channels, 1, 1, false);
            if (!maker) return maker.error();
            const TextureLayout layout = texture_layout((*document)->bounds());
            // About eight tiles wide.
            PageId page{{true, 1, 1}, 0, 0, 0};
            while (layout.page_side_m(page) > 12 * source->layers[layer].tile_m) ++page.depth;
            auto job = stage->whole_page(page);
            if (!job) return job.error();
            std::vector<double> values(size_t(kPageTexels) * kPageTexels);
            auto ms = stage->timed_frame([&](gpu::Commands& commands) -> Status {
                LOAM_TRY(maker->composer->cmd_compose(*stage->ring, commands, {&*job, 1}, maker->atlas));
                stage->ring->read_back(commands, maker->atlas[0], [&](std::span<const std::byte> bytes) {
                    for (size_t i = 0; i < values.size(); ++i)
                        values[i] = double(std::to_integer<int>(bytes[i * 4 + 1]));
                });
                return {};
            });
            if (!ms) return ms.error();
            row[hiding ? "peak, hidden" : "peak, plain"] =
                rounded(autocorrelation_peak(values, kPageTexels,
                                             source->layers[layer].tile_m / layout.texel_m(page)),
                        3);
        }
        table.rows.push_back(std::move(row));
    }
    return {};
}

// --- transitions ---

// The blend of one mip, linear albedo.
std::vector<glm::dvec3> blended(const LayerTextures& from, const LayerTextures& to, size_t mip,
                                float threshold) {
    std::vector<glm::dvec3> out(from.albedo_reveal[mip].size() / 4);
    for (size_t i = 0; i < out.size(); ++i) {
        const uint8_t *a = &from.albedo_reveal[mip][i * 4], *b = &to.albedo_reveal[mip][i * 4];
        const double cover = shared::ompv_cover(threshold, float(b[3]) / 255.0f);
        for (int c = 0; c < 3; ++c)
            out[i][c] = std::lerp(linear_of_srgb8(a[c]), linear_of_srgb8(b[c]), cover);
    }
    return out;
}

// Authored: blended once in full resolution, its mips averaged. Blended at run time: the layers' mips
// blended.
Status add_transition_error(const BenchRequest& request, BenchTable& table) {
    auto settings = load_project(request.project);
    if (!settings) return settings.error();
    std::vector<LayerTextures> layers;
    std::vector<std::string> names;
    for (const LayerEntry& entry : settings->layers) {
        if (entry.blend || layers.size() == (request.quick ? 2 : 4)) continue;
        auto layer = load_layer(request.project / entry.file);
        if (!layer) return layer.error();
        layers.push_back(std::move(*layer));
        names.push_back(entry.name);
    }
    for (size_t k = 0; k + 1 < layers.size(); ++k) {
        const LayerTextures &from = layers[k], &to = layers[k + 1];
        if (from.size_texels != to.size_texels) continue;
        for (const float threshold : {0.0f, 0.25f, 0.5f, 0.75f, 1.0f}) {
            Json row = {{"transition", names[k] + " to " + names[k + 1]}, {"threshold", threshold}};
            std::vector<glm::dvec3> authored = blended(from, to, 0, threshold);
            int side = int(from.size_texels);
            for (size_t mip = 0; mip <= 5 && side >= 1; ++mip) {
                const std::vector<glm::dvec3> live = blended(from, to, mip, threshold);
                double sum = 0;
                for (size_t i = 0; i < live.size(); ++i)
                    for (int c = 0; c < 3; ++c)
                        sum +=
                            std::pow(255 * (srgb_of_linear(live[i][c]) - srgb_of_linear(authored[i][c])), 2);
                row[fmt::format("mip {} rms/255", mip)] =
                    rounded(std::sqrt(sum / double(live.size() * 3)), 2);
                const int half = side / 2;
                std::vector<glm::dvec3> next(size_t(half) * size_t(half), glm::dvec3(0));
                for (int y = 0; y < half; ++y)
                    for (int x = 0; x < half; ++x)
                        for (int q = 0; q < 4; ++q)
                            next[size_t(y * half + x)] +=
                                0.25 * authored[size_t((2 * y + q / 2) * side + 2 * x + q % 2)];
                authored = std::move(next);
                side = half;
            }
            table.rows.push_back(std::move(row));
        }
    }
    return {};
}

}  // namespace

Result<BenchReport> bench_materials(const BenchRequest& request) {
    auto device = gpu::Device::create(request.session.device);
    if (!device) return device.error();
    BenchReport report(7);
    report[0].title = "A whole page of 8 m, RGBA8, and the picture against the reference (a mosaic of 4 m)";
    LOAM_TRY(add_costs(request, **device, report[0]));
    report[1].title = "Tile hiding: largest autocorrelation at half to one and a half tiles";
    LOAM_TRY(add_tile_hiding(request, **device, report[1]));
    report[2].title = "A transition against the same blend authored at full resolution, albedo, by mip";
    LOAM_TRY(add_transition_error(request, report[2]));
    LOAM_TRY(add_vista_steps(request, **device, report[3]));
    report[4].title = "Layers by an alpha mask each beside the index map: a whole page of 8 m, RGBA8";
    LOAM_TRY(add_masks(request, **device, report[4]));
    report[5].title = fmt::format("Parallax at {}x{}, everywhere in the picture, against 256 steps",
                                  request.width, request.height);
    LOAM_TRY(add_parallax(request, report[5]));
    report[6].title = "The index map's tints as BC1 against exact ones: the project's own ground";
    LOAM_TRY(add_tints(request, **device, report[6]));
    return report;
}

}  // namespace loam::bench
