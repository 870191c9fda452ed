#version 460
// Compresses an image to blocks in a buffer, row by row, one thread a block; a pipeline a format.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : require
#include "shaders/texture/astc.h"
#include "shaders/texture/bc1_fine.h"
#include "shaders/texture/bc3.h"
#include "shaders/texture/encode_io.h"
layout(local_size_x = 8) in;
layout(constant_id = 0) const int kFormat = kEncodeBc1;
layout(binding = 0) uniform sampler2D image;
layout(binding = 1, scalar) writeonly buffer Words { uint words[]; };
layout(push_constant, scalar) uniform Push { EncodeImagePush push; };

vec4 read_texel(ivec2 at) {
    return texelFetch(image, min(at, push.size - 1), 0);
}

void write_block(uint block, uvec2 bits) {
    words[block * 2u] = bits.x;
    words[block * 2u + 1u] = bits.y;
}

void write_block(uint block, uvec4 bits) {
    for (uint i = 0u; i < 4u; ++i) words[block * 4u + i] = bits[i];
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (at.x >= push.blocks.x) return;
    uint block = uint(at.y * push.blocks.x + at.x);
    if (kFormat == kEncodeAstc4x4 || kFormat == kEncodeAstc6x6) {
        const int kSide = kFormat == kEncodeAstc4x4 ? 4 : 6;
        LOAM_ROLLED for (int i = 0; i < kSide * kSide; ++i) astc_texels[i] = read_texel(at * kSide + ivec2(i % kSide, i / kSide));
        write_block(block, astc_encode(kSide, push.weights));
        return;
    }
    vec4 texels[16];
    vec3 colours[16];
    float reds[16];
    for (int i = 0; i < 16; ++i) {
        texels[i] = read_texel(at * 4 + ivec2(i & 3, i >> 2));
        colours[i] = texels[i].rgb;
        reds[i] = texels[i].r;
    }
    if (kFormat == kEncodeBc1) write_block(block, bc1_encode(colours, push.weights));
    if (kFormat == kEncodeBc1Fine) write_block(block, bc1_encode_fine(colours, push.weights));
    if (kFormat == kEncodeBc3) write_block(block, bc3_encode(texels, push.weights));
    if (kFormat == kEncodeBc4) write_block(block, bc4_encode(reds));
}
