// Lays the scene's picture into the viewport: texel by texel where the sizes agree, else bilinear. Two pipelines,
// because a filtered sample costs several times a fetch on a software device.
#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shaders/ui/viewport_io.h"

layout(constant_id = 0) const uint kFiltered = 0u;

layout(set = 0, binding = 0) uniform sampler2D picture;
layout(scalar, push_constant) uniform Push { ViewportPush push; };

layout(location = 0) out vec4 out_color;

void main() {
    const vec2 pixel = gl_FragCoord.xy - vec2(push.origin_x, push.origin_y);
    if (kFiltered == 0u) {
        out_color = vec4(texelFetch(picture, ivec2(pixel), 0).rgb, 1.0);
        return;
    }
    // Half a texel away from the border of what was drawn: beyond it lies an older frame.
    const vec2 size = vec2(push.size_x, push.size_y);
    const vec2 texel = clamp(pixel * vec2(push.scale_x, push.scale_y), vec2(0.5), size - 0.5);
    out_color = vec4(textureLod(picture, texel / vec2(textureSize(picture, 0)), 0.0).rgb, 1.0);
}
