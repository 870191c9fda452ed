#version 460
// A vertex of a terrain patch, pulled: no vertex buffers. gl_VertexIndex counts the (kPatchQuads + 1)² vertices of the grid
// from the south-west, rows to the north; gl_InstanceIndex the patches.
//
//   binding 0  storage buffer   PatchInstance[]
//   binding 1  sampler2DArray   heights in metres, a layer a slot (texelFetch)
//   push       GeometryPush
//
// Where a neighbour is d levels coarser, vertices of that edge slide onto its vertices (k = (k >> d) << d) before anything
// else is computed: both patches then do the same arithmetic on the same integers and the same height.
// Source: Far Cry 5 talk, "LOD Mesh Stitching".
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
#include "shaders/geometry/geometry_io.h"

layout(binding = 0, scalar) readonly buffer Patches {
    PatchInstance patches[];
};
layout(binding = 1) uniform sampler2DArray heights;

layout(push_constant, scalar) uniform Push {
    GeometryPush push;
};

layout(location = 0) out vec3 out_rel_m;         // camera-relative position
layout(location = 1) out vec2 out_texel;         // where in the page's normals, texels
layout(location = 2) flat out uint out_slot;
layout(location = 3) flat out uint out_level;    // debug views

invariant gl_Position;

int snapped(int k, uint delta) {
    return (k >> delta) << delta;
}

void main() {
    PatchInstance instance = patches[push.first_instance + gl_InstanceIndex];
    ivec2 k = ivec2(gl_VertexIndex % (kPatchQuads + 1), gl_VertexIndex / (kPatchQuads + 1));
    uint deltas = instance.lod_deltas;
    if (k.x == 0) k.y = snapped(k.y, deltas & 15u);
    if (k.x == kPatchQuads) k.y = snapped(k.y, (deltas >> 8) & 15u);
    if (k.y == 0) k.x = snapped(k.x, (deltas >> 4) & 15u);
    if (k.y == kPatchQuads) k.x = snapped(k.x, (deltas >> 12) & 15u);

    precise vec2 free_m = vec2(instance.origin + k * instance.stride) * push.step_m + push.origin_rel_m;
    precise vec2 place_m = min(free_m, push.map_edge_rel_m);
    ivec2 texel = kPatchBorder + k * kPatchQuadTexels;
    precise float z_m = texelFetch(heights, ivec3(texel, instance.slot), 0).r - push.camera_z_m;

    out_rel_m = vec3(place_m, z_m);
    float texel_m = push.step_m * float(instance.stride) / float(kPatchQuadTexels);
    out_texel = vec2(texel) - (free_m - place_m) / texel_m;
    out_slot = instance.slot;
    out_level = instance.level;
    gl_Position = push.clip_from_rel * vec4(place_m, z_m, 1.0);
}
