// The distortion map: how far a lookup of index and tint moves from where it asks, so that the index map's squares do not show.
// Made once from periodic noise, so that it tiles without a seam. Source: Call of Duty talk, "Distortion": a global 256x256 map,
// amplitude and frequency a setting of the map, applied before index and colour map are sampled.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec2.hpp>
#include <glm/gtc/type_precision.hpp>

namespace loam {

inline constexpr int kDistortionTexels = 256;

// Mips from 256² to 1², row by row, east and north, -1 … 1 as halves (R16G16_SFLOAT).
[[nodiscard]] std::vector<std::vector<glm::u16vec2>> make_distortion();

}  // namespace loam
