#version 460
// Tests: the material without the cache at given places.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define DIRECT_FIRST_SLOT 2
#include "shaders/texture/direct.glsl"
layout(local_size_x = 64) in;
struct Query { vec2 rel_m; float log2_texel; float unused; };
layout(binding = 0, scalar) readonly buffer Queries { Query queries[]; };
layout(binding = 1, scalar) writeonly buffer Answers { vec4 answers[]; };
layout(push_constant, scalar) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    MaterialSample m = direct_material(queries[i].rel_m, queries[i].log2_texel, queries[i].log2_texel);
    answers[i * 4u] = vec4(m.albedo, m.gloss);
    answers[i * 4u + 1u] = vec4(m.normal, m.occlusion, m.metalness);
    answers[i * 4u + 2u] = channels_from(m.channels);
    answers[i * 4u + 3u] = vec4(0);
}
