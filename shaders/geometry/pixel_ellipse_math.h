// What a pixel covers of the ground plane: an ellipse in the terrain's x and y, as the virtual texture is projected from above.
// Its axes are the singular values of the Jacobian from pixels to metres; the direction of the long one is kept in eight bits.
#ifndef LOAM_PIXEL_ELLIPSE_MATH_H
#define LOAM_PIXEL_ELLIPSE_MATH_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

// What log2 of an axis in metres is limited to: within this a half keeps it to 1 %.
#define kLeastAxisLog2 -20.0f
#define kMostAxisLog2 14.0f
// In both axes where there is no ground.
#define kNoGroundLog2 -32.0f

struct PixelEllipse {
    float log2_long, log2_short; // metres
    vec2 axis_twice;             // direction of the long axis, its angle doubled; not of unit length
};

// No length ends at the least, infinity and what is not a number at the most: such a pixel wants the coarsest page, as it must not
// ask for the finest of a place that nobody knows.
LOAM_INLINE float axis_log2(float metres) {
    if (!(metres < 16384.0f)) return kMostAxisLog2;
    if (!(metres > 9.5367431640625e-7f)) return kLeastAxisLog2;
    return log2(metres);
}

// x, y: metres a pixel to the right and down. The Jacobian is a turn and scale by the complex number `same` plus one by `opposite` of
// the mirrored plane: its singular values are the sum and difference of their lengths, and the angle of the long axis is half the
// sum of theirs, so that their product points along it with the angle doubled.
LOAM_INLINE PixelEllipse pixel_ellipse(vec2 x, vec2 y) {
    vec2 same = vec2(x.x + y.y, x.y - y.x) * 0.5f;
    vec2 opposite = vec2(x.x - y.y, x.y + y.x) * 0.5f;
    float q = length(same), r = length(opposite);
    PixelEllipse e;
    e.log2_long = axis_log2(q + r);
    e.log2_short = axis_log2(abs(q - r));
    e.log2_short = e.log2_short < e.log2_long ? e.log2_short : e.log2_long;
    e.axis_twice = vec2(same.x * opposite.x - same.y * opposite.y, same.x * opposite.y + same.y * opposite.x);
    return e;
}

// A direction as a place on the unit diamond, in 256 steps a turn, as a UNORM channel holds them (0 … 1 is 0 … 255). At most 0.9
// degrees of the doubled angle are lost: half of it of the axis, 0.07 of the short one at a ratio of eight.
LOAM_INLINE float encode_axis(vec2 axis_twice) {
    float sum = abs(axis_twice.x) + abs(axis_twice.y);
    if (!(sum > 1e-30f) || !(sum < 1e30f)) return 0.0f;
    float side = 1.0f - axis_twice.x / sum; // 0 … 2 over the upper half
    float turn = axis_twice.y < 0.0f ? 4.0f - side : side;
    float step = floor(turn * 64.0f + 0.5f);
    return (step > 255.5f ? 0.0f : step) * (1.0f / 255.0f);
}

// The unit direction of the long axis; its sign means nothing.
LOAM_INLINE vec2 decode_axis(float encoded) {
    float turn = encoded * (255.0f / 64.0f);
    float side = turn > 2.0f ? 4.0f - turn : turn;
    float x = 1.0f - side;
    float y = 1.0f - abs(x);
    float cosine = x / sqrt(x * x + y * y);
    float c = sqrt(max(0.5f + 0.5f * cosine, 0.0f)), s = sqrt(max(0.5f - 0.5f * cosine, 0.0f));
    return vec2(c, turn > 2.0f ? -s : s);
}

LOAM_END_SHARED
#endif
