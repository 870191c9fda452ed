// Parallax by what pages hold: one fetch a step, of the texture that has the channel.
#ifndef LOAM_FRAME_VT_PARALLAX_GLSL
#define LOAM_FRAME_VT_PARALLAX_GLSL
#include "shaders/texture/vt_sample.glsl"

float vt_log2_long, vt_log2_short; // the pixel's footprint
float vt_depth(vec2 rel_m) {
    ivec2 sector;
    vec2 offset_m;
    vt_split(rel_m, sector, offset_m);
    VtPlace place = vt_place(sector, offset_m, vt_log2_long, vt_log2_short);
    VtFound f = vt_find(place);
    float lod = floor(clamp(place.wanted - float(f.mip), 0.0, 1.0) + 0.5);
    uint channel = page_channel_place(kPageChannels, kChannelDepth);
    if (channel == 1u) return textureLod(vt_atlas2, vt_page_uv(f), lod).b;
    return textureLod(vt_atlas3, vt_page_uv(f), lod)[channel - 2u];
}
#define PARALLAX_DEPTH(rel_m) vt_depth(rel_m)
#include "shaders/frame/parallax.glsl"

vec2 vt_parallax_place(Pixel p) {
    vt_log2_long = p.log2_long;
    vt_log2_short = p.log2_short;
    return parallax_place(p);
}
#endif
