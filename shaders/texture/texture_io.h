// The virtual texture as shaders see it.
//
// Indirection texel (R32_UINT), one a square of a virtual image's page grid at each mip: the finest page that
// is resident and not finer than the square. The texture is 1.5 times as wide as high: mip 0 of all images,
// and beside it the other mips one above the other (vt_level_origin), each an image's square shrunk with its
// origin. | bits | meaning | encode | | --- | --- | --- | | 0–7 | physical page x | page units | | 8–15 |
// physical page y | page units | | 16–23 | mip of the page: 0 is the image's finest | | | 24–31 | log2 of the
// quad tree's width at that page (its depth) | | 0xffffffff: nothing resident (only before the first root
// page).
//
// Feedback value (R32), page coordinates at that mip; 0xffffffff: no terrain:
// | bits | meaning |
// | --- | --- |
// | 0–7, 8–15 | page x, page y |
// | 16–23 | sector id |
// | 24–28 | mip wanted |
// | 29–31 | by how many mips the page shown is coarser (7: or more) |
//
// Sector table entry (uint, kSectorTableSide² of them, the camera's sector in the cell (32, 32)):
// | bits | meaning |
// | --- | --- |
// | 0–7 | sector id, 0: the default sector |
// | 8–17 | x of the image in the indirection texture, texels |
// | 18–27 | y |
// | 28–31 | log2 of the image's width in pages |
// The outermost ring is always 0, so that a lookup may clamp instead of comparing.
//
// Channels of a physical page: page_format.h.
// Source: Call of Duty talk, "Indirection Texture Texel", "Feedback Buffer Value".
#ifndef LOAM_TEXTURE_IO_H
#define LOAM_TEXTURE_IO_H
#include "shaders/base/shared.h"
#include "shaders/texture/page_format.h"
LOAM_BEGIN_SHARED

#define kPageTexels 256
#define kPageBorder 4
#define kPagePayload 248
#define kSectorTableSide 64   // sectors around the camera that can be live
#define kNoPage 0xffffffffu
#define kNoTerrain 0xffffffffu
#define kFeedbackWidth 240
#define kFeedbackHeight 136
#define kFeedbackMipShift 24u
#define kFeedbackCoarserShift 29u
#define kMaxIndirectionSize 1024  // texels a side of mip 0: what a sector table entry can name
#define kMaxSectorLog2Width 8     // 256 x 256 pages on 64 m: 1.008 mm a texel
#define kIndexPageBorder 4    // of index map pages (maps/index_map.h)
#define kIndexPageLog2 8      // texels of one without its border
#define kIndexPageTexels 264
#define kMaxIndexLevels 16

// Everything that a lookup needs; a storage buffer, one a frame.
struct VtParams {
    ivec2 camera_sector;      // the sector the camera is in
    vec2 camera_offset_m;     // and where in it, [0, 64)
    ivec2 table_origin;       // sector of the table's first cell: camera_sector - 32
    int default_log2_width;   // of the default sector's image, in pages
    int indirection_size;     // texels a side of the indirection texture's mip 0
    float inv_atlas_pages;    // 1 / pages a side of the physical texture
    float mip_bias;           // added to the wanted mip; positive is blurrier
    uint frame;
    uint flags;
    float default_pages_per_sector; // finest pages of the default image a sector: 1, or less for maps above 16,384 m
    float default_log2_texel; // log2 of metres a finest texel of the default image
    float sector_log2_root;   // log2 of metres a texel of a live sector's root page
    float short_share;        // of the filter, see filter_math.h
    float log2_taps;
};

// Which pixels a feedback dispatch looks at: one a cell.
struct FeedbackPush {
    ivec2 cells;
    vec2 jitter;         // in a cell, [0, 1)
    float footprint_log2; // added to the g-buffer's footprints: where that is smaller than the picture it speaks for
};

// Where a mip of the page grids begins in the indirection texture; `size`: VtParams.indirection_size.
LOAM_INLINE ivec2 vt_level_origin(int level, int size) {
    return level == 0 ? ivec2(0, 0) : ivec2(size, size - (size >> (level - 1)));
}

// One dirty square of the indirection texture. The commands of a frame are disjoint: their order does not matter.
struct IndirectionFill {
    int x, y;   // texels
    int size;   // square side, texels
    uint value; // indirection texel
};

// The lookup of any place in the index map, for shading without the cache (direct.glsl).
struct DirectParams {
    ivec2 camera_sector;
    vec2 camera_offset_m;
    float texels_per_m;     // of level 0
    int texels_per_sector;  // of level 0
    int level_count;
    uint last_layer;        // larger indices in the map count as this one
    vec2 distortion_origin; // repeats of the distortion map at the camera's sector
    float distortion_scale; // repeats a metre
    float distortion_reach; // texels of level 0
    float distortion_lod_bias; // log2 of the distortion's texels a metre
    float vista_log2_begin;    // of vista_weight
    float imagery_log2_begin;  // likewise, of the imagery's colours
    float imagery_strength;
    ivec4 levels[kMaxIndexLevels]; // x: first entry in the page table, y: pages x, z: pages y, w: unused
};

LOAM_END_SHARED
#endif
