// Cost follows the edit, not the map: the same crater on maps of 1 km and 16 km, and what the runtime holds
// for each.
#include "editor/bench/bench.h"

namespace loam::bench {

namespace {

constexpr int kRepeats = 9;  // craters side by side; medians are compared

Result<Json> crater_on(const BenchRequest& request, double side_m) {
    auto project = TemporaryProject::create_flat(request.project, side_m);
    if (!project) return project.error();
    auto session = Session::open(project->path(), request.session);
    if (!session) return session.error();
    std::vector<double> first, settled, applied;
    Json last;
    const int repeats = request.quick ? 3 : kRepeats;
    for (int i = 0; i < repeats; ++i) {
        const glm::dvec2 place(300 + 40.0 * i, 500);
        const Camera view = Camera::look_at({place.x, place.y - 45, 130}, {place.x, place.y, 100});
        const CraterCommand crater{{.x_m = place.x, .y_m = place.y, .radius_m = 10, .seed = 7}};
        auto figures = measure_edit(**session, view, request.width, request.height, {crater});
        if (!figures) return figures.error();
        if (i == 0) continue;  // the first one compiles pipelines
        last = *figures;
        applied.push_back(last["apply ms"]);
        first.push_back(last["first changed ms"]);
        settled.push_back(last["settled ms"]);
    }
    auto renderer = (*session)->renderer();
    if (!renderer) return renderer.error();
    uint64_t runtime_bytes = 0;
    for (const MemoryRow& row : (*renderer)->statistics().memory) runtime_bytes += row.bytes;
    Json row{{"map", fmt::format("{} m", side_m)}};
    row.update(last);
    row["apply ms"] = rounded(spread_of(applied).median, 2);
    row["first changed ms"] = rounded(spread_of(first).median, 1);
    row["settled ms"] = rounded(spread_of(settled).median, 1);
    row["runtime bytes"] = runtime_bytes;
    row["device bytes"] = (*session)->device()->allocated_bytes(gpu::MemoryUse::device);
    row["document cache bytes"] = (*session)->document().statistics().cache_bytes;
    return row;
}

}  // namespace

Result<BenchReport> bench_crater(const BenchRequest& request) {
    BenchTable table{"a 10 m crater on flat maps (medians)", {}};
    for (const double side_m : {1024.0, 16384.0}) {
        auto row = crater_on(request, side_m);
        if (!row) return row.error();
        table.rows.push_back(*row);
    }
    return BenchReport{table};
}

}  // namespace loam::bench
