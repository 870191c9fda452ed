#version 460
// Brings the indirection texture in step with the CPU's quad trees: one workgroup fills one square. The squares of a
// dispatch are disjoint, so that no order between them is needed.
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/texture/texture_io.h"
layout(local_size_x = 64) in;
layout(binding = 0, r32ui) uniform writeonly uimage2D indirection;
layout(binding = 1, scalar) readonly buffer Fills { IndirectionFill fills[]; };

void main() {
    IndirectionFill fill = fills[gl_WorkGroupID.x];
    for (int i = int(gl_LocalInvocationIndex); i < fill.size * fill.size; i += 64)
        imageStore(indirection, ivec2(fill.x + i % fill.size, fill.y + i / fill.size), uvec4(fill.value));
}
