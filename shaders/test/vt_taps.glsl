#extension GL_EXT_scalar_block_layout : require
#define VT_FIRST_SLOT 2
#include "shaders/texture/vt_sample.glsl"
layout(local_size_x = 64) in;
struct Query { vec2 rel_m, axis; float log2_long, log2_short; };
layout(binding = 0, scalar) readonly buffer Queries { Query queries[]; };
layout(binding = 1, scalar) writeonly buffer Answers { vec4 answers[]; };
layout(push_constant, scalar) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    Query q = queries[i];
    ivec2 sector;
    vec2 offset;
    vt_split(q.rel_m, sector, offset);
    VtSample s = vt_sample(sector, offset, q.log2_long, q.log2_short, q.axis);
    answers[i] = vec4(s.material.albedo, float(s.shown_mip) + 100.0 * float(s.id));
}
