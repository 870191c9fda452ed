// One texel of the index and colour base map, as it is in memory and in every page.
#pragma once

#include <cstdint>

namespace loam {

struct IndexTexel {
    uint16_t layer = 0;
    uint8_t tint[3] = {255, 255, 255};  // sRGB-encoded, multiplies the layer's albedo
    uint8_t unused = 0;
    bool operator==(const IndexTexel&) const = default;
};
static_assert(sizeof(IndexTexel) == 6);

}  // namespace loam
