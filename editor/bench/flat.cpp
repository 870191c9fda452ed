// A steady flight costs the same on maps of 1, 4 and 16 km: the same square kilometre on each, seen from the
// same places, the maps taking turns frame by frame so that drift of the machine hits all alike.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "editor/bench/bench.h"

namespace loam::bench {

namespace {

constexpr double kSides_m[] = {1024, 4096, 16384};
constexpr int kFrames = 300, kQuickFrames = 12;
constexpr int kWarmFrames = 60;  // pipelines, first pages
constexpr double kSpeed_m_s = 20, kFrame_s = 1.0 / 30;
constexpr double kAbove_m = 25, kAhead_m = 25;  // 45 degrees down: nothing beyond the square is in view

Result<Camera> camera_at(Session& session, double part_m, double along_m) {
    const double middle_m = 0.5 * part_m, radius_m = 0.17 * part_m;
    const double angle = along_m / radius_m;
    const auto at = [&](double a) {
        return glm::dvec2(middle_m + radius_m * std::sin(a), middle_m - radius_m * std::cos(a));
    };
    const glm::dvec2 here = at(angle), there = at(angle + kAhead_m / radius_m);
    auto low = session.height_m(here.x, here.y);
    if (!low) return low.error();
    auto ahead = session.height_m(there.x, there.y);
    if (!ahead) return ahead.error();
    return Camera::look_at({here, std::max(*low, *ahead) + kAbove_m}, {there, *ahead});
}

}  // namespace

Result<BenchReport> bench_flat(const BenchRequest& request) {
    auto settings = load_project(request.project);
    if (!settings) return settings.error();
    const WorldRect whole = settings->bounds();
    const double part_m = std::min({kSides_m[0], whole.width(), whole.height()});
    std::vector<TemporaryProject> projects;
    std::vector<std::unique_ptr<Session>> sessions;
    for (const double side_m : kSides_m) {
        auto project =
            TemporaryProject::create_part({.of = request.project, .part_m = part_m, .side_m = side_m});
        if (!project) return project.error();
        projects.push_back(std::move(*project));
        auto session = Session::open(projects.back().path(), request.session);
        if (!session) return session.error();
        sessions.push_back(std::move(*session));
    }
    constexpr size_t kMaps = std::size(kSides_m);
    std::vector<double> times[kMaps];
    const int warm = request.quick ? 6 : kWarmFrames, frames = request.quick ? kQuickFrames : kFrames;
    for (int i = -warm; i < frames; ++i) {
        auto camera = camera_at(*sessions[0], part_m, i * kSpeed_m_s * kFrame_s);
        if (!camera) return camera.error();
        for (size_t turn = 0; turn < kMaps; ++turn) {
            const size_t map = (turn + static_cast<size_t>(i + warm)) % kMaps;
            const double start_ms = now_ms();
            LOAM_TRY(sessions[map]->step(*camera, request.width, request.height, moving_frame(0.5f), 1));
            if (i >= 0) times[map].push_back(now_ms() - start_ms);
        }
    }
    BenchTable table{fmt::format("a flight over the same ground at {} m/s, {}x{} at half its resolution",
                                 kSpeed_m_s, request.width, request.height),
                     {}};
    const double first_ms = percentile(times[0], 0.5);
    for (size_t map = 0; map < kMaps; ++map) {
        auto renderer = sessions[map]->renderer();
        if (!renderer) return renderer.error();
        const FrameStatistics statistics = (*renderer)->statistics();
        const double median_ms = percentile(times[map], 0.5);
        double total_ms = 0;
        for (const double ms : times[map]) total_ms += ms;
        table.rows.push_back({{"map", fmt::format("{} m", kSides_m[map])},
                              {"frames", frames},
                              {"median ms", rounded(median_ms, 2)},
                              {"mean ms", rounded(total_ms / frames, 2)},
                              {"p95 ms", rounded(percentile(times[map], 0.95), 2)},
                              {"to the first", rounded(median_ms / first_ms, 3)},
                              {"patches", statistics.patches},
                              {"patches in view", statistics.patches_visible},
                              {"texture pages composed", statistics.texture.pages_composed},
                              {"height pages composed", statistics.height.pages_composed}});
    }
    return BenchReport{table};
}

}  // namespace loam::bench
