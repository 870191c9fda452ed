// What an edit costs: pages and milliseconds of a brush dab, a footprint and a 10 m crater, against composing
// all resident pages again. Works on a copy of the project.
#include <numbers>

#include "editor/bench/bench.h"

namespace loam::bench {

Result<BenchReport> bench_edit(const BenchRequest& request) {
    auto copy = TemporaryProject::create_copy(request.project);
    if (!copy) return copy.error();
    auto session = Session::open(copy->path(), request.session);
    if (!session) return session.error();
    const glm::dvec2 place = (*session)->document().bounds().center();
    auto ground = (*session)->height_m(place.x, place.y);
    if (!ground) return ground.error();
    const Camera near_view =
        Camera::look_at({place.x, place.y - 4, *ground + 3}, {place.x, place.y, *ground});
    const Camera view = Camera::look_at({place.x, place.y - 45, *ground + 30}, {place.x, place.y, *ground});

    SculptCommand raise;
    raise.dabs = {place};
    raise.radius_m = 10;
    PaintCommand paint;
    paint.dabs = {place};
    paint.radius_m = 10;
    paint.tint = {{0.9, 0.5, 0.3}};
    const auto& layers = (*session)->document().settings().layers;
    if (!layers.empty()) paint.layer = layers.back().name;
    FootprintsCommand footprint;
    footprint.prints = {{.x_m = place.x, .y_m = place.y, .heading_rad = std::numbers::pi / 5}};
    CraterCommand crater{{.x_m = place.x, .y_m = place.y, .radius_m = 10, .seed = 7}};

    BenchTable table{
        fmt::format("edits of {} at {}x{}", request.project.string(), request.width, request.height), {}};
    const auto add = [&](const char* name, const Result<Json>& figures) -> Status {
        if (!figures) return figures.error();
        Json row{{"edit", name}};
        row.update(*figures);
        table.rows.push_back(row);
        return {};
    };
    Session& s = **session;
    LOAM_TRY(add("raise dab, 10 m", measure_edit(s, view, request.width, request.height, {raise})));
    LOAM_TRY(add("paint dab, 10 m", measure_edit(s, view, request.width, request.height, {paint})));
    LOAM_TRY(add("footprint, 0.3 m", measure_edit(s, near_view, request.width, request.height, {footprint})));
    LOAM_TRY(add("crater, 10 m", measure_edit(s, view, request.width, request.height, {crater})));
    LOAM_TRY(add("all resident pages", measure_compose_all(s, view, request.width, request.height)));
    return BenchReport{table};
}

}  // namespace loam::bench
