#version 460
#extension GL_GOOGLE_include_directive : require
#include "shaders/geometry/gbuffer.glsl"

void main() {
    write_gbuffer();
}
