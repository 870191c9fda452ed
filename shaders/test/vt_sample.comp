#version 460
// Tests: samples the virtual texture at given places.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define VT_FIRST_SLOT 2
#include "shaders/texture/vt_sample.glsl"
layout(local_size_x = 64) in;
struct Query { vec2 rel_m; float log2_texel; float unused; };
layout(binding = 0, scalar) readonly buffer Queries { Query queries[]; };
layout(binding = 1, scalar) writeonly buffer Answers { vec4 answers[]; };
layout(push_constant, scalar) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    ivec2 sector;
    vec2 offset;
    vt_split(queries[i].rel_m, sector, offset);
    VtSample s = vt_sample(sector, offset, queries[i].log2_texel, queries[i].log2_texel, vec2(1.0, 0.0));
    answers[i * 4u] = vec4(s.material.albedo, s.material.gloss);
    answers[i * 4u + 1u] = vec4(s.material.normal, s.material.occlusion, s.material.metalness);
    answers[i * 4u + 2u] = channels_from(s.material.channels);
    answers[i * 4u + 3u] = vec4(float(s.shown_mip), float(s.id), 0.0, 0.0);
}
