#version 460
// Composes rectangles of pages into scratch (page_format.h): a workgroup a tile.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/compose_io.h"
#include "shaders/texture/texture_io.h"

layout(local_size_x = kTileTexels, local_size_y = kTileTexels) in;
layout(constant_id = 0) const bool kOneLayer = false;
layout(constant_id = 1) const bool kHasMetal = false;
layout(constant_id = 2) const bool kTileHiding = false;
layout(constant_id = 3) const bool kDistortion = false;
layout(constant_id = 4) const bool kTransitions = false;
layout(constant_id = 5) const bool kVista = false;
layout(constant_id = 6) const bool kImagery = false;
layout(constant_id = 7) const bool kMasks = false;  // the baseline
const bool kSmoothMips = false;

layout(binding = 0) uniform sampler2DArray layer_albedo;
layout(binding = 1) uniform sampler2DArray layer_normal;
layout(binding = 2) uniform sampler2DArray layer_metal;
layout(binding = 3) uniform usampler2DArray index_pages;
layout(binding = 4) uniform sampler2DArray tint_pages;
layout(binding = 5, scalar) readonly buffer Places { LayerPlace places[]; };
layout(binding = 6, rgba8) uniform writeonly image2DArray scratch;
layout(binding = 7, scalar) readonly buffer Rects { ComposeRect rects[]; };
layout(binding = 8, scalar) readonly buffer Tiles { ComposeTile tiles[]; };
layout(binding = 9) uniform sampler2DArray distortion_map;
layout(binding = 10) uniform sampler2DArray imagery_pages;
layout(binding = 11) uniform sampler2DArray mask_pages;
layout(push_constant, scalar) uniform Push { ComposePush push; };

ComposeRect rect;

#define MATERIAL_ALBEDO layer_albedo
#define MATERIAL_NORMAL layer_normal
#define MATERIAL_METAL layer_metal
#define MATERIAL_DISTORTION distortion_map
#define MATERIAL_PLACE(layer) places[rect.first_place + (layer)]
#define MATERIAL_IMAGERY imagery_pages
#include "shaders/texture/imagery.glsl"
#define MATERIAL_MASKS mask_pages
#include "shaders/texture/material.glsl"
#include "shaders/texture/masks.glsl"

void main() {
    ComposeTile tile = tiles[push.first_tile + gl_WorkGroupID.x];
    rect = rects[tile.place >> 10u];
    ivec2 at = ivec2(tile.place & 31u, tile.place >> 5u & 31u) * kTileTexels + ivec2(gl_LocalInvocationID.xy);
    // Everything follows from the texel's place in the page, never from its place in the rectangle.
    ivec2 texel = rect.rect_min + at;
    precise vec2 position = (vec2(texel) - (float(kPageBorder) - 0.5)) * (1.0 / float(kPagePayload));
    precise vec2 index_at = rect.index_origin + position * rect.index_scale;
    precise vec2 place = index_at;
    if (kDistortion) {
        precise vec2 from = rect.distortion_origin + position * rect.distortion_scale;
        precise vec2 moved = index_at + distortion_at(from, rect.distortion_lod) * rect.distortion_reach;
        index_at = moved;
    }
    vec2 corner = floor(index_at);
    precise vec2 fraction = index_at - corner;
    ivec3 base = ivec3(ivec2(corner), int(rect.index_slot));

    MaterialCorners c;
    c.layers = uvec4(tile.layer);
    if (!kOneLayer) {
        c.layers.x = texelFetch(index_pages, base, 0).r;
        c.layers.y = texelFetch(index_pages, base + ivec3(1, 0, 0), 0).r;
        c.layers.z = texelFetch(index_pages, base + ivec3(0, 1, 0), 0).r;
        c.layers.w = texelFetch(index_pages, base + ivec3(1, 1, 0), 0).r;
        c.layers = min(c.layers, uvec4(rect.last_layer));
    }
    c.t0 = texelFetch(tint_pages, base, 0).rgb;
    c.t1 = texelFetch(tint_pages, base + ivec3(1, 0, 0), 0).rgb;
    c.t2 = texelFetch(tint_pages, base + ivec3(0, 1, 0), 0).rgb;
    c.t3 = texelFetch(tint_pages, base + ivec3(1, 1, 0), 0).rgb;
    c.fraction = fraction;
    c.from_vertex = kDistortion ? place - corner : fraction;
    c.vertex = rect.index_vertex + base.xy;
    c.level = rect.index_level;
    c.index_step = 1.0 / rect.index_scale;
    c.position = position;
    c.log2_texel = 0.0;
    c.vista = rect.vista;
    c.imagery = kImagery ? imagery_at(place, int(rect.index_slot)) * rect.imagery : vec4(0);
    MaterialSample m = kMasks ? evaluate_masks(c, base.xy, rect.last_layer + 1u) : evaluate_material(c);

    ivec2 target = rect.scratch_min + at;
    precise vec3 albedo = sqrt(clamp(m.albedo, 0.0, 1.0));
    precise float normal_x = page_encode_normal(m.normal.x);
    precise float normal_y = page_encode_normal(m.normal.y);
    imageStore(scratch, ivec3(target, 0), vec4(albedo, 1.0));
    imageStore(scratch, ivec3(target, 1), vec4(m.gloss, normal_x, m.occlusion, 1.0));
    vec4 places_held = kHasChannels ? m.channels : vec4(0);
    imageStore(scratch, ivec3(target, 2), vec4(m.metalness, normal_y, places_held.x, 1.0));
    if (page_has_fourth(kPageChannels)) imageStore(scratch, ivec3(target, 3), vec4(places_held.yzw, 1.0));
}
