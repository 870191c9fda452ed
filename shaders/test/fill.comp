// Writes i * factor + addend: the smallest pipeline there is, for tests of the GPU layer.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shaders/test/fill_io.h"

layout(local_size_x = TEST_FILL_GROUP) in;
layout(constant_id = 0) const uint kExtra = 0;
layout(scalar, set = 0, binding = 0) buffer Values {
    uint values[];
};
layout(scalar, push_constant) uniform Params {
    TestFillParams params;
};

void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i < params.count) values[i] = i * params.factor + params.addend + kExtra;
}
