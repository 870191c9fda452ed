// Base samples of a window of a virtual map, clamped by place. The Document's mips are point samples, so that
// the last sample of mip m may lie before the map's edge; clamping within each mip would give levels
// different values beyond the edge. Here a place beyond the edge takes the mip-0 sample at the edge, whatever
// the mip.
#pragma once

#include <algorithm>

#include <glm/common.hpp>
#include <glm/vec2.hpp>

#include "runtime/document/document.h"
#include "runtime/document/operator.h"

namespace loam {

// Coordinates in samples of the mip; row-major into `out`. The caller holds the document's ReadLock.
void read_heights_by_place(const Document& document, int mip, glm::ivec2 first, glm::ivec2 size,
                           int32_t* out);
void read_index_by_place(const Document& document, int mip, glm::ivec2 first, glm::ivec2 size,
                         IndexTexel* out);

// A spacing whose products with sample indices of up to 19 bits are exact, and their sums too: a sample's
// position is then the same double from whatever window it is reached. Differs from `spacing_m` by less than
// 1 µm over 16.8 km.
[[nodiscard]] double exact_spacing(double spacing_m);

// A changed rectangle that reaches the map's edge changes what is clamped beyond it too.
[[nodiscard]] WorldRect extended_beyond_edges(const WorldRect& rect, const WorldRect& bounds);

// The smallest number of levels for which one page covers `extent_m`.
[[nodiscard]] int level_count_for(double extent_m, double spacing_m, int payload_texels);

}  // namespace loam
