// One fetch of a physical page: the encoded channels at a place, and what they mean. How many textures a page has and where its
// channels are is known here (reading) and in encode_read.glsl (writing) only; page_format.h has the table.
// Slots: VT_FIRST_SLOT + 3 … + 6, the physical textures (see vt_sample.glsl).
// Specialisation constant 30: the layout, kPageRows or kPagePairs; 31: the optional channels (page_channels.glsl). A slot whose
// texture the format has not got is bound to another and never read.
#ifndef LOAM_TEXTURE_VT_FETCH_GLSL
#define LOAM_TEXTURE_VT_FETCH_GLSL
#include "shaders/texture/page_channels.glsl"
#include "shaders/texture/texture_io.h"

layout(constant_id = 30) const uint kPageLayout = kPageRows;
layout(binding = VT_FIRST_SLOT + 3) uniform sampler2D vt_atlas0;
layout(binding = VT_FIRST_SLOT + 4) uniform sampler2D vt_atlas1;
layout(binding = VT_FIRST_SLOT + 5) uniform sampler2D vt_atlas2;
layout(binding = VT_FIRST_SLOT + 6) uniform sampler2D vt_atlas3;

// As stored: fetches are averaged in this form, decoded once. What the format has not got is 0.
struct VtTexels {
    vec4 a, b;
    vec3 c, d;
};

VtTexels vt_fetch(vec2 uv, float lod) {
    VtTexels t = VtTexels(textureLod(vt_atlas0, uv, lod), textureLod(vt_atlas1, uv, lod), vec3(0), vec3(0));
    if (kPageLayout == kPageRows) t.c = textureLod(vt_atlas2, uv, lod).rgb;
    if (page_has_fourth(kPageChannels)) t.d = textureLod(vt_atlas3, uv, lod).rgb;
    return t;
}

// By the sampler's anisotropy.
VtTexels vt_fetch_grad(vec2 uv, vec2 dx, vec2 dy) {
    VtTexels t = VtTexels(textureGrad(vt_atlas0, uv, dx, dy), textureGrad(vt_atlas1, uv, dx, dy), vec3(0), vec3(0));
    if (kPageLayout == kPageRows) t.c = textureGrad(vt_atlas2, uv, dx, dy).rgb;
    if (page_has_fourth(kPageChannels)) t.d = textureGrad(vt_atlas3, uv, dx, dy).rgb;
    return t;
}

VtTexels vt_mix(VtTexels from, VtTexels to, float share) {
    return VtTexels(mix(from.a, to.a, share), mix(from.b, to.b, share), mix(from.c, to.c, share), mix(from.d, to.d, share));
}

// Several taps are averaged in linear light, as the pixels of a larger picture would be: a mean of roots is darker.
VtTexels vt_square(VtTexels t) {
    t.a.rgb *= t.a.rgb;
    return t;
}
VtTexels vt_root(VtTexels t) {
    t.a.rgb = sqrt(t.a.rgb);
    return t;
}

struct VtMaterial {
    vec3 albedo;      // linear
    vec2 normal;      // x, y of the material in the frame of the ground; z is positive
    float gloss;
    float occlusion;
    float metalness;
    vec4 channels;    // optional ones, by place
};

VtMaterial vt_decode(VtTexels t) {
    VtMaterial m;
    m.albedo = t.a.rgb * t.a.rgb;
    if (kPageLayout == kPagePairs) {
        m.metalness = t.a.a;
        m.occlusion = t.b.r;
        m.gloss = t.b.b;
        m.normal = vec2(page_decode_normal(t.b.g), page_decode_normal(t.b.a));
    } else {
        m.gloss = t.b.r;
        m.occlusion = t.b.b;
        m.metalness = t.c.r;
        m.normal = vec2(page_decode_normal(t.b.g), page_decode_normal(t.c.g));
    }
    m.channels = kHasChannels ? vec4(t.c.b, t.d) : vec4(0);
    return m;
}
#endif
