// BC1 (DXT1) of a 4×4 block: principal axis by power iteration, then endpoints refined by least squares against the indices
// they led to, three times; the best attempt is kept, and beside them one colour for the whole block.
// Sources: the method of stb_dxt and of Simon Brown's "DXT Compression Techniques"; written anew.
// Differences: no tables for the one colour, which picks, a channel, the best of the four thirds between two neighbouring
// endpoint values (error at most 1.5/255 in 5-bit channels, 0 where 5:6:5 holds the colour).
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

#define kBc1Refinements 3

struct Bc1Try {
    uint c0, c1;
    uint thirds_lo, thirds_hi; // two bits a texel as positions along the segment, texels 0–7 and 8–15
    float error;
};

LOAM_INLINE Bc1Try bc1_try(LOAM_ARRAY_IN(vec3, texels, 16), vec3 e0, vec3 e1, vec3 root_weights) {
    Bc1Try t;
    t.c0 = bc1_pack565(e0);
    t.c1 = bc1_pack565(e1);
    vec3 a = bc1_unpack565(t.c0) * root_weights;
    vec3 d = bc1_unpack565(t.c1) * root_weights - a;
    float dd = dot(d, d);
    float inv = dd > 0.0f ? 3.0f / dd : 0.0f;
    t.thirds_lo = 0u;
    t.thirds_hi = 0u;
    t.error = 0.0f;
    for (int i = 0; i < 16; ++i) {
        vec3 p = texels[i] * root_weights - a;
        float third = clamp(floor(dot(p, d) * inv + 0.5f), 0.0f, 3.0f);
        vec3 rest = p - d * (third * (1.0f / 3.0f));
        t.error += dot(rest, rest);
        if (i < 8)
            t.thirds_lo |= uint(third) << uint(i * 2);
        else
            t.thirds_hi |= uint(third) << uint(i * 2 - 16);
    }
    return t;
}

// Endpoints that fit the texels best with the indices of `t`; equal to its own endpoints where the system is singular.
LOAM_INLINE Bc1Try bc1_refine(LOAM_ARRAY_IN(vec3, texels, 16), Bc1Try t, vec3 root_weights) {
    float aa = 0.0f, ab = 0.0f, bb = 0.0f;
    vec3 ax = vec3(0.0f), bx = vec3(0.0f);
    for (int i = 0; i < 16; ++i) {
        uint third = (i < 8 ? t.thirds_lo >> uint(i * 2) : t.thirds_hi >> uint(i * 2 - 16)) & 3u;
        float b = float(third) * (1.0f / 3.0f);
        float a = 1.0f - b;
        aa += a * a;
        ab += a * b;
        bb += b * b;
        ax += texels[i] * a;
        bx += texels[i] * b;
    }
    float det = aa * bb - ab * ab;
    bool solvable = det > 1.0e-4f;
    float inv = solvable ? 1.0f / det : 0.0f;
    vec3 e0 = (ax * bb - bx * ab) * inv;
    vec3 e1 = (bx * aa - ax * ab) * inv;
    e0 = solvable ? e0 : bc1_unpack565(t.c0);
    e1 = solvable ? e1 : bc1_unpack565(t.c1);
    return bc1_try(texels, e0, e1, root_weights);
}

LOAM_INLINE Bc1Try bc1_better(Bc1Try a, Bc1Try b) {
    bool keep = a.error <= b.error;
    Bc1Try t;
    t.c0 = keep ? a.c0 : b.c0;
    t.c1 = keep ? a.c1 : b.c1;
    t.thirds_lo = keep ? a.thirds_lo : b.thirds_lo;
    t.thirds_hi = keep ? a.thirds_hi : b.thirds_hi;
    t.error = keep ? a.error : b.error;
    return t;
}

// A channel value of five (31 levels) or six bits as hardware expands it.
LOAM_INLINE float bc1_expand(float q, float levels) {
    float eight = levels < 32.0f ? q * 8.0f + floor(q * 0.25f) : q * 4.0f + floor(q * 0.0625f);
    return eight * (1.0f / 255.0f);
}

// A channel of a flat block: x, y so that (2 x + y) / 3, expanded, is nearest to v; both as shares of `levels`.
LOAM_INLINE vec2 bc1_flat_channel(float v, float levels) {
    float low = min(floor(v * levels), levels - 1.0f);
    float from = bc1_expand(low, levels);
    float third = clamp(floor((v - from) / (bc1_expand(low + 1.0f, levels) - from) * 3.0f + 0.5f), 0.0f, 3.0f);
    // 0: (0, 0), 1: (0, 1), 2: (1, 0), 3: (1, 1) above `low`
    float x = third >= 2.0f ? 1.0f : 0.0f;
    float y = third == 1.0f || third == 3.0f ? 1.0f : 0.0f;
    return vec2(low + x, low + y) / levels;
}

// All texels one third along a segment that meets their mean: what blocks with less contrast than the endpoints' steps want.
LOAM_INLINE Bc1Try bc1_flat(LOAM_ARRAY_IN(vec3, texels, 16), vec3 e0, vec3 e1, vec3 root_weights) {
    Bc1Try t;
    t.c0 = bc1_pack565(e0);
    t.c1 = bc1_pack565(e1);
    t.thirds_lo = 0x5555u;
    t.thirds_hi = 0x5555u;
    t.error = 0.0f;
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

LOAM_INLINE uvec2 bc1_encode(LOAM_ARRAY_IN(vec3, texels, 16), vec3 weights) {
    vec3 root_weights = vec3(sqrt(weights.x), sqrt(weights.y), sqrt(weights.z));
    vec3 mean = vec3(0.0f);
    for (int i = 0; i < 16; ++i) mean += texels[i];
    mean *= 1.0f / 16.0f;
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
    vec2 fx = bc1_flat_channel(mean.x, 31.0f), fy = bc1_flat_channel(mean.y, 63.0f), fz = bc1_flat_channel(mean.z, 31.0f);
    Bc1Try best = bc1_flat(texels, vec3(fx.x, fy.x, fz.x), vec3(fx.y, fy.y, fz.y), root_weights);
    Bc1Try next = bc1_try(texels, e0, e1, root_weights);
    best = bc1_better(best, next);
    for (int i = 0; i < kBc1Refinements; ++i) {
        next = bc1_refine(texels, next, root_weights);
        best = bc1_better(best, next);
    }
    return bc1_finish(best);
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
