// ASTC of 4×4 and 6×6 texels, RGB or RGBA of 0…1, for pictures and baked pages of mobile devices: one partition.
// A fixed list of block modes (grid and range of the weights; the endpoints get the bits left) is tried; of each the texels outermost
// along the principal axis are the first endpoints, refined by least squares against the weights they lead to, twice; the best mode is
// kept, and beside it one colour for the whole block (a void extent). Where the grid has fewer weights than the block texels, each weight of
// the best mode then walks by single steps while that helps.
// Source of the format: astc_bits.h. The method is that of bc1.h in four channels; an opaque block is stored without alpha. Differences
// from Arm's encoder: no partitions, and a second plane of weights in 4×4 only, for the channel that has least to do with the others.
//
// Blocks of one colour are exact to 16 bits a channel, of two opaque colours of 8 bits exact: each format has a mode of one weight a texel
// and endpoints of 8 bits. What is no number counts as 0, what lies outside 0…1 is clamped.
#ifndef LOAM_TEXTURE_ASTC_H
#define LOAM_TEXTURE_ASTC_H
#include "shaders/texture/astc_try.h"
LOAM_BEGIN_SHARED

#define kAstcRefinements 2
#define kAstcPolishes 2 // of the chosen mode, each two walks over its weights and new endpoints

// The principal axis of the texels, of any length, the channels scaled by the roots of their weights; and the channel that has least to
// do with the others: the one for a second plane.
struct AstcAxis {
    vec4 along;
    int odd_channel;
};
struct AstcStart {
    vec4 mean, first, second; // first and second: the outermost texels along the principal axis, so that two colours are met exactly
    float darkest, brightest; // as factors of the mean colour
    float flat_error;         // of the mean alone
    bool opaque;
    int odd_channel;
    float low, high; // of the odd channel
};

LOAM_STATE_WITH(AstcEncoder, AstcTrial)

LOAM_INLINE AstcAxis astc_axis(int count, vec4 mean, vec4 root_weights) {
    vec4 x = vec4(0.0f), y = vec4(0.0f), z = vec4(0.0f), w = vec4(0.0f); // columns of the covariance
    LOAM_ROLLED for (int i = 0; i < count; ++i) {
        vec4 p = (astc_texels[i] - mean) * root_weights;
        x += p * p.x;
        y += p * p.y;
        z += p * p.z;
        w += p * p.w;
    }
    // The start must not be orthogonal to the axis: the column of the largest variance is not.
    vec4 axis = x;
    float largest = x.x;
    axis = y.y > largest ? y : axis;
    largest = max(largest, y.y);
    axis = z.z > largest ? z : axis;
    largest = max(largest, z.z);
    axis = w.w > largest ? w : axis;
    LOAM_ROLLED for (int i = 0; i < 4; ++i) {
        vec4 next = x * axis.x + y * axis.y + z * axis.z + w * axis.w;
        float size = max(max(abs(next.x), abs(next.y)), max(abs(next.z), abs(next.w)));
        axis = size > 1.0e-12f ? next * (1.0f / size) : axis;
    }
    AstcAxis a;
    a.along = axis;
    // What no other channel explains of each.
    vec4 inv = vec4(1.0f) / max(vec4(x.x, y.y, z.z, w.w), vec4(1.0e-9f));
    vec4 by_x = x * x * inv, by_y = y * y * inv, by_z = z * z * inv, by_w = w * w * inv;
    vec4 left = vec4(x.x - max(by_x.y, max(by_x.z, by_x.w)), y.y - max(by_y.x, max(by_y.z, by_y.w)),
                     z.z - max(by_z.x, max(by_z.y, by_z.w)), w.w - max(by_w.x, max(by_w.y, by_w.z)));
    a.odd_channel = left.x >= max(left.y, max(left.z, left.w)) ? 0 : left.y >= max(left.z, left.w) ? 1 : left.z >= left.w ? 2 : 3;
    return a;
}

// The bits of a mode, endpoints and the weights chosen.
LOAM_INLINE uvec4 astc_finish(AstcMode m, AstcEnds e) {
    // The decoder takes the brighter colour as the second, or as the first where contracted.
    bool turned = !m.scaled && astc_shown(e, m).rise < 0.0f;
    bool even_is_second = !m.scaled && e.contracted;
    vec4 even = turned != even_is_second ? e.second : e.first, odd = turned != even_is_second ? e.first : e.second;
    LOAM_ROLLED for (int c = 0; c < 4; ++c) {
        astc_sequence[kAstcEndsAt + c * 2] = int(even[c]);
        astc_sequence[kAstcEndsAt + c * 2 + 1] = int(odd[c]);
    }
    if (m.scaled) {
        for (int c = 0; c < 3; ++c) astc_sequence[kAstcEndsAt + c] = int(e.second[c]);
        astc_sequence[kAstcEndsAt + 3] = int(e.first.x);
        astc_sequence[kAstcEndsAt + 4] = int(e.first.w);
        astc_sequence[kAstcEndsAt + 5] = int(e.second.w);
    }
    LOAM_ROLLED for (int g = 0; g < astc_weights(m); ++g)
        astc_sequence[g] = turned ? m.weight.levels - 1 - astc_sequence[g] : astc_sequence[g];
    return astc_pack(m);
}

// What the texels of a block tell before any mode is tried.
LOAM_INLINE AstcStart astc_start(int side, vec4 root_weights) {
    AstcStart s;
    int count = side * side;
    s.mean = vec4(0.0f);
    s.opaque = true;
    LOAM_ROLLED for (int i = 0; i < count; ++i) {
        vec4 t = astc_texels[i];
        t = vec4(block_unit(t.x), block_unit(t.y), block_unit(t.z), block_unit(t.w));
        astc_texels[i] = t;
        s.opaque = s.opaque && t.w >= 1.0f;
        s.mean += t * (1.0f / float(count));
    }
    s.mean.w = s.opaque ? 1.0f : s.mean.w;
    AstcAxis a = astc_axis(count, s.mean, root_weights);
    float nearest = 1.0e9f, farthest = -1.0e9f;
    s.darkest = 1.0e9f;
    s.brightest = s.flat_error = 0.0f;
    vec3 mean_colour = vec3(s.mean.x, s.mean.y, s.mean.z);
    float inv = 1.0f / max(dot(mean_colour, mean_colour), 1.0e-6f);
    s.first = s.second = s.mean;
    vec4 lowest = vec4(1.0f), highest = vec4(0.0f);
    LOAM_ROLLED for (int i = 0; i < count; ++i) {
        vec4 t = astc_texels[i];
        vec4 p = (t - s.mean) * root_weights;
        float along = dot(p, a.along);
        s.flat_error += dot(p, p);
        s.first = along < nearest ? t : s.first;
        nearest = min(nearest, along);
        s.second = along > farthest ? t : s.second;
        farthest = max(farthest, along);
        float factor = dot(vec3(t.x, t.y, t.z), mean_colour) * inv;
        s.darkest = min(s.darkest, factor);
        s.brightest = max(s.brightest, factor);
        lowest = min(lowest, t);
        highest = max(highest, t);
    }
    s.odd_channel = a.odd_channel;
    s.low = lowest[s.odd_channel];
    s.high = highest[s.odd_channel];
    return s;
}

LOAM_INLINE AstcEnds astc_first_ends(AstcStart s, AstcMode m) {
    vec4 first = s.first, second = s.second;
    if (m.second_plane >= 0) {
        first[m.second_plane] = s.low;
        second[m.second_plane] = s.high;
    }
    AstcEnds e = astc_direct_ends(first, second, m.colour);
    if (m.scaled) {
        e.second = astc_position(vec4(vec3(s.mean.x, s.mean.y, s.mean.z) * s.brightest, s.second.w), m.colour);
        e.first = astc_position(vec4(s.darkest * (1.0f / max(s.brightest, 1.0e-6f)), 0.0f, 0.0f, s.first.w), m.colour);
    }
    return e;
}

// The block of `astc_texels`, which are cleaned. `weights` are the colour channels'; alpha counts 1.
// One loop for the search and the polish, so that a shader holds each step once.
LOAM_INLINE uvec4 astc_encode(int side, vec3 weights) {
    vec4 root_weights = vec4(sqrt(weights.x), sqrt(weights.y), sqrt(weights.z), 1.0f);
    AstcStart start = astc_start(side, root_weights);
    const int kTries = kAstcRefinements + 1;
    int searches = (side == 4 ? kAstcModes4 : kAstcModes6) * kTries;
    int best = 0, round_in_mode = 0, candidate = 0;
    float least = 1.0e9f;
    AstcMode m;
    AstcEnds e, best_ends;
    LOAM_ROLLED for (int step_at = 0; step_at < searches + kAstcPolishes; ++step_at) {
        bool searching = step_at < searches;
        m = astc_candidate(side, searching ? candidate : best, !start.opaque, start.odd_channel);
        if (searching && round_in_mode == 0) e = astc_first_ends(start, m);
        if (step_at == searches) e = best_ends;
        AstcColours shown = astc_shown(e, m);
        vec4 second = astc_channel(m.second_plane);
        int planes = step_at > searches ? 0 : m.second_plane < 0 ? 1 : 2;
        LOAM_ROLLED for (int plane = 0; plane < planes; ++plane)
            astc_choose_weights(side, m, shown, root_weights * (plane == 0 ? vec4(1.0f) - second : second), plane, planes);
        if (side != 4) astc_walk(searching || m.width * m.height == side * side ? 0 : 2 * m.width * m.height, side, m, shown, root_weights);
        AstcTry t = astc_measure(side, m, shown, root_weights);
        if (searching && t.error < least) {
            best = candidate;
            least = t.error;
            best_ends = e;
        }
        e = astc_refine(t, e, m, root_weights);
        candidate += round_in_mode == kAstcRefinements ? 1 : 0;
        round_in_mode = round_in_mode == kAstcRefinements ? 0 : round_in_mode + 1;
    }
    if (start.flat_error <= least) return astc_void_extent(start.mean);
    return astc_finish(m, e);
}
LOAM_END_STATE

LOAM_END_SHARED
#endif
