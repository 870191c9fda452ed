// Errors in units that suit what a channel holds.
#pragma once

#include <span>
#include <vector>

#include <glm/vec3.hpp>

#include "editor/packer/formats.h"

namespace loam {

// CIE 1976 colour difference of two sRGB-encoded colours (D65).
[[nodiscard]] float delta_e(glm::vec3 srgb_a, glm::vec3 srgb_b);
// Between unit vectors; exact for small angles, too.
[[nodiscard]] float angle_deg(glm::vec3 a, glm::vec3 b);
// Of squared differences of values 0…1; 99 where all are 0.
[[nodiscard]] double psnr_of(std::span<const float> squares);
[[nodiscard]] ChannelError summary_of(std::vector<float> errors);

}  // namespace loam
