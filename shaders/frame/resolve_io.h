// What the resolve is told beside the frame's uniforms.
#ifndef LOAM_RESOLVE_IO_H
#define LOAM_RESOLVE_IO_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

struct ResolvePush {
    uint debug_view;        // DebugView
    float footprint_bias;   // added to log2 of the footprint by direct shading: supersampling filters what a mip would
    float deepest_m;        // bound of the depth that parallax searches
    uint first_tile;        // tile.vert: where the list of the class begins
    uint tiles_across;      // tile.vert: of the picture
};

LOAM_END_SHARED
#endif
