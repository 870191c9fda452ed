// Decals without the page cache: every decal over a pixel, in operator order, by the functions that composition uses, blended in
// the physical texture's encodings as composition blends them.
//
// Software devices run both sides of a branch, but a loop ends once its eight lanes are done. So every lane first walks to its next
// decal with a cheap test, and only then are decals evaluated, one a lane: the price is the list once, plus the most decals over
// one of eight neighbouring pixels, instead of every decal in full.
//
// Slot DIRECT_FIRST_SLOT + 8: storage buffer of DirectDecal, as long as its bound range (runtime/texture/decals.h). Specialisation
// constant 22: 1 where there are any.
#ifndef LOAM_TEXTURE_DIRECT_DECALS_GLSL
#define LOAM_TEXTURE_DIRECT_DECALS_GLSL
#include "shaders/texture/decal_shade.glsl"
#include "shaders/texture/material.glsl"

layout(constant_id = 22) const bool kDirectDecals = false;
layout(binding = DIRECT_FIRST_SLOT + 8, scalar) readonly buffer DirectDecals { DirectDecal direct_decals[]; };

MaterialSample with_decals(MaterialSample m, vec2 rel_m, float log2_footprint) {
    if (!kDirectDecals) return m;
    float texel_m = exp2(log2_footprint);
    vec3 root = sqrt(clamp(m.albedo, 0.0, 1.0));
    vec3 surface = vec3(m.gloss, page_encode_normal(m.normal.x), m.occlusion);
    vec2 metal = vec2(m.metalness, page_encode_normal(m.normal.y));
    int count = direct_decals.length();
    for (int next = 0;; ++next) {
        for (; next < count; ++next) {
            vec2 away = rel_m - direct_decals[next].center_rel_m;
            float reach = direct_decals[next].reach_m;
            if (dot(away, away) < reach * reach) break;
        }
        if (next >= count) break;
        DirectDecal decal = direct_decals[next];
        DecalInstance instance;
        instance.texel_m = texel_m;
        instance.fade = decal_fade(decal.size_m, texel_m);
        instance.shape = decal.shape;
        instance.seed = decal.seed;
        instance.foot = decal.foot;
        vec2 offset_m = rel_m - decal.center_rel_m;
        DecalShade shade;
        if (decal.kind == kDecalCrater)
            shade = crater_shade(instance, offset_m);
        else
            shade = print_shade(instance, offset_m);
        // Gone on the screen, gone in the list: a faded decal has no weight at all.
        float shown = instance.fade > 0.0 ? 1.0 : 0.0;
        root = mix(root, shade.albedo.rgb, shade.albedo.a * shown);
        surface = mix(surface, shade.surface.rgb, shade.surface.a * shown);
        metal = mix(metal, shade.metal.rg, shade.metal.a * shown);
        if (kHasChannels) m.channels = mix(m.channels, shade.channels, shade.channel_weight * shown);
    }
    m.albedo = root * root;
    m.gloss = surface.x;
    m.occlusion = surface.z;
    m.metalness = metal.x;
    m.normal = vec2(page_decode_normal(surface.y), page_decode_normal(metal.y));
    return m;
}
#endif
