#version 460
// One quad a decal, corners on whole texels.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/decal_io.h"
#include "shaders/texture/decal_quad.glsl"
layout(binding = 0, scalar) readonly buffer Decals { DecalInstance decals[]; };
layout(location = 0) flat out uint decal_index;

void main() {
    DecalInstance decal = decals[gl_InstanceIndex];
    gl_Position = decal_corner(gl_VertexIndex, decal.quad_min, decal.quad_size);
    decal_index = gl_InstanceIndex;
}
