// What the functions of procedural decals may call. In their texts these names stand without "fn_"; document/decal_function.cpp
// has the list of them, docs/decal_functions.md says how they are used.
#ifndef LOAM_TEXTURE_FUNCTION_CALLS_GLSL
#define LOAM_TEXTURE_FUNCTION_CALLS_GLSL
#include "shaders/document/noise_math.h"

struct fn_Place {
    vec2 p;         // metres from the middle, along the decal's own directions; of a spline: across, and along from its beginning
    vec2 half_m;    // half the decal's size; of a spline: half its width here, and its whole length
    float edge;     // 1 inside, falling to 0 at the outline over the decal's soft edge
    float texel_m;  // what is smaller cannot be seen
    uint seed;
};

struct fn_Surface {
    vec3 colour;     // linear; at first the decal's colour, times the layer's where it has one
    float gloss, metalness, occlusion;
    vec2 slope;      // rise a metre along the decal's directions
    float cover;     // 1: all of it; where it is less the ground shows
};

// Places beyond this are not told apart.
vec2 fn_near(vec2 p) {
    return clamp(p, -1.0e6, 1.0e6);
}

// 0 … 1, of whole cells of 1.
float fn_random(vec2 cell, uint seed) {
    vec2 whole = floor(fn_near(cell));
    return noise_share(noise_cell(int(whole.x), int(whole.y), seed));
}

// -1 … 1, smooth over about 1.
float fn_noise(vec2 p, uint seed) {
    return noise_value(fn_near(p), seed);
}

// Octaves of noise, each half as large and half as strong, at most 8.
float fn_fbm(vec2 p, uint seed, int octaves) {
    float sum = 0.0, share = 0.5;
    for (int i = 0; i < 8; ++i) {
        if (i >= octaves) break;
        sum += share * fn_noise(p, seed + uint(i));
        p *= 2.0;
        share *= 0.5;
    }
    return sum;
}

// Points strewn one a cell of 1: distance to the nearest, to the border with the next one's area, and 0 … 1 of the nearest.
vec3 fn_cells(vec2 p, uint seed) {
    p = fn_near(p);
    vec2 whole = floor(p);
    float first = 1.0e3, second = 1.0e3, which = 0.0;
    for (int y = -1; y <= 1; ++y)
        for (int x = -1; x <= 1; ++x) {
            vec2 cell = whole + vec2(float(x), float(y));
            uint hash = noise_cell(int(cell.x), int(cell.y), seed);
            uint other = noise_hash(hash);
            vec2 away = cell + 0.1 + 0.8 * vec2(noise_share(hash), noise_share(other)) - p;
            float distance = length(away);
            second = min(second, max(first, distance));
            which = distance < first ? noise_share(noise_hash(other)) : which;
            first = min(first, distance);
        }
    return vec3(first, 0.5 * (second - first), which);
}

// smoothstep that may also fall: 0 at a, 1 at b.
float fn_ramp(float a, float b, float x) {
    return noise_ramp(a, b, x);
}

// Linear of a colour as colour pickers name it.
vec3 fn_srgb(float r, float g, float b) {
    vec3 c = clamp(vec3(r, g, b), 0.0, 1.0);
    return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

// How much of detail that size a texel can show: 0 below two texels, 1 from four on.
float fn_detail(float size_m, fn_Place at) {
    return clamp(size_m / at.texel_m * 0.5 - 1.0, 0.0, 1.0);
}

bool fn_is_number(float x) { // by its bits: compilers may take for granted that there is no NaN
    return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u;
}

bool fn_are_numbers(fn_Surface s) {
    return fn_is_number(s.colour.x) && fn_is_number(s.colour.y) && fn_is_number(s.colour.z) && fn_is_number(s.gloss) &&
           fn_is_number(s.metalness) && fn_is_number(s.occlusion) && fn_is_number(s.slope.x) && fn_is_number(s.slope.y) &&
           fn_is_number(s.cover);
}
#endif
