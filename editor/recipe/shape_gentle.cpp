// Hills, dunes and plain: grounds where creep or wind has the last word.
#include <algorithm>
#include <cmath>

#include "editor/recipe/ground_shapes.h"
#include "editor/recipe/noise.h"

namespace loam::recipe {

// Uplift against streams, but with soil creep strong enough to round every crest: convex tops, concave
// hollows (the two processes set the spacing of valleys; Perron, Kirchner, Dietrich 2009, on Gabilan Mesa
// itself).
Result<Shape> shape_hills(const ShapeRequest& request, const Progress& progress) {
    const uint32_t seed = hash(request.seed, 13);
    const float side = static_cast<float>(request.side_m());
    const float waves = std::max(side / 700.0f, 1.0f);
    int level = 3;
    while (level > 0 && ((request.size - 1) >> level) < 64) --level;
    Grid height(((request.size - 1) >> level) + 1);
    height = filled_by(height.size, [&](float u, float v) {
        return 42.0f * fractal(u * waves, v * waves, seed, 7, 0.55f) + 0.012f * side * (u + 0.4f * v);
    });
    for (; level >= 0; --level) {
        const int size = ((request.size - 1) >> level) + 1;
        const double spacing = request.side_m() / (size - 1);
        const bool finer = size != height.size;
        height = resampled(height, size);
        if (finer && level >= 1) bend(height, seed + static_cast<uint32_t>(level), level == 2 ? 1.0f : 0.3f);
        const Grid strength = filled_by(size, [&](float u, float v) {
            return 1.0f + 0.4f * fractal(u * waves * 3, v * waves * 3, seed + 3, 4);
        });
        const int steps = level == 3 ? 90 : level == 2 ? 16 : level == 1 ? 3 : 1;
        for (int s = 0; s < steps; ++s) {
            LOAM_TRY(step_progress(progress, 0.7 - 0.2 * level + 0.2 * s / steps, "wearing hills"));
            const Drainage drainage = route(height, spacing, Outlets::all_edges,
                                            hash(seed, static_cast<uint32_t>(level * 1000 + s)) | 1u);
            incise(height, drainage, spacing,
                   {.uplift_m = level >= 2 ? 3.0f : 0.0f,
                    .rate = level >= 2 ? 0.14f : 0.004f,
                    .steepest = 0.7f,
                    .strength = &strength});
            creep(height, spacing,
                  level == 3   ? 90.0f
                  : level == 2 ? 40.0f
                               : 6.0f);  // m²: rounds crests over some 30 m in the coarse run
        }
    }
    Shape shape{std::move(height), Grid(request.size)};
    // Tussocks and animal paths: decimetres, which lidar of such hills shows everywhere.
    const Grid rough = filled_by(request.size, [&](float u, float v) {
        return 0.10f * fractal(u * side / 9.0f, v * side / 9.0f, seed + 7, 4, 0.6f) +
               0.25f * noise(u * side / 40.0f, v * side / 40.0f, seed + 8);
    });
    for (size_t c = 0; c < rough.v.size(); ++c) shape.height_m.v[c] += rough.v[c];
    LOAM_TRY(step_progress(progress, 1.0, "ground shaped"));
    return shape;
}

// Trains of dunes across the wind: a gentle windward side, a slip face at the angle of repose, crest lines
// that wander, join and end (the defects of W. Werner's "Eolian dunes", 1995, by noise on phase and height
// rather than by moving slabs).
Result<Shape> shape_dunes(const ShapeRequest& request, const Progress& progress) {
    const uint32_t seed = hash(request.seed, 14);
    const float side = static_cast<float>(request.side_m());
    const float wave_m = std::clamp(side / 14.0f, 16.0f, 260.0f), tall_m = wave_m * 0.1f;
    LOAM_TRY(step_progress(progress, 0.1, "piling dunes"));
    const auto train = [&](float x, float y, float length, uint32_t s, float wander) {
        // Phase grows with the wind (+x); noise on it bends the crests into horns and saddles.
        const float phase = x / length + wander * fractal(x / (length * 5), y / (length * 2.6f), s, 2, 0.4f);
        const float t = phase - std::floor(phase);
        constexpr float kCrest = 0.72f;  // share of a wave that faces the wind
        const float up = t / kCrest, down = (1 - t) / (1 - kCrest);
        const float profile =
            t < kCrest ? up * up * (3 - 2 * up) * 0.55f + 0.45f * up * up : down * (0.6f + 0.4f * down);
        const float tall = smooth_step(-0.55f, 0.75f, noise(x / (length * 3.1f), y / (length * 2.2f), s + 5));
        return profile * tall;
    };
    Shape shape{filled_by(request.size,
                          [&](float u, float v) {
                              const float x = u * side, y = v * side;
                              const float turn = 0.35f * noise(x / (wave_m * 9), y / (wave_m * 9), seed + 9);
                              const float a = x + turn * wave_m, b = y - turn * 2 * wave_m;
                              return tall_m * (train(a, b, wave_m, seed, 1.1f) * 1.3f +
                                               0.28f * train(a * 0.94f + b * 0.34f, b * 0.94f - a * 0.34f,
                                                             wave_m * 0.31f, seed + 1, 0.9f)) +
                                     0.35f * tall_m *
                                         fractal(x / (wave_m * 6), y / (wave_m * 6), seed + 2, 3);
                          }),
                {}};
    LOAM_TRY(step_progress(progress, 0.4, "letting slip faces slide"));
    // Coarse first: on a fine grid sand moves a sample a step.
    const int coarse = (request.size - 1) / 4 + 1;
    if (coarse > 33) {
        Grid low = resampled(shape.height_m, coarse), before = low;
        settle(low, request.side_m() / (coarse - 1), 0.6f, 120);
        for (size_t c = 0; c < low.v.size(); ++c) low.v[c] -= before.v[c];
        const Grid moved = resampled(low, request.size);
        for (size_t c = 0; c < moved.v.size(); ++c) shape.height_m.v[c] += moved.v[c];
    }
    LOAM_TRY(step_progress(progress, 0.6, "letting slip faces slide"));
    settle(shape.height_m, request.spacing_m, 0.62f, 60);
    shape.deposit_m = Grid(request.size, 5.0f);  // all of it is loose
    LOAM_TRY(step_progress(progress, 1.0, "ground shaped"));
    return shape;
}

Result<Shape> shape_plain(const ShapeRequest& request, const Progress& progress) {
    const uint32_t seed = hash(request.seed, 15);
    const float side = static_cast<float>(request.side_m());
    LOAM_TRY(step_progress(progress, 0.1, "laying the plain"));
    Shape shape{filled_by(request.size,
                          [&](float u, float v) {
                              const float x = u * side, y = v * side;
                              return 6.0f * fractal(x / 900, y / 900, seed, 4) +
                                     0.5f * fractal(x / 60, y / 60, seed + 1, 3) +
                                     0.06f * fractal(x / 6, y / 6, seed + 2, 2);
                          }),
                Grid(request.size, 0.5f)};
    LOAM_TRY(step_progress(progress, 1.0, "ground shaped"));
    return shape;
}

}  // namespace loam::recipe
