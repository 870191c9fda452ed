// Frame time with the virtual texture against shading the same layers and decals pixel by pixel, in turns in
// one run: at rest, and moving sideways so that pages are composed.
#include <random>

#include "editor/bench/bench.h"

namespace loam::bench {

namespace {

constexpr int kTurns = 25;
constexpr double kSpeed_m_s = 3, kFrame_s = 1.0 / 30;
constexpr double kMostTurns_ms = 5'000;  // for each of the two measurements of a row

struct Place {
    glm::dvec3 eye, target;
    [[nodiscard]] Camera camera(double east_m) const {
        return Camera::look_at(eye + glm::dvec3(east_m, 0, 0), target + glm::dvec3(east_m, 0, 0));
    }
};

Result<Place> place_of(Session& session) {
    const glm::dvec2 c = session.document().bounds().center();
    auto ground = session.height_m(c.x, c.y);
    if (!ground) return ground.error();
    return Place{{c.x, c.y - 12, *ground + 8}, {c, *ground}};
}

// Craters and footprints by turns, evenly over the lower three quarters of the picture.
Status place_decals(Session& session, const Camera& camera, int count) {
    std::mt19937 random(5);
    const auto share = [&] { return static_cast<double>(random()) / 4294967296.0; };
    FootprintsCommand prints;
    const uint64_t group = session.document().next_group();
    for (int i = 0; i < count;) {
        const glm::dvec3 ray = camera.ray(share() * 16, (0.25 + 0.75 * share()) * 9, 16, 9);
        auto hit = session.ray_cast(camera.position_m, ray);
        if (!hit) return hit.error();
        if (!*hit) continue;
        const glm::dvec3 at = **hit;
        ++i;
        if (i % 2 == 0) {
            prints.prints.push_back(
                {.x_m = at.x, .y_m = at.y, .heading_rad = 6.28 * share(), .foot = i / 2 % 2});
            continue;
        }
        const CraterCommand crater{
            {.x_m = at.x, .y_m = at.y, .radius_m = 0.2 + 0.4 * share(), .seed = static_cast<uint32_t>(i)}};
        auto dirt = session.apply({crater, group});
        if (!dirt) return dirt.error();
    }
    if (prints.prints.empty()) return {};
    auto dirt = session.apply({prints, group});
    return dirt ? Status() : Status(dirt.error());
}

Result<double> frame_ms(Session& session, const BenchRequest& request, const Camera& camera,
                        Shading shading) {
    FrameSettings settings = trilinear_frame();
    settings.shading = shading;
    if (shading == Shading::direct) settings.page_budget = 0;  // pages are the other picture's
    const double start_ms = now_ms();
    LOAM_TRY(session.step(camera, request.width, request.height, settings, 1));
    return now_ms() - start_ms;
}

struct Pair {
    double cached_ms = 0, direct_ms = 0;
};
Result<Pair> in_turns(Session& session, const BenchRequest& request, const Place& place, double step_m) {
    std::vector<double> cached, direct;
    double east_m = 0;
    const double start_ms = now_ms();
    for (int i = -2; i < (request.quick ? 3 : kTurns); ++i) {
        if (i > 3 && now_ms() - start_ms > kMostTurns_ms) break;
        east_m += step_m;
        auto a = frame_ms(session, request, place.camera(east_m), Shading::virtual_texture);
        if (!a) return a.error();
        auto b = frame_ms(session, request, place.camera(east_m), Shading::direct);
        if (!b) return b.error();
        if (i < 0) continue;  // pipelines compile
        cached.push_back(*a);
        direct.push_back(*b);
    }
    return Pair{spread_of(cached).median, spread_of(direct).median};
}

// Resolve over floor, each less an empty frame.
Result<double> resolve_to_floor(Session& session, const BenchRequest& request) {
    using Probe = Renderer::ResolveProbe;
    const FrameSettings settings = trilinear_frame();
    std::vector<double> empty, resolve, floor;
    for (int i = -2; i < (request.quick ? 3 : kTurns); ++i)
        for (const auto& [times, with, probe] :
             {std::tuple{&empty, false, Probe::floor}, std::tuple{&resolve, true, Probe::resolve},
              std::tuple{&floor, true, Probe::floor}}) {
            auto ms = resolve_probe_ms(session, with ? &settings : nullptr, probe);
            if (!ms) return ms.error();
            if (i >= 0) times->push_back(*ms);
        }
    const double none_ms = spread_of(empty).median;
    return (spread_of(resolve).median - none_ms) / (spread_of(floor).median - none_ms);
}

}  // namespace

Result<BenchReport> bench_cost(const BenchRequest& request) {
    BenchTable table{fmt::format("virtual texture against direct shading, {}x{}, medians; moving: {} m/s",
                                 request.width, request.height, kSpeed_m_s),
                     {}};
    double first_ms = 0;
    for (const int layers : {4, 16, 64}) {
        if (request.quick && layers > 4) continue;
        auto project = TemporaryProject::create_part({.of = request.project, .layers = layers});
        if (!project) return project.error();
        int placed = 0;
        for (const int decals : {0, 200, 2000}) {
            if (request.quick && decals > 200) continue;
            auto session = Session::open(project->path(), request.session);
            if (!session) return session.error();
            Session& s = **session;
            auto place = place_of(s);
            if (!place) return place.error();
            LOAM_TRY(place_decals(s, place->camera(0), decals - placed));
            placed = decals;
            auto settled = s.render({.camera = place->camera(0),
                                     .width = request.width,
                                     .height = request.height,
                                     .frame = trilinear_frame()});
            if (!settled) return settled.error();
            auto still = in_turns(s, request, *place, 0);
            if (!still) return still.error();
            auto ratio = resolve_to_floor(s, request);
            if (!ratio) return ratio.error();
            auto moving = in_turns(s, request, *place, kSpeed_m_s * kFrame_s);
            if (!moving) return moving.error();
            if (first_ms == 0) first_ms = still->cached_ms;
            table.rows.push_back(
                {{"layers", layers},
                 {"decals", decals},
                 {"virtual ms", rounded(still->cached_ms, 1)},
                 {"to the first row's", rounded(still->cached_ms / first_ms, 2)},
                 {"direct ms", rounded(still->direct_ms, 1)},
                 {"direct / virtual", rounded(still->direct_ms / still->cached_ms, 2)},
                 {"moving: virtual ms", rounded(moving->cached_ms, 1)},
                 {"moving: direct ms", rounded(moving->direct_ms, 1)},
                 {"moving: direct / virtual", rounded(moving->direct_ms / moving->cached_ms, 2)},
                 {"resolve / floor", rounded(*ratio, 2)}});
        }
    }
    return BenchReport{table};
}

}  // namespace loam::bench
