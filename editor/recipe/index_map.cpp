#include "editor/recipe/index_map.h"

#include <algorithm>
#include <cmath>

#include "editor/recipe/grid.h"
#include "editor/recipe/noise.h"
#include "runtime/base/job_queue.h"

namespace loam {

namespace {

// As layer_recipe_names() has them.
enum Layer : uint16_t { kGrass, kDryGrass, kForestFloor, kDirt, kScree, kRock, kSand, kSnow, kLayerCount };

float percentile(std::vector<float> values, double share) {
    if (values.empty()) return 0;
    const auto it =
        values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), it, values.end());
    return *it;
}

float bilinear(const std::vector<float>& v, int size, float x, float y) {
    const float top = static_cast<float>(size - 1);
    x = std::clamp(x, 0.0f, top), y = std::clamp(y, 0.0f, top);
    const int i = std::min(static_cast<int>(x), std::max(size - 2, 0)),
              j = std::min(static_cast<int>(y), std::max(size - 2, 0));
    const int right = size > 1 ? 1 : 0;
    const float u = x - static_cast<float>(i), w = y - static_cast<float>(j);
    const float* south = &v[static_cast<size_t>(j) * size + i];
    const float* north = south + static_cast<size_t>(right) * size;
    return (south[0] * (1 - u) + south[right] * u) * (1 - w) + (north[0] * (1 - u) + north[right] * u) * w;
}

uint8_t tint_byte(float v) {
    return static_cast<uint8_t>(std::lround(std::clamp(v, 0.8f, 1.0f) * 255.0f));
}

}  // namespace

double recipe_index_spacing_m(double size_m) {
    double spacing = 0.25;
    while (spacing < 64 && size_m / spacing > 4200) spacing *= 2;
    return spacing;
}

Climate recipe_climate(const std::string& recipe) {
    if (recipe == "dunes") return Climate::desert;
    return recipe == "hills" || recipe == "plain" ? Climate::temperate : Climate::alpine;
}

IndexPainter::IndexPainter(const IndexRequest& request) : request_(request) {
    const GroundMaps& maps = *request.maps;
    recipe::Grid wet(maps.size), steep(maps.size);
    for (size_t c = 0; c < wet.v.size(); ++c) wet.v[c] = std::log2(std::max(maps.flow_m2[c], 1.0f) * 0.01f);
    steep.v = maps.slope;
    // A stream is as wide as its catchment is large: its wetness reaches some metres to its sides, falling as
    // it goes.
    const int reach = std::max(1, static_cast<int>(5.0 / maps.spacing_m));
    const float fall = 7.0f / static_cast<float>(reach);
    for (int pass = 0; pass < reach; ++pass) {
        recipe::Grid wider = wet;
        parallel_ranges(maps.size, 32, [&](int begin, int end) {
            for (int j = begin; j < end; ++j)
                for (int i = 0; i < maps.size; ++i)
                    for (int k = 0; k < 4; ++k) {
                        const int x = std::clamp(i + (k == 0) - (k == 1), 0, maps.size - 1);
                        const int y = std::clamp(j + (k == 2) - (k == 3), 0, maps.size - 1);
                        wider.at(i, j) = std::max(wider.at(i, j), wet.at(x, y) - fall);
                    }
        });
        wet = std::move(wider);
    }
    wet_ = recipe::blurred(wet, std::max(1, static_cast<int>(2.0 / maps.spacing_m)), 1).v;
    steep_ = recipe::blurred(steep, std::max(1, static_cast<int>(4.0 / maps.spacing_m)), 1).v;
    const float low = percentile(maps.height_m, 0.02), high = percentile(maps.height_m, 0.99);
    // Lines of snow and trees by the map's own relief, which stands for an alpine range of any size; low
    // ground has none.
    if (request.climate == Climate::alpine && high - low > 60) {
        snow_line_m_ = percentile(maps.height_m, 0.94);
        tree_line_m_ = percentile(maps.height_m, 0.66);
    }
}

IndexTexel IndexPainter::texel_at(float x_m, float y_m) const {
    using recipe::fractal;
    using recipe::noise;
    using recipe::smooth_step;
    const GroundMaps& maps = *request_.maps;
    const uint32_t seed = request_.seed;
    // Borders: the place that is asked is shaken by some metres, and every score has noise of its own.
    const float shake_x =
        3.2f * noise(x_m / 9, y_m / 9, seed) + 1.1f * noise(x_m / 2.6f, y_m / 2.6f, seed + 1);
    const float shake_y =
        3.2f * noise(x_m / 9, y_m / 9, seed + 2) + 1.1f * noise(x_m / 2.6f, y_m / 2.6f, seed + 3);
    const float to_samples = static_cast<float>(1.0 / maps.spacing_m);
    const float x = (x_m + shake_x) * to_samples, y = (y_m + shake_y) * to_samples;
    const float fine = fractal(x_m / 11, y_m / 11, seed + 4, 4, 0.6f);
    const float broad = fractal(x_m / 130, y_m / 130, seed + 5, 4);
    const float patch = fractal(x_m / 38, y_m / 38, seed + 6, 4, 0.55f);

    const float height = bilinear(maps.height_m, maps.size, x, y),
                slope = bilinear(maps.slope, maps.size, x, y);
    const float steep = bilinear(steep_, maps.size, x, y), wet = bilinear(wet_, maps.size, x, y);
    const float deposit = bilinear(maps.deposit_m, maps.size, x, y);
    const float curvature = bilinear(maps.curvature, maps.size, x, y) * static_cast<float>(maps.spacing_m);
    const float north_x =
        bilinear(maps.height_m, maps.size, x, y + 3) - bilinear(maps.height_m, maps.size, x, y - 3);
    const float sunny = std::clamp(north_x * to_samples / 6.0f, -1.0f, 1.0f);  // > 0: faces south

    const float flat = 1 - smooth_step(0.10f, 0.28f, steep);
    // On a flat floor the paths of single drops say nothing: it is wet as a whole, in patches.
    const float moisture = 0.08f * (wet - 0.5f) * (1 - 0.75f * flat) + 0.22f * flat - 0.35f * steep -
                           0.4f * sunny + 0.55f * broad + 0.25f * patch;
    float score[kLayerCount];
    score[kGrass] = 0.55f + 0.25f * moisture - 0.5f * smooth_step(0.5f, 0.8f, steep);
    score[kDryGrass] = 0.50f - 0.45f * moisture + 0.2f * patch - 0.5f * smooth_step(0.55f, 0.85f, steep);
    score[kForestFloor] = 0.50f + 0.75f * broad + 0.25f * moisture + 0.2f * patch -
                          1.2f * smooth_step(0.55f, 0.8f, steep) - 0.35f * flat;
    score[kDirt] = 0.12f + 0.8f * smooth_step(5.0f, 8.5f, wet + 0.6f * patch) -
                   0.25f * smooth_step(9, 12, wet) + 0.35f * smooth_step(0.45f, 0.85f, patch);
    score[kSand] = -0.2f + 1.25f * smooth_step(9.0f, 12.0f, wet + 0.8f * patch) * flat;
    score[kScree] =
        0.1f + 0.85f * smooth_step(0.15f, 0.9f, deposit + 0.25f * fine) * smooth_step(0.42f, 0.58f, steep) +
        0.2f * fine + 0.2f * smooth_step(0.5f, 0.65f, steep);
    score[kRock] = 0.05f + 1.15f * smooth_step(0.48f, 0.78f, 0.6f * slope + 0.4f * steep + 0.10f * fine) -
                   0.30f * std::clamp(deposit * 0.5f, 0.0f, 1.0f) - 1.2f * std::clamp(curvature, -0.3f, 0.3f);
    score[kSnow] = -1;
    if (request_.climate == Climate::alpine) {
        const float above = (height - tree_line_m_) / std::max(snow_line_m_ - tree_line_m_, 30.0f) +
                            0.3f * broad + 0.12f * patch;
        score[kForestFloor] -= 0.9f * smooth_step(-0.2f, 0.35f, above);
        score[kGrass] -= 0.35f * smooth_step(0.35f, 1.0f, above);
        score[kDryGrass] -= 0.2f * smooth_step(0.5f, 1.1f, above);
        score[kScree] += 0.25f * smooth_step(0.4f, 1.0f, above);
        const float snow = above - 0.15f * sunny + 1.0f * std::clamp(curvature, -0.25f, 0.25f) + 0.1f * fine;
        score[kSnow] =
            1.6f * smooth_step(0.75f, 1.15f, snow) - 1.3f * smooth_step(0.5f, 0.8f, slope + 0.08f * fine);
    } else if (request_.climate == Climate::desert) {
        score[kSand] += 1.6f;
        score[kForestFloor] = -1;
    }
    uint16_t best = 0;
    for (uint16_t k = 0; k < kLayerCount; ++k) {
        score[k] += 0.14f * noise(x_m / 4.5f, y_m / 4.5f, seed + 20u + k) +
                    0.06f * noise(x_m / 1.7f, y_m / 1.7f, seed + 40u + k);
        if (score[k] > score[best]) best = k;
    }
    IndexTexel texel;
    texel.layer = best;
    // sRGB-encoded, near white; snow is left clean.
    const float strength = best == kSnow ? 0.01f : 0.05f;
    const float light = 0.945f + strength * fractal(x_m / 210, y_m / 210, seed + 60, 4),
                warm = strength * 0.7f * noise(x_m / 320, y_m / 320, seed + 61);
    texel.tint[0] = tint_byte(light + warm);
    texel.tint[1] = tint_byte(light + 0.2f * warm);
    texel.tint[2] = tint_byte(light - warm);
    return texel;
}

void IndexPainter::paint_rows(int first_row, int row_count, IndexTexel* out) const {
    parallel_ranges(row_count, 4, [&](int begin, int end) {
        for (int j = begin; j < end; ++j)
            for (int i = 0; i < request_.width; ++i)
                out[static_cast<size_t>(j) * request_.width + i] =
                    texel_at(static_cast<float>((i + 0.5) * request_.spacing_m),
                             static_cast<float>((first_row + j + 0.5) * request_.spacing_m));
    });
}

}  // namespace loam
