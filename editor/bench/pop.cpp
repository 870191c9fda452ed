// A slow approach to the ground: how far each frame is from the one before, beside the reference's own step
// between the same cameras. A step larger than twice the reference's and 4 codes is a pop.
#include <cmath>

#include "editor/bench/bench.h"
#include "editor/picture.h"

namespace loam::bench {

namespace {

constexpr double kFrom_m = 60, kTo_m = 2;  // above the ground
constexpr int kFrames = 480, kQuickFrames = 6;
constexpr double kShare = 2, kCodes = 4;  // what is allowed beyond the reference's own step
constexpr double kStretches_m[] = {60, 30, 15, 8, 4, 2};

struct Way {
    const char* name;
    FrameSettings frame;
};

double height_at(int frame, int frames) {
    return kFrom_m * std::pow(kTo_m / kFrom_m, static_cast<double>(frame) / (frames - 1));
}

// Towards one place, 45 degrees down.
Camera camera_at(glm::dvec3 place, double above_m) {
    return Camera::look_at(place + glm::dvec3(0, -above_m, above_m), place);
}

Result<std::vector<Picture>> approach(const BenchRequest& request, const Way& way, glm::dvec3 place,
                                      int width, int height, int frames) {
    auto session = open_read_only(request.project, request.session);
    if (!session) return session.error();
    RenderRequest one{
        .camera = camera_at(place, kFrom_m), .width = width, .height = height, .frame = way.frame};
    auto settled = (*session)->render(one);
    if (!settled) return settled.error();
    one.max_frames = 1;
    std::vector<Picture> pictures;
    for (int i = 0; i < frames; ++i) {
        one.camera = camera_at(place, height_at(i, frames));
        auto picture = (*session)->render(one);
        if (!picture) return picture.error();
        pictures.push_back(std::move(*picture));
    }
    return pictures;
}

struct Stretch {
    int frames = 0, pops = 0, worst_frame = 0;
    double worst = 0;  // largest step over what is allowed
    PictureStep step, own, worst_step, worst_own;
    void add(int frame, const PictureStep& s, const PictureStep& reference) {
        const double over = std::max(s.tile / (kShare * reference.tile + kCodes),
                                     s.pixel / (kShare * reference.pixel + kCodes));
        ++frames;
        pops += over > 1;
        step = {std::max(step.tile, s.tile), std::max(step.pixel, s.pixel)};
        own = {std::max(own.tile, reference.tile), std::max(own.pixel, reference.pixel)};
        if (over <= worst) return;
        worst = over;
        worst_frame = frame;
        worst_step = s;
        worst_own = reference;
    }
};

Json row(const char* name, const std::string& height, const Stretch& s, int frames) {
    return {{"filter", name},
            {"height", height},
            {"frames", s.frames},
            {"largest tile step", rounded(s.step.tile, 1)},
            {"the reference's", rounded(s.own.tile, 1)},
            {"largest p99.9 step", s.step.pixel},
            {"reference's p99.9", s.own.pixel},
            {"pops", s.pops},
            {"worst, of the allowed", rounded(s.worst, 2)},
            {"in frame", s.worst_frame},
            {"at m", rounded(height_at(s.worst_frame, frames), 1)},
            {"its tile step", rounded(s.worst_step.tile, 1)},
            {"reference's there", rounded(s.worst_own.tile, 1)},
            {"its p99.9", s.worst_step.pixel},
            {"reference's p99.9 there", s.worst_own.pixel}};
}

}  // namespace

Result<BenchReport> bench_pop(const BenchRequest& request) {
    const int frames = request.quick ? kQuickFrames : kFrames;
    // A third of the size: the reference takes 16 pictures a frame.
    const int width = request.width / 3, height = request.height / 3;
    const Way ways[] = {{"fast", moving_frame(1)}, {"fine", still_frame()}};
    constexpr size_t kWays = std::size(ways);
    auto reference = ReferenceView::open(request.project, request.session);
    if (!reference) return reference.error();
    glm::dvec3 place;
    {
        auto session = open_read_only(request.project, request.session);
        if (!session) return session.error();
        place = {(*session)->document().bounds().center(), 0};
        auto ground = (*session)->height_m(place.x, place.y);
        if (!ground) return ground.error();
        place.z = *ground;
    }
    // One after the other: a renderer that waits for another takes its own frames for slow ones.
    std::vector<Picture> pictures[kWays];
    for (size_t w = 0; w < kWays; ++w) {
        auto flown = approach(request, ways[w], place, width, height, frames);
        if (!flown) return flown.error();
        pictures[w] = std::move(*flown);
    }
    constexpr size_t kStretches = std::size(kStretches_m) - 1;
    Stretch stretches[kWays][kStretches], whole[kWays];
    const auto save = [&](const std::string& name, int frame, const Picture& picture) -> Status {
        return save_png(request.pictures / fmt::format("{}-{:03}.png", name, frame), picture);
    };
    Picture last;
    for (int i = 0; i < frames; ++i) {
        auto own = reference->picture(camera_at(place, height_at(i, frames)), width, height);
        if (!own) return own.error();
        if (i > 0) {
            const PictureStep own_step = picture_step(last, *own);
            size_t stretch = 0;
            while (stretch + 1 < kStretches && height_at(i, frames) < kStretches_m[stretch + 1]) ++stretch;
            for (size_t w = 0; w < kWays; ++w) {
                const PictureStep step = picture_step(pictures[w][size_t(i) - 1], pictures[w][size_t(i)]);
                const double worst = whole[w].worst;
                whole[w].add(i, step, own_step);
                stretches[w][stretch].add(i, step, own_step);
                if (request.pictures.empty() || whole[w].worst <= std::max(1.0, worst)) continue;
                LOAM_TRY(save(ways[w].name, i - 1, pictures[w][size_t(i) - 1]));
                LOAM_TRY(save(ways[w].name, i, pictures[w][size_t(i)]));
                LOAM_TRY(save("reference", i - 1, last));
                LOAM_TRY(save("reference", i, *own));
            }
        }
        last = std::move(*own);
    }
    BenchTable table{
        fmt::format("an approach from {} m to {} m, {}x{}: steps from frame to frame in codes of 255, "
                    "allowed {} times the reference's own and {} codes",
                    kFrom_m, kTo_m, width, height, kShare, kCodes),
        {}};
    for (size_t w = 0; w < kWays; ++w) {
        table.rows.push_back(row(ways[w].name, "all", whole[w], frames));
        for (size_t k = 0; k < kStretches; ++k)
            table.rows.push_back(row(ways[w].name,
                                     fmt::format("{}-{} m", kStretches_m[k], kStretches_m[k + 1]),
                                     stretches[w][k], frames));
    }
    return BenchReport{table};
}

}  // namespace loam::bench
