// Grass, dry grass and forest floor: thousands of blades, leaves, needles and twigs laid over soil.
#include <algorithm>
#include <cmath>

#include "editor/recipe/layer_canvas.h"

namespace loam::recipe {

namespace {

constexpr float kMm = 1.0f / 2000;  // these tiles are 2 m: a millimetre in tile units

// Crumbly soil between the plants.
void lay_soil(Canvas& canvas, uint32_t seed, glm::vec3 colour) {
    canvas.fill([&](float u, float v) {
        const float lumps = fractal(u * 24, v * 24, seed, 5, 0.6f, 24);
        const float crumbs = fractal(u * 180, v * 180, seed + 9, 3, 0.7f, 180);
        return Canvas::Texel{(4 * lumps + 2 * crumbs) * kMm, 0.15f,
                             colour * (1 + 0.25f * lumps + 0.35f * crumbs)};
    });
}

struct Sward {
    int blades;
    float length_mm, width_mm, height_mm;
    glm::vec3 root, young, old, dead;  // colours
    float dead_share, lean;            // lean: how much neighbours point the same way
};

void grow(Canvas& canvas, const Sward& s, uint32_t seed) {
    Chance chance(seed);
    for (int k = 0; k < s.blades; ++k) {
        const float x = chance.unit(), y = chance.unit();
        const float tuft = noise(x * 14, y * 14, seed + 1, 14), patch = noise(x * 5, y * 5, seed + 2, 5);
        const float layer =
            static_cast<float>(k) / static_cast<float>(s.blades);  // later blades stand higher
        const float vigour = 1 + 0.35f * tuft;
        const float angle = s.lean * 6.28f * noise(x * 4, y * 4, seed + 3, 4) +
                            chance.range(-3.1416f, 3.1416f) * (1 - 0.6f * s.lean);
        const bool dead = chance.unit() < s.dead_share * (1.2f - layer) * (1 - 0.8f * patch);
        const float age = std::clamp(0.5f + 0.45f * chance.bell() - 0.4f * tuft, 0.0f, 1.0f);
        const glm::vec3 tip =
            (dead ? s.dead : s.young + (s.old - s.young) * age) * (1 + 0.18f * chance.bell());
        const float base = s.height_mm * (0.05f + 0.55f * layer) * vigour,
                    rise = s.height_mm * chance.range(0.1f, 0.5f);
        canvas.draw(Canvas::Stroke{.x = x,
                                   .y = y,
                                   .angle = angle,
                                   .bend = chance.bell() * 0.9f,
                                   .length = s.length_mm * vigour * chance.range(0.5f, 1.15f) * kMm,
                                   .width = s.width_mm * chance.range(0.65f, 1.3f) * kMm,
                                   .root_height = base * 0.5f * kMm,
                                   .tip_height = (base + rise) * kMm,
                                   .arch = rise * chance.range(0, 0.5f) * kMm,
                                   .root_colour = (s.root + (tip - s.root) * (0.15f + 0.4f * layer)),
                                   .tip_colour = tip,
                                   .gloss = dead ? 0.25f : 0.42f,
                                   .taper = 1,
                                   .keel = 0.6f});
    }
}

void drop_twigs(Canvas& canvas, int count, float length_mm, float width_mm, glm::vec3 colour, float height_mm,
                uint32_t seed) {
    Chance chance(seed);
    for (int k = 0; k < count; ++k) {
        const glm::vec3 tone = colour * chance.range(0.6f, 1.4f);
        const float z = height_mm * chance.range(0.4f, 1.0f);
        canvas.draw(Canvas::Stroke{.x = chance.unit(),
                                   .y = chance.unit(),
                                   .angle = chance.range(0, 6.28f),
                                   .bend = chance.bell() * 0.4f,
                                   .length = length_mm * chance.range(0.4f, 1.3f) * kMm,
                                   .width = width_mm * chance.range(0.6f, 1.4f) * kMm,
                                   .root_height = z * kMm,
                                   .tip_height = z * chance.range(0.6f, 1.3f) * kMm,
                                   .root_colour = tone,
                                   .tip_colour = tone * 1.15f,
                                   .gloss = 0.25f,
                                   .taper = 0.4f});
    }
}

}  // namespace

LayerTextures layer_grass(uint32_t seed, int size) {
    Canvas canvas(size);
    lay_soil(canvas, seed, {0.07f, 0.05f, 0.03f});
    drop_twigs(canvas, 2500, 60, 4, {0.20f, 0.16f, 0.09f}, 6, seed + 50);
    grow(canvas,
         {.blades = 34000,
          .length_mm = 95,
          .width_mm = 6.5f,
          .height_mm = 42,
          .root = {0.020f, 0.030f, 0.008f},
          .young = {0.125f, 0.19f, 0.04f},
          .old = {0.055f, 0.11f, 0.018f},
          .dead = {0.27f, 0.22f, 0.10f},
          .dead_share = 0.12f,
          .lean = 0.35f},
         seed + 1);
    // Clover and other broad leaves low in the sward, in patches.
    Chance chance(seed + 2);
    for (int k = 0; k < 1500; ++k) {
        const float x = chance.unit(), y = chance.unit();
        if (noise(x * 6, y * 6, seed + 3, 6) < 0.12f) continue;
        const float turn = chance.range(0, 6.28f), reach = chance.range(7, 12) * kMm;
        const glm::vec3 colour = glm::vec3(0.07f, 0.15f, 0.02f) * chance.range(0.8f, 1.25f);
        for (int leaf = 0; leaf < 3; ++leaf) {
            const float a = turn + 2.094f * static_cast<float>(leaf);
            canvas.draw(Canvas::Leaf{.x = x + std::cos(a) * reach * 0.6f,
                                     .y = y + std::sin(a) * reach * 0.6f,
                                     .angle = a,
                                     .length = reach * 1.5f,
                                     .width = reach * 1.3f,
                                     .bottom = chance.range(18, 40) * kMm,
                                     .curl = 0.15f,
                                     .colour = colour,
                                     .seed = hash(seed, static_cast<uint32_t>(k))});
        }
    }
    return finished(canvas, {.relief = 1, .cavity = 0.55f, .mean_albedo = {0.094f, 0.118f, 0.042f}});
}

LayerTextures layer_dry_grass(uint32_t seed, int size) {
    Canvas canvas(size);
    lay_soil(canvas, seed, {0.13f, 0.09f, 0.055f});
    drop_twigs(canvas, 5000, 90, 4, {0.30f, 0.23f, 0.12f}, 8, seed + 50);
    grow(canvas,
         {.blades = 20000,
          .length_mm = 150,
          .width_mm = 5.0f,
          .height_mm = 46,
          .root = {0.07f, 0.05f, 0.022f},
          .young = {0.34f, 0.27f, 0.13f},
          .old = {0.22f, 0.165f, 0.075f},
          .dead = {0.13f, 0.15f, 0.04f},
          .dead_share = 0.16f,
          .lean = 0.5f},
         seed + 1);
    return finished(canvas, {.relief = 1, .cavity = 0.5f, .mean_albedo = {0.215f, 0.168f, 0.085f}});
}

LayerTextures layer_forest_floor(uint32_t seed, int size) {
    Canvas canvas(size);
    lay_soil(canvas, seed, {0.045f, 0.032f, 0.022f});
    drop_twigs(canvas, 9000, 55, 2.6f, {0.16f, 0.09f, 0.05f}, 12, seed + 50);  // needles
    static constexpr glm::vec3 kColours[5] = {{0.24f, 0.15f, 0.085f},
                                              {0.17f, 0.095f, 0.05f},
                                              {0.31f, 0.23f, 0.16f},
                                              {0.11f, 0.068f, 0.042f},
                                              {0.38f, 0.30f, 0.21f}};
    Chance chance(seed + 1);
    const int leaves = 2600;
    for (int k = 0; k < leaves; ++k) {
        const float layer = static_cast<float>(k) / static_cast<float>(leaves);
        const float x = chance.unit(), y = chance.unit(), length = chance.range(55, 115);
        const bool oak = chance.unit() < 0.6f;
        const glm::vec3 colour =
            kColours[static_cast<int>(chance.unit() * 4.99f)] * chance.range(0.7f, 1.25f);
        canvas.draw(Canvas::Leaf{.x = x,
                                 .y = y,
                                 .angle = chance.range(0, 6.28f),
                                 .length = length * kMm,
                                 .width = length * (oak ? 0.62f : 0.5f) * kMm,
                                 .bottom = (2 + 30 * layer + 5 * chance.unit()) * kMm,
                                 .lobes = oak ? 2.6f : 0.0f,
                                 .curl = chance.range(0.0f, 0.6f),
                                 .colour = colour * (0.7f + 0.4f * layer),
                                 .seed = hash(seed, static_cast<uint32_t>(k))});
        if (k % 4 == 0)
            drop_twigs(canvas, 3, 60, 2.2f, {0.2f, 0.115f, 0.06f}, 8 + 30 * layer,
                       hash(seed + 7, static_cast<uint32_t>(k)));
    }
    drop_twigs(canvas, 90, 180, 8, {0.15f, 0.11f, 0.08f}, 40, seed + 51);
    drop_twigs(canvas, 500, 70, 4, {0.13f, 0.095f, 0.065f}, 40, seed + 52);
    return finished(canvas, {.relief = 1, .cavity = 0.6f, .mean_albedo = {0.165f, 0.115f, 0.078f}});
}

}  // namespace loam::recipe
