// One fetch of a physical page: the encoded channels at a place, and what they mean. How many textures a page has and where its
// channels are is known here only. Slots: VT_FIRST_SLOT + 3 … + 5, the physical textures (see vt_sample.glsl).
#ifndef LOAM_TEXTURE_VT_FETCH_GLSL
#define LOAM_TEXTURE_VT_FETCH_GLSL
#include "shaders/texture/texture_io.h"

layout(binding = VT_FIRST_SLOT + 3) uniform sampler2D vt_atlas0;
layout(binding = VT_FIRST_SLOT + 4) uniform sampler2D vt_atlas1;
layout(binding = VT_FIRST_SLOT + 5) uniform sampler2D vt_atlas2;

// As stored: fetches are averaged in this form, decoded once.
struct VtTexels {
    vec3 a, b;
    vec2 c;
};

VtTexels vt_fetch(vec2 uv, float lod) {
    return VtTexels(textureLod(vt_atlas0, uv, lod).rgb, textureLod(vt_atlas1, uv, lod).rgb, textureLod(vt_atlas2, uv, lod).rg);
}

VtTexels vt_mix(VtTexels from, VtTexels to, float share) {
    return VtTexels(mix(from.a, to.a, share), mix(from.b, to.b, share), mix(from.c, to.c, share));
}

struct VtMaterial {
    vec3 albedo;      // linear
    vec2 normal;      // x, y of the material in the frame of the ground; z is positive
    float gloss;
    float occlusion;
    float metalness;
};

VtMaterial vt_decode(VtTexels t) {
    VtMaterial m;
    m.albedo = t.a * t.a;
    m.gloss = t.b.r;
    m.occlusion = t.b.b;
    m.metalness = t.c.r;
    m.normal = vec2(page_decode_normal(t.b.g), page_decode_normal(t.c.g));
    return m;
}
#endif
