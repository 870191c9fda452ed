// Sand and snow: wind's ripples and drifts, and grain.
#include <algorithm>
#include <cmath>

#include "editor/recipe/layer_canvas.h"

namespace loam::recipe {

namespace {

// A ripple train whose phase is bent by noise: crests wander, fork and end. Gentle to windward, steep to lee.
// 0 … 1.
float ripples(float phase) {
    const float t = phase - std::floor(phase);
    return t < 0.68f ? smooth_step(0.0f, 0.68f, t) : 1 - smooth_step(0.68f, 1.0f, t);
}

float grain_at(float u, float v, float per_tile, uint32_t seed) {
    return unit_from_hash(
               hash(static_cast<uint32_t>(u * per_tile), static_cast<uint32_t>(v * per_tile), seed)) -
           0.5f;
}

}  // namespace

LayerTextures layer_sand(uint32_t seed, int size) {
    Canvas canvas(size);
    constexpr float kMm = 1.0f / 2000;
    canvas.fill([&](float u, float v) {
        const float bend =
            1.0f * noise_xy(u * 3, v * 4, seed + 1, 3, 4) + 0.35f * noise_xy(u * 6, v * 9, seed + 2, 6, 9);
        const float tall = 0.45f + 0.55f * smooth_step(-0.6f, 0.5f, noise_xy(u * 5, v * 5, seed + 3, 5, 5));
        const float crest = ripples(v * 21 + bend),
                    small = ripples(v * 55 + u * 3 + 1.7f * bend +
                                    0.8f * noise_xy(u * 12, v * 20, seed + 4, 12, 20));
        const float soft = fractal(u * 6, v * 6, seed + 5, 4, 0.5f, 6);
        const float grain = grain_at(u, v, 2048, seed) + 0.8f * grain_at(u, v, 1024, seed + 1);
        const float speck = grain_at(u, v, 1024, seed + 2);
        const float dark = speck > 0.47f ? -0.35f : speck < -0.475f ? 0.3f : 0.0f;  // heavy minerals, shell
        const float height = 11 * tall * crest + 1.6f * (1 - crest) * small + 5 * soft + 0.8f * grain;
        // Coarse grains gather on crests and are lighter; troughs hold the dark fines.
        const float tone = 1 + 0.10f * (crest - 0.5f) * tall + 0.04f * soft + 0.13f * grain + dark;
        return Canvas::Texel{height * kMm, 0.2f + 0.06f * grain, glm::vec3(0.46f, 0.37f, 0.255f) * tone};
    });
    return finished(canvas, {.relief = 1, .cavity = 0.35f, .mean_albedo = {0.435f, 0.352f, 0.245f}});
}

LayerTextures layer_snow(uint32_t seed, int size) {
    Canvas canvas(size);
    constexpr float kMm = 1.0f / 3000;
    canvas.fill([&](float u, float v) {
        const float bend = noise_xy(u * 3, v * 4, seed + 1, 3, 4);
        const float drift = fractal(u * 3, v * 3, seed + 2, 4, 0.45f, 3);
        // Sastrugi: low wind-cut ridges, only in places.
        const float cut = smooth_step(0.0f, 0.6f, noise_xy(u * 4, v * 4, seed + 3, 4, 4));
        const float ridge = ripples(v * 11 + 1.1f * bend + 0.5f * noise_xy(u * 5, v * 9, seed + 4, 5, 9));
        const float crust = fractal(u * 40, v * 40, seed + 5, 5, 0.55f, 40);
        const float grain = grain_at(u, v, 2048, seed) + 0.6f * grain_at(u, v, 1024, seed + 6);
        const float sparkle = grain_at(u, v, 1024, seed + 7);
        const float height = 60 * drift + 13 * cut * ridge + 5.5f * crust + 1.3f * grain;
        const float tone = 1 + 0.012f * crust + 0.022f * grain + 0.01f * drift;
        return Canvas::Texel{height * kMm, sparkle > 0.485f ? 0.95f : 0.42f + 0.05f * grain,
                             glm::vec3(0.80f, 0.82f, 0.845f) * tone};
    });
    return finished(canvas, {.relief = 1, .cavity = 0.16f, .mean_albedo = {0.795f, 0.815f, 0.84f}});
}

}  // namespace loam::recipe
