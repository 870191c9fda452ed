// The cutout map's pages and table (runtime/maps/cutout_map.h), for the map and for shaders.
#ifndef LOAM_GEOMETRY_CUTOUT_IO_H
#define LOAM_GEOMETRY_CUTOUT_IO_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

#define kCutoutPayload 64     // vertices of a page without its border
#define kCutoutBorder 2
#define kCutoutTexels 68
#define kCutoutRowBytes 17    // of two rows of bits
#define kCutoutPageBytes 578
#define kCutoutPageWords 145  // a page in the buffer
#define kMaxCutoutPages 254
#define kCutoutGround 0       // table entries; any other is 1 + a page's place
#define kCutoutGone 255

struct CutoutPush {
    ivec2 origin;        // a vertex near the camera
    vec2 origin_rel_m;   // where it is, camera-relative
    float inv_spacing;   // vertices a metre
    ivec2 pages;         // of the table
};

// Of a page's texel with its border: the byte, and the bit in it.
LOAM_INLINE int cutout_byte(int x, int y) {
    return (y >> 1) * kCutoutRowBytes + (x >> 2);
}
LOAM_INLINE int cutout_bit(int x, int y) {
    return (y & 1) * 4 + (x & 3);
}
// Bits as 0 or 1 of the four vertices around a place, x to the east and z to the north of the first; u, v: 0 … 1 between them.
LOAM_INLINE bool cutout_between(vec4 bits, float u, float v) {
    float south = bits.x + (bits.y - bits.x) * u;
    float north = bits.z + (bits.w - bits.z) * u;
    return south + (north - south) * v > 0.5f;
}

LOAM_END_SHARED
#endif
