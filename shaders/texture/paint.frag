#version 460
// A decal of a material over composed texels. The place comes from gl_FragCoord, whole texels shifted by whole texels, so
// that a rectangle of a page gets the bits of the whole page.
//
// One target has one weight. Where a decal's channels have shares of their own it is drawn three times, each time into the
// channels of one part (runtime/texture/decal_passes.cpp): 0 all, 1 albedo, gloss, metalness; 2 normals; 3 occlusion.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/paint_io.h"

layout(constant_id = 0) const uint kKind = kPaintTerrain;
layout(constant_id = 1) const uint kPart = 0u;
layout(constant_id = 2) const bool kHasMetal = false;
const bool kSmoothMips = false;
layout(binding = 0, scalar) readonly buffer Instances { PaintInstance instances[]; };
layout(binding = 1, scalar) readonly buffer Segments { PaintSegment segments[]; };
layout(binding = 2, scalar) readonly buffer Heights { float heights[]; };
layout(binding = 3) uniform sampler2DArray layer_albedo;
layout(binding = 4) uniform sampler2DArray layer_normal;
layout(binding = 5) uniform sampler2DArray layer_metal;
layout(location = 0) flat in uint instance_index;
layout(location = 0) out vec4 albedo;
layout(location = 1) out vec4 surface;
layout(location = 2) out vec4 metal;

#define MATERIAL_ALBEDO layer_albedo
#define MATERIAL_NORMAL layer_normal
#define MATERIAL_METAL layer_metal
#define PAINT_SEGMENT(i) segments[i]
#include "shaders/texture/paint_shade.glsl"

#ifdef LOAM_DECAL_FUNCTIONS
layout(binding = 6, scalar) buffer Failed { uint failed_texels; }; // of this draw: where a function gave no number
#endif

float height_at(PaintInstance instance, vec2 grid) {
    vec2 whole = floor(grid), rest = grid - whole;
    ivec2 at = ivec2(whole) - instance.grid_min;
    uint i = instance.grid_first + uint(at.y) * instance.grid_width + uint(at.x);
    precise float south = heights[i] + (heights[i + 1u] - heights[i]) * rest.x;
    i += instance.grid_width;
    precise float north = heights[i] + (heights[i + 1u] - heights[i]) * rest.x;
    precise float height = south + (north - south) * rest.y;
    return height;
}

PaintPlace paint_on_ground(PaintInstance instance, vec2 texel, vec2 at_m) {
    precise vec2 grid = texel * instance.grid_scale + instance.grid_origin;
    float east = height_at(instance, grid + vec2(1.0, 0.0)), west = height_at(instance, grid - vec2(1.0, 0.0));
    float north = height_at(instance, grid + vec2(0.0, 1.0)), south = height_at(instance, grid - vec2(0.0, 1.0));
    precise vec2 slope = vec2(east - west, north - south) * (0.5 / instance.grid_spacing_m);
    vec3 ground = vec3(-slope, 1.0) / sqrt(1.0 + dot(slope, slope));
    return paint_volume(instance.decal, vec3(at_m, height_at(instance, grid)), ground, instance.texel_m);
}

void main() {
    PaintInstance instance = instances[instance_index];
    vec2 texel = vec2(ivec2(gl_FragCoord.xy) - instance.page_shift) + 0.5;
    precise vec2 at_m = (texel - float(kPageBorder)) * instance.texel_m;
    PaintPlace place;
    if (kKind == kPaintTerrain) place = paint_terrain(instance.decal, at_m, instance.texel_m);
    if (kKind == kPaintSpline) place = paint_spline(instance.decal, at_m, instance.texel_m);
    if (kKind == kPaintVolume) place = paint_on_ground(instance, texel, at_m);
    PaintShade shade = paint_material(instance.decal, place);
#ifdef LOAM_DECAL_FUNCTIONS
    if (shade.failed && kPart <= 1u) atomicAdd(failed_texels, 1u);
#endif

    // Of part 0 all shares are equal.
    PaintDecal decal = instance.decal;
    float surface_share = kPart == 2u ? decal.normal_share : kPart == 3u ? decal.occlusion_share : decal.gloss_share;
    float metal_share = kPart == 2u ? decal.normal_share : decal.metal_share;
    albedo = vec4(shade.root, shade.cover * decal.albedo_share);
    surface = vec4(shade.gloss, shade.normal.x, shade.occlusion, shade.cover * surface_share);
    metal = vec4(shade.metalness, shade.normal.y, 0.0, shade.cover * metal_share);
}
