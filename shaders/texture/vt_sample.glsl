// Sampling the virtual texture: sector table, indirection texel, three fetches of the physical page.
//
// Slots (storage buffers and combined image samplers), counted from VT_FIRST_SLOT, which the includer may define (0):
// | slot | what | C++ |
// | --- | --- | --- |
// | +0 | VtParams, storage buffer | params() |
// | +1 | sector table, storage buffer | sector_table() |
// | +2 | indirection, usampler2D | indirection(), nearest_sampler() |
// | +3 … +6 | physical textures, sampler2D | atlas(0 … 3), sampler() |
// Specialisation constants 30, 31: the page's layout and channels (vt_fetch.glsl);
// 20: 1 samples both mips of the page and blends them (twice the fetches); 26: taps along the footprint's long axis, 27: look-ups
// of a page that these are shared among, 28: the probes are the sampler's own anisotropy.
// Source: Call of Duty talk, "Indirection Texture Texel".
//
//     ivec2 sector; vec2 offset;
//     vt_split(rel.xy, sector, offset);                  // rel: camera-relative metres
//     VtSample s = vt_sample(sector, offset, g.z, g.w, axis);  // log2 footprints in metres from the g-buffer; see pixel_ellipse_math.h
#ifndef LOAM_TEXTURE_VT_SAMPLE_GLSL
#define LOAM_TEXTURE_VT_SAMPLE_GLSL
#include "shaders/texture/vt_fetch.glsl"
#include "shaders/texture/vt_place.glsl"

layout(constant_id = 20) const bool kVtTrilinear = false;
layout(constant_id = 26) const int kVtTaps = 1;
layout(constant_id = 27) const int kVtProbes = 1;
layout(constant_id = 28) const bool kVtHardware = false;
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

// A page looked up: where the place is in it.
struct VtFound {
    uint word;    // indirection texel
    uint mip;     // of the page
    vec2 in_page; // 0…1
};

VtFound vt_find(VtPlace place) {
    VtFound f;
    f.word = texelFetch(vt_indirection, vt_indirection_texel(place), 0).r;
    f.mip = min(f.word >> 16u & 0xffu, 31u);
    // Limited, as a probe may lie beside the map: there its edge goes on.
    f.in_page = clamp(place.pages * uintBitsToFloat((127u - f.mip) << 23u) - vec2(place.cell >> f.mip), 0.0, 1.0);
    return f;
}

// In the physical textures.
vec2 vt_page_uv(VtFound f) {
    vec2 page = vec2(f.word & 0xffu, f.word >> 8u & 0xffu);
    return (page + f.in_page * (float(kPagePayload) / float(kPageTexels)) + float(kPageBorder) / float(kPageTexels)) *
           vt.inv_atlas_pages;
}

// The taps of one page, spaced along the axis (filter_math.h says why they stay within its border); with more than one, squares.
VtTexels vt_probe(VtPlace place, VtFound f, vec2 axis, float spacing_m) {
    vec2 uv = vt_page_uv(f);
    float lod = clamp(place.wanted - float(f.mip), 0.0, 1.0);
    float in_texels = exp2(-place.log2_finest - float(f.mip)); // of the page's first mip, a metre
    float texel_uv = vt.inv_atlas_pages * (1.0 / float(kPageTexels));
    if (kVtHardware) {
        // A probe's part of the long axis, and across it the texel wanted: in the page at most two of its texels.
        float along = min(spacing_m * in_texels, kTapReach) * float(kVtTaps / kVtProbes);
        float across = min(exp2(place.log2_texel) * in_texels, kTapReach);
        return vt_square(
            vt_fetch_grad(uv, axis * (max(along, across) * texel_uv), vec2(-axis.y, axis.x) * (across * texel_uv)));
    }
    const int taps = kVtTaps / kVtProbes;
    vec2 step_uv = axis * (min(spacing_m * in_texels, kTapReach) * texel_uv);
    VtTexels sum;
    for (int i = 0; i < taps; ++i) {
        vec2 at = taps > 1 ? uv + step_uv * (float(i) - 0.5 * float(taps - 1)) : uv;
        VtTexels tap = vt_fetch(at, kVtTrilinear ? 0.0 : floor(lod + 0.5));
        if (kVtTrilinear) tap = vt_mix(tap, vt_fetch(at, 1.0), lod);
        if (kVtTaps > 1) tap = vt_square(tap);
        if (i == 0)
            sum = tap;
        else
            sum = vt_mix(sum, tap, 1.0 / float(i + 1));
    }
    return sum;
}

// axis: unit direction of the footprint's long axis.
VtSample vt_sample(ivec2 sector_delta, vec2 offset_m, float log2_long, float log2_short, vec2 axis) {
    VtPlace place = vt_place(sector_delta, offset_m, log2_long, log2_short);
    VtFound found = vt_find(place);
    float spacing_m = kVtTaps > 1 ? filter_spacing_m(log2_long, place.log2_texel, kVtTaps) : 0.0;
    VtTexels texels;
    if (kVtProbes == 1) {
        texels = vt_probe(place, found, axis, spacing_m);
    } else {
        float probe_m = spacing_m * float(kVtTaps / kVtProbes);
        for (int i = 0; i < kVtProbes; ++i) {
            vec2 at = offset_m + axis * (probe_m * (float(i) - 0.5 * float(kVtProbes - 1)));
            vec2 over = floor(at * (1.0 / 64.0));
            VtPlace there = vt_place(sector_delta + ivec2(over), at - over * 64.0, log2_long, log2_short);
            VtTexels probe = vt_probe(there, vt_find(there), axis, spacing_m);
            if (i == 0)
                texels = probe;
            else
                texels = vt_mix(texels, probe, 1.0 / float(i + 1));
        }
    }
    if (kVtTaps > 1) texels = vt_root(texels);
    VtSample s;
    s.material = vt_decode(texels);
    s.word = found.word;
    s.id = place.id;
    s.wanted_mip = place.wanted;
    s.shown_mip = int(found.mip);
    s.page_uv = found.in_page;
    return s;
}
#endif
