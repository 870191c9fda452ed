// Hashes and value noise of position, the same in GLSL and C++: integer hashing, then + - * only.
// Source: PCG output permutation as a hash (Jarzynski and Olano 2020).
#ifndef LOAM_NOISE_MATH_H
#define LOAM_NOISE_MATH_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

LOAM_INLINE uint noise_hash(uint v) {
    uint state = v * 747796405u + 2891336453u;
    uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

LOAM_INLINE uint noise_cell(int x, int y, uint seed) {
    return noise_hash(uint(x) + noise_hash(uint(y) + noise_hash(seed)));
}

// 24 bits of a hash as [0, 1).
LOAM_INLINE float noise_share(uint hash) {
    return float(hash >> 8u) * (1.0f / 16777216.0f);
}

// Value noise, cells of 1, C2, -1 … 1, and its derivatives along x and y: value, d/dx, d/dy. |p| up to about
// 10^6.
LOAM_INLINE vec3 noise_value_slope(vec2 p, uint seed) {
    float fx = floor(p.x);
    float fy = floor(p.y);
    int ix = int(fx);
    int iy = int(fy);
    float s = p.x - fx;
    float t = p.y - fy;
    float u = s * s * s * (s * (s * 6.0f - 15.0f) + 10.0f);
    float v = t * t * t * (t * (t * 6.0f - 15.0f) + 10.0f);
    float du = 30.0f * s * s * (1.0f - s) * (1.0f - s);
    float dv = 30.0f * t * t * (1.0f - t) * (1.0f - t);
    float a = noise_share(noise_cell(ix, iy, seed));
    float b = noise_share(noise_cell(ix + 1, iy, seed));
    float c = noise_share(noise_cell(ix, iy + 1, seed));
    float d = noise_share(noise_cell(ix + 1, iy + 1, seed));
    float low = a + (b - a) * u;
    float high = c + (d - c) * u;
    return vec3((low + (high - low) * v) * 2.0f - 1.0f, ((b - a) * (1.0f - v) + (d - c) * v) * du * 2.0f,
                (high - low) * dv * 2.0f);
}

// The value alone: compilers leave the rest out.
LOAM_INLINE float noise_value(vec2 p, uint seed) {
    return noise_value_slope(p, seed).x;
}

// smoothstep written out, so that both sides compute the same steps.
LOAM_INLINE float noise_ramp(float low, float high, float x) {
    float t = (x - low) / (high - low);
    t = t < 0.0f ? 0.0f : (t > 1.0f ? 1.0f : t);
    return t * t * (3.0f - 2.0f * t);
}

LOAM_END_SHARED
#endif
