// Clip position of a corner of a quad of whole scratch texels.
#ifndef LOAM_TEXTURE_DECAL_QUAD_GLSL
#define LOAM_TEXTURE_DECAL_QUAD_GLSL
#include "shaders/texture/compose_io.h"

vec4 decal_corner(int vertex, ivec2 quad_min, ivec2 quad_size) {
    const ivec2 corners[6] = ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 1));
    vec2 pixel = vec2(quad_min + corners[vertex] * quad_size);
    return vec4(pixel * vec2(2.0 / kScratchWidth, 2.0 / kScratchHeight) - 1.0, 0.0, 1.0);
}
#endif
