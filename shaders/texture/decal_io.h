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
    float fade;         // its strength, less where the decal is smaller than a texel of this level
    vec4 shape;         // crater: radius m, depth m, heat, age; footprint: length m, depth m, sin heading, cos heading
    uint seed;
    uint foot;          // footprint: 0 left, 1 right, 2 tyre, 3 furrow
};

// One decal in view, for shading without the cache (direct_decals.glsl).
struct DirectDecal {
    vec2 center_rel_m;  // camera-relative
    float reach_m;      // nothing farther than this from the centre changes
    float size_m;       // what fades when smaller than a texel: see decal_fade
    float strength;     // of the whole mark
    vec4 shape;         // as DecalInstance's
    uint seed;
    uint foot;
    uint kind;          // kDecalCrater …
    uint paint;         // kDecalPaint and on: which PaintDecal (paint_io.h); nothing else of this struct but place and reach counts
};

#define kDecalCrater 0u
#define kDecalFootprint 1u
#define kDecalPaint 2u  // and kPaintTerrain, kPaintSpline or kPaintVolume

// Below half a texel a decal is gone, from one texel on it is whole: a function of the texel's size alone, so that
// neighbouring pages of a level agree.
LOAM_INLINE float decal_fade(float size_m, float texel_m) { return clamp(size_m / texel_m * 2.0f - 1.0f, 0.0f, 1.0f); }

LOAM_END_SHARED
#endif
