// ASTC on the CPU, read from the bits by the specification's own steps and tables, so that it is a check of
// the encoder's.
#pragma once

#include <array>
#include <cstdint>

#include <glm/glm.hpp>

namespace loam {

// What decode_block of block_decoder.h says of ASTC. `texels`: side × side.
void astc_decode_block(const std::array<uint32_t, 4>& block, int side, glm::vec4* texels);

}  // namespace loam
