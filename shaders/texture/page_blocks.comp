#version 460
// Compresses rectangles of scratch to the blocks of a page format (BC1, or BC3 where channels come in pairs of textures), in a
// buffer, one thread a block.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/bc3.h"
#include "shaders/texture/compose_io.h"
layout(local_size_x = 8) in;
layout(binding = 1, scalar) writeonly buffer Blocks { uvec2 blocks[]; }; // a BC3 block is two: alpha, colour
const uint kMip0Units = 1u;
#include "shaders/texture/encode_read.glsl"

void main() {
    const int kLog2Side = 1 - kMip; // a tile of 8 texels is 2 x 2 blocks, or one of mip 1
    if (gl_GlobalInvocationID.x >= push.tile_count << (2 * kLog2Side)) return;
    int which = int(gl_WorkGroupID.y);
    Unit unit = unit_of(gl_GlobalInvocationID.x, kLog2Side, which, 2);
    if (!unit.exists) return;
    vec3 weights = push.weights[which].xyz;
    if (kPageLayout == kPagePairs) {
        vec4 texels[16];
        for (int i = 0; i < 16; ++i) texels[i] = read_texel(unit, unit.at * 4 + ivec2(i & 3, i >> 2), which);
        uvec4 block = bc3_encode(texels, weights);
        blocks[unit.output_index * 2u] = block.xy;
        blocks[unit.output_index * 2u + 1u] = block.zw;
    } else {
        vec3 texels[16];
        for (int i = 0; i < 16; ++i) texels[i] = read_texel(unit, unit.at * 4 + ivec2(i & 3, i >> 2), which).rgb;
        blocks[unit.output_index] = bc1_encode(texels, weights);
    }
}
