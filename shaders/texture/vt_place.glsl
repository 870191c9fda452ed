// Where a terrain position is in its virtual image, and which mip its footprint wants: what sampling and feedback share.
// Slots: VT_FIRST_SLOT + 0 VtParams (VirtualTexture::params()), + 1 sector table (VirtualTexture::sector_table()).
#ifndef LOAM_TEXTURE_VT_PLACE_GLSL
#define LOAM_TEXTURE_VT_PLACE_GLSL
#include "shaders/texture/filter_math.h"
#include "shaders/texture/texture_io.h"

#ifndef VT_FIRST_SLOT
#define VT_FIRST_SLOT 0
#endif
layout(binding = VT_FIRST_SLOT + 0, scalar) readonly buffer VtParamsBuffer { VtParams vt; };
layout(binding = VT_FIRST_SLOT + 1, scalar) readonly buffer VtTable { uint vt_table[]; };

struct VtPlace {
    ivec2 origin;   // of the image in the indirection texture's mip 0
    vec2 pages;     // position in the image, finest pages
    ivec2 cell;     // the finest page, inside the image
    float wanted;   // mip, not limited below, at most the image's coarsest
    uint id;        // sector id
    int log2_width; // of the image
    float log2_texel;  // wanted, metres
    float log2_finest; // the image's finest, metres
};

VtPlace vt_place(ivec2 sector_delta, vec2 offset_m, float log2_long, float log2_short) {
    VtPlace place;
    ivec2 slot = clamp(sector_delta + kSectorTableSide / 2, ivec2(0), ivec2(kSectorTableSide - 1));
    uint entry = vt_table[slot.y * kSectorTableSide + slot.x];
    float log2_texel = filter_log2_texel(log2_long, log2_short, vt.short_share, vt.log2_taps) + vt.mip_bias;
    // Coarser texels than the sector's root has come from the default image: what a pixel shows does not depend on which sectors
    // happen to be live. A footprint that is not a number goes there too.
    bool live = entry != 0u && log2_texel < vt.sector_log2_root + 1.0;
    place.id = live ? entry & 0xffu : 0u;
    place.origin = live ? ivec2(entry >> 8u & 0x3ffu, entry >> 18u & 0x3ffu) : ivec2(0);
    place.log2_width = live ? int(entry >> 28u) : vt.default_log2_width;
    vec2 in_sector = offset_m * (1.0 / 64.0);
    vec2 default_pages = (vec2(vt.camera_sector + sector_delta) + in_sector) * vt.default_pages_per_sector;
    place.pages = live ? in_sector * float(1 << place.log2_width) : default_pages;
    place.cell = clamp(ivec2(floor(place.pages)), ivec2(0), ivec2((1 << place.log2_width) - 1));
    float coarsest = float(place.log2_width);
    place.log2_texel = log2_texel;
    place.log2_finest = live ? vt.sector_log2_root - coarsest : vt.default_log2_texel;
    float wanted = log2_texel - place.log2_finest;
    place.wanted = wanted < coarsest ? wanted : coarsest;
    return place;
}

// The mip of the page grid that a place looks at: no page finer than wanted is shown, or texels would alias.
int vt_level(VtPlace place) {
    return clamp(int(floor(place.wanted)), 0, place.log2_width);
}

ivec2 vt_indirection_texel(VtPlace place) {
    int level = vt_level(place);
    return vt_level_origin(level, vt.indirection_size) + ((place.origin + place.cell) >> level);
}

// Position relative to the camera to sector and offset. rel_m: metres from the camera.
void vt_split(vec2 rel_m, out ivec2 sector_delta, out vec2 offset_m) {
    vec2 at = vt.camera_offset_m + rel_m;
    vec2 sector = floor(at * (1.0 / 64.0));
    sector_delta = ivec2(sector);
    offset_m = at - sector * 64.0;
}
#endif
