// The G-buffer of the terrain (shaders/frame/frame_io.h) and, in a target of its own, ambient occlusion and the footprint's direction.
//
//   binding 2  sampler2DArray   normal x, normal y, ambient occlusion; a layer a slot (linear)
//   colour 0   RGBA16F          normal x, y, log2 of the pixel footprint's long and short axis on the ground plane, metres
//   colour 1   RG8              ambient occlusion, 1 open; direction of the long axis (encode_axis)
#include "shaders/geometry/geometry_io.h"
#include "shaders/geometry/pixel_ellipse_math.h"

layout(binding = 2) uniform sampler2DArray normals;

layout(location = 0) in vec3 in_rel_m;
layout(location = 1) in vec2 in_texel;
layout(location = 2) flat in uint in_slot;

layout(location = 0) out vec4 out_gbuffer;
layout(location = 1) out vec2 out_occlusion;

void write_gbuffer() {
    vec3 texel = vec3((in_texel + 0.5) / float(kPatchTexels), float(in_slot));
    vec3 normal_occlusion = textureLod(normals, texel, 0.0).xyz;

    PixelEllipse e = pixel_ellipse(dFdx(in_rel_m.xy), dFdy(in_rel_m.xy));
    out_gbuffer = vec4(normal_occlusion.xy, e.log2_long, e.log2_short);
    out_occlusion = vec2(normal_occlusion.z, encode_axis(e.axis_twice));
}
