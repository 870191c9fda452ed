// Which class of taps every tile of 8x8 pixels needs: the largest in it. One invocation a tile.
// Tiles without ground are in no list.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/frame/tiles_io.h"
#include "shaders/geometry/pixel_ellipse_math.h"
layout(local_size_x = 32) in;
layout(binding = 0) uniform sampler2D gbuffer;
layout(binding = 1, scalar) buffer Draws { TileDraw draws[kTapClasses]; };
layout(binding = 2, scalar) writeonly buffer List { uint list[]; };
layout(push_constant, scalar) uniform Push { ClassifyPush push; };

void main() {
    uint count = uint(push.tiles.x * push.tiles.y);
    uint tile = gl_GlobalInvocationID.x;
    if (tile >= count) return;
    ivec2 first = ivec2(tile % uint(push.tiles.x), tile / uint(push.tiles.x)) * kTileSide_px;
    float log2_ratio = -1.0; // no ground
    for (int i = 0; i < kTileSide_px * kTileSide_px; ++i) {
        ivec2 at = min(first + ivec2(i % kTileSide_px, i / kTileSide_px), push.picture_px - 1);
        vec2 axes = texelFetch(gbuffer, at, 0).zw;
        float ratio = axes.x - filter_log2_texel(axes.x, axes.y, push.short_share, push.log2_taps);
        log2_ratio = max(log2_ratio, axes.x > kNoGroundLog2 ? max(ratio, 0.0) : -1.0);
    }
    if (log2_ratio < 0.0) return;
    int c = filter_class(log2_ratio);
    list[uint(c) * count + atomicAdd(draws[c].instance_count, 1u)] = tile;
}
