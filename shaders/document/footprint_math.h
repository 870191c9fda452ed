// Prints: a boot's, and pieces of a tyre's track and of a furrow; the same in GLSL and C++.
//
// Inputs everywhere: `local`: position from the print's middle in units of its length, x to the right of and
// y along the heading (footprint_local turns an offset in the world); `foot`: 0 left, 1 right, kFootTyre, kFootFurrow. Heights
// are 0 for |local| >= kFootprintReach.
//
// Pieces of a track lie half a length apart: their heights fade along it so that neighbours add up to an even track,
// their marks end where the next piece's begin.
#ifndef LOAM_FOOTPRINT_MATH_H
#define LOAM_FOOTPRINT_MATH_H
#include "shaders/document/noise_math.h"
LOAM_BEGIN_SHARED

#define kFootprintReach 0.72f  // of marks and of the dent, in lengths
#define kFootprintRim 0.16f    // width of the raised rim outside the sole, in lengths
// The box of the sole and its rim, half sides in lengths: what lies outside is left as it is.
#define kFootprintHalfWidth 0.345f
#define kFootprintHalfLength 0.655f

#define kFootTyre 2
#define kFootFurrow 3
#define kTrackHalfWidth 0.185f  // in lengths
#define kTrackHalfPiece 0.25f   // of a mark, along

// `offset`: from the print's middle, east and north, in units of its length; `heading`: (sin, cos) of the
// heading clockwise from north, which is the direction of the toes.
LOAM_INLINE vec2 footprint_local(vec2 offset, vec2 heading) {
    return vec2(offset.x * heading.y - offset.y * heading.x, offset.x * heading.x + offset.y * heading.y);
}

// Maximum with a rounded corner of size k.
LOAM_INLINE float footprint_join(float a, float b, float k) {
    float h = k - abs(a - b);
    h = h > 0.0f ? h : 0.0f;
    return (a > b ? a : b) + h * h / (4.0f * k);
}

LOAM_INLINE float footprint_disc(vec2 p, float x, float y, float radius) {
    float dx = p.x - x;
    float dy = p.y - y;
    return radius - sqrt(dx * dx + dy * dy);
}

// Signed coverage of the sole: about the distance to its outline in lengths, positive inside (up to about
// 0.17).
LOAM_INLINE float footprint_sole(vec2 local, int foot) {
    if (foot >= kFootTyre) return kTrackHalfWidth - (local.x < 0.0f ? -local.x : local.x);
    vec2 p = vec2(foot == 0 ? -local.x : local.x, local.y);  // a right foot: the inner side is at negative x
    float heel = footprint_disc(p, 0.005f, -0.365f, 0.115f);
    float ball = footprint_disc(p, 0.0f, 0.16f, 0.165f);
    float toes = footprint_disc(p, -0.025f, 0.33f, 0.135f);
    // The waist: a capsule between heel and ball.
    float along = p.y < -0.36f ? -0.36f : (p.y > 0.14f ? 0.14f : p.y);
    float waist = footprint_disc(p, 0.025f, along, 0.095f);
    return footprint_join(footprint_join(heel, waist, 0.05f), footprint_join(ball, toes, 0.06f), 0.05f);
}

// Tread: 0 in the grooves, 1 under the lugs; 0 outside the sole and in the gap before the heel. `sole`:
// footprint_sole there. A tyre's lugs have eight a length, so that pieces continue each other; a furrow has none.
LOAM_INLINE float footprint_tread(vec2 local, int foot, float sole) {
    if (foot == kFootFurrow) return 1.0f;
    float inside = noise_ramp(0.012f, 0.03f, sole);
    float side = local.x < 0.0f ? -local.x : local.x;
    if (foot == kFootTyre) {
        float lug = fract((local.y + 0.4f * side) * 8.0f);
        lug = lug < 0.5f ? 2.0f * lug : 2.0f - 2.0f * lug;
        return inside * noise_ramp(0.25f, 0.5f, lug);
    }
    // Chevrons across the sole, straight bars on the heel; triangle waves of 13 and 16 a length.
    float heel = 1.0f - noise_ramp(-0.23f, -0.21f, local.y);
    float front = noise_ramp(-0.15f, -0.13f, local.y);
    float chevron = fract((local.y + 0.7f * side) * 13.0f + 0.25f);
    float bar = fract(local.y * 16.0f);
    chevron = chevron < 0.5f ? 2.0f * chevron : 2.0f - 2.0f * chevron;
    bar = bar < 0.5f ? 2.0f * bar : 2.0f - 2.0f * bar;
    return inside * (front * noise_ramp(0.3f, 0.55f, chevron) + heel * noise_ramp(0.3f, 0.55f, bar));
}

// Height by the sole, the tread and the unevenness (-1 … 1) of a place. The rim is a bump over -kFootprintRim
// … 0 of the signed coverage, uneven like pushed earth.
LOAM_INLINE float footprint_profile(int foot, float sole, float tread, float unevenness) {
    float dent = noise_ramp(0.0f, 0.06f, sole);
    float u = -sole / kFootprintRim;
    u = u < 0.0f ? 0.0f : (u > 1.0f ? 1.0f : u);
    float bump = 16.0f * u * u * (1.0f - u) * (1.0f - u);
    // Earth ploughed aside.
    if (foot == kFootFurrow)
        return bump * (0.4f + 0.2f * unevenness) - noise_ramp(0.0f, kTrackHalfWidth, sole) * (1.0f + 0.12f * unevenness);
    return bump * (0.14f + 0.06f * unevenness) - dent * (1.0f - 0.2f * (1.0f - tread));
}

// Height change in units of the print's depth: -1 under the sole, up to +0.2 on the rim, 0 from kFootprintRim
// outside it on.
LOAM_INLINE float footprint_height(vec2 local, int foot, uint seed) {
    float r2 = local.x * local.x + local.y * local.y;
    if (r2 >= kFootprintReach * kFootprintReach) return 0.0f;
    float sole = footprint_sole(local, foot);
    float uneven = noise_value(local * 9.0f, noise_hash(seed + 41u));
    float height = footprint_profile(foot, sole, footprint_tread(local, foot, sole), uneven);
    if (foot < kFootTyre) return height;
    return height * (1.0f - noise_ramp(0.0f, 0.5f, local.y < 0.0f ? -local.y : local.y));
}

// What a texel shows of a print: from four places around its middle, one evaluation of the sole each. Of
// three places the slopes would be twice as far from the texel's mean.
struct FootprintMark {
    vec2 slope;     // of footprint_height, depths a length, along local x and y
    float pressed;  // how much the ground is pressed and darkened, 0 … 1
    float around;   // 1 in the sole, 0 from the rim's outer edge on
};

// `reach`: of the places from the middle, in lengths. Everything is 0 outside the box of the sole and its
// rim.
LOAM_INLINE FootprintMark footprint_mark(vec2 local, int foot, uint seed, float reach) {
    FootprintMark mark;
    mark.slope = vec2(0.0f, 0.0f);
    mark.pressed = 0.0f;
    mark.around = 0.0f;
    float side = local.x < 0.0f ? -local.x : local.x;
    float along = local.y < 0.0f ? -local.y : local.y;
    if (side > kFootprintHalfWidth || along > kFootprintHalfLength) return mark;
    vec3 noise = noise_value_slope(local * 9.0f, noise_hash(seed + 41u));
    for (int i = 0; i < 4; ++i) {
        float sign = i < 2 ? 1.0f : -1.0f;
        vec2 to = (i & 1) == 0 ? vec2(sign, 0.0f) : vec2(0.0f, sign);
        vec2 place = vec2(local.x + reach * to.x, local.y + reach * to.y);
        float sole = footprint_sole(place, foot);
        float tread = footprint_tread(place, foot, sole);
        float uneven = noise.x + 9.0f * reach * (noise.y * to.x + noise.z * to.y);
        uneven = uneven < -1.0f ? -1.0f : (uneven > 1.0f ? 1.0f : uneven);
        float height = footprint_profile(foot, sole, tread, uneven);
        mark.slope.x += height * to.x;
        mark.slope.y += height * to.y;
        float beside = place.y < 0.0f ? -place.y : place.y;
        if (foot >= kFootTyre && beside > kTrackHalfPiece) continue;
        mark.pressed += noise_ramp(-0.01f, 0.02f, sole) * (0.55f + 0.45f * tread);
        mark.around += noise_ramp(-kFootprintRim, 0.0f, sole);
    }
    mark.slope.x /= 2.0f * reach;
    mark.slope.y /= 2.0f * reach;
    mark.pressed *= 0.25f;
    mark.around *= 0.25f;
    return mark;
}

LOAM_END_SHARED
#endif
