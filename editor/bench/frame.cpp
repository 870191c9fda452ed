// A fly-through with painting, as a person would do it: every frame moves the camera, every fourth one paints
// or digs. The render scale follows a frame-time goal.
#include <algorithm>
#include <cmath>

#include "editor/bench/bench.h"

namespace loam::bench {

namespace {

constexpr double kSpeed_m_s = 40, kHeightAboveGround_m = 25, kFrame_s = 1.0 / 30;
constexpr float kScales[] = {1.0f, 0.75f, 2.0f / 3, 0.5f, 1.0f / 3, 0.25f};
constexpr int kSettleFrames = 12;  // at a scale before it is judged

Command edit_of(int i, glm::dvec2 place, uint64_t group) {
    if (i % 2 == 0) {
        PaintCommand paint;
        paint.dabs = {place};
        paint.radius_m = 6;
        paint.tint = {{0.8, 0.4, 0.3}};
        paint.seed = static_cast<uint32_t>(i);
        return {paint, group};
    }
    SculptCommand sculpt;
    sculpt.mode = SculptMode::lower;
    sculpt.dabs = {place};
    sculpt.radius_m = 6;
    sculpt.strength = 0.2;
    return {sculpt, group};
}

Camera camera_at(Session& session, double along_m, double& ground_m) {
    const WorldRect bounds = session.document().bounds();
    const glm::dvec2 c = bounds.center();
    const double radius_m = 0.3 * std::min(bounds.width(), bounds.height());
    const double angle = along_m / radius_m;
    const glm::dvec2 at(c.x + radius_m * std::sin(angle), c.y - radius_m * std::cos(angle));
    const glm::dvec2 ahead(c.x + radius_m * std::sin(angle + 60 / radius_m),
                           c.y - radius_m * std::cos(angle + 60 / radius_m));
    const auto here = session.height_m(at.x, at.y), there = session.height_m(ahead.x, ahead.y);
    const double wanted_m = std::max(here ? *here : 0.0, there ? *there : 0.0);
    ground_m += (wanted_m - ground_m) * 0.1;
    return Camera::look_at({at.x, at.y, std::max(ground_m, wanted_m) + kHeightAboveGround_m},
                           {ahead.x, ahead.y, there ? *there : 0.0});
}

}  // namespace

Result<BenchReport> bench_frame(const BenchRequest& request) {
    auto copy = TemporaryProject::create_copy(request.project);
    if (!copy) return copy.error();
    auto session = Session::open(copy->path(), request.session);
    if (!session) return session.error();
    Session& s = **session;
    const glm::dvec2 c = s.document().bounds().center();
    auto start_height = s.height_m(c.x, c.y);
    if (!start_height) return start_height.error();
    double ground_m = *start_height;
    // Warm: pipelines and the first pages.
    LOAM_TRY(s.step(camera_at(s, 0, ground_m), request.width, request.height, {}, 20));

    const uint64_t group = s.document().next_group();
    size_t scale = 0;
    std::vector<double> recent, all, edits;
    std::vector<double> steady;  // frames at the final scale
    for (int i = 0; i < request.frames; ++i) {
        const Camera camera = camera_at(s, i * kSpeed_m_s * kFrame_s, ground_m);
        const double start_ms = now_ms();
        if (i % 4 == 0) {
            const glm::dvec3 forward = camera.forward();
            const glm::dvec2 place(camera.position_m.x + forward.x * 30,
                                   camera.position_m.y + forward.y * 30);
            auto dirt = s.apply(edit_of(i / 4, place, group));
            if (!dirt) return dirt.error();
            edits.push_back(now_ms() - start_ms);
        }
        LOAM_TRY(s.step(camera, request.width, request.height, moving_frame(kScales[scale]), 1));
        const double ms = now_ms() - start_ms;
        all.push_back(ms);
        recent.push_back(ms);
        steady.push_back(ms);
        if (recent.size() == kSettleFrames) {
            if (spread_of(recent).median > request.goal_ms && scale + 1 < std::size(kScales)) {
                ++scale;
                steady.clear();
            }
            recent.clear();
        }
    }
    const Spread a = spread_of(all), b = spread_of(steady), e = spread_of(edits);
    const auto row = [](const char* name, const Spread& spread, size_t count) {
        return Json{{"what", name},
                    {"count", count},
                    {"median ms", rounded(spread.median, 1)},
                    {"p95 ms", rounded(spread.p95, 1)},
                    {"max ms", rounded(spread.max, 1)}};
    };
    BenchReport report{{fmt::format("fly-through with painting, {}x{}, goal {} ms: render scale {:.2f}",
                                    request.width, request.height, request.goal_ms, kScales[scale]),
                        {row("frames at that scale", b, steady.size()), row("all frames", a, all.size()),
                         row("commands", e, edits.size())}}};
    auto renderer = s.renderer();
    if (!renderer) return renderer.error();
    BenchTable passes{"passes of the last frame, by timestamps (display only)", {}};
    for (const gpu::PassTime& pass : (*renderer)->statistics().passes)
        passes.rows.push_back({{"pass", std::string(pass.name)}, {"gpu ms", rounded(pass.gpu_ms, 2)}});
    report.push_back(passes);
    return report;
}

}  // namespace loam::bench
