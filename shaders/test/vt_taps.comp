#version 460
#extension GL_GOOGLE_include_directive : require
// Tests: the albedo that a footprint of any shape sees.
#include "shaders/test/vt_taps.glsl"
