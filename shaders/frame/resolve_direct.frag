// The reference's resolve: the same material functions per pixel, without page cache and compression.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define DIRECT_FIRST_SLOT 5
#include "shaders/frame/resolve_common.glsl"
#include "shaders/texture/direct.glsl"
#include "shaders/texture/direct_decals.glsl"
#include "shaders/texture/direct_texels.glsl"

layout(constant_id = 25) const bool kDirectTexels = false;

float direct_log2_footprint, direct_log2_short;
Pixel direct_pixel;
float direct_depth(vec2 rel_m) {
    MaterialSample m = with_decals(direct_material(rel_m, direct_log2_footprint, direct_log2_short),
                                   vec3(rel_m, direct_pixel.rel_m.z), direct_pixel.ground, direct_log2_footprint);
    return channel_at(m.channels, kChannelDepth);
}
#define PARALLAX_DEPTH(rel_m) direct_depth(rel_m)
#include "shaders/frame/parallax.glsl"

void main() {
    Pixel p = read_pixel();
    float log2_footprint = mix(p.log2_long, p.log2_short, 0.5) + push.footprint_bias;
    direct_log2_footprint = log2_footprint;
    direct_log2_short = p.log2_short;
    direct_pixel = p;
    vec3 at_rel_m = vec3(parallax_place(p), p.rel_m.z);
    MaterialSample m;
    if (kDirectTexels)
        m = direct_texels(at_rel_m, p.ground, log2_footprint);
    else
        m = with_decals(direct_material(at_rel_m.xy, log2_footprint, p.log2_short), at_rel_m, p.ground, log2_footprint);
    Surface s = Surface(m.albedo, bent_normal(p.ground, m.normal), m.gloss, m.occlusion, m.metalness);
    vec2 at_m = direct.camera_offset_m + p.rel_m.xy, sector = floor(at_m * (1.0 / 64.0));
    out_color = vec4(lit_pixel(p, s, m.channels, direct.camera_sector + ivec2(sector), at_m - sector * 64.0), 1.0);
}
