// How soon the picture is as sharp as it wants to be: the share of the picture's cells that show the mip they
// want, frame by frame, after a jump with and without announcement, in a half-turn and in a fast dolly.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <utility>

#include "editor/bench/bench.h"

namespace loam::bench {

namespace {

constexpr int kMostFrames = 300;
constexpr int kDrain = 4;  // feedback of a frame is known three frames later
constexpr int kShownFrames[] = {0, 1, 2, 3, 5, 8, 13, 21, 34, 55, 89};
constexpr double kFrame_s = 1.0 / 30, kDolly_m_s = 30;
constexpr int kTurnFrames = 15;  // half a second for the half-turn

struct Place {
    glm::dvec2 at{0};
    double ground_m = 0;
    [[nodiscard]] Camera camera(double yaw_rad) const {
        Camera camera;
        camera.position_m = {at, ground_m + 8};
        camera.yaw_rad = yaw_rad;
        camera.pitch_rad = -0.35;
        return camera;
    }
};

// 0 and 1 are the places of the jump: corners of a square of up to 1.2 km in the middle of the map.
Result<Place> place_of(Session& session, double share) {
    const WorldRect bounds = session.document().bounds();
    const double away_m = std::min(600.0, 0.3 * std::min(bounds.width(), bounds.height()));
    Place place{.at = bounds.center() + glm::dvec2(away_m, away_m) * (2 * share - 1)};
    auto ground = session.height_m(place.at.x, place.at.y);
    if (!ground) return ground.error();
    place.ground_m = *ground;
    return place;
}

using CameraOf = std::function<Result<Camera>(int frame)>;

// Shares of the cells at the wanted mip by frame; negative where no feedback came back.
Result<std::vector<double>> shares(Session& session, const BenchRequest& request,
                                   const FrameSettings& settings, const CameraOf& camera_of, int frames) {
    auto renderer = session.renderer();
    if (!renderer) return renderer.error();
    const auto first = static_cast<uint64_t>(session.frames_rendered()) + 1;
    std::vector<double> out(static_cast<size_t>(frames), -1);
    Camera camera;
    for (int i = 0; i < frames + kDrain; ++i) {
        if (i < frames) {
            auto next = camera_of(i);
            if (!next) return next.error();
            camera = *next;
        }
        LOAM_TRY(session.step(camera, request.width, request.height, settings, 1));
        const auto sharpness = (*renderer)->statistics().texture.sharpness;
        if (sharpness.view_frame < first || sharpness.view_frame - first >= out.size()) continue;
        out[sharpness.view_frame - first] =
            sharpness.cells == 0 ? 1.0 : static_cast<double>(sharpness.coarser[0]) / sharpness.cells;
    }
    return out;
}

// The first frame from which on the share never falls below; null when that is not reached.
Json frames_until(const std::vector<double>& shares, double share) {
    size_t from = shares.size();
    for (size_t i = shares.size(); i-- > 0 && (shares[i] >= share || shares[i] < 0);) from = i;
    return from < shares.size() ? Json(from) : Json();
}

Json share_row(const std::string& motion, const std::vector<double>& shares) {
    Json row{{"motion", motion}};
    for (const int frame : kShownFrames)
        row[fmt::format("frame {}", frame)] =
            static_cast<size_t>(frame) < shares.size() && shares[static_cast<size_t>(frame)] >= 0
                ? Json(rounded(shares[static_cast<size_t>(frame)], 3))
                : Json();
    double least = 1, sum = 0;
    size_t count = 0;
    for (const double share : shares)
        if (share >= 0) {
            least = std::min(least, share);
            sum += share;
            ++count;
        }
    row["least"] = rounded(least, 3);
    row["mean"] = rounded(sum / static_cast<double>(std::max<size_t>(1, count)), 3);
    return row;
}

Result<std::unique_ptr<Session>> settled_at(const BenchRequest& request, const FrameSettings& settings,
                                            Place& from, Place& to) {
    auto session = open_read_only(request.project, request.session);
    if (!session) return session;
    auto a = place_of(**session, 0), b = place_of(**session, 1);
    if (!a) return a.error();
    if (!b) return b.error();
    from = *a;
    to = *b;
    auto picture = (*session)->render(
        {.camera = from.camera(0.6), .width = request.width, .height = request.height, .frame = settings});
    if (!picture) return picture.error();
    return session;
}

// A jump from a settled picture to another place, which was announced so many frames before.
Result<std::vector<double>> jump(const BenchRequest& request, const FrameSettings& settings, int announced,
                                 int frames) {
    Place from, to;
    auto session = settled_at(request, settings, from, to);
    if (!session) return session.error();
    auto renderer = (*session)->renderer();
    if (!renderer) return renderer.error();
    const Camera there = to.camera(2.2);
    if (announced > 0) {
        (*renderer)->announce(there);
        LOAM_TRY((*session)->step(from.camera(0.6), request.width, request.height, settings, announced));
    }
    bool arrived = false;
    return shares(
        **session, request, settings,
        [&](int) -> Result<Camera> {
            if (std::exchange(arrived, true)) (*renderer)->announce(std::nullopt);
            return there;
        },
        frames);
}

Result<std::vector<double>> half_turn(const BenchRequest& request, const FrameSettings& settings,
                                      int frames) {
    Place from, to;
    auto session = settled_at(request, settings, from, to);
    if (!session) return session.error();
    return shares(
        **session, request, settings,
        [&](int i) -> Result<Camera> {
            return from.camera(0.6 + std::numbers::pi * std::min(1.0, (i + 1.0) / kTurnFrames));
        },
        frames);
}

Result<std::vector<double>> dolly(const BenchRequest& request, const FrameSettings& settings, int frames) {
    Place from, to;
    auto session = settled_at(request, settings, from, to);
    if (!session) return session.error();
    const glm::dvec2 along = glm::dvec2(std::sin(0.6), std::cos(0.6)) * kDolly_m_s * kFrame_s;
    return shares(
        **session, request, settings,
        [&](int i) -> Result<Camera> {
            Place here = from;
            here.at += along * (i + 1.0);
            auto ground = (*session)->height_m(here.at.x, here.at.y);
            if (!ground) return ground.error();
            // The height follows the ground gently: a dolly, not a walk.
            here.ground_m = from.ground_m += (*ground - from.ground_m) * 0.2;
            return here.camera(0.6);
        },
        frames);
}

}  // namespace

Result<BenchReport> bench_converge(const BenchRequest& request) {
    const int most = request.quick ? 12 : kMostFrames;
    FrameSettings at_rest = still_frame();
    at_rest.render_scale = 0.5f;
    const FrameSettings moving = moving_frame(0.5f);
    const std::string size = fmt::format("{}x{} at half its resolution", request.width, request.height);
    BenchReport report{
        {fmt::format("after a jump, {}: frames from which on so many cells show the wanted mip", size), {}},
        {"the same in motion, share of cells at the wanted mip by frame: the window's settings while it "
         "moves",
         {}}};
    const auto jump_row = [&](int budget, int announced) -> Status {
        FrameSettings settings = at_rest;
        settings.page_budget = budget;
        auto found = jump(request, settings, announced, most);
        if (!found) return found.error();
        report[0].rows.push_back({{"announced, frames", announced},
                                  {"pages a frame", budget},
                                  {"first frame", rounded((*found)[0], 3)},
                                  {"second", rounded((*found)[1], 3)},
                                  {"95 %", frames_until(*found, 0.95)},
                                  {"99 %", frames_until(*found, 0.99)},
                                  {"100 %", frames_until(*found, 1)}});
        return {};
    };
    for (const int budget : {1, 2, 4, 8, 20})
        if (!request.quick || budget == 8) LOAM_TRY(jump_row(budget, 0));
    for (const int announced : {15, 30, 60, 120})
        if (!request.quick || announced == 30) LOAM_TRY(jump_row(2, announced));
    const int shown = request.quick ? 12 : kShownFrames[std::size(kShownFrames) - 1] + 1;
    const auto motion_row = [&](const std::string& name, const Result<std::vector<double>>& found) -> Status {
        if (!found) return found.error();
        report[1].rows.push_back(share_row(name, *found));
        return {};
    };
    LOAM_TRY(motion_row("jump", jump(request, moving, 0, shown)));
    LOAM_TRY(motion_row("jump, announced 60 frames", jump(request, moving, request.quick ? 6 : 60, shown)));
    LOAM_TRY(
        motion_row(fmt::format("half-turn in {} frames", kTurnFrames), half_turn(request, moving, shown)));
    LOAM_TRY(motion_row(fmt::format("dolly, {} m/s", kDolly_m_s), dolly(request, moving, shown)));
    return report;
}

}  // namespace loam::bench
