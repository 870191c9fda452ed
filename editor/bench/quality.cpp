// Speed against error: every quality level with every page format, against the reference (per pixel,
// uncached, uncompressed, full geometry, supersampled), on three views of real ground or of the project
// given; and the error of the high level taken apart by cause, each picture against the one that has that
// cause less.
#include <algorithm>
#include <cmath>

#include "editor/bench/bench.h"
#include "editor/picture.h"

namespace loam::bench {

namespace {

constexpr int kTimedFrames = 7;
constexpr int kSettleBudget = 40;  // pages a frame while nothing is timed
constexpr Quality kLevels[] = {Quality::very_low, Quality::low, Quality::mid, Quality::high, Quality::ultra};
constexpr const char* kLevelNames[] = {"very low", "low", "mid", "high", "ultra"};
struct Format {
    PageFormat format;
    const char* name;
};
constexpr Format kFormats[] = {{PageFormat::rgba8, "uncompressed"},
                               {PageFormat::bc1x3, "3xBC1"},
                               {PageFormat::bc1x4, "4xBC1"},
                               {PageFormat::bc3x2, "2xBC3"}};

// Those that hold the map's channels, each layout once.
std::vector<Format> formats_for(const ProjectSettings& settings) {
    std::vector<Format> formats;
    for (const Format& format : kFormats) {
        const bool as_bc1x3 = format.format == PageFormat::bc1x4 && settings.channels.size() <= 1;
        if (!as_bc1x3 && page_textures(format.format, settings.channels).ok()) formats.push_back(format);
    }
    return formats;
}

// Real ground by file (README of the elevation data): metres = offset + sample * step.
struct Ground {
    const char* file;
    double spacing_m, offset_m, step_m;
    std::optional<SampleCrop> crop;
};
const Ground kGrounds[] = {
    {"halfdome.png", 27, 1175, 0.05, SampleCrop{200, 150, 600, 600}},  // 16 km
    {"gabilan.png", 1, 187, 0.01, std::nullopt},
};

struct Error {
    double psnr = 0, detail = 0;
};
Error error_of(const Picture& picture, const Picture& truth) {
    return {psnr_db(picture, truth), laplacian_energy(picture) / std::max(1e-9, laplacian_energy(truth))};
}

Json decibels(double psnr) {
    return std::isfinite(psnr) ? Json(rounded(psnr, 2)) : Json("equal");
}

struct Scene {
    std::string name;
    View view;
    // From the truth down; texels: direct, filtered as pages are; pages: high, uncompressed.
    Picture reference, direct_full, direct, texels, pages;
};

RenderRequest request_of(const BenchRequest& request, const Camera& camera) {
    RenderRequest r{
        .camera = camera, .width = request.width, .height = request.height, .frame = still_frame()};
    r.frame.page_budget = kSettleBudget;
    return r;
}

// The pictures that need no pages: the truth, and direct shading of one sample with its geometry and with the
// frame's own.
Status shade_directly(const BenchRequest& request, const std::filesystem::path& project,
                      std::vector<Scene>& scenes) {
    auto reference = ReferenceView::open(project, request.session, kTruthSamples);
    if (!reference) return reference.error();
    auto session = open_read_only(project, request.session);
    if (!session) return session.error();
    SessionDesc full = request.session;
    full.renderer = reference_renderer(full.renderer);
    auto full_session = open_read_only(project, full);
    if (!full_session) return full_session.error();
    for (Scene& scene : scenes) {
        auto truth = reference->picture(scene.view.camera, request.width, request.height);
        if (!truth) return truth.error();
        scene.reference = std::move(*truth);
        RenderRequest direct = request_of(request, scene.view.camera);
        direct.frame.page_budget = 0;
        const auto shade = [&](Session& in, Shading shading, Picture& out) -> Status {
            direct.frame.shading = shading;
            auto picture = in.render(direct);
            if (!picture) return picture.error();
            out = std::move(*picture);
            return {};
        };
        LOAM_TRY(shade(**full_session, Shading::direct, scene.direct_full));
        LOAM_TRY(shade(**session, Shading::direct, scene.direct));
        LOAM_TRY(shade(**session, Shading::direct_texels, scene.texels));
    }
    return {};
}

Status measure_level(const BenchRequest& request, const std::filesystem::path& project, size_t level,
                     const Format& format, std::vector<Scene>& scenes, BenchReport& report) {
    SessionDesc desc = request.session;
    desc.renderer.quality = kLevels[level];
    desc.renderer.page_format = format.format;
    auto session = open_read_only(project, desc);
    if (!session) return session.error();
    for (Scene& scene : scenes) {
        const RenderRequest r = request_of(request, scene.view.camera);
        auto picture = (*session)->render(r);
        if (!picture) return picture.error();
        const bool settled = (*session)->last_render_settled();
        std::vector<double> still_ms, moving_ms;
        for (int i = 0; i < (request.quick ? 3 : kTimedFrames); ++i) {
            const auto timed = [&](const FrameSettings& settings, std::vector<double>& out) -> Status {
                const double start_ms = now_ms();
                LOAM_TRY((*session)->step(r.camera, r.width, r.height, settings, 1));
                out.push_back(now_ms() - start_ms);
                return {};
            };
            LOAM_TRY(timed(r.frame, still_ms));
            LOAM_TRY(timed(moving_frame(1), moving_ms));
        }
        auto renderer = (*session)->renderer();
        if (!renderer) return renderer.error();
        const auto statistics = (*renderer)->statistics().texture;
        const Error error = error_of(*picture, scene.reference);
        // Causes are told apart with the filter that direct shading has.
        RenderRequest plain = r;
        plain.frame = trilinear_frame();
        plain.frame.page_budget = kSettleBudget;
        auto trilinear = (*session)->render(plain);
        if (!trilinear) return trilinear.error();
        report[0].rows.push_back({{"ground", scene.name},
                                  {"view", scene.view.name},
                                  {"level", kLevelNames[level]},
                                  {"pages", format.name},
                                  {"still frame ms", rounded(percentile(still_ms, 0.5), 1)},
                                  {"moving frame ms", rounded(percentile(moving_ms, 0.5), 1)},
                                  {"texture MB", rounded(double(statistics.gpu_bytes) / (1 << 20), 1)},
                                  {"PSNR dB", rounded(error.psnr, 2)},
                                  {"detail", rounded(error.detail, 3)},
                                  {"settled", settled}});
        if (!request.pictures.empty())
            LOAM_TRY(save_png(request.pictures / fmt::format("{}-{}-{}-{}.png", scene.name, scene.view.name,
                                                             kLevelNames[level], format.name),
                              *picture));
        const auto cause = [&](const std::string& name, const Picture& with, const Picture& without) {
            const Error e = error_of(with, without);
            report[1].rows.push_back({{"ground", scene.name},
                                      {"view", scene.view.name},
                                      {"cause", name},
                                      {"PSNR dB", decibels(e.psnr)},
                                      {"detail", rounded(e.detail, 3)}});
        };
        if (kLevels[level] != Quality::high) {
            if (format.format == PageFormat::rgba8 && kLevels[level] == Quality::ultra) {
                cause("page resolution: high against ultra", scene.pages, *trilinear);
            }
            continue;
        }
        if (format.format != PageFormat::rgba8) {
            cause(fmt::format("block compression: {} against uncompressed", format.name), *trilinear,
                  scene.pages);
            continue;
        }
        scene.pages = std::move(*trilinear);
        cause(fmt::format("samples: one a pixel against {}", kTruthSamples * kTruthSamples),
              scene.direct_full, scene.reference);
        cause("geometry: the frame's cut against the full one", scene.direct, scene.direct_full);
        cause("filter: between texels and mips against direct", scene.texels, scene.direct);
        cause("paging: uncompressed pages against direct with the same filter", scene.pages, scene.texels);
    }
    return {};
}

Status measure_project(const BenchRequest& request, const std::string& name,
                       const std::filesystem::path& project, BenchReport& report) {
    std::vector<Scene> scenes;
    std::vector<Format> formats;
    {
        auto session = open_read_only(project, request.session);
        if (!session) return session.error();
        formats = formats_for((*session)->document().settings());
        auto views = views_of(request, **session);
        if (!views) return views.error();
        for (View& view : *views) scenes.push_back({.name = name, .view = std::move(view)});
    }
    LOAM_TRY(shade_directly(request, project, scenes));
    if (!request.pictures.empty())
        for (const Scene& scene : scenes) {
            const auto save = [&](const char* what, const Picture& picture) {
                return save_png(request.pictures / fmt::format("{}-{}-{}.png", name, scene.view.name, what),
                                picture);
            };
            LOAM_TRY(save("reference", scene.reference));
            LOAM_TRY(save("direct", scene.direct));
            LOAM_TRY(save("texels", scene.texels));
        }
    for (size_t level = 0; level < std::size(kLevels); ++level)
        for (const Format& format : formats) {
            if (request.quick && kLevels[level] != Quality::high) continue;
            LOAM_TRY(measure_level(request, project, level, format, scenes, report));
        }
    return {};
}

}  // namespace

Result<BenchReport> bench_quality(const BenchRequest& request) {
    BenchReport report{
        {fmt::format("against the reference, {}x{}, one sample a pixel", request.width, request.height), {}},
        {"the error at the high level by cause: with it against without it", {}}};
    if (request.dem.empty()) {
        LOAM_TRY(measure_project(request, request.project.filename().string(), request.project, report));
        return report;
    }
    for (const Ground& ground : kGrounds) {
        ImportRequest import{
            .heights = request.dem / ground.file,
            .project = {},
            .spacing_m = ground.spacing_m,
            .scale = {.has_step = true, .offset_m = ground.offset_m, .step_m = ground.step_m},
            .fill_nan_m = std::nullopt,
            .crop = ground.crop,
            .layer_size_texels = 64};
        auto project = TemporaryProject::create_import(import, request.project);
        if (!project) return project.error();
        LOAM_TRY(measure_project(request, std::filesystem::path(ground.file).stem().string(), project->path(),
                                 report));
    }
    return report;
}

}  // namespace loam::bench
