// Tile hiding: the ground in sections of four by four index vertices, and each section's textures turned by one of sixteen
// angles, so that no repeat of a texture lies beside another as it is.
// Source: Call of Duty talk, "Tile Hiding": a rotation a vertex from its world position, "reduced by 1/4 so we get sections of
// uniform rotation"; layers of one index merge only where their rotations agree. What differs: the angle is a multiple of 2 pi / 16
// and comes from a hash of the section (the talk's formula gives four values of the sixteen), and a section turns about its own
// middle and is shifted as well, so that the place in the texture is computed from small numbers wherever on the map it lies.
//
// A corner's key stands for its layer when layers are merged and ordered (ompv.h):
// | bits | meaning |
// | --- | --- |
// | 0, 1 | parity of the section's x and y: neighbours are told apart, and the section is found from any texel beside it |
// | 2–5 | turn, sixteenths of a circle |
// | 6–21 | layer |
#ifndef LOAM_TEXTURE_TILE_HIDING_H
#define LOAM_TEXTURE_TILE_HIDING_H
#include "shaders/base/shared.h"
#include "shaders/document/noise_math.h"
LOAM_BEGIN_SHARED

#define kSectionLog2 2  // a section is so wide, log2 of level-0 vertices
#define kKeyLayerShift 6u
#define kSectionSeed 0x7115u

// log2 of a section's width in vertices of a level. From level 2 on every vertex is in a section of its own.
LOAM_INLINE int section_shift(int level) { return level < kSectionLog2 ? kSectionLog2 - level : 0; }

// Sections are those of level 0: the vertices that two levels share are in the same one.
LOAM_INLINE uint section_hash(int x, int y, int level) {
    int up = level > kSectionLog2 ? level - kSectionLog2 : 0;
    return noise_cell(x << up, y << up, kSectionSeed);
}

// x, y: the vertex, counted in those of the level from the map's corner.
LOAM_INLINE uint tile_key(uint layer, int x, int y, int level) {
    int shift = section_shift(level);
    int section_x = x >> shift, section_y = y >> shift;
    uint turn = section_hash(section_x, section_y, level) & 15u;
    return layer << kKeyLayerShift | turn << 2u | uint(section_y & 1) << 1u | uint(section_x & 1);
}

// Where the section of a key lies: its middle in index texels from `vertex`, the lower left one of the four around a texel; and
// its shift, in repeats of a texture.
struct SectionPlace {
    vec2 middle;
    vec2 shift;
};

LOAM_INLINE SectionPlace section_place(uint key, ivec2 vertex, int level) {
    int shift = section_shift(level);
    int x = vertex.x >> shift, y = vertex.y >> shift;
    x += (x ^ int(key)) & 1; // the other section's parity: it begins at the next vertex
    y += (y ^ int(key >> 1u)) & 1;
    float middle = 1.5f / float(1 << level); // of vertices 0 to 3
    uint hash = section_hash(x, y, level);
    SectionPlace place;
    place.middle = vec2(float((x << shift) - vertex.x) + middle, float((y << shift) - vertex.y) + middle);
    place.shift = vec2(float(hash >> 8u & 0xffu), float(hash >> 16u & 0xffu)) * (1.0f / 256.0f);
    return place;
}

LOAM_END_SHARED
#endif
