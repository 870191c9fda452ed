// The tints of an index page as BC1. Pages of a level share their grid of blocks (border and payload are
// whole blocks), so that a texel has the same block, and shows the same tint, in every page that holds it.
// Source: Call of Duty talk, "Virtual Index & Color Map": the colour map is BC1, the index map is not.
#pragma once

#include <cstdint>
#include <span>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "runtime/base/rect.h"
#include "runtime/store/index_texel.h"

namespace loam {

inline constexpr int kTintBlockTexels = 4;

// The blocks that a rectangle of texels reaches into, in blocks.
[[nodiscard]] TexelRect tint_blocks_of(const TexelRect& texels);
// What shows a change of the texels in a rectangle of the world, in a level of that spacing: all of their blocks' texels.
[[nodiscard]] WorldRect tint_block_rect(const WorldRect& rect, double spacing_m);
// `texels` and `blocks` are a whole page of `side_texels`² and of (side_texels / 4)²; writes those in `rect`
// (in blocks). A block of one tint that 5:6:5 holds, white among them, is exact; of any other it is off
// by 1.5 of 255 at most.
void encode_tint_blocks(std::span<const IndexTexel> texels, int side_texels, const TexelRect& rect,
                        std::span<glm::uvec2> blocks);
// Texel i (row by row) of a block as devices show it, sRGB-encoded, 0…1.
[[nodiscard]] glm::vec3 shown_tint(glm::uvec2 block, int i);

}  // namespace loam
