// Ways to filter the virtual texture, on three views: what the resolve takes (in turns, in one run), and how
// far the picture is from the reference (per pixel, uncached, supersampled).
#include <algorithm>
#include <array>
#include <cstring>

#include "editor/bench/bench.h"
#include "editor/picture.h"
#include "shaders/frame/tiles_io.h"

namespace loam::bench {

namespace {

constexpr int kSettleBudget = 40;  // pages a frame while nothing is timed
constexpr int kTurns = 15;

struct Way {
    const char* name;
    Filter filter;
    int taps = kMaxTaps;
    bool at_rest = true;
};
// The first is the window's in motion on the software profile, with its cheaper shadows.
constexpr Way kWays[] = {
    {"bilinear, moving", Filter::bilinear, 1, false},
    {"bilinear", Filter::bilinear},
    {"trilinear", Filter::trilinear},
    {"tiles, 2 taps", Filter::anisotropic_tiles, 2},
    {"tiles, 4 taps", Filter::anisotropic_tiles, 4},
    {"tiles, 8 taps", Filter::anisotropic_tiles, 8},
    {"hardware", Filter::anisotropic_hardware},
};

FrameSettings settings_of(const Way& way) {
    FrameSettings settings = still_frame();
    settings.at_rest = way.at_rest;
    settings.filter = way.filter;
    settings.most_taps = way.taps;
    settings.page_budget = kSettleBudget;
    return settings;
}

// Tiles a class of the newest resolve.
Result<std::array<uint32_t, kTapClasses>> tiles_by_class(Session& session) {
    std::array<uint32_t, kTapClasses> count{};
    auto renderer = session.renderer();
    if (!renderer) return renderer.error();
    auto frame = session.ring()->begin();
    if (!frame) return frame.error();
    gpu::Buffer& draws = (*renderer)->filter_tiles().draws();
    session.ring()->read_back((*frame)->commands, draws, 0, draws.size_bytes(),
                              [&count](std::span<const std::byte> bytes) {
                                  std::array<shared::TileDraw, kTapClasses> got{};
                                  std::memcpy(got.data(), bytes.data(), sizeof got);
                                  for (size_t c = 0; c < count.size(); ++c) count[c] = got[c].instance_count;
                              });
    LOAM_TRY(session.ring()->finish(**frame));
    return count;
}

// The renderer takes tiles in the place of a software device's sampler.
size_t way_count(Session& session) {
    return std::size(kWays) - (session.device()->caps().profile == gpu::Profile::software ? 1 : 0);
}

struct Times {
    std::vector<double> resolve, floor;
};

// The resolve alone, of each way's own frame, in turns.
Result<std::vector<Times>> resolve_times(const BenchRequest& request, Session& session,
                                         const Camera& camera) {
    std::vector<Times> times(way_count(session));
    for (int turn = -1; turn < (request.quick ? 2 : kTurns); ++turn)  // the first compiles pipelines
        for (size_t i = 0; i < times.size(); ++i) {
            const FrameSettings settings = settings_of(kWays[i]);
            LOAM_TRY(session.step(camera, request.width, request.height, settings, 1));
            auto none = resolve_probe_ms(session, nullptr, Renderer::ResolveProbe::floor);
            if (!none) return none.error();
            auto least = resolve_probe_ms(session, &settings, Renderer::ResolveProbe::floor);
            if (!least) return least.error();
            auto real = resolve_probe_ms(session, &settings, Renderer::ResolveProbe::resolve);
            if (!real) return real.error();
            if (turn < 0) continue;
            times[i].floor.push_back(*least - *none);
            times[i].resolve.push_back(*real - *none);
        }
    return times;
}

Status measure_view(const BenchRequest& request, Session& session, const View& view, const Picture& truth,
                    BenchReport& report) {
    const size_t first = report[0].rows.size();
    auto started = session.renderer();
    if (!started) return started.error();
    for (const Way& way : std::span(kWays).first(way_count(session))) {
        auto picture = session.render({.camera = view.camera,
                                       .width = request.width,
                                       .height = request.height,
                                       .frame = settings_of(way)});
        if (!picture) return picture.error();
        Json row{{"view", view.name}, {"filter", way.name}, {"resolve ms", Json()}, {"of the floor", Json()}};
        const bool tiles = way.filter == Filter::anisotropic_tiles;
        std::array<uint32_t, kTapClasses> count{};
        if (tiles) {
            auto counted = tiles_by_class(session);
            if (!counted) return counted.error();
            count = *counted;
        }
        const double all = std::max(1u, count[0] + count[1] + count[2] + count[3]);
        for (size_t c = 0; c < count.size(); ++c)
            row[fmt::format("{} tap{}", 1 << c, c ? "s" : "")] =
                tiles ? Json(rounded(count[c] / all, 3)) : Json();
        row["pages"] = (*started)->statistics().texture.resident_pages;
        row["PSNR dB"] = rounded(psnr_db(*picture, truth), 2);
        row["detail"] = rounded(laplacian_energy(*picture) / std::max(1e-9, laplacian_energy(truth)), 3);
        row["settled"] = session.last_render_settled();
        report[0].rows.push_back(std::move(row));
        if (!request.pictures.empty())
            LOAM_TRY(save_png(request.pictures / fmt::format("{}-{}.png", view.name, way.name), *picture));
    }
    auto times = resolve_times(request, session, view.camera);
    if (!times) return times.error();
    for (size_t i = 0; i < times->size(); ++i) {
        const double ms = spread_of((*times)[i].resolve).median,
                     floor_ms = spread_of((*times)[i].floor).median;
        report[0].rows[first + i]["resolve ms"] = rounded(ms, 2);
        report[0].rows[first + i]["of the floor"] = rounded(ms / floor_ms, 2);
    }
    return {};
}

}  // namespace

Result<BenchReport> bench_filter(const BenchRequest& request) {
    auto session = open_read_only(request.project, request.session);
    if (!session) return session.error();
    auto views = views_of(request, **session);
    if (!views) return views.error();
    auto reference = ReferenceView::open(request.project, request.session, kTruthSamples);
    if (!reference) return reference.error();
    BenchReport report{
        {fmt::format("filters at {}x{}; shares of the tiles by taps", request.width, request.height), {}}};
    for (const View& view : *views) {
        auto truth = reference->picture(view.camera, request.width, request.height);
        if (!truth) return truth.error();
        if (!request.pictures.empty())
            LOAM_TRY(save_png(request.pictures / fmt::format("{}-reference.png", view.name), *truth));
        LOAM_TRY(measure_view(request, **session, view, *truth, report));
    }
    return report;
}

}  // namespace loam::bench
