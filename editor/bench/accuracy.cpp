// Accuracy against the reference (per pixel, uncached, uncompressed, full geometry, supersampled), and time,
// together.
#include <optional>

#include "editor/bench/bench.h"
#include "editor/picture.h"

namespace loam::bench {

namespace {

struct Setting {
    const char* name;
    Quality quality;
    PageFormat format;
    Shading shading = Shading::virtual_texture;
    bool fine_filter = true;
    float render_scale = 1;
    int supersample = 1;
};

constexpr Setting kSettings[] = {
    {.name = "rgba8 pages, mid, 2x2 samples",
     .quality = Quality::mid,
     .format = PageFormat::rgba8,
     .supersample = 2},
    {.name = "rgba8 pages, mid", .quality = Quality::mid, .format = PageFormat::rgba8},
    {.name = "bc1 pages, mid", .quality = Quality::mid, .format = PageFormat::bc1x3},
    {.name = "bc1 pages, low", .quality = Quality::low, .format = PageFormat::bc1x3},
    {.name = "rgba8 pages, low, coarse filter",
     .quality = Quality::low,
     .format = PageFormat::rgba8,
     .fine_filter = false},
    {.name = "direct, 1 sample",
     .quality = Quality::low,
     .format = PageFormat::rgba8,
     .shading = Shading::direct},
};

struct View {
    std::string name;
    Camera camera;
};

Result<std::vector<View>> views_of(const BenchRequest& request, Session& session) {
    if (request.camera) return std::vector<View>{{"camera", *request.camera}};
    const WorldRect bounds = session.document().bounds();
    const glm::dvec2 c = bounds.center();
    auto ground = session.height_m(c.x, c.y);
    if (!ground) return ground.error();
    std::vector<View> views{{"whole map", session.default_camera()}};
    const auto above = [&](double back_m, double up_m, double target_up_m) {
        return Camera::look_at({c.x, c.y - back_m, *ground + up_m}, {c.x, c.y, *ground + target_up_m});
    };
    if (request.quick) return std::vector<View>{{"30 m", above(40, 30, 0)}};
    views.push_back({"30 m", above(40, 30, 0)});
    views.push_back({"2 m", above(4, 2, 0)});
    return views;
}

Result<Json> measure(Session& session, const Setting& setting, const RenderRequest& base,
                     const Picture& reference) {
    RenderRequest r = base;
    r.supersample = setting.supersample;
    r.frame.shading = setting.shading;
    r.frame.fine_filter = setting.fine_filter;
    r.frame.render_scale = setting.render_scale;
    const double start_ms = now_ms();
    auto picture = session.render(r);
    if (!picture) return picture.error();
    const double settle_ms = now_ms() - start_ms;
    std::vector<double> frames;
    for (int i = 0; i < 15; ++i) {
        const double frame_start_ms = now_ms();
        LOAM_TRY(session.step(r.camera, r.width, r.height, r.frame, 1));
        frames.push_back(now_ms() - frame_start_ms);
    }
    return Json{
        {"PSNR dB", rounded(psnr_db(*picture, reference), 2)},
        {"fine detail", rounded(laplacian_energy(*picture) / std::max(1e-9, laplacian_energy(reference)), 3)},
        {"ms a frame", rounded(spread_of(frames).median * setting.supersample * setting.supersample, 1)},
        {"ms to settle", rounded(settle_ms, 0)},
        {"settled", session.last_render_settled()}};
}

}  // namespace

Result<BenchReport> bench_accuracy(const BenchRequest& request) {
    BenchReport report;
    std::vector<Picture> references;
    std::vector<View> views;
    {
        auto session = Session::open(request.project, request.session);
        if (!session) return session.error();
        auto chosen = views_of(request, **session);
        if (!chosen) return chosen.error();
        views = *chosen;
        for (const View& view : views) {
            auto picture = (*session)->render({.camera = view.camera,
                                               .width = request.width,
                                               .height = request.height,
                                               .frame = {},
                                               .reference = true});
            if (!picture) return picture.error();
            references.push_back(std::move(*picture));
            report.push_back(
                {fmt::format("{}, {}x{}, against the reference", view.name, request.width, request.height),
                 {}});
        }
    }
    for (const Setting& setting : kSettings) {
        if (request.quick && setting.supersample > 1) continue;
        SessionDesc desc = request.session;
        desc.renderer.quality = setting.quality;
        desc.renderer.page_format = setting.format;
        auto session = Session::open(request.project, desc);
        if (!session) return session.error();
        for (size_t v = 0; v < views.size(); ++v) {
            auto figures = measure(
                **session, setting,
                {.camera = views[v].camera, .width = request.width, .height = request.height, .frame = {}},
                references[v]);
            if (!figures) return figures.error();
            Json row{{"setting", setting.name}};
            row.update(*figures);
            report[v].rows.push_back(row);
        }
    }
    return report;
}

}  // namespace loam::bench
