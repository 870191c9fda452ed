// Decals drawn over composed pages.
#ifndef LOAM_TEXTURE_DECAL_IO_H
#define LOAM_TEXTURE_DECAL_IO_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

// One decal in one page rectangle: whole texels, so that what is covered does not depend on where the rectangle lies.
struct DecalInstance {
    ivec2 quad_min;     // scratch pixels
    ivec2 quad_size;
    ivec2 page_shift;   // page texel = scratch pixel - page_shift
    vec2 center_texel;  // of the decal, in page texels (border included, texel i's centre is at i + 0.5)
    float texel_m;      // of the page
    float fade;         // 1, less where the decal is smaller than a texel of this level
    vec4 shape;         // crater: radius m, depth m, 0, 0; footprint: length m, depth m, sin heading, cos heading
    uint seed;
    uint foot;          // footprint: 0 left, 1 right
};

LOAM_END_SHARED
#endif
