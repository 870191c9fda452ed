#version 460
// Compresses a rectangle of scratch to BC1 blocks in a buffer, one thread a block.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/bc1.h"
#include "shaders/texture/compose_io.h"
layout(local_size_x = 8, local_size_y = 1) in;
layout(binding = 1, scalar) writeonly buffer Blocks { uvec2 blocks[]; };
#include "shaders/texture/encode_read.glsl"

void main() {
    ivec2 block = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(block, push.size))) return;
    vec3 texels[16];
    for (int i = 0; i < 16; ++i) texels[i] = read_texel(block * 4 + ivec2(i & 3, i >> 2));
    blocks[push.first + uint(block.y * push.size.x + block.x)] = bc1_encode(texels, push.weights.xyz);
}
