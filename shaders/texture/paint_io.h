// Decals that lay a material on the ground (document/ground_decal.h): terrain decals, pieces of splines,
// volumes; for composition and for shading without the cache.
#ifndef LOAM_TEXTURE_PAINT_IO_H
#define LOAM_TEXTURE_PAINT_IO_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

#define kPaintTerrain 0u
#define kPaintSpline 1u
#define kPaintVolume 2u

// One decal, or one piece of a spline. Places are metres in a frame: of a page, whose south-west corner is the
// origin, or of the picture, whose camera is. Heights of a frame count from the decal's centre (page) or from
// the camera (picture).
struct PaintDecal {
    vec3 center_m;        // terrain decals: z is 0; splines: unused
    vec3 axis_x, axis_y;  // unit, in the world: the decal's own directions (a mirrored one turned over)
    vec3 axis_z;          // out of the ground; terrain decals: up
    vec3 half_m;
    vec2 phase;           // of the layer's texture at the frame's origin, repeats
    float tiles_per_m;    // repeats of the layer
    float lod_bias;       // log2 of its texels a metre
    int layer;            // slot of its textures; -1: a flat colour
    vec3 colour;          // linear; multiplies the layer's albedo
    float gloss, metalness;  // of a flat colour
    float opacity;
    float edge;           // share of the smaller half size over which it fades
    float deep_edge;      // volumes: share of z's half size over which it fades
    float rough;          // how far noise eats into the edge
    uint seed;
    uint ellipse;         // 1: of an ellipse's outline
    float albedo_share, normal_share, gloss_share, metal_share, occlusion_share;  // of the channels
    // Splines: which segments are near, which of them are this piece's to draw, and the ends.
    uint first_segment, segment_count;
    uint own_first, own_count;  // counted from first_segment
    float length_m, fade_m;
    uint function;        // counted from 1 in the shader's functions (document/decal_function.h); 0: none
    vec4 parameters_a, parameters_b;  // of the function, in its order
};

// A straight piece of a spline.
struct PaintSegment {
    vec2 from_m;          // in the frame
    vec2 direction;       // unit
    float length_m;
    float half_from_m, half_to_m;  // half widths
    float start_m;        // arc length from the spline's beginning
    float phase;          // of the layer's texture there, repeats
};

// One decal in one page rectangle: whole texels, so that what is covered does not depend on where the
// rectangle lies.
struct PaintInstance {
    ivec2 quad_min;       // scratch pixels
    ivec2 quad_size;
    ivec2 page_shift;     // page texel = scratch pixel - page_shift
    float texel_m;        // of the page
    // Volumes: the ground's heights over the decal's centre, on a grid of the world. A page texel's place in
    // it, in samples, is texel * grid_scale + grid_origin; sample (i, j) is at grid_first + (j - grid_min.y) *
    // grid_width + (i - grid_min.x) in the buffer.
    float grid_scale;
    vec2 grid_origin;
    ivec2 grid_min;
    uint grid_first;
    uint grid_width;
    float grid_spacing_m;
    PaintDecal decal;
};

LOAM_END_SHARED
#endif
