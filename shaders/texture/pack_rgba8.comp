#version 460
// Writes a rectangle of scratch as RGBA8 texels to a buffer: the uncompressed page format.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/compose_io.h"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 1, scalar) writeonly buffer Texels { uint texels[]; };
#include "shaders/texture/encode_read.glsl"

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, push.size))) return;
    texels[push.first + uint(at.y * push.size.x + at.x)] = packUnorm4x8(vec4(read_texel(at), 1.0));
}
