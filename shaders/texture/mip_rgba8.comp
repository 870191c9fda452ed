#version 460
// Writes mip 1 of rectangles of scratch into uncompressed page textures, a thread a texel of all of them. Mip 0 is a copy.
// Specialisation constant 1: 1 where there is a fourth texture.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/compose_io.h"
layout(local_size_x = 64) in;
layout(constant_id = 1) const bool kHasFourth = false;
layout(binding = 4, rgba8) writeonly uniform image2D page_texture_0;
layout(binding = 5, rgba8) writeonly uniform image2D page_texture_1;
layout(binding = 6, rgba8) writeonly uniform image2D page_texture_2;
layout(binding = 7, rgba8) writeonly uniform image2D page_texture_3; // one of the others where there is none
#include "shaders/texture/encode_read.glsl"

void main() {
    const int kLog2Side = 2;
    if (gl_GlobalInvocationID.x >= push.tile_count << (2 * kLog2Side)) return;
    Unit unit = unit_of(gl_GlobalInvocationID.x, kLog2Side);
    ivec2 target = rects[unit.rect].target;
    if (target.x < 0) return;
    ivec2 at = (target >> 1) + unit.at;
    imageStore(page_texture_0, at, read_texel(unit, unit.at, 0));
    imageStore(page_texture_1, at, read_texel(unit, unit.at, 1));
    imageStore(page_texture_2, at, read_texel(unit, unit.at, 2));
    if (kHasFourth) imageStore(page_texture_3, at, read_texel(unit, unit.at, 3));
}
