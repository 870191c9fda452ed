// Gradient noise and its sums, and the hash that every recipe draws its chances from. Pure functions of
// position and seed: nothing here keeps a state, so that the order of evaluation (and the number of threads)
// cannot matter. Sources: K. Perlin, "Improving Noise" (2002); F. K. Musgrave, "Procedural Fractal Terrains"
// in Ebert et al., "Texturing and Modeling" (ridged multifractal).
#pragma once

#include <cstdint>

namespace loam::recipe {

[[nodiscard]] constexpr uint32_t hash(
    uint32_t x) {  // lowbias32 by C. Wellons: every input bit reaches every output bit
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}
[[nodiscard]] constexpr uint32_t hash(uint32_t a, uint32_t b) {
    return hash(a ^ (hash(b) + 0x9e3779b9u));
}
[[nodiscard]] constexpr uint32_t hash(uint32_t a, uint32_t b, uint32_t c) {
    return hash(hash(a, b), c);
}
[[nodiscard]] constexpr float unit_from_hash(uint32_t h) {
    return static_cast<float>(h >> 8) * 0x1p-24f;
}  // [0, 1)

// A stream of chances for recipes that scatter things one after the other.
class Chance {
  public:
    explicit Chance(uint32_t seed) : state_(hash(seed, 0x51edu)) {}
    [[nodiscard]] float unit() { return unit_from_hash(hash(state_, ++count_)); }
    [[nodiscard]] float range(float low, float high) { return low + (high - low) * unit(); }
    // Sum of three: near enough to a normal deviate of standard deviation 0.5, never beyond ±1.5.
    [[nodiscard]] float bell() { return unit() + unit() + unit() - 1.5f; }

  private:
    uint32_t state_, count_ = 0;
};

// Gradient noise, about -1 … 1, one feature a unit. `period` > 0: repeats after that many units in x and y.
[[nodiscard]] float noise_xy(float x, float y, uint32_t seed, int period_x, int period_y);
[[nodiscard]] inline float noise(float x, float y, uint32_t seed, int period = 0) {
    return noise_xy(x, y, seed, period, period);
}

// Octaves of `noise`, each at twice the frequency and `gain` times the amplitude; normalised to about -1 … 1.
[[nodiscard]] float fractal(float x, float y, uint32_t seed, int octaves, float gain = 0.5f, int period = 0);

// Musgrave's ridged multifractal, 0 … 1: sharp crests, each octave weighted by the one before, so that
// valleys stay smooth.
[[nodiscard]] float ridged(float x, float y, uint32_t seed, int octaves, int period = 0);

// Distances to the nearest and second nearest point of a jittered grid, one point a unit, and the nearest
// one's identity (S. Worley, "A Cellular Texture Basis Function", 1996). The border distance is measured to
// the bisector.
struct Cell {
    float nearest = 0, border = 0;
    float to_x = 0, to_y = 0;  // from the nearest point to here
    uint32_t id = 0;
};
[[nodiscard]] Cell cellular_xy(float x, float y, uint32_t seed, int period_x, int period_y);
[[nodiscard]] inline Cell cellular(float x, float y, uint32_t seed, int period = 0) {
    return cellular_xy(x, y, seed, period, period);
}

[[nodiscard]] inline float smooth_step(float low, float high, float x) {
    const float t = x <= low ? 0.0f : x >= high ? 1.0f : (x - low) / (high - low);
    return t * t * (3.0f - 2.0f * t);
}
[[nodiscard]] inline float mix(float a, float b, float t) {
    return a + (b - a) * t;
}

}  // namespace loam::recipe
