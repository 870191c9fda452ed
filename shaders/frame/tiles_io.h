// Screen tiles by class of filter: a list of tiles and the arguments of an indirect draw, one a class.
// Source: Far Cry 5, "Terrain Classification Pass". Differs: classes are taps of the texture filter, not shader variants.
#ifndef LOAM_FRAME_TILES_IO_H
#define LOAM_FRAME_TILES_IO_H
#include "shaders/base/shared.h"
#include "shaders/texture/filter_math.h"
LOAM_BEGIN_SHARED

struct ClassifyPush {
    ivec2 picture_px;
    ivec2 tiles;       // of the picture
    float short_share; // of the filter
    float log2_taps;
};

// As VkDrawIndirectCommand: a tile is an instance. The list of class c begins at c times the picture's tiles.
struct TileDraw {
    uint vertex_count;
    uint instance_count;
    uint first_vertex;
    uint first_instance;
};

LOAM_END_SHARED
#endif
