#version 460
// Tests: what a pixel covers and which page it wants, from its derivatives to the place in the image.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define VT_FIRST_SLOT 2
#include "shaders/geometry/pixel_ellipse_math.h"
#include "shaders/texture/vt_place.glsl"
layout(local_size_x = 64) in;
struct Query { ivec2 sector_delta; vec2 offset_m, dx, dy; };
struct Answer { float log2_long, log2_short, axis, log2_texel, wanted, spacing_m; vec2 direction, pages; ivec2 cell; uint id; int tap_class; };
layout(binding = 0, scalar) readonly buffer Queries { Query queries[]; };
layout(binding = 1, scalar) writeonly buffer Answers { Answer answers[]; };
layout(push_constant, scalar) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    Query q = queries[i];
    PixelEllipse e = pixel_ellipse(q.dx, q.dy);
    VtPlace p = vt_place(q.sector_delta, q.offset_m, e.log2_long, e.log2_short);
    float axis = encode_axis(e.axis_twice);
    answers[i] = Answer(e.log2_long, e.log2_short, axis, p.log2_texel, p.wanted,
                        filter_spacing_m(e.log2_long, p.log2_texel, kMaxTaps), decode_axis(axis), p.pages, p.cell, p.id,
                        filter_class(e.log2_long - p.log2_texel));
}
