// The search for what lies under the surface: steps, their time and their error.
#include <algorithm>

#include "editor/bench/bench.h"
#include "editor/bench/stage.h"
#include "editor/picture.h"
#include "shaders/frame/parallax_math.h"

namespace loam::bench {

namespace {

constexpr double kSide_m = 256;
constexpr int kExactSteps = 256, kTurns = 30;

}  // namespace

Status add_parallax(const BenchRequest& request, BenchTable& table) {
    auto project = TemporaryProject::create_flat(request.project, kSide_m);
    if (!project) return project.error();
    ProjectSettings settings = load_project(project->path()).value();
    // Of a rough layer everywhere.
    const auto rough = std::find_if(settings.layers.begin(), settings.layers.end(),
                                    [](const LayerEntry& layer) { return layer.name == "scree"; });
    if (rough == settings.layers.end()) {
        table.rows.push_back({{"steps", "needs a layer \"scree\""}});
        return {};
    }
    std::swap(settings.layers[0], *rough);
    settings.channels = {Channel::depth};
    LOAM_TRY(save_project(project->path(), settings));

    SessionDesc desc = request.session;
    desc.renderer.page_format = PageFormat::rgba8;
    auto session = Session::open(project->path(), desc);
    if (!session) return session.error();
    Session& s = **session;
    const double at_m = kSide_m / 2;
    auto ground = s.height_m(at_m, at_m);
    if (!ground) return ground.error();
    const Camera camera = Camera::look_at({at_m, at_m, *ground + 2}, {at_m, at_m + 2, *ground}, 0.9);
    FrameSettings frame{.filter = Filter::bilinear};
    const auto picture = [&](int steps) {
        frame.parallax_steps = steps;
        return s.render({.camera = camera, .width = request.width, .height = request.height, .frame = frame});
    };
    for (const double amount : {0.2, 1.0}) {
        settings.layers[0].channels[size_t(Channel::depth)] = amount;
        LOAM_TRY(s.change_settings(settings));
        // Its pages are made with pictures that cost less.
        if (auto settled = picture(0); !settled) return settled.error();
        auto exact = picture(kExactSteps);
        if (!exact) return exact.error();
        for (const int steps : {0, 4, 8, 16, 32}) {
            auto seen = picture(steps);
            if (!seen) return seen.error();
            const double db = psnr_db(*seen, *exact);
            std::vector<double> with, without, empty;
            FrameSettings plain = frame;
            plain.parallax_steps = 0;
            for (int i = -3; i < (request.quick ? 3 : kTurns); ++i) {
                auto none = resolve_probe_ms(s, nullptr, Renderer::ResolveProbe::floor);
                if (!none) return none.error();
                auto searched = resolve_probe_ms(s, &frame, Renderer::ResolveProbe::resolve);
                if (!searched) return searched.error();
                auto bare = resolve_probe_ms(s, &plain, Renderer::ResolveProbe::resolve);
                if (!bare) return bare.error();
                if (i < 0) continue;  // pipelines compile
                empty.push_back(*none);
                with.push_back(*searched);
                without.push_back(*bare);
            }
            const double none_ms = spread_of(empty).median, ms = spread_of(with).median - none_ms,
                         plain_ms = spread_of(without).median - none_ms;
            table.rows.push_back({{"deepest m", amount * double(kParallaxDepth_m)},
                                  {"steps", steps},
                                  {"resolve ms", rounded(ms, 2)},
                                  {"of one without", rounded(ms / plain_ms, 2)},
                                  {"PSNR dB", rounded(db, 2)}});
        }
    }
    return {};
}

}  // namespace loam::bench
