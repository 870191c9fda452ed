#version 460
// Writes mip 1 of rectangles of scratch as RGBA8 texels to a buffer: the uncompressed page format. Mip 0 is a copy.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/compose_io.h"
layout(local_size_x = 64) in;
layout(binding = 1, scalar) writeonly buffer Texels { uint texels[]; };
const uint kMip0Units = 0u;
#include "shaders/texture/encode_read.glsl"

void main() {
    const int kLog2Side = 2;
    if (gl_GlobalInvocationID.x >= push.tile_count << (2 * kLog2Side)) return;
    int which = int(gl_WorkGroupID.y);
    Unit unit = unit_of(gl_GlobalInvocationID.x, kLog2Side, which, 0);
    if (!unit.exists) return;
    texels[unit.output_index] = packUnorm4x8(read_texel(unit, unit.at, which));
}
