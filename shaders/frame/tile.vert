// A tile of the picture as two triangles, from the list of its class.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/frame/frame_io.h"
#include "shaders/frame/resolve_io.h"
#include "shaders/frame/tiles_io.h"
layout(binding = 0, scalar) readonly buffer Frame { FrameUniforms u; };
layout(binding = 20, scalar) readonly buffer List { uint list[]; };
layout(push_constant, scalar) uniform Push { ResolvePush push; };

void main() {
    uint tile = list[push.first_tile + uint(gl_InstanceIndex)];
    uvec2 at = uvec2(tile % push.tiles_across, tile / push.tiles_across);
    const uvec2 corners[6] = uvec2[6](uvec2(0, 0), uvec2(0, 1), uvec2(1, 1), uvec2(0, 0), uvec2(1, 1), uvec2(1, 0));
    vec2 pixel = vec2((at + corners[gl_VertexIndex]) * uint(kTileSide_px));
    gl_Position = vec4(pixel * u.inv_picture_px * 2.0 - 1.0, 0.0, 1.0);
}
