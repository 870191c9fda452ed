// Decals without the page cache: every decal over a pixel, in operator order, by the functions that composition uses, blended in
// the physical texture's encodings as composition blends them.
//
// Software devices run both sides of a branch, but a loop ends once its eight lanes are done. So every lane first walks to its next
// decal with a cheap test, and only then are decals evaluated, one a lane: the price is the list once, plus the most decals over
// one of eight neighbouring pixels, instead of every decal in full.
//
// Slots DIRECT_FIRST_SLOT + 8, 10, 11: storage buffers of DirectDecal, as long as its bound range, PaintDecal and PaintSegment
// (runtime/texture/decals.h). Specialisation constants: 22: 1 where there are any decals, 23: 1 where any lays a material.
#ifndef LOAM_TEXTURE_DIRECT_DECALS_GLSL
#define LOAM_TEXTURE_DIRECT_DECALS_GLSL
#include "shaders/texture/decal_shade.glsl"
#include "shaders/texture/material.glsl"
#include "shaders/texture/paint_io.h"

layout(constant_id = 22) const bool kDirectDecals = false;
layout(constant_id = 23) const bool kDirectPaint = false;
layout(binding = DIRECT_FIRST_SLOT + 8, scalar) readonly buffer DirectDecals { DirectDecal direct_decals[]; };
layout(binding = DIRECT_FIRST_SLOT + 10, scalar) readonly buffer DirectPaints { PaintDecal direct_paints[]; };
layout(binding = DIRECT_FIRST_SLOT + 11, scalar) readonly buffer DirectSegments { PaintSegment direct_segments[]; };

#define PAINT_SEGMENT(i) direct_segments[i]
#include "shaders/texture/paint_shade.glsl"

// As composition blends it: runtime/texture/decal_passes.cpp.
void blend_paint(PaintDecal decal, PaintPlace place, inout vec3 root, inout vec3 surface, inout vec2 metal) {
    PaintShade shade = paint_material(decal, place);
    root = mix(root, shade.root, shade.cover * decal.albedo_share);
    surface = mix(surface, vec3(shade.gloss, shade.normal.x, shade.occlusion),
                  shade.cover * vec3(decal.gloss_share, decal.normal_share, decal.occlusion_share));
    metal = mix(metal, vec2(shade.metalness, shade.normal.y), shade.cover * vec2(decal.metal_share, decal.normal_share));
}

// at_rel_m: camera-relative; ground: the height field's normal there.
MaterialSample with_decals(MaterialSample m, vec3 at_rel_m, vec3 ground, float log2_footprint) {
    if (!kDirectDecals) return m;
    vec2 rel_m = at_rel_m.xy;
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
        if (kDirectPaint && decal.kind >= kDecalPaint) {
            PaintDecal paint = direct_paints[decal.paint];
            uint kind = decal.kind - kDecalPaint;
            PaintPlace place;
            if (kind == kPaintTerrain)
                place = paint_terrain(paint, rel_m, texel_m);
            else if (kind == kPaintSpline)
                place = paint_spline(paint, rel_m, texel_m);
            else
                place = paint_volume(paint, at_rel_m, ground, texel_m);
            blend_paint(paint, place, root, surface, metal);
            continue;
        }
        DecalInstance instance;
        instance.texel_m = texel_m;
        instance.fade = decal_fade(decal.size_m, texel_m) * decal.strength;
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
