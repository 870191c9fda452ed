#version 460
// The shadow map of patches with holes: light falls through them.
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shaders/geometry/geometry_io.h"
#define CUTOUT_FIRST_SLOT 3
#include "shaders/geometry/cutout.glsl"

layout(location = 0) in vec3 in_rel_m;

layout(push_constant, scalar) uniform Push {
    GeometryPush push;
};

void main() {
    if (is_cut(in_rel_m.xy, push.cutout)) discard;
}
