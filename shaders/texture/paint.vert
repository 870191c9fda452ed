#version 460
// One quad a decal or piece of a spline, corners on whole texels.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/decal_quad.glsl"
#include "shaders/texture/paint_io.h"
layout(binding = 0, scalar) readonly buffer Instances { PaintInstance instances[]; };
layout(location = 0) flat out uint instance_index;

void main() {
    gl_Position = decal_corner(gl_VertexIndex, instances[gl_InstanceIndex].quad_min, instances[gl_InstanceIndex].quad_size);
    instance_index = gl_InstanceIndex;
}
