#version 460
// Debug view: the level of the height page that a pixel's geometry and normal come from, and the patches' edges.
//
//   binding 2  sampler2DArray   normal x, normal y, ambient occlusion; a layer a slot (linear)
#extension GL_GOOGLE_include_directive : require
#include "shaders/frame/debug_io.h"
#include "shaders/geometry/geometry_io.h"

layout(binding = 2) uniform sampler2DArray normals;

layout(location = 0) in vec3 in_rel_m;
layout(location = 1) in vec2 in_texel;
layout(location = 2) flat in uint in_slot;
layout(location = 3) flat in uint in_level;

layout(location = 0) out vec4 out_color;

void main() {
    vec3 n = textureLod(normals, vec3((in_texel + 0.5) / float(kPatchTexels), float(in_slot)), 0.0).xyz;
    // Lit from the north-west, as maps are.
    float light = clamp(0.55 + 0.6 * dot(n.xy, vec2(-0.7, 0.7)), 0.2, 1.0);
    vec2 inner = min(in_texel - float(kPatchBorder), float(kPatchBorder + kPatchQuads * kPatchQuadTexels) - in_texel);
    float edge = min(inner.x, inner.y) < 0.6 ? 0.6 : 1.0;
    out_color = vec4(debug_step_color(int(in_level)) * light * edge, 1.0);
}
