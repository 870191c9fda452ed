// The material under any place, without the page cache: index map and layers per pixel. This is what the cached picture is
// measured against. Decals come after it: direct_decals.glsl.
//
// Slots, counted from DIRECT_FIRST_SLOT, which the includer may define (0):
// | slot | what | C++ |
// | --- | --- | --- |
// | +0 | DirectParams, storage buffer | VirtualTexture::direct_params() |
// | +1 | LayerPlace a layer, relative to the camera's sector, storage buffer | VirtualTexture::direct_places() |
// | +2 | index page table, storage buffer, uint an entry | IndexMap::page_table() |
// | +3 | index pages, usampler2DArray | IndexMap::indices(), VirtualTexture::nearest_sampler() |
// | +4 | tint pages, sampler2DArray | IndexMap::tints(), VirtualTexture::nearest_sampler() |
// | +5 | layers' albedo+reveal, sampler2DArray | LayerSet::albedo_reveal, LayerSet::sampler |
// | +6 | layers' normal+gloss+occlusion | LayerSet::normal_gloss_occlusion, LayerSet::sampler |
// | +7 | layers' metalness | LayerSet::metalness, LayerSet::sampler |
// | +12 | imagery pages, sampler2DArray | IndexMap::imagery(), VirtualTexture::nearest_sampler() |
// | +9 | distortion map, sampler2DArray | LayerSet::distortion_map(), LayerSet::sampler |
// Specialisation constants: 21 where a layer has metal (LayerSet::has_metal), 40 tile hiding, 41 distortion,
// 42 transitions, 43 layers blended between their mips (LayerSet::smooth_sampler), 44 vista UVs, 45 imagery, 31 the optional channels
// (page_channels.glsl).
//
//     MaterialSample m = direct_material(rel.xy, log2_footprint, log2_distance_texel);
// rel: camera-relative metres; log2 of metres a sample, and of the texel that vista UVs take the distance from (vista.h): of a
// supersampled pixel not the sample's.
#ifndef LOAM_TEXTURE_DIRECT_GLSL
#define LOAM_TEXTURE_DIRECT_GLSL
#include "shaders/texture/compose_io.h"
#include "shaders/texture/texture_io.h"
#include "shaders/texture/vista.h"

#ifndef DIRECT_FIRST_SLOT
#define DIRECT_FIRST_SLOT 0
#endif
layout(constant_id = 21) const bool kHasMetal = false;
layout(constant_id = 40) const bool kTileHiding = false;
layout(constant_id = 41) const bool kDistortion = false;
layout(constant_id = 42) const bool kTransitions = false;
layout(constant_id = 43) const bool kSmoothMips = false;
layout(constant_id = 44) const bool kVista = false;
layout(constant_id = 45) const bool kImagery = false;
const bool kOneLayer = false;
layout(binding = DIRECT_FIRST_SLOT + 0, scalar) readonly buffer DirectParamsBuffer { DirectParams direct; };
layout(binding = DIRECT_FIRST_SLOT + 1, scalar) readonly buffer DirectPlaces { LayerPlace direct_places[]; };
layout(binding = DIRECT_FIRST_SLOT + 2, scalar) readonly buffer DirectTable { uint direct_table[]; };
layout(binding = DIRECT_FIRST_SLOT + 3) uniform usampler2DArray direct_indices;
layout(binding = DIRECT_FIRST_SLOT + 4) uniform sampler2DArray direct_tints;
layout(binding = DIRECT_FIRST_SLOT + 5) uniform sampler2DArray direct_albedo;
layout(binding = DIRECT_FIRST_SLOT + 6) uniform sampler2DArray direct_normal;
layout(binding = DIRECT_FIRST_SLOT + 7) uniform sampler2DArray direct_metal;
layout(binding = DIRECT_FIRST_SLOT + 9) uniform sampler2DArray direct_distortion;
layout(binding = DIRECT_FIRST_SLOT + 12) uniform sampler2DArray direct_imagery;

#define MATERIAL_ALBEDO direct_albedo
#define MATERIAL_NORMAL direct_normal
#define MATERIAL_METAL direct_metal
#define MATERIAL_DISTORTION direct_distortion
#define MATERIAL_PLACE(layer) direct_places[layer]
#define MATERIAL_IMAGERY direct_imagery
#include "shaders/texture/imagery.glsl"
#include "shaders/texture/material.glsl"

MaterialSample direct_material(vec2 rel_m, float log2_footprint, float log2_distance_texel) {
    vec2 at_m = direct.camera_offset_m + rel_m; // from the corner of the camera's sector
    vec2 sector = floor(at_m * (1.0 / 64.0));
    vec2 in_sector = (at_m - sector * 64.0) * direct.texels_per_m;
    vec2 moved = vec2(0); // texels of level 0
    if (kDistortion) {
        vec2 from = direct.distortion_origin + at_m * direct.distortion_scale;
        moved = distortion_at(from, direct.distortion_lod_bias + log2_footprint) * direct.distortion_reach;
        in_sector += moved;
    }
    vec2 whole = floor(in_sector);
    vec2 rest = in_sector - whole;
    // Whole texels in integers: a 16 km map at 0.25 m is more than a float's fraction holds.
    ivec2 texel = (direct.camera_sector + ivec2(sector)) * direct.texels_per_sector + ivec2(whole);
    // The level a page of this texel size is composed from: two texture texels an index texel, or level 0.
    int level = clamp(int(floor(log2_footprint + 1.0 + log2(direct.texels_per_m))), 0, direct.level_count - 1);
    uint slot = 0xffffu;
    for (; level < direct.level_count; ++level) {
        ivec4 info = direct.levels[level];
        ivec2 page = clamp(texel >> (level + kIndexPageLog2), ivec2(0), info.yz - 1);
        slot = direct_table[info.x + page.y * info.y + page.x];
        if (slot != 0xffffu) break;
    }
    level = min(level, direct.level_count - 1);
    ivec2 coarse = texel >> level;
    vec2 fraction = (vec2(texel - (coarse << level)) + rest) * (1.0 / float(1 << level));
    ivec2 page = clamp(coarse >> kIndexPageLog2, ivec2(0), direct.levels[level].yz - 1);
    ivec2 local = clamp(coarse - (page << kIndexPageLog2) + kIndexPageBorder, ivec2(0), ivec2(kIndexPageTexels - 2));
    ivec3 base = ivec3(local, int(slot == 0xffffu ? 0u : slot));
    MaterialCorners c;
    c.layers = uvec4(texelFetch(direct_indices, base, 0).r, texelFetch(direct_indices, base + ivec3(1, 0, 0), 0).r,
                     texelFetch(direct_indices, base + ivec3(0, 1, 0), 0).r,
                     texelFetch(direct_indices, base + ivec3(1, 1, 0), 0).r);
    c.layers = min(c.layers, uvec4(direct.last_layer));
    c.t0 = texelFetch(direct_tints, base, 0).rgb;
    c.t1 = texelFetch(direct_tints, base + ivec3(1, 0, 0), 0).rgb;
    c.t2 = texelFetch(direct_tints, base + ivec3(0, 1, 0), 0).rgb;
    c.t3 = texelFetch(direct_tints, base + ivec3(1, 1, 0), 0).rgb;
    c.fraction = fraction;
    c.from_vertex = fraction - moved * (1.0 / float(1 << level));
    c.vertex = coarse;
    c.level = level;
    c.index_step = float(1 << level) / direct.texels_per_m;
    c.position = at_m;
    c.log2_texel = log2_footprint;
    c.vista = vista_weight(log2_distance_texel, direct.vista_log2_begin);
    c.imagery = vec4(0);
    if (kImagery)
        c.imagery = imagery_at(vec2(local) + c.from_vertex, base.z) *
                    (direct.imagery_strength * vista_weight(log2_distance_texel, direct.imagery_log2_begin));
    return evaluate_material(c);
}
#endif
