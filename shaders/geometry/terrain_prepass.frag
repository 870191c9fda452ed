#version 460
// The G-buffer of the terrain (shaders/frame/frame_io.h) and, in a target of its own, ambient occlusion.
//
//   binding 2  sampler2DArray   normal x, normal y, ambient occlusion; a layer a slot (linear)
//   colour 0   RGBA16F          normal x, y, log2 of the pixel footprint's long and short axis on the ground plane, metres
//   colour 1   R8               ambient occlusion, 1 open
#extension GL_GOOGLE_include_directive : require
#include "shaders/geometry/geometry_io.h"

layout(binding = 2) uniform sampler2DArray normals;

layout(location = 0) in vec3 in_rel_m;
layout(location = 1) in vec2 in_texel;
layout(location = 2) flat in uint in_slot;

layout(location = 0) out vec4 out_gbuffer;
layout(location = 1) out float out_occlusion;

// log2 within what a half holds well; the comparisons are such that NaN ends at a limit too.
float log2_limited(float metres) {
    const float low = exp2(-20.0), high = exp2(14.0);
    if (!(metres > low)) return -20.0;
    if (!(metres < high)) return 14.0;
    return log2(metres);
}

void main() {
    vec3 texel = vec3((in_texel + 0.5) / float(kPatchTexels), float(in_slot));
    vec3 normal_occlusion = textureLod(normals, texel, 0.0).xyz;

    // Singular values of the Jacobian [a b; c d] from pixels to metres.
    vec2 x = dFdx(in_rel_m.xy), y = dFdy(in_rel_m.xy);
    vec2 same = 0.5 * vec2(x.x + y.y, x.y - y.x);
    vec2 opposite = 0.5 * vec2(x.x - y.y, x.y + y.x);
    float q = length(same), r = length(opposite);
    out_gbuffer = vec4(normal_occlusion.xy, log2_limited(q + r), log2_limited(abs(q - r)));
    out_occlusion = normal_occlusion.z;
}
