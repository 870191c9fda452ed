// Whether the ground is cut at a camera-relative place.
//
//   binding CUTOUT_FIRST_SLOT      storage buffer   the table, four pages a word
//   binding CUTOUT_FIRST_SLOT + 1  storage buffer   bits of the mixed pages, kCutoutPageWords each
#include "shaders/geometry/cutout_io.h"

layout(binding = CUTOUT_FIRST_SLOT, scalar) readonly buffer CutoutTable {
    uint cutout_table[];
};
layout(binding = CUTOUT_FIRST_SLOT + 1, scalar) readonly buffer CutoutPages {
    uint cutout_pages[];
};

float cutout_vertex(uint first_word, ivec2 texel) {
    int at = cutout_byte(texel.x, texel.y);
    uint byte_bits = cutout_pages[first_word + uint(at >> 2)] >> uint((at & 3) * 8);
    return float(byte_bits >> uint(cutout_bit(texel.x, texel.y)) & 1u);
}

bool is_cut(vec2 rel_m, CutoutPush push) {
    vec2 at = (rel_m - push.origin_rel_m) * push.inv_spacing;
    vec2 whole = floor(at);
    ivec2 cell = max(push.origin + ivec2(whole), ivec2(0));
    ivec2 page = min(cell / kCutoutPayload, push.pages - 1); // the map's last vertices are the far edge of its last pages
    int entry_at = page.y * push.pages.x + page.x;
    uint entry = cutout_table[entry_at >> 2] >> uint((entry_at & 3) * 8) & 255u;
    if (entry == kCutoutGround || entry == kCutoutGone) return entry == kCutoutGone;
    ivec2 texel = min(cell - page * kCutoutPayload + kCutoutBorder, ivec2(kCutoutTexels - 2));
    uint first = (entry - 1u) * kCutoutPageWords;
    vec4 bits = vec4(cutout_vertex(first, texel), cutout_vertex(first, texel + ivec2(1, 0)),
                     cutout_vertex(first, texel + ivec2(0, 1)), cutout_vertex(first, texel + ivec2(1, 1)));
    vec2 f = at - whole;
    return cutout_between(bits, f.x, f.y);
}
