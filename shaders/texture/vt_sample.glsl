// Sampling the virtual texture: sector table, indirection texel, three fetches of the physical page.
//
// Slots (storage buffers and combined image samplers), counted from VT_FIRST_SLOT, which the includer may define (0):
// | slot | what | C++ |
// | --- | --- | --- |
// | +0 | VtParams, storage buffer | params() |
// | +1 | sector table, storage buffer | sector_table() |
// | +2 | indirection, usampler2D | indirection(), nearest_sampler() |
// | +3 … +6 | physical textures, sampler2D | atlas(0 … 3), sampler() |
// Specialisation constants 30, 31: the page's layout and channels (vt_fetch.glsl); 20: 1 samples both mips of the page and blends them (twice the fetches).
// Source: Call of Duty talk, "Indirection Texture Texel".
//
//     ivec2 sector; vec2 offset;
//     vt_split(rel.xy, sector, offset);                  // rel: camera-relative metres
//     VtSample s = vt_sample(sector, offset, g.z, g.w);  // log2 footprints in metres from the g-buffer
#ifndef LOAM_TEXTURE_VT_SAMPLE_GLSL
#define LOAM_TEXTURE_VT_SAMPLE_GLSL
#include "shaders/texture/vt_fetch.glsl"
#include "shaders/texture/vt_place.glsl"

layout(constant_id = 20) const bool kVtTrilinear = false;
layout(binding = VT_FIRST_SLOT + 2) uniform usampler2D vt_indirection;

struct VtSample {
    VtMaterial material;
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
    VtTexels texels = vt_fetch(uv, kVtTrilinear ? 0.0 : floor(lod + 0.5));
    if (kVtTrilinear) texels = vt_mix(texels, vt_fetch(uv, 1.0), lod);
    VtSample s;
    s.material = vt_decode(texels);
    s.word = word;
    s.id = place.id;
    s.wanted_mip = place.wanted;
    s.shown_mip = int(mip);
    s.page_uv = in_page;
    return s;
}
#endif
