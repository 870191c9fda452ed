#version 460
// One quad a decal, corners on whole texels.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/compose_io.h"
#include "shaders/texture/decal_io.h"
layout(binding = 0, scalar) readonly buffer Decals { DecalInstance decals[]; };
layout(location = 0) flat out uint decal_index;

void main() {
    const ivec2 corners[6] = ivec2[](ivec2(0, 0), ivec2(1, 0), ivec2(0, 1), ivec2(0, 1), ivec2(1, 0), ivec2(1, 1));
    DecalInstance decal = decals[gl_InstanceIndex];
    vec2 pixel = vec2(decal.quad_min + corners[gl_VertexIndex] * decal.quad_size);
    gl_Position = vec4(pixel * vec2(2.0 / kScratchWidth, 2.0 / kScratchHeight) - 1.0, 0.0, 1.0);
    decal_index = gl_InstanceIndex;
}
