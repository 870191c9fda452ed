// BC4 (one channel, 8 bytes for 4×4 texels): the outermost values are the first endpoints, then the line that fits the values best
// over the positions they led to, twice; beside it the mode of six values with 0 and 1 extra, for blocks that touch the limits.
// Sources: the format as in the Khronos Data Format Specification 1.3, section 19; the regression is that of stb_dxt's colours,
// here over positions in a line, so that its sums are gathered while the positions are chosen. Differences: stb_dxt keeps the
// outermost values and knows no second mode.
//
// Result: bits 0–7 and 8–15 of x: endpoints; then three bits a texel. Values of 8 bits that differ in up to two ways in a
// block are exact: both are endpoints. Otherwise no texel is farther than 1/14 of the block's range (and half a step of 255) away
// in the first attempt, and the sum of squares is never above that attempt's.
#ifndef LOAM_TEXTURE_BC4_H
#define LOAM_TEXTURE_BC4_H
#include "shaders/texture/block.h"
LOAM_BEGIN_SHARED

#define kBc4Refinements 2
// Values this near to 0 and 255 are left out of the first endpoints of the mode of six: tuned on flat blocks with outliers and noise.
#define kBc4Limit 16.0f

// Steps are the values between two endpoints less one: 7, or 5 where indices 6 and 7 mean 0 and 1.
struct Bc4Try {
    float from, to; // endpoints 0…255, from ≤ to
    uint lo, hi;    // three bits a texel, texels 0–7 and 8–15: the position from `from`; 6 and 7 as in the format
    float error;
    float next_from, next_to; // endpoints that fit best with these positions, not rounded
};

// `values` 0…255.
LOAM_INLINE Bc4Try bc4_try(LOAM_ARRAY_IN(float, values, 16), float from, float to, float steps) {
    Bc4Try t;
    t.from = clamp(floor(from + 0.5f), 0.0f, 255.0f);
    t.to = clamp(floor(to + 0.5f), 0.0f, 255.0f);
    float range = t.to - t.from;
    float inv = range > 0.0f ? steps * (1.0f / range) : 0.0f;
    float step_size = range * (1.0f / steps);
    bool limits = steps < 6.0f;
    t.lo = 0u;
    t.hi = 0u;
    t.error = 0.0f;
    float n = 0.0f, sum_p = 0.0f, sum_pp = 0.0f, sum_v = 0.0f, sum_pv = 0.0f;
    for (int i = 0; i < 16; ++i) {
        float v = values[i];
        float p = clamp(floor((v - t.from) * inv + 0.5f), 0.0f, steps);
        float rest = abs(v - (t.from + step_size * p));
        float extreme = v < 127.5f ? 0.0f : 255.0f;
        bool to_extreme = limits && abs(v - extreme) < rest;
        rest = to_extreme ? abs(v - extreme) : rest;
        t.error += rest * rest;
        float counts = to_extreme ? 0.0f : 1.0f;
        n += counts;
        sum_p += p * counts;
        sum_pp += p * p * counts;
        sum_v += v * counts;
        sum_pv += p * v * counts;
        uint position = to_extreme ? (v < 127.5f ? 6u : 7u) : uint(p);
        if (i < 8)
            t.lo |= position << uint(i * 3);
        else
            t.hi |= position << uint(i * 3 - 24);
    }
    float det = n * sum_pp - sum_p * sum_p;
    bool solvable = det > 0.5f;
    float slope = (n * sum_pv - sum_p * sum_v) * (1.0f / max(det, 0.5f));
    float start = (sum_v - slope * sum_p) * (1.0f / max(n, 1.0f));
    t.next_from = solvable ? start : t.from;
    t.next_to = solvable ? start + slope * steps : t.to;
    return t;
}

// Index bits of eight texels from positions: 0 is the smaller endpoint. Eight values: the larger endpoint is the first, so
// 7 → 0, 0 → 1, p → 8 - p. Six values: 0 → 0, 5 → 1, p → p + 1, 6 and 7 as they are.
LOAM_INLINE uint bc4_indices(uint positions, bool six) {
    uint indices = 0u;
    for (int i = 0; i < 8; ++i) {
        uint p = positions >> uint(i * 3) & 7u;
        uint of_eight = p == 7u ? 0u : p == 0u ? 1u : 8u - p;
        uint of_six = p == 0u || p > 5u ? p : p == 5u ? 1u : p + 1u;
        indices |= (six ? of_six : of_eight) << uint(i * 3);
    }
    return indices;
}

LOAM_INLINE uvec2 bc4_encode(LOAM_ARRAY_IN(float, texels, 16)) {
    float values[16];
    float low = 255.0f, high = 0.0f;
    float inner_low = 255.0f, inner_high = 0.0f; // of the values that are not near the limits
    for (int i = 0; i < 16; ++i) {
        float v = block_unit(texels[i]) * 255.0f;
        values[i] = v;
        low = min(low, v);
        high = max(high, v);
        bool inner = v >= kBc4Limit && v <= 255.0f - kBc4Limit;
        inner_low = inner ? min(inner_low, v) : inner_low;
        inner_high = inner ? max(inner_high, v) : inner_high;
    }
    Bc4Try next = bc4_try(values, low, high, 7.0f);
    Bc4Try best = next;
    bool six = false;
    for (int i = 0; i < kBc4Refinements; ++i) {
        next = bc4_try(values, next.next_from, next.next_to, 7.0f);
        bool better = next.error < best.error;
        best.from = better ? next.from : best.from;
        best.to = better ? next.to : best.to;
        best.lo = better ? next.lo : best.lo;
        best.hi = better ? next.hi : best.hi;
        best.error = better ? next.error : best.error;
    }
    next.next_from = min(inner_low, inner_high);
    next.next_to = inner_high;
    for (int i = 0; i < kBc4Refinements; ++i) {
        next = bc4_try(values, next.next_from, next.next_to, 5.0f);
        bool better = next.error < best.error;
        six = six || better;
        best.from = better ? next.from : best.from;
        best.to = better ? next.to : best.to;
        best.lo = better ? next.lo : best.lo;
        best.hi = better ? next.hi : best.hi;
        best.error = better ? next.error : best.error;
    }
    uint first = uint(six ? best.from : best.to), second = uint(six ? best.to : best.from);
    uint lo = bc4_indices(best.lo, six), hi = bc4_indices(best.hi, six);
    return uvec2(first | second << 8u | lo << 16u, lo >> 16u | hi << 8u);
}

// Texel i of a block, as hardware decodes it.
LOAM_INLINE float bc4_decode(uvec2 block, int i) {
    float a = float(block.x & 255u), b = float(block.x >> 8u & 255u);
    uint eight = i < 8 ? block.x >> 16u | block.y << 16u : block.y >> 8u;
    uint index = eight >> uint(i < 8 ? i * 3 : i * 3 - 24) & 7u;
    if (index < 2u) return (index == 0u ? a : b) * (1.0f / 255.0f);
    float k = float(index);
    if (a > b) return (a * (8.0f - k) + b * (k - 1.0f)) * (1.0f / 7.0f / 255.0f);
    if (index > 5u) return index == 6u ? 0.0f : 1.0f;
    return (a * (6.0f - k) + b * (k - 1.0f)) * (1.0f / 5.0f / 255.0f);
}

LOAM_END_SHARED
#endif
