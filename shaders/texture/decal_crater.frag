#version 460
// A crater over composed texels. The place comes from gl_FragCoord, whole texels shifted by whole texels, so that
// a rectangle of a page gets the bits of the whole page.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/decal_shade.glsl"
layout(binding = 0, scalar) readonly buffer Decals { DecalInstance decals[]; };
layout(location = 0) flat in uint decal_index;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 surface;
layout(location = 2) out vec4 metal;
layout(location = 3) out vec4 channels; // where scratch has the layer

void main() {
    DecalInstance decal = decals[decal_index];
    vec2 texel = vec2(ivec2(gl_FragCoord.xy) - decal.page_shift) + 0.5;
    precise vec2 offset_m = (texel - decal.center_texel) * decal.texel_m;
    DecalShade shade = crater_shade(decal, offset_m);
    albedo = shade.albedo;
    surface = shade.surface;
    metal = vec4(shade.metal.rg, shade.channels.x, shade.metal.a);
    channels = vec4(shade.channels.yzw, shade.metal.a);
}
