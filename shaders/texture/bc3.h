// BC3 (DXT5): alpha as a BC4 block, then colour as a BC1 block, which BC3 always reads in the four-colour mode: bc1_encode writes
// no other (equal endpoints go with index 0, which is the first endpoint in both modes).
#ifndef LOAM_TEXTURE_BC3_H
#define LOAM_TEXTURE_BC3_H
#include "shaders/texture/bc1.h"
#include "shaders/texture/bc4.h"
LOAM_BEGIN_SHARED

// `weights` are the colour channels'; alpha is on its own.
LOAM_INLINE uvec4 bc3_encode(LOAM_ARRAY_IN(vec4, texels, 16), vec3 weights) {
    vec3 colours[16];
    float alphas[16];
    for (int i = 0; i < 16; ++i) {
        colours[i] = vec3(texels[i].x, texels[i].y, texels[i].z);
        alphas[i] = texels[i].w;
    }
    uvec2 alpha = bc4_encode(alphas), colour = bc1_encode(colours, weights);
    return uvec4(alpha.x, alpha.y, colour.x, colour.y);
}

LOAM_INLINE vec4 bc3_decode(uvec4 block, int i) {
    return vec4(bc1_decode(uvec2(block.z, block.w), i), bc4_decode(uvec2(block.x, block.y), i));
}

LOAM_END_SHARED
#endif
