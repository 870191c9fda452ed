// The virtual texture as shaders see it.
//
// Indirection texel (R32_UINT), one a finest page of a virtual image:
// | bits | meaning | encode |
// | --- | --- | --- |
// | 0–7 | physical page x | page units |
// | 8–15 | physical page y | page units |
// | 16–23 | mip of the page: 0 is the image's finest | |
// | 24–31 | log2 of the quad tree's width at that page (its depth) | |
// 0xffffffff: nothing resident (only before the first root page).
//
// Feedback value (R32): mip : 8 | sector id : 8 | page y : 8 | page x : 8, from the high byte down; page coordinates at
// that mip. 0xffffffff: no terrain.
// Source: Call of Duty talk, "Indirection Texture Texel", "Feedback Buffer Value".
#ifndef LOAM_TEXTURE_IO_H
#define LOAM_TEXTURE_IO_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

#define kPageTexels 256
#define kPageBorder 4
#define kPagePayload 248
#define kSectorTableSide 64   // sectors around the camera that can be live, toroidal window
#define kNoPage 0xffffffffu

// Everything that a lookup needs; a storage buffer, one a frame.
struct VtParams {
    ivec2 camera_sector;      // the sector the camera is in
    vec2 camera_offset_m;     // and where in it, [0, 64)
    ivec2 table_origin;       // sector of the table's window corner; sectors outside use the default sector
    int default_log2_width;   // the default sector is 64 m << this wide: depth of its finest pages
    int sector_log2_width;    // of live sectors' images, in pages
    float inv_atlas_pages;    // 1 / pages a side of the physical texture
    float mip_bias;           // added to the wanted mip; positive is blurrier
    uint frame;
    uint flags;
    // Table entry of a sector, follows in the sector table buffer: uint = id | x << 8 | y << 20 … see vt_sample.glsl
};

LOAM_END_SHARED
#endif
