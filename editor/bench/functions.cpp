// What decals that are functions cost: each shipped one against a flat colour of the same size, whole pages;
// how long a text takes from the last key to the ground; and how far pages, which have the function at their
// texels' centres, are from the reference.
#include <algorithm>
#include <chrono>

#include "editor/bench/bench.h"
#include "editor/picture.h"

namespace loam::bench {

namespace {

using Clock = std::chrono::steady_clock;

double ms_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// Milliseconds of a picture from the change on, until it is at rest.
Result<double> settle_ms(Session& session, const Camera& view, const BenchRequest& request) {
    const auto start = Clock::now();
    auto picture = session.render({.camera = view, .width = request.width, .height = request.height});
    if (!picture) return picture.error();
    return ms_since(start);
}

// Of the picture at rest against the reference with 4 x 4 samples a pixel, dB.
Result<double> reference_psnr_db(Session& session, const Camera& view, const BenchRequest& request) {
    auto shown =
        session.render({.camera = view, .width = request.width, .height = request.height, .supersample = 4});
    if (!shown) return shown.error();
    auto exact =
        session.render({.camera = view, .width = request.width, .height = request.height, .reference = true});
    if (!exact) return exact.error();
    return psnr_db(*shown, *exact);
}

}  // namespace

Result<BenchReport> bench_functions(const BenchRequest& request) {
    auto project = TemporaryProject::create_flat(request.project, 1024);
    if (!project) return project.error();
    auto session = Session::open(project->path(), request.session);
    if (!session) return session.error();
    const Camera view = Camera::look_at({500, 490, 112}, {500, 500, 100});
    if (auto first = settle_ms(**session, view, request); !first) return first.error();

    const auto decal = [&](const std::string& function) {
        TerrainDecal d{.x_m = 500, .y_m = 500, .half_m = {8, 8}};
        d.material.function = function;
        return d;
    };
    if (auto added = (*session)->apply({AddOperatorCommand{decal(""), {}}}); !added) return added.error();
    const uint64_t id = (*session)->document().operators().back().id;
    const int repeats = request.quick ? 2 : 7;
    // The median of making the decal's pages again, for it and for a flat colour in turn.
    const auto measure = [&](const std::string& function) -> Result<std::array<double, 2>> {
        std::vector<double> flat, made;
        for (int i = 0; i <= repeats; ++i)
            for (const bool plain : {true, false}) {
                TerrainDecal d = decal(plain ? "" : function);
                d.material.seed = uint32_t(i);
                if (auto edited = (*session)->apply({EditOperatorCommand{id, d, {}}}); !edited)
                    return edited.error();
                auto ms = settle_ms(**session, view, request);
                if (!ms) return ms.error();
                if (i > 0) (plain ? flat : made).push_back(*ms);  // the first one makes pipelines
            }
        return std::array{spread_of(flat).median, spread_of(made).median};
    };
    BenchTable cost{"a decal of 16 m by functions: to a picture at rest, milliseconds (medians, in turn)",
                    {}};
    FunctionLibrary& functions = (*session)->document().functions();
    auto names = functions.names();
    if (request.quick) names.resize(2);
    auto flat_db = reference_psnr_db(**session, view, request);
    if (!flat_db) return flat_db.error();
    for (const std::string& name : names) {
        const auto start = Clock::now();
        const auto found = functions.find(name);
        if (!found) return found.error();
        const double checked_ms = ms_since(start);
        auto ms = measure(name);
        if (!ms) return ms.error();
        auto db = reference_psnr_db(**session, view, request);
        if (!db) return db.error();
        cost.rows.push_back({{"name", name},
                             {"steps", (*found)->steps},
                             {"read and checked", rounded(checked_ms, 1)},
                             {"flat colour", rounded((*ms)[0], 0)},
                             {"function", rounded((*ms)[1], 0)},
                             {"ratio", rounded((*ms)[1] / (*ms)[0], 2)},
                             {"from the reference, dB", rounded(*db, 1)}});
    }

    BenchTable live{"from a text to the ground, milliseconds; and the error without a function", {}};
    if (auto edited = (*session)->apply({EditOperatorCommand{id, decal(names[0]), {}}}); !edited)
        return edited.error();
    if (auto ms = settle_ms(**session, view, request); !ms) return ms.error();
    std::vector<double> applied, shown;
    const auto text = functions.text(names[0]);
    if (!text) return text.error();
    for (int i = 0; i < repeats; ++i) {
        const auto start = Clock::now();
        // Another program each time, so that no cache of shaders has it.
        const std::string other = *text + fmt::format("const float OTHER_{} = {}.0;\n", i, i) +
                                  fmt::format("float other(float x) {{ return x + OTHER_{}; }}\n", i);
        auto set = (*session)->apply({FunctionCommand{names[0], other}});
        if (!set) return set.error();
        applied.push_back(ms_since(start));
        auto ms = settle_ms(**session, view, request);
        if (!ms) return ms.error();
        shown.push_back(*ms);
    }
    live.rows.push_back(
        {{"a flat colour from the reference, dB", rounded(*flat_db, 1)},
         {"checked, compiled and saved", rounded(spread_of(applied).median, 1)},
         {"then, with the pipeline, to a picture at rest", rounded(spread_of(shown).median, 0)}});
    return BenchReport{cost, live};
}

}  // namespace loam::bench
