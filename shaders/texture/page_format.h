// Where a physical page keeps its channels. The formats differ in what the encoder makes of scratch and in how a fetch is
// read; composition and decals know scratch only. Source: Call of Duty talk, "Composition", "Physical Textures", "Extra
// Channel", "4th BC1 Texture".
//
// Scratch, a layer a row (RGBA8; A is a decal's weight while it blends):
// | layer | R | G | B |
// | --- | --- | --- | --- |
// | 0 | albedo r | albedo g | albedo b | square root of the linear value: BC1 spends its bits well, decoding is one multiply
// | 1 | gloss | normal x | occlusion |
// | 2 | metalness | normal y | optional channel (0) |
// | 3 | optional channel | optional channel | optional channel | only where the map has more than one
//
// Textures of a page:
// | layout | textures |
// | --- | --- |
// | kPageRows (BC1, RGBA8) | a texture a layer of scratch: three or four |
// | kPagePairs (BC3) | 0: albedo, A metalness; 1: R occlusion, G normal x, B gloss, A normal y |
// Optional channels fill the places 1: layer 2's blue, 2 … 4: layer 3's red, green, blue, in the order of kChannel…; four bits of
// the placement word a channel hold its place, 0: the map has not got it. kPagePairs has no room for any.
//
// Normal components are (130 + 125 n) / 255: zero is a value that BC1's six bits of green hold exactly.
#ifndef LOAM_TEXTURE_PAGE_FORMAT_H
#define LOAM_TEXTURE_PAGE_FORMAT_H
#include "shaders/base/shared.h"
LOAM_BEGIN_SHARED

#define kMaxPageTextures 4
#define kPageRows 0u
#define kPagePairs 1u

#define kChannelScattering 0u
#define kChannelThermal 1u
#define kChannelEmissive 2u
#define kChannelGlint 3u
#define kChannelDepth 4u  // under the surface, of parallax
#define kChannelCount 5u
#define kMostChannels 4u  // of a map: the places that pages have

LOAM_INLINE uint page_channel_place(uint placement, uint channel) { return placement >> (4u * channel) & 15u; }
// Whether layer 3 and its texture exist.
LOAM_INLINE bool page_has_fourth(uint placement) {
    uint last = 0u;
    for (uint c = 0u; c < kChannelCount; ++c) last = max(last, page_channel_place(placement, c));
    return last > 1u;
}

LOAM_INLINE float page_encode_normal(float n) { return (130.0f + 125.0f * n) / 255.0f; }
LOAM_INLINE float page_decode_normal(float v) { return v * (255.0f / 125.0f) - 130.0f / 125.0f; }

LOAM_END_SHARED
#endif
