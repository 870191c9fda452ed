// Composition of page rectangles and their compression.
#ifndef LOAM_TEXTURE_COMPOSE_IO_H
#define LOAM_TEXTURE_COMPOSE_IO_H
#include "shaders/base/shared.h"
#include "shaders/texture/page_format.h"
LOAM_BEGIN_SHARED

#define kScratchWidth 1024
#define kScratchHeight 512

// How a layer lies under a position: uv = offset + position * scale, lod = lod_bias + log2 of the texel's size. For a
// page, the position is 0…1 across its payload; the offset is the page's corner modulo the tile, from doubles.
struct LayerPlace {
    vec2 offset;
    float scale;
    float lod_bias;
    uint slot;       // of the layer's textures in their arrays
    uint first;      // the layer itself; of a transition: from
    uint second;     // the layer itself; of a transition: to
    float threshold; // of a transition
    vec2 vista_offset;  // of the magnified lookup (vista.h), as offset, scale and lod_bias of the plain one
    float vista_scale;
    float vista_lod_bias;
    vec4 channels;  // amounts of the optional channels, by place in pages; of a transition: those of its
                    // layers count
};

// A rectangle of a page to be composed and encoded.
struct ComposeRect {
    ivec2 rect_min;      // texels of the page, border included
    ivec2 rect_size;
    ivec2 scratch_min;   // where rect_min goes
    vec2 index_origin;   // the payload's corner in texels of the index page, border included
    float index_scale;   // index texels a payload side
    uint index_slot;
    ivec2 index_vertex;  // the index page's texel (0, 0) in texels of its level, from the map's corner
    int index_level;
    // Distortion's place = origin + position * scale, in repeats of its map (distortion.h).
    vec2 distortion_origin;
    float distortion_scale;
    float distortion_reach; // index texels of the level
    float distortion_lod;
    float vista;    // weight of the magnified lookup; as imagery's above 0 only in squares of that kind
    float imagery;  // weight of the imagery's colours
    ivec2 mip_min;  // where the second mip lies in scratch as a rectangle composed for itself; x < 0: it is
                    // the mean
    uint first_place;    // of the rectangle's layer places
    uint last_layer;     // larger indices in the map count as this one
    ivec2 target;  // where rect_min goes in the page textures, texels; x < 0: nowhere, a second mip is read
                   // with the rectangle it belongs to
    uint first_block;  // of compressed output: mip by mip, texture by texture
    uint blocks;       // a texture
};

// Work is listed in squares of 8 texels, so that a dispatch holds any number of rectangles, and those of a
// page that hold one layer run another pipeline than those where layers meet.
#define kTileTexels 8
struct ComposeTile {
    uint place;  // bits 0-4: x in the rectangle, squares; 5-9: y; 10-31: the rectangle
    uint layer;  // of a square of one layer; with tile hiding its key (tile_hiding.h)
};
LOAM_INLINE uint compose_tile_place(uint rect, uint x, uint y) {
    return rect << 10u | y << 5u | x;
}

struct ComposePush {
    uint first_tile;     // of this dispatch
};

struct EncodePush {
    uint tile_count;
    vec4 weights[kMaxPageTextures]; // of each texture's colour channels in the block compressor
};

LOAM_END_SHARED
#endif
