#version 460
#extension GL_GOOGLE_include_directive : require
// Tests: vt_taps.comp with taps that reach twice as far as they may.
#define kTapReach 4.0f
#include "shaders/test/vt_taps.glsl"
