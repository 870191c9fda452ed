// What astc.h tries: weights of one block mode between two endpoints for a block's texels, the error they leave.
#ifndef LOAM_TEXTURE_ASTC_TRY_H
#define LOAM_TEXTURE_ASTC_TRY_H
#include "shaders/texture/astc_ends.h"
#include "shaders/texture/astc_pack.h"
LOAM_BEGIN_SHARED

#define kAstcGridSteps 2 // corrections of a coarse grid towards the texels' own weights

// 1 in the channel, 0 elsewhere.
LOAM_INLINE vec4 astc_channel(int channel) {
    return vec4(channel == 0 ? 1.0f : 0.0f, channel == 1 ? 1.0f : 0.0f, channel == 2 ? 1.0f : 0.0f, channel == 3 ? 1.0f : 0.0f);
}

LOAM_STATE_WITH(AstcTrial, AstcSequences)
vec4 astc_texels[kAstcMaxTexels]; // of the block

// Weights of the channels with a root nearest to what the texels want between two endpoints: every `stride`th from `first` on.
LOAM_INLINE void astc_choose_weights(int side, AstcMode m, AstcColours c, vec4 root_weights, int first, int stride) {
    int count = side * side, grid = m.width * m.height;
    vec4 from = c.first * root_weights;
    vec4 d = c.second * root_weights - from;
    float dd = dot(d, d);
    float inv = dd > 0.0f ? 1.0f / dd : 0.0f;
    float want[kAstcMaxTexels], have[kAstcMaxTexels];
    LOAM_ROLLED for (int i = 0; i < count; ++i) {
        want[i] = clamp(dot(astc_texels[i] * root_weights - from, d) * inv, 0.0f, 1.0f);
        have[i] = grid == count ? want[i] : 0.0f;
    }
    int steps = grid == count ? 0 : kAstcGridSteps + 1; // from 0 the first takes the mean of the texels about
    LOAM_ROLLED for (int k = 0; k < steps; ++k) {
        float sum[kAstcMaxTexels], share[kAstcMaxTexels];
        LOAM_ROLLED for (int g = 0; g < grid; ++g) sum[g] = share[g] = 0.0f;
        LOAM_ROLLED for (int i = 0; i < count; ++i) {
            AstcInfill f = astc_infill(i, side, m);
            float rest = want[i];
            for (int n = 0; n < 4; ++n) rest -= float(f.share[n]) * (1.0f / 16.0f) * have[f.at[n]];
            for (int n = 0; n < 4; ++n) {
                sum[f.at[n]] += float(f.share[n]) * rest;
                share[f.at[n]] += float(f.share[n]);
            }
        }
        LOAM_ROLLED for (int g = 0; g < grid; ++g) have[g] = clamp(have[g] + sum[g] * (1.0f / max(share[g], 1.0f)), 0.0f, 1.0f);
    }
    float top = float(m.weight.levels - 1);
    LOAM_ROLLED for (int g = 0; g < grid; ++g) astc_sequence[g * stride + first] = int(floor(have[g] * top + 0.5f));
}

// The weight of texel i, 0…64, as decoded.
LOAM_INLINE int astc_texel_weight(int i, int side, AstcMode m) {
    if (side == 4) return astc_weight_value(astc_sequence[m.second_plane < 0 ? i : 2 * i], m.weight); // no coarser grid is a candidate
    AstcInfill f = astc_infill(i, side, m);
    int sum = 8;
    LOAM_ROLLED for (int n = 0; n < 4; ++n) sum += f.share[n] * astc_weight_value(astc_sequence[f.at[n]], m.weight);
    return sum >> 4;
}

LOAM_INLINE AstcTry astc_measure(int side, AstcMode m, AstcColours c, vec4 root_weights) {
    vec4 d = c.second - c.first;
    AstcTry t;
    t.error = 0.0f;
    t.aa = t.ab = t.bb = t.ax = t.bx = vec4(0.0f);
    vec4 second = astc_channel(m.second_plane);
    LOAM_ROLLED for (int i = 0; i < side * side; ++i) {
        vec4 w = vec4(float(astc_texel_weight(i, side, m)) * (1.0f / 64.0f));
        if (m.second_plane >= 0) w += second * (float(astc_weight_value(astc_sequence[2 * i + 1], m.weight)) * (1.0f / 64.0f) - w.x);
        vec4 texel = astc_texels[i];
        vec4 rest = (texel - c.first - d * w) * root_weights;
        t.error += dot(rest, rest);
        t.aa += (vec4(1.0f) - w) * (vec4(1.0f) - w);
        t.ab += w * (vec4(1.0f) - w);
        t.bb += w * w;
        t.ax += texel * (vec4(1.0f) - w);
        t.bx += texel * w;
    }
    return t;
}

// Each of `count` weights, round and round, a step up or down where that lowers the error.
LOAM_INLINE void astc_walk(int count, int side, AstcMode m, AstcColours c, vec4 root_weights) {
    vec4 from = c.first * root_weights;
    vec4 d = c.second * root_weights - from;
    float dd = dot(d, d);
    float inv = dd > 0.0f ? 1.0f / dd : 0.0f;
    int g = 0;
    LOAM_ROLLED for (int k = 0; k < count; ++k) {
        vec3 error = vec3(0.0f);
        int now = astc_sequence[g];
        vec3 values = vec3(float(astc_weight_value(max(now - 1, 0), m.weight)), float(astc_weight_value(now, m.weight)),
                           float(astc_weight_value(min(now + 1, m.weight.levels - 1), m.weight)));
        LOAM_ROLLED for (int i = 0; i < side * side; ++i) {
            AstcInfill f = astc_infill(i, side, m);
            int others = 8, mine = 0;
            LOAM_ROLLED for (int n = 0; n < 4; ++n) {
                bool own = f.at[n] == g;
                mine += own ? f.share[n] : 0;
                others += own ? 0 : f.share[n] * astc_weight_value(astc_sequence[f.at[n]], m.weight);
            }
            // Not clamped: along the segment, the error is the square of the distance from it.
            float want = dot(astc_texels[i] * root_weights - from, d) * inv;
            vec3 rest = floor((values * float(mine) + vec3(float(others))) * (1.0f / 16.0f)) * (1.0f / 64.0f) - vec3(want);
            error += mine > 0 ? rest * rest : vec3(0.0f);
        }
        int step_by = error.x < error.y && error.x <= error.z ? -1 : error.z < error.y ? 1 : 0;
        astc_sequence[g] = clamp(now + step_by, 0, m.weight.levels - 1);
        g = g + 1 == m.width * m.height ? 0 : g + 1;
    }
}
LOAM_END_STATE

LOAM_END_SHARED
#endif
