#version 460
// Compresses rectangles of scratch to the blocks of a page format (BC1, or BC3 where channels come in pairs of textures), in a
// buffer, one thread a block, a texture a workgroup's y.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/bc3.h"
#include "shaders/texture/compose_io.h"
layout(local_size_x = 8) in;
layout(binding = 1, scalar) writeonly buffer Blocks { uvec2 blocks[]; }; // a BC3 block is two: alpha, colour
#include "shaders/texture/encode_read.glsl"

void main() {
    const int kLog2Side = 1 - kMip; // a tile of 8 texels is 2 x 2 blocks, or one of mip 1
    if (gl_GlobalInvocationID.x >= push.tile_count << (2 * kLog2Side)) return;
    int which = int(gl_WorkGroupID.y);
    Unit unit = unit_of(gl_GlobalInvocationID.x, kLog2Side);
    ComposeRect rect = rects[unit.rect];
    if (rect.target.x < 0) return;
    ivec2 size = rect.rect_size >> 2;
    uint before = kMip == 0 ? 0u : uint(size.x * size.y);
    uint block = rect.first_block + uint(which) * rect.blocks + before + uint(unit.at.y * (size.x >> kMip) + unit.at.x);
    vec3 weights = push.weights[which].xyz;
    if (kPageLayout == kPagePairs) {
        vec4 texels[16];
        for (int i = 0; i < 16; ++i) texels[i] = read_texel(unit, unit.at * 4 + ivec2(i & 3, i >> 2), which);
        uvec4 encoded = bc3_encode(texels, weights);
        blocks[block * 2u] = encoded.xy;
        blocks[block * 2u + 1u] = encoded.zw;
    } else {
        vec3 texels[16];
        for (int i = 0; i < 16; ++i) texels[i] = read_texel(unit, unit.at * 4 + ivec2(i & 3, i >> 2), which).rgb;
        blocks[block] = bc1_encode(texels, weights);
    }
}
