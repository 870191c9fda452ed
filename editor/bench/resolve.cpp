// The resolve alone against its floor (shaders/frame/resolve_floor.frag): three bilinear RGBA8 samples and
// the same light, in one run, in turns, submit to fence.
#include <algorithm>

#include "editor/bench/bench.h"

namespace loam::bench {

namespace {

constexpr int kTurns = 60;

}  // namespace

Result<BenchReport> bench_resolve(const BenchRequest& request) {
    using Probe = Renderer::ResolveProbe;
    SessionDesc desc = request.session;
    desc.renderer.page_format = PageFormat::rgba8;
    auto session = Session::open(request.project, desc);
    if (!session) return session.error();
    Session& s = **session;
    const glm::dvec2 c = s.document().bounds().center();
    auto ground = s.height_m(c.x, c.y);
    if (!ground) return ground.error();
    // Ground to all edges of the picture, near and far.
    const Camera camera = request.camera
                              ? *request.camera
                              : Camera::look_at({c.x, c.y - 60, *ground + 60}, {c.x, c.y, *ground});
    auto renderer = s.renderer();
    if (!renderer) return renderer.error();
    BenchReport report{
        {fmt::format("resolve at {}x{}, medians of {} turns", request.width, request.height, kTurns), {}}};
    for (const bool fine : {false, true}) {
        FrameSettings settings;
        settings.at_rest = fine;
        settings.filter = fine ? Filter::trilinear : Filter::bilinear;
        auto picture =
            s.render({.camera = camera, .width = request.width, .height = request.height, .frame = settings});
        if (!picture) return picture.error();
        std::vector<double> resolve, floor, empty;
        for (int i = -5; i < (request.quick ? 5 : kTurns); ++i) {
            auto none = resolve_probe_ms(s, nullptr, Probe::floor);
            if (!none) return none.error();
            auto real = resolve_probe_ms(s, &settings, Probe::resolve);
            if (!real) return real.error();
            auto least = resolve_probe_ms(s, &settings, Probe::floor);
            if (!least) return least.error();
            if (i < 0) continue;  // pipelines compile
            empty.push_back(*none);
            resolve.push_back(*real);
            floor.push_back(*least);
        }
        const double none_ms = spread_of(empty).median, resolve_ms = spread_of(resolve).median - none_ms,
                     floor_ms = spread_of(floor).median - none_ms;
        const auto least = [](const std::vector<double>& v) { return *std::min_element(v.begin(), v.end()); };
        report[0].rows.push_back(
            {{"filter", fine ? "fine: two mips, five shadow taps" : "fast: one mip, one shadow tap"},
             {"resolve ms", rounded(resolve_ms, 2)},
             {"floor ms", rounded(floor_ms, 2)},
             {"empty frame ms", rounded(none_ms, 2)},
             {"ratio", rounded(resolve_ms / floor_ms, 2)},
             {"ratio of the best", rounded((least(resolve) - none_ms) / (least(floor) - none_ms), 2)}});
    }
    return report;
}

}  // namespace loam::bench
