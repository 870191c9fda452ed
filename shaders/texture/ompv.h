// One material per vertex: which layers meet at a texel, with what weight, in which order.
// Source: Call of Duty talk, "OMPV Explained": the four index texels around a texel weigh bilinearly, equal layers are
// merged with alpha and tint summed, alpha times two clamped to 0..1, sorted by layer index, the lowest is opaque.
//
// Instead of sorting four records, the layers are visited in ascending order (`ompv_next`): each visit sums the weights of
// the corners that hold the layer. A texel with one layer makes one visit, and a pipeline that knows that there is
// only one layer computes the very same expressions, so both give the same bits (`precise` forbids fusing).
// Corners: x (0, 0), y (1, 0), z (0, 1), w (1, 1).
#ifndef LOAM_TEXTURE_OMPV_H
#define LOAM_TEXTURE_OMPV_H
#include "shaders/base/shared.h"
#ifdef __cplusplus
#define LOAM_PRECISE
#else
#define LOAM_PRECISE precise
#endif
LOAM_BEGIN_SHARED

#define kNoLayer 0xffffffffu
// Softness of the edge that a reveal map cuts, in units of reveal; looked at on rock over grass.
#define kRevealSoftness 0.25f

LOAM_INLINE vec4 ompv_weights(vec2 fraction) {
    LOAM_PRECISE vec2 rest = vec2(1.0f) - fraction;
    LOAM_PRECISE vec4 weights = vec4(rest.x * rest.y, fraction.x * rest.y, rest.x * fraction.y, fraction.x * fraction.y);
    return weights;
}

// The lowest layer among the corners that is at least `from`; kNoLayer when there is none. A corner of weight 0 counts as
// absent: at an exact vertex only that vertex is seen.
LOAM_INLINE uint ompv_next(uvec4 layers, vec4 weights, uint from) {
    uint next = kNoLayer;
    next = layers.x >= from && weights.x > 0.0f ? min(next, layers.x) : next;
    next = layers.y >= from && weights.y > 0.0f ? min(next, layers.y) : next;
    next = layers.z >= from && weights.z > 0.0f ? min(next, layers.z) : next;
    next = layers.w >= from && weights.w > 0.0f ? min(next, layers.w) : next;
    return next;
}

// Weights of the corners that hold this layer, 0 for the others.
LOAM_INLINE vec4 ompv_share(uvec4 layers, vec4 weights, uint layer) {
    return vec4(layers.x == layer ? weights.x : 0.0f, layers.y == layer ? weights.y : 0.0f,
                layers.z == layer ? weights.z : 0.0f, layers.w == layer ? weights.w : 0.0f);
}

LOAM_INLINE float ompv_sum(vec4 share) {
    LOAM_PRECISE float sum = ((share.x + share.y) + share.z) + share.w;
    return sum;
}

LOAM_INLINE vec3 ompv_tint(vec4 share, vec3 t0, vec3 t1, vec3 t2, vec3 t3) {
    LOAM_PRECISE vec3 sum = ((t0 * share.x + t1 * share.y) + t2 * share.z) + t3 * share.w;
    LOAM_PRECISE vec3 tint = sum / ompv_sum(share);
    return tint;
}

LOAM_INLINE float ompv_alpha(float summed_weight) { return clamp(summed_weight * 2.0f, 0.0f, 1.0f); }

// How much of a texel an upper layer covers: its high places (reveal near 1) come through first.
//     cover = clamp((alpha (1 + s) - (1 - reveal)) / s, 0, 1)
// alpha 0: nothing; alpha 1: all; never falls as alpha or reveal grow.
LOAM_INLINE float ompv_cover(float alpha, float reveal) {
    LOAM_PRECISE float cover = (alpha * (1.0f + kRevealSoftness) - (1.0f - reveal)) * (1.0f / kRevealSoftness);
    return clamp(cover, 0.0f, 1.0f);
}

// sRGB to linear by a cubic: within 0.003 of the standard's curve, 0 and 1 exact; for tints, which are seldom dark.
LOAM_INLINE vec3 ompv_decode_tint(vec3 srgb) {
    LOAM_PRECISE vec3 linear = srgb * (srgb * (srgb * 0.305306011f + vec3(0.682171111f)) + vec3(0.012522878f));
    return linear;
}

LOAM_END_SHARED
#endif
