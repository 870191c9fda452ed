// Valley and ridge: uplift against stream power from a coarse grid to the fine one, then what loose material
// does.
//
// At the coarse grid (an eighth of the samples a side) the drainage network organises itself, which takes a
// hundred steps; each finer grid inherits it and needs only the few that carve its own gullies (Cordonnier et
// al. 2016). Slopes follow from the steepness ks = uplift / rate: a stream with catchment A settles at slope
// ks / sqrt(A), and everything whose catchment is too small for that stands at the angle of failure.
#include <algorithm>
#include <cmath>

#include "editor/recipe/ground_shapes.h"
#include "editor/recipe/noise.h"

namespace loam::recipe {

namespace {

struct MountainPlan {
    Grid uplift;             // share, at the fine grid
    Grid strength;           // of rock, about 0.6 … 1.6
    Grid start_m;            // coarse ground to begin with
    float steepness_m = 90;  // ks
    float fill_m = 14;       // of valley floors at a catchment of 1 km² (shares of the map's scale)
    Outlets outlets = Outlets::all_edges;
};

int level_size(int size, int level) {
    return std::max((size - 1) >> level, 1) + 1;
}

Result<Shape> carve(const ShapeRequest& request, const MountainPlan& plan, const Progress& progress) {
    int coarsest = 3;
    while (coarsest > 0 && level_size(request.size, coarsest) < 33) --coarsest;
    Shape shape{resampled_linear(plan.start_m, level_size(request.size, coarsest)), {}};
    shape.deposit_m = Grid(shape.height_m.size);
    static constexpr int kSteps[4] = {2, 5, 22, 110};           // of incision, fine to coarse
    static constexpr double kShare[4] = {0.55, 0.2, 0.1, 0.0};  // of the time, where each level begins
    const float scale = static_cast<float>(request.side_m() / 4096.0);  // constants below were tuned at 4 km
    for (int level = coarsest; level >= 0; --level) {
        const int size = level_size(request.size, level);
        const double spacing = request.side_m() / (size - 1);
        const float dx = static_cast<float>(spacing);
        if (size != shape.height_m.size) {
            shape.height_m = resampled(shape.height_m, size);
            shape.deposit_m = resampled_linear(shape.deposit_m, size);
            if (level >= 1)
                bend(shape.height_m, request.seed + static_cast<uint32_t>(level), level == 2 ? 1.0f : 0.3f);
        }
        const Grid uplift = resampled_linear(plan.uplift, size),
                   strength = resampled_linear(plan.strength, size);
        // What the coarser grid could not hold: rills and ribs, more where it is steep, none on the floors.
        const Grid slope = slope_of(shape.height_m, spacing);
        const float frequency = static_cast<float>(size - 1) / 14.0f;
        const Grid rough = filled_by(size, [&](float u, float v) {
            return fractal(u * frequency, v * frequency, request.seed + 900u + static_cast<uint32_t>(level),
                           4, 0.6f);
        });
        for (size_t c = 0; c < rough.v.size(); ++c)
            shape.height_m.v[c] += rough.v[c] * dx *
                                   (0.035f + std::min(slope.v[c], 1.2f) * (level == 0   ? 0.26f
                                                                           : level == 3 ? 1.6f
                                                                                        : 0.9f));

        const int steps = coarsest == 0 ? 60 : kSteps[level];
        Incision incision{.uplift_m = 0,
                          .rate = 0.6f,
                          .steepest = level >= 2 ? 0.44f : 0.72f,
                          .uplift_share = &uplift,
                          .strength = &strength};
        if (level == 2 && coarsest > 2) incision.rate = 0.15f;
        if (level == 1 && coarsest > 1) incision.rate = 0.04f;
        if (level == 0 && coarsest > 0) incision.rate = 0.02f;
        // Finer grids have smaller catchments, which uplift would raise to peaks: there only rain is at work.
        if (level == coarsest || level == 2) incision.uplift_m = plan.steepness_m * incision.rate;
        for (int s = 0; s < steps; ++s) {
            LOAM_TRY(step_progress(progress, kShare[level] + 0.1 * s / steps,
                                   level == coarsest ? "carving the drainage network" : "carving gullies"));
            const uint32_t wander = hash(request.seed, static_cast<uint32_t>(level * 1000 + s)) | 1u;
            const Drainage drainage = route(shape.height_m, spacing, plan.outlets, wander);
            incise(shape.height_m, drainage, spacing, incision);
            if (level > 0)
                creep(shape.height_m, spacing, (level == 3 ? 2.0f : level == 2 ? 0.9f : 0.1f) * dx * dx);
        }
        if (level == std::min(1, coarsest)) {
            LOAM_TRY(step_progress(progress, 0.4, "filling valley floors"));
            const Drainage drainage = route(shape.height_m, spacing, plan.outlets, request.seed | 1u);
            fill_valleys(shape.height_m, shape.deposit_m, drainage, spacing, plan.fill_m * scale,
                         60000.0f * scale * scale);
            // Old channels and bars: a floor is never a plane, and what flows over it needs somewhere to go.
            const Grid bars = filled_by(size, [&](float u, float v) {
                return fractal(u * 26, v * 26, request.seed + 700u, 5, 0.5f);
            });
            for (size_t c = 0; c < bars.v.size(); ++c)
                shape.height_m.v[c] +=
                    2.2f * scale * bars.v[c] * std::min(shape.deposit_m.v[c] / (2 * scale), 1.0f);
        }
        if (level <= 1) {
            LOAM_TRY(step_progress(progress, kShare[level] + 0.15, "laying fans and scree"));
            for (int s = 0; s < (level == 1 ? 6 : 2); ++s) {
                const Drainage drainage = route(shape.height_m, spacing, plan.outlets);
                carry_sediment(shape.height_m, shape.deposit_m, drainage, spacing,
                               {.capacity = 0.05f * dx * dx, .pick_up = 0.3f, .deepest_m = 0.15f * dx});
            }
            weather(shape.height_m, shape.deposit_m, spacing,
                    {.repose = 0.62f, .rock_limit = 0.68f, .crumble = 0.05f, .strength = &strength},
                    level == 1 ? 60 : 40);
            creep(shape.height_m, spacing, (level == 1 ? 0.35f : 0.3f) * dx * dx);
        }
    }
    LOAM_TRY(step_progress(progress, 1.0, "ground shaped"));
    return shape;
}

// Bands of harder and softer rock, tilted, bent by noise: the hard ones stand as cliffs and steps.
Grid rock_strength(const ShapeRequest& request, uint32_t seed) {
    const float bands = 9.0f;
    return filled_by(std::min(request.size, 1025), [&](float u, float v) {
        const float bend = fractal(u * 3, v * 3, seed, 4) * 0.22f;
        const float band = noise((u * 0.6f + v * 0.8f + bend) * bands, 0.5f, seed + 1);
        return std::clamp(1.0f + 0.35f * band + 0.45f * fractal(u * 14, v * 14, seed + 2, 6, 0.65f), 0.6f,
                          1.7f);
    });
}

// Lengths scale slower than maps: a 16 km valley is not four times as high as one of 4 km.
float steepness_at(double side_m, float at_4_km) {
    return at_4_km * static_cast<float>(std::pow(side_m / 4096.0, 0.75));
}

}  // namespace

void bend(Grid& height_m, uint32_t seed, float strength) {
    const Grid straight = height_m;
    const float last = static_cast<float>(height_m.size - 1);
    height_m = filled_by(height_m.size, [&](float u, float v) {
        const float finer = 2.0f / (0.5f + strength);
        const float su = strength * 0.028f * fractal(u * 6 * finer, v * 6 * finer, seed + 31, 3);
        const float sv = strength * 0.028f * fractal(u * 6 * finer, v * 6 * finer, seed + 37, 3);
        return straight.bilinear((u + su) * last, (v + sv) * last);
    });
}

Result<Shape> shape_valley(const ShapeRequest& request, const Progress& progress) {
    const uint32_t seed = hash(request.seed, 11);
    const int size = std::min(request.size, 1025);
    const float relief = steepness_at(request.side_m(), 500.0f);
    // The main valley runs from the east edge to the west one on a winding line.
    const auto from_axis = [seed](float u, float v) {
        const float axis =
            0.46f + 0.13f * noise(u * 2.2f, 0.3f, seed) + 0.04f * noise(u * 6.0f, 7.3f, seed + 1);
        return std::fabs(v - axis);
    };
    MountainPlan plan;
    plan.uplift = filled_by(size, [&](float u, float v) {
        const float warp_u = u + 0.09f * fractal(u * 3, v * 3, seed + 2, 3),
                    warp_v = v + 0.09f * fractal(u * 3, v * 3, seed + 3, 3);
        const float high = 0.45f + 0.85f * ridged(warp_u * 2.4f, warp_v * 2.4f, seed + 4, 4);
        return high * mix(0.05f, 1.0f, smooth_step(0.035f, 0.2f, from_axis(u, v))) * mix(0.75f, 1.15f, u);
    });
    plan.start_m = filled_by(size, [&](float u, float v) {
        const float warp_u = u + 0.08f * fractal(u * 3, v * 3, seed + 2, 3),
                    warp_v = v + 0.08f * fractal(u * 3, v * 3, seed + 3, 3);
        const float high = ridged(warp_u * 3, warp_v * 3, seed + 5, 5);
        return relief * (0.35f * u + smooth_step(0.0f, 0.35f, from_axis(u, v)) * (0.5f + high));
    });
    plan.strength = rock_strength(request, seed + 20);
    plan.steepness_m = steepness_at(request.side_m(), 100.0f);
    plan.fill_m = 10;
    plan.outlets = Outlets::lowest_of_edge;
    return carve(request, plan, progress);
}

Result<Shape> shape_ridge(const ShapeRequest& request, const Progress& progress) {
    const uint32_t seed = hash(request.seed, 12);
    const int size = std::min(request.size, 1025);
    const float relief = steepness_at(request.side_m(), 350.0f);
    const auto crest = [seed](float u, float v) {
        const float axis =
            0.5f + 0.12f * noise(u * 2.0f, 0.3f, seed) + 0.05f * noise(u * 5.0f, 2.3f, seed + 1);
        return 1.0f - smooth_step(0.0f, v > axis ? 0.3f : 0.5f, std::fabs(v - axis));  // steep to the north
    };
    MountainPlan plan;
    plan.uplift = filled_by(size, [&](float u, float v) {
        return 0.1f + crest(u, v) * (0.6f + 0.6f * ridged(u * 3, v * 3, seed + 4, 4));
    });
    plan.start_m = filled_by(size, [&](float u, float v) {
        return relief * (crest(u, v) + 0.2f * fractal(u * 5, v * 5, seed + 5, 6));
    });
    plan.strength = rock_strength(request, seed + 20);
    plan.steepness_m = steepness_at(request.side_m(), 110.0f);
    plan.fill_m = 5;
    return carve(request, plan, progress);
}

}  // namespace loam::recipe
