#include "editor/recipe/noise.h"

#include <algorithm>
#include <cmath>

namespace loam::recipe {

namespace {

int wrapped(int v, int period) {
    if (period <= 0) return v;
    const int m = v % period;
    return m < 0 ? m + period : m;
}

// One of 16 directions at each lattice point: cheaper than a sine, and no axis is preferred.
float gradient(int ix, int iy, float dx, float dy, uint32_t seed, int period_x, int period_y) {
    static constexpr float kX[16] = {1,  0.9239f,  0.7071f,  0.3827f,  0, -0.3827f, -0.7071f, -0.9239f,
                                     -1, -0.9239f, -0.7071f, -0.3827f, 0, 0.3827f,  0.7071f,  0.9239f};
    const uint32_t h = hash(static_cast<uint32_t>(wrapped(ix, period_x)) * 0x9e3779b1u ^
                            hash(static_cast<uint32_t>(wrapped(iy, period_y)) + seed * 0x85ebca77u));
    return kX[h & 15] * dx + kX[(h + 12) & 15] * dy;
}

}  // namespace

float noise_xy(float x, float y, uint32_t seed, int period_x, int period_y) {
    const float fx = std::floor(x), fy = std::floor(y);
    const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
    const float dx = x - fx, dy = y - fy;
    const auto fade = [](float t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const float u = fade(dx), v = fade(dy);
    const auto corner = [&](int cx, int cy) {
        return gradient(ix + cx, iy + cy, dx - static_cast<float>(cx), dy - static_cast<float>(cy), seed,
                        period_x, period_y);
    };
    const float south = mix(corner(0, 0), corner(1, 0), u), north = mix(corner(0, 1), corner(1, 1), u);
    return mix(south, north, v) * 1.45f;  // the extreme of the plain sum is about 0.7
}

float fractal(float x, float y, uint32_t seed, int octaves, float gain, int period) {
    float sum = 0, amplitude = 1, whole = 0;
    for (int o = 0; o < octaves; ++o) {
        sum += amplitude * noise(x, y, seed + static_cast<uint32_t>(o) * 101u, period);
        whole += amplitude;
        amplitude *= gain;
        x *= 2, y *= 2, period *= 2;
    }
    return sum / whole * 1.3f;  // octaves seldom peak together
}

float ridged(float x, float y, uint32_t seed, int octaves, int period) {
    float sum = 0, amplitude = 1, whole = 0, weight = 1;
    for (int o = 0; o < octaves; ++o) {
        float crest = 1.0f - std::fabs(noise(x, y, seed + static_cast<uint32_t>(o) * 131u, period));
        crest *= crest * weight;
        weight = std::clamp(crest * 2.0f, 0.0f, 1.0f);
        sum += amplitude * crest;
        whole += amplitude;
        amplitude *= 0.5f;
        x *= 2, y *= 2, period *= 2;
    }
    return std::clamp(sum / whole, 0.0f, 1.0f);
}

Cell cellular_xy(float x, float y, uint32_t seed, int period_x, int period_y) {
    const int ix = static_cast<int>(std::floor(x)), iy = static_cast<int>(std::floor(y));
    float px[25], py[25];
    uint32_t ids[25];
    int best = 0;
    float best_squared = 1e9f;
    for (int k = 0; k < 25; ++k) {
        const int cx = ix + k % 5 - 2, cy = iy + k / 5 - 2;
        const uint32_t h = hash(static_cast<uint32_t>(wrapped(cx, period_x)),
                                static_cast<uint32_t>(wrapped(cy, period_y)), seed);
        ids[k] = h;
        px[k] = static_cast<float>(cx) + 0.5f + 0.84f * (unit_from_hash(h) - 0.5f) - x;
        py[k] = static_cast<float>(cy) + 0.5f + 0.84f * (unit_from_hash(hash(h)) - 0.5f) - y;
        const float squared = px[k] * px[k] + py[k] * py[k];
        if (squared < best_squared) best_squared = squared, best = k;
    }
    float border = 1e9f;
    for (int k = 0; k < 25; ++k) {
        const float ex = px[k] - px[best], ey = py[k] - py[best];
        const float length = std::sqrt(ex * ex + ey * ey);
        if (length < 1e-6f) continue;
        border = std::min(border, (0.5f * (px[k] + px[best]) * ex + 0.5f * (py[k] + py[best]) * ey) / length);
    }
    return {std::sqrt(best_squared), std::max(border, 0.0f), -px[best], -py[best], ids[best]};
}

}  // namespace loam::recipe
