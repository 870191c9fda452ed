// Composition of page rectangles and their compression.
#ifndef LOAM_TEXTURE_COMPOSE_IO_H
#define LOAM_TEXTURE_COMPOSE_IO_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

#define kScratchWidth 1024
#define kScratchHeight 512
#define kComposeGroup 8

// A layer's constants.
struct LayerParams {
    float inv_tile_m;  // repeats a metre
    float lod_bias;    // log2 of texels a metre of mip 0
    float unused0, unused1;
};

// How a layer lies under a position: uv = offset + position * scale, lod = lod_bias + log2 of the texel's size. For a
// page, the position is 0…1 across its payload; the offset is the page's corner modulo the tile, from doubles.
struct LayerPlace {
    vec2 offset;
    float scale;
    float lod_bias;
};

struct ComposePush {
    ivec2 rect_min;      // texels of the page, border included
    ivec2 rect_size;
    ivec2 scratch_min;   // where rect_min goes
    vec2 index_origin;   // the payload's corner in texels of the index page, border included
    float index_scale;   // index texels a payload side
    uint index_slot;
    uint first_place;    // of the job's layer places
    uint layer;          // of one-layer pages
    uint last_layer;     // larger indices in the map count as this one
};

struct EncodePush {
    ivec2 scratch_min;   // texels
    ivec2 size;          // blocks (BC1) or texels (RGBA8) of this mip
    uint first;          // output index: uvec2 (BC1) or uint (RGBA8)
    uint albedo;         // 1: mips average the square, as albedo is stored as a square root
    vec2 unused;
    vec4 weights;        // of the channels in the block compressor
};

LOAM_END_SHARED
#endif
