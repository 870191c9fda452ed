// Events, prints and operators in time: what they cost, what that depends on, and how far their
// approximations are from what they stand for. Works on copies of the project.
#include <algorithm>
#include <cmath>

#include <glm/geometric.hpp>

#include "editor/bench/bench.h"
#include "runtime/base/units.h"
#include "runtime/document/spline_path.h"
#include "runtime/maps/half.h"
#include "runtime/maps/height_compose.h"

namespace loam::bench {

namespace {

constexpr double kCrowd_m = 25;  // prints are emitted within, in view
constexpr double kEnd_s = 1000;  // every event is over

Camera over(Session& session, glm::dvec2 at, double away_m) {
    const double ground_m = session.height_m(at.x, at.y).value();
    return Camera::look_at({at.x, at.y - 0.83 * away_m, ground_m + 0.56 * away_m}, {at.x, at.y, ground_m});
}

// Evenly over a disc, whatever the count: the two numbers' multiples fill a square.
std::vector<Footprint> prints_around(glm::dvec2 at, int count, double radius_m, int first = 0) {
    std::vector<Footprint> prints;
    for (int i = first; i < first + count; ++i) {
        const double angle = 6.283185307179586 * std::fmod(0.7548776662 * i, 1.0);
        const double away_m = radius_m * std::sqrt(std::fmod(0.5698402910 * i, 1.0));
        prints.push_back({.x_m = at.x + away_m * std::cos(angle),
                          .y_m = at.y + away_m * std::sin(angle),
                          .heading_rad = angle,
                          .depth_m = 0.05,
                          .foot = i % 2,
                          .seed = uint32_t(i)});
    }
    return prints;
}

// Everything that is resident, composed again: what an edit of the whole map costs.
Result<double> all_again_ms(Session& session, const RenderRequest& request) {
    auto settled = session.render(request);
    if (!settled) return settled.error();
    auto renderer = session.renderer();
    if (!renderer) return renderer.error();
    const double start_ms = now_ms();
    const WorldRect map = session.document().bounds();
    (*renderer)->on_dirt(
        {.height = {map}, .index = {map}, .texture = {map}, .cutout = {}, .texture_size_m = INFINITY});
    settled = session.render(request);
    if (!settled) return settled.error();
    return now_ms() - start_ms;
}

// One change after another on a copy, each with its own view; the ratio is to all residents of that view.
Result<BenchTable> follow_the_dirt(const BenchRequest& request) {
    BenchTable table{"one change, from the command to a picture that rests", {}};
    auto project = TemporaryProject::create_copy(request.project);
    if (!project) return project.error();
    auto session = Session::open(project->path(), request.session);
    if (!session) return session.error();
    const glm::dvec2 middle = (*session)->document().bounds().center();
    const double side_m = std::min(500.0, 0.4 * (*session)->document().bounds().width());
    const double ground_m = (*session)->height_m(middle.x, middle.y).value();
    Event barrage = default_event(EventKind::barrage), crater = default_event(EventKind::crater);
    Event flood = default_event(EventKind::flood);
    for (Event* event : {&barrage, &crater, &flood}) {
        event->x_m = middle.x;
        event->y_m = middle.y;
        event->start_s = 1;
    }
    crater.weather_s = 64;
    barrage.radius_m = flood.radius_m = side_m;
    flood.level_m = ground_m + 3;
    flood.from_m = ground_m - 3;
    struct Case {
        std::string name;
        double away_m;
        std::optional<Command> before;
        Command command;
    };
    const std::vector<Case> cases = {
        {"one footprint", 4, {}, {FootprintsCommand{.prints = prints_around(middle, 1, 0), .life = {}}}},
        {"100 footprints", 12, {}, {FootprintsCommand{.prints = prints_around(middle, 100, 4), .life = {}}}},
        {"crater of 10 m", 54, Command{AddOperatorCommand{crater, {}}}, {TimeCommand{1}}},
        {"it weathers, a step", 54, Command{TimeCommand{5}}, {TimeCommand{9}}},
        {fmt::format("{} craters on {:.2f} km²", barrage.count, std::pow(side_m / 500, 2)),
         2.4 * side_m,
         Command{AddOperatorCommand{barrage, {}}},
         {TimeCommand{kEnd_s}}},
        {"back in time before it", 2.4 * side_m, {}, {TimeCommand{0}}},
        {"a flood rises, a step", 2 * side_m, Command{AddOperatorCommand{flood, {}}}, {TimeCommand{10}}}};
    for (const Case& one : cases) {
        if (one.before)
            if (auto dirt = (*session)->apply(*one.before); !dirt) return dirt.error();
        const Camera view = over(**session, middle, one.away_m);
        auto figures = measure_edit(**session, view, request.width, request.height, one.command);
        if (!figures) return figures.error();
        auto all_ms =
            all_again_ms(**session, {.camera = view, .width = request.width, .height = request.height});
        if (!all_ms) return all_ms.error();
        const auto texture = (*session)->renderer().value()->statistics().texture;
        const double settled_ms = figures->at("settled ms");
        table.rows.push_back({{"change", one.name},
                              {"apply ms", figures->at("apply ms")},
                              {"first changed ms", figures->at("first changed ms")},
                              {"rests ms", settled_ms},
                              {"of all residents' ms", rounded(settled_ms / *all_ms, 3)},
                              {"height pages", figures->at("height dirtied")},
                              {"index pages", figures->at("index dirtied")},
                              {"texture pages", figures->at("texture dirtied")},
                              {"texture texels", figures->at("texture texels")},
                              {"resident", texture.resident_pages}});
    }
    return table;
}

// Prints all around a walker, at so many a second; a frame is laid, composed and drawn before the next.
Result<BenchTable> emission(const BenchRequest& request) {
    BenchTable table{"prints a second, 30 frames a second of the map's time, at half the resolution", {}};
    auto project = TemporaryProject::create_copy(request.project);
    if (!project) return project.error();
    auto session = Session::open(project->path(), request.session);
    if (!session) return session.error();
    const glm::dvec2 middle = (*session)->document().bounds().center();
    const Camera view = over(**session, middle, 50);
    const RenderRequest one{.camera = view,
                            .width = request.width,
                            .height = request.height,
                            .frame = moving_frame(0.5f),
                            .max_frames = 1};
    if (auto rested = (*session)->render({.camera = view, .width = request.width, .height = request.height});
        !rested)
        return rested.error();
    const int frames = request.quick ? 12 : 90;
    int laid = 0;
    Prints& prints = (*session)->prints();
    for (const int rate : {0, 1, 100, 10'000}) {
        std::vector<double> frame_ms, apply_ms;
        uint32_t deferred = 0;
        for (int f = 0; f < frames; ++f) {
            const double start_ms = now_ms();
            if (auto moved = (*session)->apply({TimeCommand{(*session)->document().time_s() + 1 / 30.0}});
                !moved)
                return moved.error();
            const int count = int(double(rate) * (f + 1) / 30) - int(double(rate) * f / 30);
            for (const Footprint& print : prints_around(middle, count, kCrowd_m, laid))
                if (auto stepped = prints.step(1, print.foot, {print.x_m, print.y_m}, print.heading_rad, {});
                    !stepped)
                    return stepped.error();
            laid += count;
            apply_ms.push_back(now_ms() - start_ms);
            if (auto drawn = (*session)->render(one); !drawn) return drawn.error();
            frame_ms.push_back(now_ms() - start_ms);
            deferred = std::max(deferred, (*session)->renderer().value()->statistics().texture.dirty_pages);
        }
        const size_t waiting =
            prints.waiting();  // laid with the frames that follow, or dropped by newer ones
        const Spread frame = spread_of(frame_ms), apply = spread_of(apply_ms);
        table.rows.push_back({{"prints a second", rate},
                              {"apply ms p50", rounded(apply.median, 2)},
                              {"apply ms p95", rounded(apply.p95, 2)},
                              {"frame ms p50", rounded(frame.median, 1)},
                              {"frame ms p95", rounded(frame.p95, 1)},
                              {"pages put off, most", deferred},
                              {"prints waiting", waiting},
                              {"prints on the map", (*session)->document().statistics().operators}});
    }
    return table;
}

// The same print and the same picture with more and more operators where nobody looks.
Result<BenchTable> elsewhere(const BenchRequest& request) {
    BenchTable table{"the same print, with operators elsewhere on the map (medians)", {}};
    for (const int count : {10, 10'000, 100'000}) {
        if (request.quick && count > 10'000) continue;
        auto project = TemporaryProject::create_copy(request.project);
        if (!project) return project.error();
        {
            auto document = Document::open(project->path());
            if (!document) return document.error();
            const WorldRect map = (*document)->bounds();
            FootprintsCommand far{.prints = prints_around({0, 0}, count, 1), .life = {}};
            for (int i = 0; i < count; ++i) {  // the northern quarter of the map
                far.prints[size_t(i)].x_m = map.width() * std::fmod(0.61803 * i, 1.0);
                far.prints[size_t(i)].y_m = map.max_y - 0.25 * map.height() * std::fmod(0.32471 * i, 1.0);
            }
            if (auto dirt = (*document)->apply({far}); !dirt) return dirt.error();
            far.life = {.from_s = 5000, .until_s = 6000, .fade_s = 100};
            far.prints.resize(size_t(count) / 2);
            if (auto dirt = (*document)->apply({far}); !dirt) return dirt.error();
        }
        const double open_ms = now_ms();
        auto session = Session::open(project->path(), request.session);
        if (!session) return session.error();
        const double opened_ms = now_ms() - open_ms;
        const WorldRect map = (*session)->document().bounds();
        const glm::dvec2 at(map.center().x, map.min_y + 0.3 * map.height());
        const Camera view = over(**session, at, 8);
        const RenderRequest one{.camera = view,
                                .width = request.width,
                                .height = request.height,
                                .frame = moving_frame(0.5f),
                                .max_frames = 1};
        if (auto rested =
                (*session)->render({.camera = view, .width = request.width, .height = request.height});
            !rested)
            return rested.error();
        std::vector<double> apply_ms, time_ms, frame_ms, query_ms;
        for (int i = 0; i < (request.quick ? 6 : 120); ++i) {
            double start_ms = now_ms();
            if (auto dirt =
                    (*session)->apply({FootprintsCommand{.prints = prints_around(at, 1, 1, i), .life = {}}});
                !dirt)
                return dirt.error();
            apply_ms.push_back(now_ms() - start_ms);
            start_ms = now_ms();
            if (auto dirt = (*session)->apply({TimeCommand{double(i)}}); !dirt) return dirt.error();
            time_ms.push_back(now_ms() - start_ms);
            start_ms = now_ms();
            if (auto drawn = (*session)->render(one); !drawn) return drawn.error();
            frame_ms.push_back(now_ms() - start_ms);
            start_ms = now_ms();
            for (int k = 0; k < 200; ++k) (void)(*session)->height_m(at.x + 0.01 * k, at.y);
            query_ms.push_back((now_ms() - start_ms) / 200);
        }
        table.rows.push_back({{"operators elsewhere", count + count / 2},
                              {"open ms", rounded(opened_ms, 1)},
                              {"apply ms", rounded(spread_of(apply_ms).median, 3)},
                              {"move the time ms", rounded(spread_of(time_ms).median, 4)},
                              {"frame ms", rounded(spread_of(frame_ms).median, 1)},
                              {"height query ms", rounded(spread_of(query_ms).median, 5)}});
    }
    return table;
}

// Decals of 1 to 8 m all over the map, which are read where somebody looks: near the ground, then from far.
Result<BenchTable> decals_all_over(const BenchRequest& request) {
    BenchTable table{"decals all over the map: what is read of them (times are medians but for opening)", {}};
    for (const int count : {10, 10'000, 100'000}) {
        if (request.quick && count > 10'000) continue;
        auto project = TemporaryProject::create_copy(request.project);
        if (!project) return project.error();
        {
            auto document = Document::open(project->path());
            if (!document) return document.error();
            const WorldRect map = (*document)->bounds();
            for (int i = 0; i < count; ++i) {
                TerrainDecal decal{.x_m = map.min_x + map.width() * std::fmod(0.61803 * i, 1.0),
                                   .y_m = map.min_y + map.height() * std::fmod(0.32471 * i, 1.0)};
                decal.half_m = glm::dvec2(0.5 * std::exp2(i % 4));
                decal.heading_rad = i % 6;
                decal.material.colour = {0.5, 0.3, 0.2};
                if (auto dirt = (*document)->apply({AddOperatorCommand{decal, {}}}); !dirt)
                    return dirt.error();
            }
        }
        const double open_ms = now_ms();
        auto session = Session::open(project->path(), request.session);
        if (!session) return session.error();
        const double opened_ms = now_ms() - open_ms;
        const Document& document = (*session)->document();
        const WorldRect map = document.bounds();
        const glm::dvec2 at(map.center().x, map.min_y + 0.3 * map.height());
        const auto picture_ms = [&](double up_m) -> Result<double> {
            const double start_ms = now_ms();
            auto drawn = (*session)->render(
                {.camera = over(**session, at, up_m), .width = request.width, .height = request.height});
            if (!drawn) return drawn.error();
            return now_ms() - start_ms;
        };
        auto near_ms = picture_ms(8);
        if (!near_ms) return near_ms.error();
        const auto near = document.statistics();
        std::vector<double> apply_ms, frame_ms;
        const RenderRequest one{.camera = over(**session, at, 8),
                                .width = request.width,
                                .height = request.height,
                                .frame = moving_frame(0.5f),
                                .max_frames = 1};
        const uint64_t mine = near.operators + 1;
        for (int i = 0; i < (request.quick ? 6 : 120); ++i) {
            const TerrainDecal decal{.x_m = at.x + 0.02 * i, .y_m = at.y};
            double start_ms = now_ms();
            const CommandBody body =
                i == 0 ? CommandBody(AddOperatorCommand{decal, {}}) : EditOperatorCommand{mine, decal, {}};
            if (auto dirt = (*session)->apply({body}); !dirt) return dirt.error();
            apply_ms.push_back(now_ms() - start_ms);
            start_ms = now_ms();
            if (auto drawn = (*session)->render(one); !drawn) return drawn.error();
            frame_ms.push_back(now_ms() - start_ms);
        }
        auto far_ms = picture_ms(2000);
        if (!far_ms) return far_ms.error();
        const auto far = document.statistics();
        table.rows.push_back({{"decals", count},
                              {"nodes", near.operator_nodes},
                              {"open ms", rounded(opened_ms, 1)},
                              {"picture at 8 m, ms", rounded(*near_ms, 0)},
                              {"read for it", near.loaded_operators},
                              {"of nodes", near.node_reads},
                              {"move one ms", rounded(spread_of(apply_ms).median, 3)},
                              {"frame ms", rounded(spread_of(frame_ms).median, 1)},
                              {"picture at 2 km, ms", rounded(*far_ms, 0)},
                              {"in memory then", far.loaded_operators}});
    }
    return table;
}

Result<BenchTable> memory(const BenchRequest& request) {
    BenchTable table{"what an event takes", {}};
    auto project = TemporaryProject::create_copy(request.project);
    if (!project) return project.error();
    auto session = Session::open(project->path(), request.session);
    if (!session) return session.error();
    Document& document = (*session)->document();
    for (const auto& [name, kind, count] : {std::tuple("1 crater", EventKind::crater, 1),
                                            {"1,000 craters in a line", EventKind::crater_line, 1000},
                                            {"1 km² of 1,200 craters", EventKind::barrage, 1200},
                                            {"a crash site", EventKind::crash, 60},
                                            {"a landslide", EventKind::landslide, 0},
                                            {"a flood", EventKind::flood, 0}}) {
        Event event = default_event(kind);
        event.count = count;
        if (kind == EventKind::crash || kind == EventKind::crater_line) event.to_m = glm::dvec2(100, 0);
        if (auto dirt = (*session)->apply({AddOperatorCommand{event, {}}}); !dirt) return dirt.error();
        const uint64_t id = document.operators().back().id;
        const auto cost = document.event_cost(id);
        table.rows.push_back({{"event", name},
                              {"stored bytes", cost.stored_bytes},
                              {"parts", cost.parts},
                              {"memory bytes while open", cost.memory_bytes}});
    }
    return table;
}

// Heights of a crater of 10 m on level ground at 600 m, kept as the cache keeps them and as it does not.
BenchTable crater_heights() {
    BenchTable table{"a crater of 10 m at 600 m above the sea, by what its heights are kept as", {}};
    constexpr int kSide = 241;
    constexpr double kStep_m = 0.25, kGround_m = 600;
    Operator op{.id = 1, .order = 1, .shape = Crater{.x_m = 30, .y_m = 30, .radius_m = 10, .seed = 3}};
    std::vector<double> exact(size_t(kSide) * kSide, kGround_m);
    apply_height(op, {exact.data(), kSide, kSide, kSide, 0, 0, kStep_m});
    const auto [low, high] = std::minmax_element(exact.begin(), exact.end());
    const double low_m = *low, range_m = *high - *low;
    struct Format {
        const char* name;
        int bytes;
        double (*kept)(double height_m, double low_m, double range_m);
    };
    const Format formats[] = {
        {"float32, the cache's", 4, [](double h, double, double) { return double(float(h)); }},
        {"16 bits over the page's range", 2,
         [](double h, double from, double range) {
             return from + std::round((h - from) / range * 65535) / 65535 * range;
         }},
        {"millimetres, the store's", 4, [](double h, double, double) { return std::round(h * 1000) / 1000; }},
        {"float16", 2,
         [](double h, double, double) { return double(float_from_half(half_from_float(float(h)))); }}};
    for (const Format& format : formats) {
        double worst = 0, sum = 0;
        for (const double h : exact) {
            const double error = std::abs(format.kept(h, low_m, range_m) - h);
            worst = std::max(worst, error);
            sum += error * error;
        }
        table.rows.push_back({{"kept as", format.name},
                              {"bytes a sample", format.bytes},
                              {"rms mm", rounded(1000 * std::sqrt(sum / double(exact.size())), 4)},
                              {"worst mm", rounded(1000 * worst, 4)}});
    }
    return table;
}

// A winding road of 10 km, and one with a cusp: how far its segments are from the curve, at a thousand places
// a piece.
BenchTable tessellation(const BenchRequest& request) {
    BenchTable table{"a splined decal's segments, by the tolerance asked for", {}};
    std::vector<SplinePoint> winding, through;
    for (int i = 0; i <= 100; ++i)
        through.push_back({100.0 * i, 60 * std::sin(0.9 * i), 5 * std::sin(0.3 * i), 6});
    winding = bezier_through(through);
    const std::vector<SplinePoint> cusp = {{0, 0, 0, 4}, {100, 0, 0, 4}, {0, 0.001, 0, 4}, {100, 0, 0, 4}};
    for (const auto& [name, points] : {std::pair("10 km, winding", winding), {"a cusp of 100 m", cusp}})
        for (const double tolerance_m : {0.5, 0.1, 0.01, 0.001}) {
            if (request.quick && tolerance_m < 0.01) continue;
            const double start_ms = now_ms();
            const SplinePath path(points, tolerance_m);
            const double ms = now_ms() - start_ms;
            double worst_m = 0;
            const size_t pieces = (points.size() - 1) / 3;
            size_t from = 0;  // segments are in the curve's order
            for (size_t piece = 0; piece < pieces; ++piece)
                for (int k = 0; k <= 200; ++k) {
                    const SplinePoint at = bezier_at(points, piece, k / 200.0);
                    double nearest_m = INFINITY;
                    size_t best = from;
                    const size_t end = std::min(from + 60, path.segments().size());
                    for (size_t s = from > 4 ? from - 4 : 0; s < end; ++s) {
                        const SplineSegment& segment = path.segments()[s];
                        const glm::dvec2 away = glm::dvec2(at.x_m, at.y_m) - segment.from_m;
                        const double along =
                            std::clamp(glm::dot(away, segment.direction), 0.0, segment.length_m);
                        const double apart_m = glm::length(away - segment.direction * along);
                        if (apart_m < nearest_m) nearest_m = apart_m, best = s;
                    }
                    from = best;
                    worst_m = std::max(worst_m, nearest_m);
                }
            table.rows.push_back({{"spline", name},
                                  {"tolerance m", tolerance_m},
                                  {"segments", path.segments().size()},
                                  {"worst mm", rounded(1000 * worst_m, 3)},
                                  {"ms", rounded(ms, 3)}});
        }
    return table;
}

// 2,000 prints of a walk, of which only the newest are kept.
Result<BenchTable> dropped(const BenchRequest& request) {
    BenchTable table{"2,000 prints in view, of which the newest are kept, against all of them", {}};
    Picture all;
    for (const uint64_t keep : {0, 0, 1500, 1000, 500}) {
        auto project = TemporaryProject::create_copy(request.project);
        if (!project) return project.error();
        auto session = Session::open(project->path(), request.session);
        if (!session) return session.error();
        const glm::dvec2 middle = (*session)->document().bounds().center();
        const Camera view = over(**session, middle, 12);  // before the prints: they lower the ground
        FootprintsCommand command{.prints = prints_around(middle, 2000, 8),
                                  .life = {.from_s = 0, .until_s = 1000}};
        command.keep = keep;
        if (auto dirt = (*session)->apply({command}); !dirt) return dirt.error();
        const double start_ms = now_ms();
        auto picture = (*session)->render({.camera = view, .width = request.width, .height = request.height});
        if (!picture) return picture.error();
        const double ms = now_ms() - start_ms;
        if (all.rgba.empty()) {
            all = std::move(*picture);
            continue;
        }
        double sum = 0;
        size_t changed = 0;
        for (size_t i = 0; i < all.rgba.size(); i += 4) {
            int worst = 0;
            for (size_t c = 0; c < 3; ++c) {
                const int d = int(all.rgba[i + c]) - int(picture->rgba[i + c]);
                sum += d * d;
                worst = std::max(worst, std::abs(d));
            }
            changed += worst > 8;
        }
        const double pixels = double(all.rgba.size()) / 4;
        table.rows.push_back({{"kept", (*session)->document().statistics().operators},
                              {"first picture ms", rounded(ms, 0)},
                              {"rms of 255", rounded(std::sqrt(sum / (3 * pixels)), 2)},
                              {"pixels changed", rounded(double(changed) / pixels, 3)}});
    }
    return table;
}

}  // namespace

Result<BenchReport> bench_events(const BenchRequest& request) {
    BenchReport report;
    for (const auto part : {follow_the_dirt, emission, elsewhere, decals_all_over, memory}) {
        auto table = part(request);
        if (!table) return table.error();
        report.push_back(std::move(*table));
    }
    report.push_back(crater_heights());
    report.push_back(tessellation(request));
    auto table = dropped(request);
    if (!table) return table.error();
    report.push_back(std::move(*table));
    return report;
}

}  // namespace loam::bench
