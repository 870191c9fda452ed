// Imagery at a place of an index page. The includer declares MATERIAL_IMAGERY, IndexMap::imagery().
#ifndef LOAM_TEXTURE_IMAGERY_GLSL
#define LOAM_TEXTURE_IMAGERY_GLSL
#include "shaders/texture/imagery.h"

// index_at: texels of the index page, its border included. Linear colours times cover, and cover.
vec4 imagery_at(vec2 index_at, int slot) {
    precise vec2 at = index_at * float(kImageryDensity) - 0.5;
    vec2 corner = clamp(floor(at), vec2(0.0), vec2(kImageryPageTexels - 2));
    precise vec2 f = clamp(at - corner, vec2(0.0), vec2(1.0));
    ivec3 base = ivec3(ivec2(corner), slot);
    vec4 t0 = texelFetch(MATERIAL_IMAGERY, base, 0), t1 = texelFetch(MATERIAL_IMAGERY, base + ivec3(1, 0, 0), 0);
    vec4 t2 = texelFetch(MATERIAL_IMAGERY, base + ivec3(0, 1, 0), 0), t3 = texelFetch(MATERIAL_IMAGERY, base + ivec3(1, 1, 0), 0);
    precise vec4 weights = vec4((1.0 - f.x) * (1.0 - f.y), f.x * (1.0 - f.y), (1.0 - f.x) * f.y, f.x * f.y);
    precise vec4 cover = weights * vec4(t0.a, t1.a, t2.a, t3.a);
    precise vec3 colour = t0.rgb * cover.x + t1.rgb * cover.y + t2.rgb * cover.z + t3.rgb * cover.w;
    precise float sum = cover.x + cover.y + cover.z + cover.w;
    return vec4(colour, sum);
}
#endif
