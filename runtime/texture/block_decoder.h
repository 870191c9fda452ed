// Compressed blocks back to texels on the CPU, as a device shows them: to measure what compression lost, also
// where no device at hand can sample the format.
#pragma once

#include <cstdint>
#include <span>

#include "runtime/texture/block_encoder.h"

namespace loam {

// `texels`: side × side of the format's shape, row by row, 0…1. BC1 as three colours and black, too, which
// Loam's encoder does not write. ASTC: every two-dimensional block mode and void extent of low range with one
// partition and RGB or RGBA endpoints, direct or scaled; anything else is the format's error
// colour, magenta.
void decode_block(BlockFormat format, const uint8_t* block, glm::vec4* texels);

// Mean of the channels' squared errors in steps of 255, each channel alone, of an RGBA8 image and its blocks.
[[nodiscard]] glm::dvec4 mean_square_errors(BlockFormat format, std::span<const uint8_t> blocks,
                                            std::span<const uint8_t> rgba, glm::ivec2 size_texels);
[[nodiscard]] double decibels(double mean_square_error);  // PSNR; 99 of none

}  // namespace loam
