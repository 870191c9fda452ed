#version 460
// Which page every cell of the picture would like: one pixel a cell, another one each frame.
// Source: Call of Duty talk, "Feedback Buffer". Differs: an own small dispatch, jittered over frames, not part of shading; and it says how far
// what is shown is from what is wanted.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define VT_FIRST_SLOT 0
#include "shaders/frame/frame_io.h"
#include "shaders/texture/vt_place.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = 2) uniform sampler2D depth_image;
layout(binding = 3) uniform sampler2D gbuffer;
layout(binding = 4, scalar) readonly buffer FrameBuffer { FrameUniforms frame; };
layout(binding = 5, scalar) writeonly buffer Values { uint values[]; };
layout(binding = 6) uniform usampler2D indirection;
layout(push_constant, scalar) uniform Push { FeedbackPush push; };

void main() {
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (cell.x >= push.cells.x || cell.y >= push.cells.y) return;
    vec2 size = frame.picture_px;
    ivec2 pixel = ivec2(min((vec2(cell) + push.jitter) * size / vec2(push.cells), size - 1.0));
    float depth = texelFetch(depth_image, pixel, 0).r;
    vec4 surface = texelFetch(gbuffer, pixel, 0);
    vec2 ndc = (vec2(pixel) + 0.5) / size * 2.0 - 1.0;
    vec4 rel = frame.rel_from_clip * vec4(ndc, depth, 1.0);

    uint value = kNoTerrain;
    if (depth > 0.0) {
        ivec2 sector;
        vec2 offset;
        vt_split(rel.xy / rel.w, sector, offset);
        VtPlace place = vt_place(sector, offset, surface.z + push.footprint_log2, surface.w + push.footprint_log2);
        int mip = vt_level(place);
        uvec2 page = uvec2(place.cell) >> mip;
        uint word = texelFetch(indirection, vt_indirection_texel(place), 0).r;
        // An image that is still too small for what the pixel wants counts as well, as far as any image could grow.
        float image_log2_texel = place.id != 0u ? vt.sector_log2_root - float(place.log2_width) : vt.default_log2_texel;
        float finest = vt.sector_log2_root - float(kMaxSectorLog2Width) - image_log2_texel;
        int coarser = clamp(int(word >> 16u & 0xffu) - int(floor(max(place.wanted, min(finest, 0.0)))), 0, 7);
        value = uint(coarser) << kFeedbackCoarserShift | uint(mip) << kFeedbackMipShift | place.id << 16u | page.y << 8u | page.x;
    }
    values[cell.y * push.cells.x + cell.x] = value;
}
