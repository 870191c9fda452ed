// Writes 64-bit blocks through a texel view of a block-compressed image.
#version 460

layout(local_size_x = 8, local_size_y = 8) in;
layout(rg32ui, set = 0, binding = 0) uniform writeonly uimage2D blocks;

void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, imageSize(blocks)))) imageStore(blocks, at, uvec4(at.x * 1000 + at.y, ~at.x, 0, 0));
}
