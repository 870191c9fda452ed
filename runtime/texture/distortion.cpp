#include "runtime/texture/distortion.h"

#include <algorithm>
#include <cmath>

#include "runtime/maps/half.h"
#include "shaders/document/noise_math.h"

namespace loam {

namespace {

constexpr int kWaves = 16;  // cells of the coarsest octave: a bend is 16 texels long
constexpr int kOctaves = 3;
constexpr double kGain = 0.5;
constexpr uint32_t kSeeds[2] = {0xd157u, 0x0a7bu};

// Value noise of `cells` cells a side that repeats after them; at: 0 … 1.
double periodic_noise(double x, double y, int cells, uint32_t seed) {
    const double at_x = x * cells, at_y = y * cells;
    const int i = int(std::floor(at_x)), j = int(std::floor(at_y));
    const auto ease = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const auto corner = [&](int a, int b) {
        return double(shared::noise_share(shared::noise_cell((i + a) % cells, (j + b) % cells, seed))) * 2 -
               1;
    };
    const double u = ease(at_x - i), v = ease(at_y - j);
    return std::lerp(std::lerp(corner(0, 0), corner(1, 0), u), std::lerp(corner(0, 1), corner(1, 1), u), v);
}

double octaves(double x, double y, uint32_t seed) {
    double sum = 0, gain = 1;
    for (int octave = 0; octave < kOctaves; ++octave, gain *= kGain)
        sum += gain * periodic_noise(x, y, kWaves << octave, seed + uint32_t(octave));
    return sum;
}

}  // namespace

std::vector<std::vector<glm::u16vec2>> make_distortion() {
    int side = kDistortionTexels;
    std::vector<glm::dvec2> texels(size_t(side) * size_t(side));
    double largest = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            glm::dvec2& t = texels[size_t(y * side + x)];
            for (int c = 0; c < 2; ++c) {
                t[c] = octaves((x + 0.5) / side, (y + 0.5) / side, kSeeds[c]);
                largest = std::max(largest, std::abs(t[c]));
            }
        }
    std::vector<std::vector<glm::u16vec2>> mips;
    for (;; side /= 2) {
        auto& mip = mips.emplace_back();
        for (const glm::dvec2& t : texels)
            mip.emplace_back(half_from_float(float(t.x / largest)), half_from_float(float(t.y / largest)));
        if (side == 1) return mips;
        const int half = side / 2;
        std::vector<glm::dvec2> next(size_t(half) * size_t(half));
        for (int y = 0; y < half; ++y)
            for (int x = 0; x < half; ++x)
                for (int k = 0; k < 4; ++k)
                    next[size_t(y * half + x)] +=
                        0.25 * texels[size_t((2 * y + k / 2) * side + 2 * x + k % 2)];
        texels = std::move(next);
    }
}

}  // namespace loam
