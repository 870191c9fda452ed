// BC1 for baking, about thirty times as dear as bc1.h: from its best attempt, cluster fit, then a walk over the endpoints.
// Cluster fit: the texels in their order along an axis are cut into four runs in each of the 969 ways; a cut gives positions, hence the
// best endpoints and their error in closed form from running sums. Twice: along the principal axis, then along the segment found.
// Source: Simon Brown's libsquish, written anew. Differences: the positions are then chosen again by distance and refined, and
// the endpoints walk by single steps of a channel while that helps, which libsquish does not do.
#ifndef LOAM_TEXTURE_BC1_FINE_H
#define LOAM_TEXTURE_BC1_FINE_H
#include "shaders/texture/bc1.h"
LOAM_BEGIN_SHARED

#define kBc1FineOrders 2
#define kBc1FineRounds 2 // over the six channels of the endpoints, each a step up and down

// The packed endpoints of the best cut along `axis`.
LOAM_INLINE uvec2 bc1_cluster_fit(LOAM_ARRAY_IN(vec3, texels, 16), vec3 sum, vec3 axis, vec3 root_weights) {
    float along[16];
    for (int i = 0; i < 16; ++i) along[i] = dot(texels[i] * root_weights, axis);
    vec3 sums[17]; // of the first n texels in order
    for (int i = 0; i < 17; ++i) sums[i] = vec3(0.0f);
    for (int i = 0; i < 16; ++i) {
        int rank = 0;
        for (int j = 0; j < 16; ++j) rank += along[j] < along[i] || (along[j] == along[i] && j < i) ? 1 : 0;
        sums[rank + 1] = texels[i];
    }
    for (int i = 1; i < 17; ++i) sums[i] += sums[i - 1];
    vec3 weights = root_weights * root_weights;
    float least = 1.0e9f;
    uvec2 best = uvec2(0u);
    for (int i = 0; i <= 16; ++i)
        for (int j = i; j <= 16; ++j)
            for (int k = j; k <= 16; ++k) {
                if (i == 16 || (i == 0 && (j == 0 || j == 16) && (k == 0 || k == 16 || k == j))) continue; // one run only
                // Runs at 0, 1/3, 2/3 and 1 from the first endpoint.
                float n0 = float(i), n1 = float(j - i), n2 = float(k - j), n3 = float(16 - k);
                Bc1Quadric q;
                q.aa = n0 + (4.0f * n1 + n2) * (1.0f / 9.0f);
                q.bb = n3 + (n1 + 4.0f * n2) * (1.0f / 9.0f);
                q.ab = (n1 + n2) * (2.0f / 9.0f);
                q.ax = (sums[i] + sums[j] + sums[k]) * (1.0f / 3.0f);
                q.bx = sum - q.ax;
                float inv = 1.0f / (q.aa * q.bb - q.ab * q.ab);
                vec3 levels = vec3(31.0f, 63.0f, 31.0f);
                vec3 e0 = floor(clamp((q.ax * q.bb - q.bx * q.ab) * inv, vec3(0.0f), vec3(1.0f)) * levels + vec3(0.5f));
                vec3 e1 = floor(clamp((q.bx * q.aa - q.ax * q.ab) * inv, vec3(0.0f), vec3(1.0f)) * levels + vec3(0.5f));
                float error = dot(bc1_quadric_error(q, bc1_expand565(e0), bc1_expand565(e1)), weights);
                bool better = error < least;
                least = better ? error : least;
                best.x = better ? uint(e0.x) << 11u | uint(e0.y) << 5u | uint(e0.z) : best.x;
                best.y = better ? uint(e1.x) << 11u | uint(e1.y) << 5u | uint(e1.z) : best.y;
            }
    return best;
}

// A packed colour with one channel (0 blue, 1 green, 2 red) a step of ±1 away; itself at the channel's limit.
LOAM_INLINE uint bc1_step565(uint colour, int channel, bool up) {
    uint shift = channel == 0 ? 0u : channel == 1 ? 5u : 11u;
    uint most = channel == 1 ? 63u : 31u;
    uint value = colour >> shift & most;
    if (value == (up ? most : 0u)) return colour;
    return up ? colour + (1u << shift) : colour - (1u << shift);
}

LOAM_INLINE uvec2 bc1_encode_fine(LOAM_ARRAY_IN(vec3, given, 16), vec3 weights) {
    vec3 root_weights = vec3(sqrt(weights.x), sqrt(weights.y), sqrt(weights.z));
    vec3 texels[16];
    vec3 sum = vec3(0.0f);
    for (int i = 0; i < 16; ++i) {
        texels[i] = block_unit3(given[i]);
        sum += texels[i];
    }
    Bc1Try best = bc1_best(texels, sum, root_weights);
    vec3 axis = bc1_axis(texels, sum * (1.0f / 16.0f), root_weights);
    for (int order = 0; order < kBc1FineOrders; ++order) {
        uvec2 c = bc1_cluster_fit(texels, sum, axis, root_weights);
        Bc1Try next = bc1_try(texels, c.x, c.y, root_weights);
        best = bc1_better(best, next);
        axis = (bc1_unpack565(c.y) - bc1_unpack565(c.x)) * root_weights;
        for (int i = 0; i < kBc1Refinements; ++i) {
            next = bc1_refine(texels, next, sum, root_weights);
            best = bc1_better(best, next);
        }
    }
    for (int step = 0; step < kBc1FineRounds * 12; ++step) {
        int which = step % 12;
        bool first = which < 6, up = (which & 1) == 0;
        int channel = (first ? which : which - 6) / 2;
        uint c0 = first ? bc1_step565(best.c0, channel, up) : best.c0;
        uint c1 = first ? best.c1 : bc1_step565(best.c1, channel, up);
        best = bc1_better(best, bc1_try(texels, c0, c1, root_weights));
    }
    return bc1_finish(best);
}

LOAM_END_SHARED
#endif
