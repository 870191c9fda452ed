// BC1 (DXT1) of a 4×4 block for live pages: principal axis by power iteration; endpoints from the outermost texels along it,
// and a second time from within them; each start refined by least squares against the positions it led to, twice; the best attempt
// is kept, and beside them one colour for the whole block. bc1_fine.h is the dearer encoder of the same format.
// Longer than 200 lines because packing, error and search share their scaled colours, and bc1_fine.h and bc3.h build on all of it.
// Sources: the method of stb_dxt and of Simon Brown's "DXT Compression Techniques"; written anew.
// Differences: two starts (0.2–0.35 dB on photographs over one); the endpoints of a channel are rounded together; no tables for
// the one colour, which picks, a channel, the best of the four thirds between two neighbouring endpoint values (error at most
// 1.5/255 in 5-bit channels, 0 where 5:6:5 holds the colour).
//
// Colours are 0…1. Channels are scaled by the square roots of the weights, so that plain distance is the weighted error.
// Result: x: endpoints (colour 0 low half), y: indices, texel 0 in the lowest bits. Always the four-colour mode
// unless both endpoints are equal.
#ifndef LOAM_TEXTURE_BC1_H
#define LOAM_TEXTURE_BC1_H
#include "shaders/texture/block.h"
LOAM_BEGIN_SHARED

LOAM_INLINE uint bc1_pack565(vec3 c) {
    vec3 q = floor(clamp(c, vec3(0.0f), vec3(1.0f)) * vec3(31.0f, 63.0f, 31.0f) + vec3(0.5f));
    return uint(q.x) << 11u | uint(q.y) << 5u | uint(q.z);
}

// As hardware expands it: bits repeated to eight.
LOAM_INLINE vec3 bc1_unpack565(uint c) {
    uint r = c >> 11u & 31u, g = c >> 5u & 63u, b = c & 31u;
    return vec3(float(r << 3u | r >> 2u), float(g << 2u | g >> 4u), float(b << 3u | b >> 2u)) * (1.0f / 255.0f);
}

// A channel value of five (31 levels) or six bits as hardware expands it.
LOAM_INLINE float bc1_expand(float q, float levels) {
    float eight = levels < 32.0f ? q * 8.0f + floor(q * 0.25f) : q * 4.0f + floor(q * 0.0625f);
    return eight * (1.0f / 255.0f);
}
LOAM_INLINE vec3 bc1_expand565(vec3 q) {
    return vec3(bc1_expand(q.x, 31.0f), bc1_expand(q.y, 63.0f), bc1_expand(q.z, 31.0f));
}

#define kBc1Refinements 2
// How far within the outermost texels the second start lies, as a share of their distance: best of 0.06 … 0.2 on photographs.
#define kBc1Inset 0.125f

struct Bc1Try {
    uint c0, c1;
    uint thirds_lo, thirds_hi; // two bits a texel as positions along the segment, texels 0–7 and 8–15
    float error;
    float sum_p, sum_pp;       // of the positions and their squares
    vec3 sum_pt;               // of the positions times the texels
};

LOAM_INLINE Bc1Try bc1_try(LOAM_ARRAY_IN(vec3, texels, 16), uint c0, uint c1, vec3 root_weights) {
    Bc1Try t;
    t.c0 = c0;
    t.c1 = c1;
    vec3 a = bc1_unpack565(c0) * root_weights;
    vec3 d = bc1_unpack565(c1) * root_weights - a;
    float dd = dot(d, d);
    float inv = dd > 0.0f ? 3.0f * (1.0f / dd) : 0.0f;
    t.thirds_lo = 0u;
    t.thirds_hi = 0u;
    t.error = 0.0f;
    t.sum_p = 0.0f;
    t.sum_pp = 0.0f;
    t.sum_pt = vec3(0.0f);
    for (int i = 0; i < 16; ++i) {
        vec3 p = texels[i] * root_weights - a;
        float third = clamp(floor(dot(p, d) * inv + 0.5f), 0.0f, 3.0f);
        vec3 rest = p - d * (third * (1.0f / 3.0f));
        t.error += dot(rest, rest);
        t.sum_p += third;
        t.sum_pp += third * third;
        t.sum_pt += texels[i] * third;
        if (i < 8)
            t.thirds_lo |= uint(third) << uint(i * 2);
        else
            t.thirds_hi |= uint(third) << uint(i * 2 - 16);
    }
    return t;
}

// With positions given, a channel's error is a quadric of its two endpoints e:
// aa·e.x² + 2·ab·e.x·e.y + bb·e.y² − 2·ax·e.x − 2·bx·e.y, and a constant.
struct Bc1Quadric {
    float aa, ab, bb;
    vec3 ax, bx;
};
LOAM_INLINE vec3 bc1_quadric_error(Bc1Quadric q, vec3 e0, vec3 e1) {
    return e0 * (e0 * q.aa + e1 * (2.0f * q.ab) - q.ax * 2.0f) + e1 * (e1 * q.bb - q.bx * 2.0f);
}

// The packed endpoints with (nearly) the least error, x and y: the two neighbours of the first endpoint's best value are
// tried, each with the best second endpoint for it. Rounding each endpoint alone would lose up to 0.1 dB.
LOAM_INLINE uvec2 bc1_least(Bc1Quadric q) {
    vec3 levels = vec3(31.0f, 63.0f, 31.0f);
    float inv = 1.0f / (q.aa * q.bb - q.ab * q.ab);
    float inv_bb = 1.0f / q.bb;
    vec3 best = clamp((q.ax * q.bb - q.bx * q.ab) * inv, vec3(0.0f), vec3(1.0f)) * levels;
    vec3 low0 = floor(best), high0 = min(low0 + vec3(1.0f), levels);
    vec3 low = bc1_expand565(low0), high = bc1_expand565(high0);
    vec3 low1 = floor(clamp((q.bx - low * q.ab) * inv_bb, vec3(0.0f), vec3(1.0f)) * levels + vec3(0.5f));
    vec3 high1 = floor(clamp((q.bx - high * q.ab) * inv_bb, vec3(0.0f), vec3(1.0f)) * levels + vec3(0.5f));
    vec3 gain = bc1_quadric_error(q, low, bc1_expand565(low1)) - bc1_quadric_error(q, high, bc1_expand565(high1));
    vec3 e0 = vec3(gain.x > 0.0f ? high0.x : low0.x, gain.y > 0.0f ? high0.y : low0.y, gain.z > 0.0f ? high0.z : low0.z);
    vec3 e1 = vec3(gain.x > 0.0f ? high1.x : low1.x, gain.y > 0.0f ? high1.y : low1.y, gain.z > 0.0f ? high1.z : low1.z);
    return uvec2(uint(e0.x) << 11u | uint(e0.y) << 5u | uint(e0.z), uint(e1.x) << 11u | uint(e1.y) << 5u | uint(e1.z));
}

// Endpoints that fit the texels best with the positions of `t`; its own endpoints where all positions are equal.
LOAM_INLINE Bc1Try bc1_refine(LOAM_ARRAY_IN(vec3, texels, 16), Bc1Try t, vec3 sum, vec3 root_weights) {
    Bc1Quadric q;
    q.bb = t.sum_pp * (1.0f / 9.0f);
    q.ab = (3.0f * t.sum_p - t.sum_pp) * (1.0f / 9.0f);
    q.aa = 16.0f - t.sum_p * (2.0f / 3.0f) + q.bb;
    q.bx = t.sum_pt * (1.0f / 3.0f);
    q.ax = sum - q.bx;
    bool solvable = 16.0f * t.sum_pp - t.sum_p * t.sum_p > 0.5f;
    q.bb = solvable ? q.bb : 1.0f;
    q.ab = solvable ? q.ab : 0.0f;
    uvec2 c = bc1_least(q);
    return bc1_try(texels, solvable ? c.x : t.c0, solvable ? c.y : t.c1, root_weights);
}

LOAM_INLINE Bc1Try bc1_better(Bc1Try a, Bc1Try b) {
    if (a.error <= b.error) return a;
    return b;
}

// A channel of a flat block: x, y so that (2 x + y) / 3, expanded, is nearest to v.
LOAM_INLINE vec2 bc1_flat_channel(float v, float levels) {
    float low = min(floor(v * levels), levels - 1.0f);
    float from = bc1_expand(low, levels);
    float step_size = bc1_expand(low + 1.0f, levels) - from;
    float third = clamp(floor((v - from) * (3.0f * (1.0f / step_size)) + 0.5f), 0.0f, 3.0f);
    // 0: (0, 0), 1: (0, 1), 2: (1, 0), 3: (1, 1) above `low`
    float x = third >= 2.0f ? 1.0f : 0.0f;
    float y = third == 1.0f || third == 3.0f ? 1.0f : 0.0f;
    return vec2(low + x, low + y);
}

// All texels one third along a segment that meets their mean: what blocks with less contrast than the endpoints' steps want.
LOAM_INLINE Bc1Try bc1_flat(LOAM_ARRAY_IN(vec3, texels, 16), vec3 mean, vec3 root_weights) {
    vec2 r = bc1_flat_channel(mean.x, 31.0f), g = bc1_flat_channel(mean.y, 63.0f), b = bc1_flat_channel(mean.z, 31.0f);
    Bc1Try t;
    t.c0 = uint(r.x) << 11u | uint(g.x) << 5u | uint(b.x);
    t.c1 = uint(r.y) << 11u | uint(g.y) << 5u | uint(b.y);
    t.thirds_lo = 0x5555u;
    t.thirds_hi = 0x5555u;
    t.error = 0.0f;
    t.sum_p = 16.0f;
    t.sum_pp = 16.0f;
    t.sum_pt = mean * 16.0f;
    vec3 a = bc1_unpack565(t.c0);
    vec3 shown = a + (bc1_unpack565(t.c1) - a) * (1.0f / 3.0f);
    for (int i = 0; i < 16; ++i) {
        vec3 rest = (texels[i] - shown) * root_weights;
        t.error += dot(rest, rest);
    }
    return t;
}

LOAM_INLINE uvec2 bc1_finish(Bc1Try t) {
    uint c0 = t.c0, c1 = t.c1;
    uint lo = t.thirds_lo, hi = t.thirds_hi;
    if (c0 < c1) { // the four-colour mode wants the larger value first: turn the segment round
        uint swap = c0;
        c0 = c1;
        c1 = swap;
        lo = ~lo & 0xffffu;
        hi = ~hi & 0xffffu;
    }
    uint thirds = lo | hi << 16u;
    // thirds 0 1 2 3 → indices 0 2 3 1, all sixteen at once: bit 1 is (t ^ t>>1), bit 0 is t's high bit.
    uint high = thirds >> 1u & 0x55555555u;
    uint low = thirds & 0x55555555u;
    uint indices = (high ^ low) << 1u | high;
    return uvec2(c0 | c1 << 16u, c0 == c1 ? 0u : indices);
}

// The principal axis of the weighted texels; of any length.
LOAM_INLINE vec3 bc1_axis(LOAM_ARRAY_IN(vec3, texels, 16), vec3 mean, vec3 root_weights) {
    // Covariance: xx xy xz, yy yz zz.
    vec3 c_diagonal = vec3(0.0f), c_side = vec3(0.0f);
    for (int i = 0; i < 16; ++i) {
        vec3 p = (texels[i] - mean) * root_weights;
        c_diagonal += p * p;
        c_side += vec3(p.x * p.y, p.x * p.z, p.y * p.z);
    }
    // The start must not be orthogonal to the axis: the column of the largest variance is not.
    vec3 axis = vec3(c_diagonal.x, c_side.x, c_side.y);
    float largest = c_diagonal.x;
    axis = c_diagonal.y > largest ? vec3(c_side.x, c_diagonal.y, c_side.z) : axis;
    largest = max(largest, c_diagonal.y);
    axis = c_diagonal.z > largest ? vec3(c_side.y, c_side.z, c_diagonal.z) : axis;
    for (int i = 0; i < 4; ++i) {
        vec3 next = vec3(c_diagonal.x * axis.x + c_side.x * axis.y + c_side.y * axis.z,
                         c_side.x * axis.x + c_diagonal.y * axis.y + c_side.z * axis.z,
                         c_side.y * axis.x + c_side.z * axis.y + c_diagonal.z * axis.z);
        float size = max(max(abs(next.x), abs(next.y)), abs(next.z));
        axis = size > 1.0e-12f ? next * (1.0f / size) : axis;
    }
    return axis;
}

// The best attempt, of clean texels.
LOAM_INLINE Bc1Try bc1_best(LOAM_ARRAY_IN(vec3, texels, 16), vec3 sum, vec3 root_weights) {
    vec3 mean = sum * (1.0f / 16.0f);
    vec3 axis = bc1_axis(texels, mean, root_weights);
    // The outermost texels along the axis are the first endpoints: a block of two colours is met exactly.
    float nearest = 1.0e9f, farthest = -1.0e9f;
    vec3 e0 = mean, e1 = mean;
    for (int i = 0; i < 16; ++i) {
        float along = dot((texels[i] - mean) * root_weights, axis);
        e0 = along < nearest ? texels[i] : e0;
        nearest = min(nearest, along);
        e1 = along > farthest ? texels[i] : e1;
        farthest = max(farthest, along);
    }
    Bc1Try best = bc1_flat(texels, mean, root_weights);
    vec3 inset = (e1 - e0) * kBc1Inset;
    for (int start = 0; start < 2; ++start) {
        Bc1Try next = bc1_try(texels, bc1_pack565(e0), bc1_pack565(e1), root_weights);
        best = bc1_better(best, next);
        for (int i = 0; i < kBc1Refinements; ++i) {
            next = bc1_refine(texels, next, sum, root_weights);
            best = bc1_better(best, next);
        }
        e0 += inset;
        e1 -= inset;
    }
    return best;
}

LOAM_INLINE uvec2 bc1_encode(LOAM_ARRAY_IN(vec3, given, 16), vec3 weights) {
    vec3 root_weights = vec3(sqrt(weights.x), sqrt(weights.y), sqrt(weights.z));
    vec3 texels[16];
    vec3 sum = vec3(0.0f);
    for (int i = 0; i < 16; ++i) {
        texels[i] = block_unit3(given[i]);
        sum += texels[i];
    }
    return bc1_finish(bc1_best(texels, sum, root_weights));
}

// Texel i of a block, as hardware decodes the four-colour mode (to within its rounding).
LOAM_INLINE vec3 bc1_decode(uvec2 block, int i) {
    vec3 a = bc1_unpack565(block.x & 0xffffu), b = bc1_unpack565(block.x >> 16u);
    uint index = block.y >> uint(i * 2) & 3u;
    float t = index == 0u ? 0.0f : index == 1u ? 1.0f : index == 2u ? 1.0f / 3.0f : 2.0f / 3.0f;
    return a + (b - a) * t;
}

LOAM_END_SHARED
#endif
