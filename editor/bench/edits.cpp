// What an edit costs: from a dab's command to the first frame that shows it and to the frame after which no
// page lacks it, with a still camera and in flight, beside a steady frame of the same run. Frames are the
// window's while it moves: half the resolution, the coarse filter. Works on a copy of the project.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "editor/bench/bench.h"
#include "shaders/texture/texture_io.h"

namespace loam::bench {

namespace {

constexpr int kDabs = 200, kQuickDabs = 4;
constexpr double kMostPerRow_ms =
    5'000;                        // of dabs and the steady frames between them, unless --dabs says how many
constexpr int kSteadyFrames = 3;  // between two dabs
constexpr int kMaxFrames = 240;   // of one dab; then it is given up
constexpr uint64_t kHeightPageTexels = uint64_t(kHeightTexels) * kHeightTexels;

enum class Tool { footprint, paint, sculpt, crater };
struct Brush {
    Tool tool;
    const char* name;
    double radius_m;
    double distance_m;  // of the eye
};
constexpr Brush kBrushes[] = {
    {Tool::footprint, "footprint, 0.3 m", 0.3, 4}, {Tool::paint, "paint, 1 m", 1, 8},
    {Tool::paint, "paint, 10 m", 10, 54},          {Tool::paint, "paint, 100 m", 100, 450},
    {Tool::paint, "paint, 1000 m", 1000, 2500},    {Tool::sculpt, "sculpt, 1 m", 1, 8},
    {Tool::sculpt, "sculpt, 10 m", 10, 54},        {Tool::sculpt, "sculpt, 100 m", 100, 450},
    {Tool::sculpt, "sculpt, 1000 m", 1000, 2500},  {Tool::crater, "crater, 10 m", 10, 54},
};

// Dab `i`: raise and lower, and layers and tints, take turns, so that every one changes something.
Command dab(const Brush& brush, glm::dvec2 place, int i, const std::vector<LayerEntry>& layers) {
    const auto seed = static_cast<uint32_t>(i);
    switch (brush.tool) {
        case Tool::footprint:
            return {FootprintsCommand{
                {{.x_m = place.x, .y_m = place.y, .heading_rad = 0.6 * i, .foot = i % 2, .seed = seed}}}};
        case Tool::crater:
            return {
                CraterCommand{{.x_m = place.x, .y_m = place.y, .radius_m = brush.radius_m, .seed = seed}}};
        case Tool::paint: {
            PaintCommand paint;
            paint.dabs = {place};
            paint.radius_m = brush.radius_m;
            paint.seed = seed;
            paint.tint = i % 2 == 0 ? glm::dvec3(0.9, 0.5, 0.3) : glm::dvec3(0.5, 0.7, 0.9);
            if (!layers.empty()) paint.layer = layers[static_cast<size_t>(i) % layers.size()].name;
            return {paint};
        }
        case Tool::sculpt:
            break;
    }
    SculptCommand sculpt;
    sculpt.mode = i % 2 == 0 ? SculptMode::raise : SculptMode::lower;
    sculpt.dabs = {place};
    sculpt.radius_m = brush.radius_m;
    sculpt.strength = 0.05 * brush.radius_m;
    return {sculpt};
}

// A view from the south, 34 degrees down, of ground that drifts east in flight: a tenth of the distance a
// second.
class Rig {
  public:
    Rig(Session& session, const BenchRequest& request, const Brush& brush, bool flying)
        : session_(session), request_(request), brush_(brush), flying_(flying) {}

    [[nodiscard]] glm::dvec2 target() const {
        // Every brush has a place of its own, which no nearer view has left its pages at.
        const WorldRect bounds = session_.document().bounds();
        const double apart_m = 0.04 * bounds.height() * static_cast<double>(&brush_ - kBrushes);
        return {bounds.center().x + along_m_, bounds.min_y + 0.3 * bounds.height() + apart_m};
    }
    Result<Camera> camera() {
        const glm::dvec2 at = target();
        auto ground = session_.height_m(at.x, at.y);
        if (!ground) return ground.error();
        if (floor_m_ < 0) floor_m_ = *ground;
        floor_m_ += (*ground - floor_m_) * (flying_ ? 0.05 : 0.0);
        return Camera::look_at({at.x, at.y - 0.83 * brush_.distance_m, floor_m_ + 0.56 * brush_.distance_m},
                               {at.x, at.y, floor_m_});
    }
    // Milliseconds of one frame, its picture read back.
    Result<double> frame() {
        if (flying_) along_m_ += brush_.distance_m * 0.1 / 30;
        auto from = camera();
        if (!from) return from.error();
        const RenderRequest one{.camera = *from,
                                .width = request_.width,
                                .height = request_.height,
                                .frame = moving_frame(0.5f),
                                .max_frames = 1};
        const double start_ms = now_ms();
        auto drawn = session_.render(one);
        if (!drawn) return drawn.error();
        picture_ = std::move(*drawn);
        return now_ms() - start_ms;
    }

    Session& session() { return session_; }
    [[nodiscard]] const Brush& brush() const { return brush_; }
    [[nodiscard]] bool flying() const { return flying_; }
    [[nodiscard]] const Picture& picture() const { return picture_; }  // of the last frame

  private:
    Session& session_;
    const BenchRequest& request_;
    const Brush& brush_;
    bool flying_;
    double along_m_ = 0, floor_m_ = -1;
    Picture picture_;
};

struct DabFigures {
    std::vector<double> apply_ms, shown_ms, finished_ms, first_extra_ms, all_extra_ms;
    std::vector<double> pages, texels, height_texels, index_texels, shown_frame;
    std::vector<double> whole_pages, steady_ms;
    int given_up = 0;
};

Status one_dab(Rig& rig, int i, DabFigures& out) {
    auto renderer = rig.session().renderer();
    if (!renderer) return renderer.error();
    std::vector<double> steady;
    for (int k = 0; k < kSteadyFrames; ++k) {
        auto ms = rig.frame();
        if (!ms) return ms.error();
        steady.push_back(*ms);
        out.steady_ms.push_back(*ms);
    }
    const Picture before = rig.picture();
    const double steady_ms = spread_of(steady).median;
    const FrameStatistics a = (*renderer)->statistics();
    // Places go round the middle of the picture, so that dabs overlap as a stroke's do. Footprints trample a
    // circle of 3 m: nobody steps on one spot 200 times.
    const double angle = 2.4 * i;
    const double away_m = rig.brush().tool == Tool::footprint
                              ? 1.5 * std::sqrt((i % kDabs + 0.5) / kDabs)
                              : 0.5 * std::min(rig.brush().radius_m, 0.4 * rig.brush().distance_m);
    const glm::dvec2 place =
        rig.target() + glm::dvec2(away_m * std::cos(angle), away_m * std::sin(angle) * 0.7);
    const double start_ms = now_ms();
    auto dirt = rig.session().apply(dab(rig.brush(), place, i, rig.session().document().settings().layers));
    if (!dirt) return dirt.error();
    out.apply_ms.push_back(now_ms() - start_ms);

    double shown_ms = 0, finished_ms = 0, frames_ms = 0, extra_ms = 0;
    int frames = 0, shown_frame = 0, resting = 0;
    // At rest pages may be asked for late (feedback comes back three frames later): four frames must agree.
    const int wanted_resting = rig.flying() ? 1 : 4;
    while (resting < wanted_resting && frames < kMaxFrames) {
        auto ms = rig.frame();
        if (!ms) return ms.error();
        ++frames;
        frames_ms += *ms;
        const FrameStatistics b = (*renderer)->statistics();
        if (frames == 1) out.first_extra_ms.push_back(out.apply_ms.back() + *ms - steady_ms);
        // In flight every picture differs: what counts there is the first composed rectangle that is no whole
        // page.
        const bool composed_dirt =
            b.height.texels_composed - a.height.texels_composed >
                (b.height.pages_composed - a.height.pages_composed) * kHeightPageTexels ||
            b.texture.rects_composed - a.texture.rects_composed >
                b.texture.pages_composed - a.texture.pages_composed;
        if (shown_frame == 0 && (rig.flying() ? composed_dirt : rig.picture().rgba != before.rgba)) {
            shown_frame = frames;
            shown_ms = now_ms() - start_ms;
        }
        const bool finished = rig.flying() ? b.texture.dirty_pages == 0 : (*renderer)->settled();
        if (resting == 0) {
            finished_ms = now_ms() - start_ms;
            extra_ms = out.apply_ms.back() + frames_ms - frames * steady_ms;
        }
        resting = finished ? resting + 1 : 0;
    }
    if (resting == 0) {
        ++out.given_up;
        return {};
    }
    const FrameStatistics b = (*renderer)->statistics();
    if (shown_frame > 0) {
        out.shown_ms.push_back(shown_ms);
        out.shown_frame.push_back(shown_frame);
    }
    out.finished_ms.push_back(finished_ms);
    out.all_extra_ms.push_back(extra_ms);
    out.pages.push_back(double(b.texture.pages_dirtied - a.texture.pages_dirtied));
    const uint64_t whole_pages = b.texture.pages_composed - a.texture.pages_composed;
    out.texels.push_back(double(b.texture.texels_composed - a.texture.texels_composed -
                                whole_pages * kPageTexels * kPageTexels));
    out.whole_pages.push_back(double(whole_pages));
    out.height_texels.push_back(double(b.height.texels_composed - a.height.texels_composed));
    out.index_texels.push_back(double(b.index.texels_composed - a.index.texels_composed));
    return {};
}

Status measure_brush(Session& session, const BenchRequest& request, const Brush& brush, bool flying,
                     BenchReport& report) {
    Rig rig(session, request, brush, flying);
    auto renderer = session.renderer();
    if (!renderer) return renderer.error();
    for (int i = 0, resting = 0; i < 300 && resting < 4; ++i) {
        auto ms = rig.frame();
        if (!ms) return ms.error();
        resting = (flying ? i > 30 : (*renderer)->settled()) ? resting + 1 : 0;
    }
    DabFigures figures;
    DabFigures warm;
    LOAM_TRY(one_dab(rig, 1001, warm));  // pipelines compile
    const int wanted = request.dabs > 0 ? request.dabs : request.quick ? kQuickDabs : kDabs;
    const double start_ms = now_ms();
    int dabs = 0;
    while (dabs < wanted && (request.dabs > 0 || dabs < kQuickDabs || now_ms() - start_ms < kMostPerRow_ms))
        LOAM_TRY(one_dab(rig, dabs++, figures));

    const auto at = [](const std::vector<double>& values, double share, int decimals = 1) {
        return values.empty() ? Json() : Json(rounded(percentile(values, share), decimals));
    };
    const double steady_ms = percentile(figures.steady_ms, 0.5);
    const auto share = [&](const std::vector<double>& values) {
        return values.empty() ? Json() : Json(rounded(percentile(values, 0.5) / steady_ms, 2));
    };
    const char* camera = flying ? "in flight" : "still";
    report[0].rows.push_back({{"edit", brush.name},
                              {"camera", camera},
                              {"dabs", dabs},
                              {"apply ms p50", at(figures.apply_ms, 0.5, 2)},
                              {"apply ms p99", at(figures.apply_ms, 0.99, 2)},
                              {"shown ms p50", at(figures.shown_ms, 0.5)},
                              {"shown ms p99", at(figures.shown_ms, 0.99)},
                              {"shown in frame p99", at(figures.shown_frame, 0.99, 0)},
                              {"finest mip ms p50", at(figures.finished_ms, 0.5)},
                              {"finest mip ms p99", at(figures.finished_ms, 0.99)},
                              {"given up", figures.given_up}});
    report[1].rows.push_back({{"edit", brush.name},
                              {"camera", camera},
                              {"steady frame ms", rounded(steady_ms, 1)},
                              {"first frame's extra", share(figures.first_extra_ms)},
                              {"all frames' extra", share(figures.all_extra_ms)},
                              {"texture pages dirtied", at(figures.pages, 0.5, 0)},
                              {"texture texels", at(figures.texels, 0.5, 0)},
                              {"whole pages", at(figures.whole_pages, 0.5, 0)},
                              {"height texels", at(figures.height_texels, 0.5, 0)},
                              {"index texels", at(figures.index_texels, 0.5, 0)}});
    return {};
}

}  // namespace

Result<BenchReport> bench_edits(const BenchRequest& request) {
    BenchReport report{
        {fmt::format("from the command to the picture, {}x{} at half its resolution, the coarse filter",
                     request.width, request.height),
         {}},
        {"what that takes: medians a dab (texels: of dirt; whole pages: new ones meanwhile); extra: beyond "
         "as many "
         "steady frames, in steady frames",
         {}}};
    auto copy = TemporaryProject::create_copy(request.project);
    if (!copy) return copy.error();
    auto session = Session::open(copy->path(), request.session);
    if (!session) return session.error();
    for (const Brush& brush : kBrushes) {
        if (request.quick && (brush.radius_m > 10 || brush.radius_m == 1)) continue;
        for (const bool flying : {false, true})
            LOAM_TRY(measure_brush(**session, request, brush, flying, report));
    }
    return report;
}

}  // namespace loam::bench
