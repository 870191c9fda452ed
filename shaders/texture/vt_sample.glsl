// Sampling the virtual texture: sector table, indirection texel, three fetches of the physical page.
//
// Slots (storage buffers and combined image samplers), counted from VT_FIRST_SLOT, which the includer may define (0):
// | slot | what | C++ |
// | --- | --- | --- |
// | +0 | VtParams, storage buffer | params() |
// | +1 | sector table, storage buffer | sector_table() |
// | +2 | indirection, usampler2D | indirection(), nearest_sampler() |
// | +3 … +5 | physical textures, sampler2D | atlas(0 … 2), sampler() |
// Specialisation constant 20: 1 samples both mips of the page and blends them (twice the fetches).
// Source: Call of Duty talk, "Indirection Texture Texel".
//
//     ivec2 sector; vec2 offset;
//     vt_split(rel.xy, sector, offset);                  // rel: camera-relative metres
//     VtSample s = vt_sample(sector, offset, g.z, g.w);  // log2 footprints in metres from the g-buffer
#ifndef LOAM_TEXTURE_VT_SAMPLE_GLSL
#define LOAM_TEXTURE_VT_SAMPLE_GLSL
#include "shaders/texture/vt_place.glsl"

layout(constant_id = 20) const bool kVtTrilinear = false;
layout(binding = VT_FIRST_SLOT + 2) uniform usampler2D vt_indirection;
layout(binding = VT_FIRST_SLOT + 3) uniform sampler2D vt_atlas0;
layout(binding = VT_FIRST_SLOT + 4) uniform sampler2D vt_atlas1;
layout(binding = VT_FIRST_SLOT + 5) uniform sampler2D vt_atlas2;

struct VtSample {
    vec3 albedo;      // linear
    vec2 normal;      // x, y of the material in the frame of the ground; z is positive
    float gloss;
    float occlusion;
    float metalness;
    // For debug views; costs nothing where unused.
    uint word;        // indirection texel
    uint id;          // sector id
    float wanted_mip;
    int shown_mip;
    vec2 page_uv;     // 0…1 in the page shown
};

VtSample vt_sample(ivec2 sector_delta, vec2 offset_m, float log2_long, float log2_short) {
    VtPlace place = vt_place(sector_delta, offset_m, log2_long, log2_short);
    uint word = texelFetch(vt_indirection, place.origin + place.cell, 0).r;
    uint mip = min(word >> 16u & 0xffu, 31u);
    vec2 at = place.pages * uintBitsToFloat((127u - mip) << 23u); // / 2^mip
    vec2 in_page = at - floor(at);
    vec2 page = vec2(word & 0xffu, word >> 8u & 0xffu);
    vec2 uv = (page + in_page * (float(kPagePayload) / float(kPageTexels)) + float(kPageBorder) / float(kPageTexels)) *
              vt.inv_atlas_pages;
    float lod = clamp(place.wanted - float(mip), 0.0, 1.0);
    float first = kVtTrilinear ? 0.0 : floor(lod + 0.5);
    vec3 a = textureLod(vt_atlas0, uv, first).rgb;
    vec3 b = textureLod(vt_atlas1, uv, first).rgb;
    vec2 c = textureLod(vt_atlas2, uv, first).rg;
    if (kVtTrilinear) {
        a = mix(a, textureLod(vt_atlas0, uv, 1.0).rgb, lod);
        b = mix(b, textureLod(vt_atlas1, uv, 1.0).rgb, lod);
        c = mix(c, textureLod(vt_atlas2, uv, 1.0).rg, lod);
    }
    VtSample s;
    s.albedo = a * a;
    s.gloss = b.r;
    s.occlusion = b.b;
    s.metalness = c.r;
    s.normal = vec2(page_decode_normal(b.g), page_decode_normal(c.g));
    s.word = word;
    s.id = place.id;
    s.wanted_mip = place.wanted;
    s.shown_mip = int(mip);
    s.page_uv = in_page;
    return s;
}
#endif
