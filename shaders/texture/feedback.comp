#version 460
// Which page every cell of the picture would like: one pixel a cell, another one each frame.
// Source: Call of Duty talk, "Feedback Buffer". Differs: an own small dispatch, jittered over frames, not part of shading.
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

void main() {
    ivec2 cell = ivec2(gl_GlobalInvocationID.xy);
    if (cell.x >= kFeedbackWidth || cell.y >= kFeedbackHeight) return;
    // R2 sequence (Roberts 2018): every place of a cell is visited evenly.
    vec2 jitter = fract(vec2(0.5) + float(vt.frame & 1023u) * vec2(0.75487767, 0.56984029));
    vec2 size = frame.picture_px;
    ivec2 pixel = ivec2(min((vec2(cell) + jitter) * size / vec2(kFeedbackWidth, kFeedbackHeight), size - 1.0));
    float depth = texelFetch(depth_image, pixel, 0).r;
    vec4 surface = texelFetch(gbuffer, pixel, 0);
    vec2 ndc = (vec2(pixel) + 0.5) / size * 2.0 - 1.0;
    vec4 rel = frame.rel_from_clip * vec4(ndc, depth, 1.0);

    uint value = kNoTerrain;
    if (depth > 0.0) {
        ivec2 sector;
        vec2 offset;
        vt_split(rel.xy / rel.w, sector, offset);
        VtPlace place = vt_place(sector, offset, surface.z, surface.w);
        uint mip = uint(max(place.wanted, 0.0));
        uvec2 page = uvec2(place.cell) >> mip;
        value = mip << 24u | place.id << 16u | page.y << 8u | page.x;
        if (place.wanted < 0.0) value |= kFeedbackFinerBit;
    }
    values[cell.y * kFeedbackWidth + cell.x] = value;
}
