// What a resolve cannot be cheaper than: three bilinear samples at coherent places and the same light. `loam bench resolve` draws
// it beside the real one; no picture is made with it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/frame/resolve_common.glsl"
#include "shaders/texture/texture_io.h"

layout(binding = 5) uniform sampler2D page0;
layout(binding = 6) uniform sampler2D page1;
layout(binding = 7) uniform sampler2D page2;

void main() {
    Pixel p = read_pixel();
    vec2 uv = gl_FragCoord.xy / vec2(textureSize(page0, 0)); // a texel a pixel, as a page's
    vec3 a = textureLod(page0, uv, 0.0).rgb;
    vec3 b = textureLod(page1, uv, 0.0).rgb;
    vec2 c = textureLod(page2, uv, 0.0).rg;
    vec2 normal = vec2(page_decode_normal(b.g), page_decode_normal(c.g));
    Surface s = Surface(a * a, bent_normal(p.ground, normal), b.r, b.b, c.r);
    out_color = vec4(lit_pixel(p, s), 1.0);
}
