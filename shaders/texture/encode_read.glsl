// What the two encoders share: a thread a unit (block or texel), and a texel of mip kMip of a rectangle of a page texture,
// its channels gathered from scratch (page_format.h); mip 1 is the mean of four texels, or was composed for itself.
// Specialisation constants: 0: the mip, 30: the layout, kPageRows or kPagePairs.
#include "shaders/texture/page_format.h"
layout(constant_id = 0) const int kMip = 0;
layout(constant_id = 30) const uint kPageLayout = kPageRows;
layout(binding = 0) uniform sampler2DArray scratch;
layout(binding = 2, scalar) readonly buffer Rects { ComposeRect rects[]; };
layout(binding = 3, scalar) readonly buffer Tiles { ComposeTile tiles[]; };
layout(push_constant, scalar) uniform Push { EncodePush push; };

// Where a unit of a tile lies: units a texel square's side (2 or 1 blocks, 4 texels of mip 1 …) as a power of two.
struct Unit {
    ivec2 at;          // of the rectangle's mip, units
    ivec2 scratch_min;
    bool as_composed;  // scratch holds the mip's own texels there
    uint rect;
};

// Albedo is stored as a square root: its mip averages the square.
vec3 read_layer(Unit unit, ivec2 texel, int layer) {
    if (unit.as_composed) return texelFetch(scratch, ivec3(unit.scratch_min + texel, layer), 0).rgb;
    ivec3 at = ivec3(unit.scratch_min + texel * 2, layer);
    precise vec3 a = texelFetch(scratch, at, 0).rgb;
    precise vec3 b = texelFetch(scratch, at + ivec3(1, 0, 0), 0).rgb;
    precise vec3 c = texelFetch(scratch, at + ivec3(0, 1, 0), 0).rgb;
    precise vec3 d = texelFetch(scratch, at + ivec3(1, 1, 0), 0).rgb;
    precise vec3 mean = (a + b + c + d) * 0.25;
    precise vec3 mean_square = sqrt((a * a + b * b + c * c + d * d) * 0.25);
    return layer == 0 ? mean_square : mean;
}

vec4 read_texel(Unit unit, ivec2 texel, int which) {
    vec3 own = read_layer(unit, texel, which);
    if (kPageLayout == kPageRows) return vec4(own, 1.0);
    vec3 metal = read_layer(unit, texel, 2);
    return which == 0 ? vec4(own, metal.r) : vec4(own.bgr, metal.g);
}

Unit unit_of(uint thread, int log2_side) {
    uint tile = tiles[thread >> (2 * log2_side)].place;
    int inside = int(thread) & ((1 << (2 * log2_side)) - 1);
    Unit unit;
    unit.rect = tile >> 10u;
    unit.at = (ivec2(tile & 31u, tile >> 5u & 31u) << log2_side) + ivec2(inside & ((1 << log2_side) - 1), inside >> log2_side);
    ivec2 mip_min = rects[unit.rect].mip_min;
    bool own_mip = kMip == 1 && mip_min.x >= 0;
    unit.scratch_min = own_mip ? mip_min : rects[unit.rect].scratch_min;
    unit.as_composed = kMip == 0 || own_mip;
    return unit;
}
