#version 460
// The prepass of patches with holes. A fragment is thrown away, not a vertex made NaN: no interface promises what becomes of those, and
// the outline then follows the patch's level of detail.
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shaders/geometry/gbuffer.glsl"
#define CUTOUT_FIRST_SLOT 3
#include "shaders/geometry/cutout.glsl"

layout(push_constant, scalar) uniform Push {
    GeometryPush push;
};

void main() {
    write_gbuffer(); // first: it looks at its neighbours
    if (is_cut(in_rel_m.xy, push.cutout)) discard;
}
