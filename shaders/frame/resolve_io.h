// What the resolve is told beside the frame's uniforms.
#ifndef LOAM_RESOLVE_IO_H
#define LOAM_RESOLVE_IO_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

struct ResolvePush {
    vec2 ring_center_rel_m; // brush ring, camera-relative
    float ring_radius_m;    // 0: none
    float ring_inner;       // share of the radius where the brush begins to fall off
    uint debug_view;        // DebugView
};

LOAM_END_SHARED
#endif
