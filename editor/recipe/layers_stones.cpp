// Dirt, scree and rock: clods and pebbles, packed angular stones, fractured strata.
#include <algorithm>
#include <cmath>

#include "editor/recipe/layer_canvas.h"

namespace loam::recipe {

LayerTextures layer_dirt(uint32_t seed, int size) {
    Canvas canvas(size);
    constexpr float kMm = 1.0f / 2000;
    canvas.fill([&](float u, float v) {
        const float bend_u = u + 0.012f * fractal(u * 16, v * 16, seed + 1, 3, 0.5f, 16);
        const float bend_v = v + 0.012f * fractal(u * 16, v * 16, seed + 2, 3, 0.5f, 16);
        // Trodden soil: lumps that merge, crumbs between them, drying cracks in places.
        float height = 9 * fractal(u * 7, v * 7, seed + 3, 4, 0.5f, 7);
        float tone = 0.10f * fractal(u * 9, v * 9, seed + 4, 5, 0.6f, 9);
        for (int s = 0; s < 3; ++s) {
            const int period = 22 << s;
            const Cell clod =
                cellular(bend_u * static_cast<float>(period), bend_v * static_cast<float>(period),
                         seed + 10u + static_cast<uint32_t>(s), period);
            const float there = unit_from_hash(clod.id) < 0.42f ? 1.0f : 0.0f;
            const float dome = std::sqrt(smooth_step(0.0f, 0.42f, clod.border)) * there *
                               (0.4f + unit_from_hash(hash(clod.id)));
            height += dome * 16.0f / static_cast<float>(1 << s);
            tone += there * dome * 0.16f * (unit_from_hash(hash(clod.id, 7)) - 0.35f);
        }
        const Cell plate = cellular(bend_u * 9, bend_v * 9, seed + 20, 9);
        const float dry = smooth_step(0.05f, 0.45f, noise(u * 4, v * 4, seed + 21, 4));
        height -= 9 * dry * smooth_step(0.035f, 0.0f, plate.border);
        const float crumbs = fractal(u * 128, v * 128, seed + 5, 4, 0.75f, 128);
        const float grain =
            unit_from_hash(hash(static_cast<uint32_t>(u * 2048), static_cast<uint32_t>(v * 2048), seed)) -
            0.5f;
        height += 4.0f * crumbs + 1.2f * grain;
        const glm::vec3 soil =
            glm::vec3(0.165f, 0.115f, 0.072f) +
            glm::vec3(0.03f, 0.022f, 0.012f) * fractal(u * 11, v * 11, seed + 6, 3, 0.5f, 11);
        return Canvas::Texel{height * kMm, 0.16f,
                             soil * std::max(0.25f, 1 + tone * 1.4f + 0.26f * crumbs + 0.18f * grain)};
    });
    Chance chance(seed + 30);
    for (int k = 0; k < 2600; ++k) {
        const float roll = chance.unit(), radius = (2.5f + 17 * roll * roll * roll * roll) * kMm;
        const float warm = chance.unit();
        const glm::vec3 colour =
            (glm::vec3(0.22f, 0.19f, 0.155f) * warm + glm::vec3(0.17f, 0.152f, 0.13f) * (1 - warm)) *
            chance.range(0.65f, 1.35f);
        canvas.draw(Canvas::Stone{.x = chance.unit(),
                                  .y = chance.unit(),
                                  .radius = radius,
                                  .bottom = chance.range(-4, 6) * kMm,
                                  .thickness = radius * chance.range(0.4f, 0.8f),
                                  .colour = colour,
                                  .gloss = 0.28f,
                                  .roundness = chance.unit() < 0.3f ? 1.0f : 0.0f,
                                  .seed = hash(seed, static_cast<uint32_t>(k))});
    }
    for (int k = 0; k < 420; ++k) {  // straw and root fibres
        const glm::vec3 colour = glm::vec3(0.24f, 0.18f, 0.10f) * chance.range(0.5f, 1.3f);
        const float z = chance.range(3, 13) * kMm;
        canvas.draw(Canvas::Stroke{.x = chance.unit(),
                                   .y = chance.unit(),
                                   .angle = chance.range(0, 6.28f),
                                   .bend = chance.bell(),
                                   .length = chance.range(15, 70) * kMm,
                                   .width = chance.range(1.5f, 3.2f) * kMm,
                                   .root_height = z,
                                   .tip_height = z,
                                   .root_colour = colour,
                                   .tip_colour = colour,
                                   .gloss = 0.2f,
                                   .taper = 0.5f});
    }
    return finished(
        canvas, {.relief = 1, .cavity = 0.6f, .mean_albedo = {0.150f, 0.108f, 0.070f}, .contrast = 1.25f});
}

LayerTextures layer_scree(uint32_t seed, int size) {
    Canvas canvas(size);
    constexpr float kMm = 1.0f / 3000;  // a tile of 3 m
    canvas.fill([&](float u, float v) {
        const float crumbs = fractal(u * 150, v * 150, seed, 4, 0.7f, 150);
        return Canvas::Texel{(6 * crumbs - 14) * kMm, 0.15f,
                             glm::vec3(0.13f, 0.118f, 0.10f) * (1 + 0.4f * crumbs)};
    });
    Chance chance(seed + 1);
    // From chips to blocks: each size lies on those before it, as it does after sliding (the fine sinks
    // between).
    static constexpr struct {
        int count;
        float low_mm, high_mm;
    } kSizes[5] = {{16000, 8, 17}, {4200, 16, 34}, {1100, 32, 62}, {250, 60, 110}, {40, 105, 190}};
    for (int s = 0; s < 5; ++s)
        for (int k = 0; k < kSizes[s].count; ++k) {
            const float radius = chance.range(kSizes[s].low_mm, kSizes[s].high_mm) * kMm;
            const float lichen = chance.unit(), warm = chance.unit();
            glm::vec3 colour =
                glm::vec3(0.27f, 0.265f, 0.255f) +
                (glm::vec3(0.30f, 0.245f, 0.185f) - glm::vec3(0.27f, 0.265f, 0.255f)) * warm * warm;
            if (lichen > 0.93f) colour = {0.265f, 0.26f, 0.20f};
            canvas.draw(Canvas::Stone{
                .x = chance.unit(),
                .y = chance.unit(),
                .radius = radius,
                .bottom = radius * chance.range(-0.35f, 0.15f) + static_cast<float>(s) * 4 * kMm,
                .thickness = radius * chance.range(0.45f, 0.85f),
                .colour = colour * chance.range(0.62f, 1.3f),
                .gloss = 0.26f,
                .seed = hash(seed + static_cast<uint32_t>(s), static_cast<uint32_t>(k))});
        }
    return finished(canvas, {.relief = 1, .cavity = 0.6f, .mean_albedo = {0.245f, 0.228f, 0.205f}});
}

LayerTextures layer_rock(uint32_t seed, int size) {
    Canvas canvas(size);
    constexpr float kMm = 1.0f / 4000;  // a tile of 4 m
    canvas.fill([&](float u, float v) {
        const float wu = u + 0.020f * fractal(u * 5, v * 5, seed + 1, 5, 0.55f, 5);
        const float wv = v + 0.022f * fractal(u * 4, v * 4, seed + 2, 6, 0.55f, 4);
        // Beds: flat cells four times as long as high, each pushed out or in and tilted as one piece; then
        // their fragments, twice smaller each time.
        float height = 0, tone = 0, crack = 0;
        glm::vec3 colour(0.27f, 0.262f, 0.25f);
        for (int s = 0; s < 4; ++s) {
            static constexpr int kAlong[4] = {3, 7, 20, 52}, kUp[4] = {9, 20, 40, 80};
            static constexpr float kPush[4] = {150, 62, 22, 9}, kTilt[4] = {0.30f, 0.36f, 0.40f, 0.4f},
                                   kOpen[4] = {30, 13, 4, 1.5f};
            const float x = wu * static_cast<float>(kAlong[s]), y = wv * static_cast<float>(kUp[s]);
            const Cell cell = cellular_xy(x, y, seed + 40u + static_cast<uint32_t>(s), kAlong[s], kUp[s]);
            const float push = unit_from_hash(cell.id) - 0.5f;
            const float tilt_x = unit_from_hash(hash(cell.id, 1)) - 0.5f,
                        tilt_y = unit_from_hash(hash(cell.id, 2)) - 0.62f;
            height +=
                kPush[s] * push + 2 * kTilt[s] *
                                      (cell.to_x * tilt_x * 4000.0f / static_cast<float>(kAlong[s]) * 0.5f +
                                       cell.to_y * tilt_y * 4000.0f / static_cast<float>(kUp[s]));
            const float width = 0.03f + 0.06f * unit_from_hash(hash(cell.id, 3));
            const float open =
                smooth_step(width, 0.0f, cell.border) *
                smooth_step(-0.1f, 0.5f, noise(u * 7, v * 7, seed + 60u + static_cast<uint32_t>(s), 7));
            height -= kOpen[s] * open;
            crack = std::max(crack, open * (s < 3 ? 1.0f : 0.6f));
            tone += (0.20f - 0.035f * static_cast<float>(s)) * (unit_from_hash(hash(cell.id, 4)) - 0.5f);
        }
        const float bedding = noise_xy(wu * 8, wv * 110, seed + 7, 8, 110);
        const float pits = fractal(u * 70, v * 70, seed + 8, 5, 0.65f, 70);
        height += 5 * bedding + 10 * pits;
        const float rust = smooth_step(0.15f, 0.9f, fractal(wu * 6, wv * 6, seed + 9, 5, 0.6f, 6));
        colour += (glm::vec3(0.30f, 0.235f, 0.165f) - colour) * rust * 0.45f;
        const float lichen = smooth_step(0.35f, 0.6f, fractal(u * 20, v * 20, seed + 10, 5, 0.65f, 20));
        colour += (glm::vec3(0.33f, 0.34f, 0.28f) - colour) * lichen * 0.35f;
        const float grain =
            unit_from_hash(hash(static_cast<uint32_t>(u * 2048), static_cast<uint32_t>(v * 2048), seed)) -
            0.5f;
        return Canvas::Texel{
            height * kMm, 0.3f - 0.1f * lichen,
            colour * std::max(0.12f, (1 + tone + 0.22f * pits + 0.10f * bedding + 0.16f * grain) *
                                         (1 - 0.35f * crack))};
    });
    return finished(canvas, {.relief = 0.8f,
                             .cavity = 0.55f,
                             .flatten = 0.35f,
                             .mean_albedo = {0.245f, 0.236f, 0.218f},
                             .contrast = 1.6f});
}

}  // namespace loam::recipe
